//! The output of a builder, from which a tree is made.

use crate::exact::{PlaneId, StoredVertex};

/// A node as the builder writes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RawNode {
    /// The partition plane.
    pub(crate) plane: PlaneId,
    /// The number of fragments on the plane.
    pub(crate) own: u32,
    /// The front side.
    pub(crate) front: RawChild,
    /// The back side.
    pub(crate) back: RawChild,
}

/// One side of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RawChild {
    /// A leaf with this number of fragments. [`Parts`] states where the fragments are stored.
    Leaf(u32),
    /// Another node.
    Node,
}

/// A stored fragment. The fragment's vertices end where the next fragment's vertices begin; a whole face has
/// no stored vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Record {
    /// The face that the fragment is a piece of.
    pub(crate) face: u32,
    /// The index of the fragment's first vertex.
    pub(crate) vertices: u32,
}

/// Stored fragments, by reference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stored<'t> {
    pub(crate) records: &'t [Record],
    pub(crate) vertices: &'t [StoredVertex],
    /// The rounded positions of the vertices, if stored.
    pub(crate) positions: &'t [[f64; 3]],
}

/// Nodes and fragments, both depth first and the front before the back. The fragments of a node are stored in
/// this order: on the node's plane, in a front leaf, in a back leaf, in the nodes below.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    /// The nodes.
    pub(crate) nodes: Vec<RawNode>,
    /// The fragments.
    pub(crate) records: Vec<Record>,
    /// The vertices of all fragments that are not whole faces.
    pub(crate) vertices: Vec<StoredVertex>,
    /// The rounded positions of `vertices`, in lattice units; empty if not stored.
    pub(crate) positions: Vec<[f64; 3]>,
    /// The number of times that a piece was cut in two.
    pub(crate) cuts: usize,
}

impl Parts {
    /// The fragments, by reference.
    pub(crate) fn stored(&self) -> Stored<'_> {
        let Self { records, vertices, positions, .. } = self;
        Stored { records, vertices, positions }
    }

    /// Removes everything.
    pub(crate) fn clear(&mut self) {
        self.nodes.clear();
        self.records.clear();
        self.vertices.clear();
        self.positions.clear();
        self.cuts = 0;
    }
}
