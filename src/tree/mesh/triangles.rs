//! Triangles of fragments as indices, and their order for a viewpoint.

use std::ops::Range;

use crate::Error;
use crate::memory::reserve;
use crate::tree::BspTree;
use crate::viewpoint::Viewpoint;

/// Triangles of a tree's fragments: three vertices of a [`Mesh`](crate::Mesh) each, one range of
/// indices a fragment.
///
/// [`Mesh::triangles`](crate::Mesh::triangles) has those of all fragments,
/// [`Mesh::triangles_of`](crate::Mesh::triangles_of) those of some polygons, such as the translucent
/// ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Triangles {
    /// Where each fragment's indices begin, and the end of the last.
    starts: Vec<u32>,
    indices: Vec<u32>,
}

impl Triangles {
    /// Room for so many indices of each fragment.
    pub(super) fn with_lengths(lengths: impl Iterator<Item = u32>) -> Result<Self, Error> {
        let (mut starts, mut indices) = (Vec::new(), Vec::new());
        reserve(&mut starts, lengths.size_hint().0 + 1)?;
        let mut sum = 0_u32;
        starts.push(sum);
        for length in lengths {
            sum = sum.checked_add(length).ok_or(Error::too_many_indices())?;
            starts.push(sum);
        }
        reserve(&mut indices, sum as usize)?;
        indices.resize(sum as usize, 0);
        Ok(Self { starts, indices })
    }

    /// The indices of a fragment, to be filled in.
    pub(super) fn of_mut(&mut self, fragment: u32) -> &mut [u32] {
        let range = self.range(fragment);
        &mut self.indices[range]
    }

    /// Those of some fragments alone.
    pub(super) fn of_fragments(&self, keep: impl Fn(u32) -> bool) -> Result<Self, Error> {
        let fragments = 0..self.starts.len() as u32 - 1;
        let kept = |fragment| if keep(fragment) { self.range(fragment) } else { 0..0 };
        let mut some = Self::with_lengths(fragments.clone().map(|f| kept(f).len() as u32))?;
        for fragment in fragments {
            some.of_mut(fragment).copy_from_slice(&self.indices[kept(fragment)]);
        }
        Ok(some)
    }

    /// All indices in the order of the fragments' numbers, for what is drawn in any order.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Which of [`indices`](Self::indices) a fragment has, given its number.
    ///
    /// # Panics
    ///
    /// If there is no such fragment.
    pub fn range(&self, fragment: u32) -> Range<usize> {
        let fragment = fragment as usize;
        self.starts[fragment] as usize..self.starts[fragment + 1] as usize
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.starts) + size_of_val(&*self.indices)
    }

    /// Writes the indices back to front, and returns how many: always the length of
    /// [`indices`](Self::indices). Inside a fragment the triangles keep their order.
    ///
    /// `indices` may be mapped memory of a device: each place is written once, from the first on,
    /// and none is read. Places beyond are left as they are. `order` is working space, in which the
    /// order of the fragments is left; as in
    /// [`back_to_front_into`](BspTree::back_to_front_into), nothing is allocated once it has grown.
    ///
    /// O(n).
    ///
    /// # Errors
    ///
    /// If `indices` is too short, or the tree is not the one that the mesh was made of and has
    /// another number of fragments. Then nothing is written.
    pub fn write_back_to_front(
        &self,
        tree: &BspTree,
        viewpoint: Viewpoint,
        order: &mut Vec<u32>,
        indices: &mut [u32],
    ) -> Result<usize, Error> {
        let (count, fragments) = (self.indices.len(), self.starts.len() - 1);
        if tree.len() != fragments {
            return Err(Error::other_tree(tree.len(), fragments));
        }
        let given = indices.len();
        let places = indices.get_mut(..count).ok_or(Error::places(count, given))?;
        tree.back_to_front_into(viewpoint, order);
        self.write(order, places);
        Ok(count)
    }

    /// Writes the indices of fragments one after the other.
    fn write(&self, order: &[u32], mut places: &mut [u32]) {
        for &fragment in order {
            let Range { start, end } = self.range(fragment);
            // Most fragments have one triangle or two: calling `memcpy` for each takes longer.
            for triangle in self.indices[start..end].as_chunks::<3>().0 {
                let Some((place, rest)) = places.split_first_chunk_mut::<3>() else { return };
                *place = *triangle;
                places = rest;
            }
        }
    }
}
