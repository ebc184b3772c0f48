//! Cuts a piece in two, within the arena that holds the vertices of cut pieces.

use super::live::Live;
use crate::Error;
use crate::exact::{Faces, Kernel, split};
use crate::memory::reserve;

/// Lists that are reused for every cut.
#[derive(Debug)]
pub(crate) struct Knife<V> {
    outline: Vec<V>,
    front: Vec<V>,
    back: Vec<V>,
}

impl<V> Default for Knife<V> {
    fn default() -> Self {
        Self { outline: vec![], front: vec![], back: vec![] }
    }
}

impl<V> Knife<V> {
    /// Cuts a piece that spans a plane. Appends the vertices of its parts to the arena, and gives the
    /// parts in front and behind.
    pub(crate) fn cut<K: Kernel<Vertex = V>>(
        &mut self,
        kernel: &K,
        faces: &Faces,
        splitter: &K::Splitter,
        live: &Live,
        arena: &mut Vec<V>,
    ) -> Result<[Live; 2], Error>
    where
        V: Copy,
    {
        let Self { outline, front, back } = self;
        // Copied, because the parts are appended to the arena that the piece's vertices are in.
        outline.clear();
        match live.piece(arena).cut {
            Some(vertices) => outline.extend_from_slice(vertices),
            None => {
                let corners = 0..faces.corners(live.face).len() as u32;
                outline.extend(corners.map(|k| kernel.corner(faces, live.face, k)));
            }
        }
        front.clear();
        back.clear();
        split(kernel, faces, splitter, live.face, outline, front, back);
        // The piece's own vertices stay behind as garbage until the arena is compacted or truncated.
        let start = arena.len();
        reserve(arena, front.len() + back.len())?;
        arena.extend_from_slice(front);
        arena.extend_from_slice(back);
        let front_part = Live::cut::<K>(live, front, start);
        Ok([front_part, Live::cut::<K>(live, back, start + front.len())])
    }
}
