//! A fragment: what a tree's orders are made of.

use glam::DVec3;
use smallvec::SmallVec;

use super::BspTree;
use crate::geom::{Exact, Kernel, Line, Symbol, Vertex};

/// A convex piece of a polygon, or all of it.
#[derive(Clone, Copy, Debug)]
pub struct Fragment<'t, K: Kernel = Exact> {
    tree: &'t BspTree<K>,
    index: u32,
    face: u32,
    stored: &'t [K::Stored],
}

impl<'t, K: Kernel> Fragment<'t, K> {
    pub(super) fn new(tree: &'t BspTree<K>, index: u32) -> Self {
        let record = tree.records[index as usize];
        let next = tree.records.get(index as usize + 1);
        let end = next.map_or(tree.vertices.len(), |next| next.vertices as usize);
        Self {
            tree,
            index,
            face: record.face,
            stored: &tree.vertices[record.vertices as usize..end],
        }
    }

    /// The vertices as the tree keeps them; none if it is all of its face.
    pub(super) fn stored(&self) -> &'t [K::Stored] {
        self.stored
    }

    /// Its number in the tree: what index orders hold.
    pub fn index(&self) -> u32 {
        self.index
    }

    /// The index, in the input, of the polygon it is a piece of.
    pub fn polygon(&self) -> usize {
        self.tree.faces.polygon(self.face) as usize
    }

    /// The face it is a piece of, one of [`BspTree::faces`]: the polygon, or a triangle of it.
    pub fn face(&self) -> u32 {
        self.face
    }

    /// Whether it is all of its face.
    pub fn is_whole(&self) -> bool {
        self.stored.is_empty()
    }

    /// How many vertices it has.
    pub fn len(&self) -> usize {
        if self.is_whole() { self.tree.faces.corners(self.face).len() } else { self.stored.len() }
    }

    /// Never: a fragment has three vertices or more.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// The vertices in the polygon's own orientation: counter-clockwise seen from its front.
    ///
    /// Corners of the polygon are as they were given, but for the rounding to the lattice (and,
    /// if only the tolerance puts them on a plane, the move onto it). Others are within three
    /// roundings of their exact place, and the same bit for bit in all fragments that share them.
    /// They are computed from their definition each time: about 0.1 µs each.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = DVec3> + use<'t, K> {
        let lattice = *self.tree.faces.lattice();
        self.lattice_vertices().map(move |position| lattice.to_world(position))
    }

    /// The vertices in lattice units, rounded.
    pub fn lattice_vertices(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + use<'t, K> {
        let Self { tree, face, stored, .. } = *self;
        (0..self.len()).map(move |i| match stored.get(i) {
            Some(stored) => tree.kernel.restore(&tree.faces, face, stored).position(),
            None => tree.faces.corners(face)[i],
        })
    }

    /// For each edge, from each vertex to the next: the number of the polygon's edge that it lies
    /// on, counted by the corner where that edge begins (of repeated corners the last, of edges in one
    /// line that triangulation made one the first); `None` if it was made by a cut or by
    /// triangulation.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = Option<u32>> + use<'t, K> {
        let (faces, face) = (&self.tree.faces, self.face);
        self.lines().map(move |line| faces.outline_edge(face, line.as_edge()?))
    }

    /// For each edge, from each vertex to the next: what bounds the fragment there.
    pub fn lines(&self) -> impl ExactSizeIterator<Item = Line> + use<'t, K> {
        let stored = self.stored;
        (0..self.len()).map(move |i| match stored.get(i) {
            Some(stored) => K::line(stored),
            None => Line::edge(i as u32),
        })
    }

    /// For each vertex, its weights over the polygon's corners: pairs of a corner's number and a
    /// weight, which sum to 1. A corner has itself alone, a vertex on an edge that edge's two
    /// ends, one inside three corners.
    ///
    /// To interpolate an attribute, sum weight · attribute: on an edge, neighbours agree.
    pub fn weights(&self) -> impl ExactSizeIterator<Item = SmallVec<[(u32, f64); 3]>> + use<'t, K> {
        let (faces, face) = (&self.tree.faces, self.face);
        let stored = self.stored;
        (0..self.len()).map(move |i| {
            let symbol = stored.get(i).map_or(Symbol::corner(i as u32), K::symbol);
            let mut weights = faces.barycentric(face, symbol);
            weights.iter_mut().for_each(|(k, _)| *k = faces.corner_number(face, *k));
            weights
        })
    }
}
