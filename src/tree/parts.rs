//! The output of a builder, from which a tree is made, and into which it is taken apart.

use super::BspTree;
use super::node_record::NodeRecord;
use super::walk::Walk;
use crate::exact::{ExactStored, PlaneId};

/// A node as the builder writes it.
#[derive(Clone, Copy, Debug)]
pub struct RawNode {
    /// The partition plane.
    pub plane: PlaneId,
    /// How many fragments lie on the plane.
    pub own: u32,
    /// The front side.
    pub front: RawChild,
    /// The back side.
    pub back: RawChild,
}

/// What is on one side of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RawChild {
    /// A leaf of this many fragments, stored right behind the node's own.
    Leaf(u32),
    /// Another node.
    Node,
}

/// A stored fragment. Its vertices end where those of the next fragment begin; a whole face has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Record {
    /// The face that it is a piece of.
    pub face: u32,
    /// The index of its first vertex.
    pub vertices: u32,
}

/// Stored fragments, by reference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stored<'t, S> {
    pub(crate) records: &'t [Record],
    pub(crate) vertices: &'t [S],
    /// The rounded positions of the vertices, if they are kept.
    pub(crate) positions: &'t [[f64; 3]],
}

/// Nodes and fragments, both depth first and the front before the back. The fragments of a node come
/// in this order: those on its plane, those of a front leaf, those of a back leaf, those of the
/// nodes below.
#[derive(Debug)]
pub struct Parts<S> {
    /// The nodes.
    pub nodes: Vec<RawNode>,
    /// The fragments.
    pub records: Vec<Record>,
    /// The vertices of all fragments that are not whole faces.
    pub vertices: Vec<S>,
    /// Their rounded positions, in lattice units; none if they are not kept.
    pub positions: Vec<[f64; 3]>,
    /// How many times a piece was cut in two.
    pub cuts: usize,
}

impl<S> Parts<S> {
    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.nodes.clear();
        self.records.clear();
        self.vertices.clear();
        self.positions.clear();
        self.cuts = 0;
    }
}

impl<S> Default for Parts<S> {
    fn default() -> Self {
        Self { nodes: vec![], records: vec![], vertices: vec![], positions: vec![], cuts: 0 }
    }
}

/// The nodes of a tree as the builder wrote them, in their order. Takes O(depth) memory.
pub(super) fn raw_nodes(tree: &BspTree) -> impl Iterator<Item = RawNode> {
    let mut walk = Walk::new(tree);
    std::iter::from_fn(move || {
        let visit = walk.next(tree)?;
        let node = &tree.nodes[visit.node];
        let &NodeRecord { plane, front_len, front_nodes, .. } = node;
        let child = |is_node, len| if is_node { RawChild::Node } else { RawChild::Leaf(len) };
        Some(RawNode {
            plane,
            own: node.own(),
            front: child(front_nodes > 0, front_len),
            back: child(node.back_is_node(), visit.behind.len() as u32),
        })
    })
}

/// The parts that a tree was made of.
pub fn parts_of_tree(tree: &BspTree) -> Parts<ExactStored> {
    Parts {
        nodes: raw_nodes(tree).collect(),
        records: tree.records.clone(),
        vertices: tree.vertices.clone(),
        positions: tree.positions.clone(),
        cuts: tree.cuts,
    }
}
