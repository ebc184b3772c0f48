//! The output of a builder, from which a tree is made.

use crate::exact::{PlaneId, StoredVertex};

/// A node as the builder writes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RawNode {
    /// The partition plane.
    pub(crate) plane: PlaneId,
    /// How many fragments lie on the plane.
    pub(crate) own: u32,
    /// The front side.
    pub(crate) front: RawChild,
    /// The back side.
    pub(crate) back: RawChild,
}

/// What is on one side of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RawChild {
    /// A leaf of this many fragments, stored right behind the node's own.
    Leaf(u32),
    /// Another node.
    Node,
}

/// A stored fragment. Its vertices end where those of the next fragment begin; a whole face has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Record {
    /// The face that it is a piece of.
    pub(crate) face: u32,
    /// The index of its first vertex.
    pub(crate) vertices: u32,
}

/// Stored fragments, by reference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stored<'t> {
    pub(crate) records: &'t [Record],
    pub(crate) vertices: &'t [StoredVertex],
    /// The rounded positions of the vertices, if they are kept.
    pub(crate) positions: &'t [[f64; 3]],
}

/// Nodes and fragments, both depth first and the front before the back. The fragments of a node come
/// in this order: those on its plane, those of a front leaf, those of a back leaf, those of the
/// nodes below.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    /// The nodes.
    pub(crate) nodes: Vec<RawNode>,
    /// The fragments.
    pub(crate) records: Vec<Record>,
    /// The vertices of all fragments that are not whole faces.
    pub(crate) vertices: Vec<StoredVertex>,
    /// Their rounded positions, in lattice units; none if they are not kept.
    pub(crate) positions: Vec<[f64; 3]>,
    /// How many times a piece was cut in two.
    pub(crate) cuts: usize,
}

impl Parts {
    /// The fragments, by reference.
    pub(crate) fn stored(&self) -> Stored<'_> {
        let Self { records, vertices, positions, .. } = self;
        Stored { records, vertices, positions }
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.nodes.clear();
        self.records.clear();
        self.vertices.clear();
        self.positions.clear();
        self.cuts = 0;
    }
}
