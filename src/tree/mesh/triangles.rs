//! Triangles of fragments as indices, and the order of the triangles for a viewpoint.

use std::ops::Range;

use crate::error::{Error, Kind};
use crate::memory::reserve;
use crate::tree::BspTree;
use crate::viewpoint::Viewpoint;

/// Triangles of a tree's [fragments](crate::Fragment). Each triangle has three vertices of a
/// [`Mesh`](crate::mesh::Mesh), and each fragment has one range of indices.
///
/// [`Mesh::triangles`](crate::mesh::Mesh::triangles) returns the triangles of all fragments.
/// [`Mesh::triangles_of`](crate::mesh::Mesh::triangles_of) returns the triangles of some polygons, such as
/// the translucent polygons.
#[derive(Clone, Debug)]
pub struct Triangles {
    /// The generation of the tree.
    generation: u64,
    /// The number of the first fragment in orders: 0, or the number of an overlay's first piece.
    first: usize,
    /// The number of the mesh's vertices.
    pub(super) vertices: u32,
    /// The first index of each fragment, and the end of the last fragment's indices.
    starts: Vec<u32>,
    /// All indices, and then [`CHUNK`] unused entries.
    indices: Vec<u32>,
    /// The number of triangles of each fragment, if all fragments have the same number.
    each: Option<u32>,
}

/// Triangles of two trees are equal if they have the same indices.
impl PartialEq for Triangles {
    fn eq(&self, other: &Self) -> bool {
        (&self.starts, &self.indices) == (&other.starts, &other.indices)
    }
}

impl Eq for Triangles {}

impl Triangles {
    /// Creates triangles with a given number of indices for each fragment, to be filled in.
    pub(super) fn with_lengths(
        generation: u64,
        first: usize,
        lengths: impl Iterator<Item = u32>,
    ) -> Result<Self, Error> {
        let (mut starts, mut indices) = (Vec::new(), Vec::new());
        reserve(&mut starts, lengths.size_hint().0 + 1)?;
        let mut sum = 0_u32;
        starts.push(sum);
        for length in lengths {
            sum = sum.checked_add(length).ok_or(Kind::Indices.error())?;
            starts.push(sum);
        }
        reserve(&mut indices, sum as usize + CHUNK)?;
        indices.resize(sum as usize + CHUNK, 0);
        let mut lengths = starts.windows(2).map(|ends| ends[1] - ends[0]);
        let length = lengths.next().unwrap_or(0);
        let each = lengths.all(|other| other == length).then_some(length / 3);
        Ok(Self { generation, first, vertices: 0, starts, indices, each })
    }

    /// The indices of the fragment at place `at` of this mesh, to be filled in.
    pub(super) fn of_mut(&mut self, at: usize) -> &mut [u32] {
        let range = self.range_at(at);
        &mut self.indices[range]
    }

    /// The triangles of some fragments only, chosen by their indices.
    pub(super) fn of_fragments(&self, keep: impl Fn(&[u32]) -> bool) -> Result<Self, Error> {
        let fragments = 0..self.starts.len() - 1;
        let kept = |at| Some(&self.indices[self.range_at(at)]).filter(|indices| keep(indices));
        let kept = |at| kept(at).unwrap_or_default();
        let lengths = fragments.clone().map(|at| kept(at).len() as u32);
        let mut some = Self::with_lengths(self.generation, self.first, lengths)?;
        some.vertices = self.vertices;
        for at in fragments {
            some.of_mut(at).copy_from_slice(kept(at));
        }
        Ok(some)
    }

    /// Returns all indices in the order of the fragments' numbers, for drawing without an order.
    pub fn indices(&self) -> &[u32] {
        &self.indices[..self.indices.len() - CHUNK]
    }

    /// Returns the range of a fragment's indices in [`indices`](Self::indices).
    ///
    /// # Panics
    ///
    /// If no fragment has this number.
    pub fn range(&self, fragment: u32) -> Range<usize> {
        self.range_at(fragment as usize - self.first)
    }

    fn range_at(&self, at: usize) -> Range<usize> {
        self.starts[at] as usize..self.starts[at + 1] as usize
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.starts) + size_of_val(&*self.indices)
    }

    /// Writes the indices back to front and returns the number of indices: always the length of
    /// [`indices`](Self::indices).
    ///
    /// `tree` must be the tree that the mesh was made of, or a clone of that tree. The triangles of one
    /// fragment keep their order.
    ///
    /// `indices` may be mapped device memory: each element is written once, in increasing order, and never
    /// read. Elements after the last written index are not changed. `order` is working space. After the call,
    /// `order` contains the fragments' numbers, back to front. Once `order` is large enough, nothing is
    /// allocated.
    ///
    /// Takes O(n) time.
    ///
    /// # Errors
    ///
    /// If `indices` is too short, or the mesh was made of another tree. After an error nothing is written.
    pub fn write_back_to_front(
        &self,
        tree: &BspTree,
        viewpoint: Viewpoint,
        order: &mut Vec<u32>,
        indices: &mut [u32],
    ) -> Result<usize, Error> {
        let is_of_tree = self.first == 0 && self.starts.len() == tree.len() + 1;
        if tree.generation != self.generation || !is_of_tree {
            return Err(Kind::MeshOfOtherTree.error());
        }
        let (count, given) = (self.indices().len(), indices.len());
        let places =
            indices.get_mut(..count).ok_or(Kind::Places { needed: count, given }.error())?;
        tree.back_to_front_into(viewpoint, order);
        self.write(order, places);
        Ok(count)
    }

    /// Writes the indices of the fragments in `order`, such as a list from
    /// [`Order::write_into`](crate::Order::write_into), and returns the number of written indices. `indices`
    /// may be mapped device memory, as for [`write_back_to_front`](Self::write_back_to_front).
    ///
    /// # Errors
    ///
    /// If `indices` is too short. After an error nothing is written.
    ///
    /// # Panics
    ///
    /// If a number in the list belongs to no fragment.
    pub fn write_order(&self, order: &[u32], indices: &mut [u32]) -> Result<usize, Error> {
        let count = match self.each {
            Some(each) => 3 * each as usize * order.len(),
            None => order.iter().map(|&fragment| self.range(fragment).len()).sum(),
        };
        let given = indices.len();
        let places =
            indices.get_mut(..count).ok_or(Kind::Places { needed: count, given }.error())?;
        self.write(order, places);
        Ok(count)
    }

    /// Writes the indices of a tree's fragments and of an [overlay](crate::overlay::Overlay)'s pieces of
    /// polygons in one common order, such as a list from
    /// [`OverlayOrder::write_into`](crate::overlay::OverlayOrder::write_into), and returns the number of
    /// indices. `pieces` are triangles of [`Overlay::welded_mesh`](crate::overlay::Overlay::welded_mesh).
    ///
    /// The written indices assume one vertex buffer: first the vertices of the tree's mesh, then the vertices
    /// of the overlay's mesh. Lines and points in the order have no triangles. After each
    /// [`replace`](crate::overlay::Overlay::replace) of the overlay, make the overlay's mesh again: the
    /// triangles of an earlier mesh do not fit the new order.
    ///
    /// Takes O(n) time. `indices` may be mapped device memory, as for
    /// [`write_back_to_front`](Self::write_back_to_front).
    ///
    /// # Errors
    ///
    /// If `indices` is too short, if `pieces` are not triangles of an overlay of the same tree, or if there
    /// are more than 2³² vertices. After an error nothing is written.
    ///
    /// # Panics
    ///
    /// As for [`write_order`](Self::write_order).
    pub fn write_order_with(
        &self,
        pieces: &Self,
        order: &[u32],
        indices: &mut [u32],
    ) -> Result<usize, Error> {
        let is_of_one_tree = self.generation == pieces.generation;
        if !is_of_one_tree || self.first != 0 || pieces.first != self.starts.len() - 1 {
            return Err(Kind::MeshOfOtherTree.error());
        }
        if self.vertices.checked_add(pieces.vertices).is_none() {
            return Err(Kind::Indices.error());
        }
        let is_piece = |number: u32| number as usize >= pieces.first;
        let of = |number: u32| if is_piece(number) { pieces } else { self };
        let count = order.iter().map(|&number| of(number).range(number).len()).sum();
        let given = indices.len();
        let mut places =
            indices.get_mut(..count).ok_or(Kind::Places { needed: count, given }.error())?;
        for run in order.chunk_by(|&a, &b| is_piece(a) == is_piece(b)) {
            let len = run.iter().map(|&number| of(number).range(number).len()).sum();
            let Some((here, rest)) = places.split_at_mut_checked(len) else { break };
            if is_piece(run[0]) {
                pieces.write_one_by_one(run, here, self.vertices);
            } else {
                self.write(run, here);
            }
            places = rest;
        }
        Ok(count)
    }

    /// Writes the indices of fragments, each increased by `shift`.
    fn write_one_by_one(&self, order: &[u32], places: &mut [u32], shift: u32) {
        let indices = order.iter().flat_map(|&number| &self.indices[self.range(number)]);
        places.iter_mut().zip(indices).for_each(|(place, index)| *place = index + shift);
    }

    /// Writes the indices of fragments one after the other.
    fn write(&self, order: &[u32], places: &mut [u32]) {
        match self.each {
            _ if self.first > 0 => self.write_one_by_one(order, places, 0),
            Some(1) => self.write_equal::<3>(order, places),
            Some(2) => self.write_equal::<6>(order, places),
            _ => self.write_staged(order, places),
        }
    }

    /// Writes the indices if each fragment has N indices: the place of the indices is computed from the
    /// fragment's number.
    fn write_equal<const N: usize>(&self, order: &[u32], places: &mut [u32]) {
        // Excludes the unused indices at the end, so that too large a number panics.
        let all = &self.indices.as_chunks::<N>().0[..self.starts.len() - 1];
        let places = places.as_chunks_mut::<N>().0;
        for (&fragment, place) in order.iter().zip(places) {
            *place = all[fragment as usize];
        }
    }

    /// Copies each fragment's indices into a small buffer. Each copy has [`CHUNK`] indices, and the next
    /// fragment overwrites the excess. Such copies are faster than a branch on the number of indices, because
    /// no processor can predict that number. The buffer is necessary because the caller's memory may be
    /// written only once.
    fn write_staged(&self, order: &[u32], mut places: &mut [u32]) {
        let mut stage = [0_u32; STAGE + CHUNK];
        let mut filled = 0;
        for &fragment in order {
            let fragment = fragment as usize;
            let (start, end) = (self.starts[fragment] as usize, self.starts[fragment + 1] as usize);
            // The unused indices at the end make `CHUNK` indices readable for every fragment.
            let from = self.indices[start..].first_chunk::<CHUNK>();
            let to = stage[filled..].first_chunk_mut::<CHUNK>();
            let (Some(from), Some(to)) = (from, to) else { continue };
            *to = *from;
            let rest = if end - start <= CHUNK {
                filled += end - start;
                &[]
            } else {
                filled += CHUNK;
                &self.indices[start + CHUNK..end]
            };
            if filled >= STAGE || !rest.is_empty() {
                places = put(places, &stage[..filled]);
                places = put(places, rest);
                filled = 0;
            }
        }
        put(places, &stage[..filled]);
    }
}

/// The number of indices copied at once: four triangles. Too small: more fragments are copied piece by
/// piece. Too large: more excess indices are copied.
const CHUNK: usize = 12;
/// The number of indices gathered before they are written, 4 kB. Too small: more calls. Too large: the
/// buffer leaves the processor's nearest cache.
const STAGE: usize = 1024;

/// Writes some indices to the first places, and returns the other places.
fn put<'p>(places: &'p mut [u32], indices: &[u32]) -> &'p mut [u32] {
    match places.split_at_mut_checked(indices.len()) {
        Some((first, rest)) => {
            first.copy_from_slice(indices);
            rest
        }
        None => &mut [],
    }
}
