//! Putting a set's pieces on the sides of a plane, and cutting what spans it.

use super::{Builder, Live};
use crate::Error;
use crate::geom::{Kernel, PlaneId, Side, reserve, split};

/// So many pieces are put on sides of a plane before it is asked whether to go on. Smaller: time
/// for asking; larger: it takes longer to stop.
const AT_ONCE: usize = 4096;
/// To cut a piece is as much work as to look at so many.
const CUT: usize = 64;

impl<K: Kernel> Builder<'_, K> {
    pub(super) fn classify(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
        let (kernel, faces) = (self.shared.kernel, self.shared.faces);
        let splitter = kernel.splitter(faces, plane);
        let arena = &self.arena;
        let side = |live: &Live| kernel.classify(faces, &splitter, live.piece(arena));
        self.scratch.sides.clear();
        for pieces in self.pieces[start..].chunks(AT_ONCE) {
            self.shared.watch.work(pieces.len())?;
            self.scratch.sides.extend(pieces.iter().map(side));
        }
        Ok(())
    }

    pub(super) fn makes_progress(&self, count: usize) -> bool {
        let sides = &self.scratch.sides;
        let reach = |other: Side| {
            sides.iter().filter(|&&side| side == other || side == Side::Spanning).count()
        };
        reach(Side::Front) < count && reach(Side::Back) < count
    }

    pub(super) fn partition(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
        self.classify(start, plane)?;
        self.divide(start, plane)
    }

    /// Divides the set on top of the stack by the sides just found: what is behind stays there, what
    /// is in front is left in `scratch.front`, and what is on the plane in `scratch.own`.
    pub(super) fn divide(&mut self, start: usize, plane: PlaneId) -> Result<(), Error> {
        let scratch = &mut self.scratch;
        scratch.own.clear();
        scratch.front.clear();
        scratch.spanning.clear();
        let in_front = |side: &&Side| matches!(side, Side::Front | Side::Spanning);
        reserve(&mut scratch.front, scratch.sides.iter().filter(in_front).count());
        let mut back = start;
        for (i, &side) in scratch.sides.iter().enumerate() {
            let piece = self.pieces[start + i];
            match side {
                Side::Back => {
                    self.pieces[back] = piece;
                    back += 1;
                }
                Side::Front => scratch.front.push(piece),
                Side::Coplanar => scratch.own.push(piece),
                Side::Spanning => scratch.spanning.push(piece),
            }
        }
        self.pieces.truncate(back);
        self.shared.count(self.scratch.spanning.len())?;
        self.cut_spanning(plane)
    }

    fn cut_spanning(&mut self, plane: PlaneId) -> Result<(), Error> {
        let (kernel, faces) = (self.shared.kernel, self.shared.faces);
        let splitter = kernel.splitter(faces, plane);
        let scratch = &mut self.scratch;
        for live in &scratch.spanning {
            self.shared.watch.work(CUT)?;
            scratch.outline.clear();
            match live.piece(&self.arena).cut {
                Some(vertices) => scratch.outline.extend_from_slice(vertices),
                None => {
                    let corners = 0..faces.corners(live.face).len() as u32;
                    scratch.outline.extend(corners.map(|k| kernel.corner(faces, live.face, k)));
                }
            }
            scratch.front_part.clear();
            scratch.back_part.clear();
            split(
                &kernel,
                faces,
                (plane, &splitter),
                live.face,
                &scratch.outline,
                &mut scratch.front_part,
                &mut scratch.back_part,
            );
            for (part, list) in
                [(&scratch.back_part, &mut self.pieces), (&scratch.front_part, &mut scratch.front)]
            {
                let start = self.arena.len();
                self.arena.extend_from_slice(part);
                list.push(Live::cut::<K>(live, &self.arena, start));
            }
        }
        Ok(())
    }
}
