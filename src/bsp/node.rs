//! A node of the finished tree.

use super::assemble::{Child, RawNode};
use crate::geom::PlaneId;

const BACK_IS_NODE: u32 = 1 << 31;

/// The most fragments of a tree: the parts of a [`Schedule`](super::schedule::Schedule), of which
/// there are fewer than two to a fragment, are numbered in 30 bits while it is laid out.
pub(super) const MOST_FRAGMENTS: usize = (1 << 29) - 1;

/// A node.
///
/// Nodes stand depth first, the front subtree right behind its root and before the back subtree.
/// Fragments are numbered likewise: those on the node's plane, then those of a side that is a
/// leaf, front before back, then those of the subtrees, front before back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    pub(super) plane: PlaneId,
    own: u32,
    /// How many fragments are in front.
    pub(super) front_len: u32,
    /// How many nodes are in front; if none, the front is a leaf.
    pub(super) front_nodes: u32,
}

impl Node {
    /// How many fragments lie on the plane.
    #[inline]
    pub(super) fn own(&self) -> u32 {
        self.own & !BACK_IS_NODE
    }

    /// Whether the back is a node rather than a leaf.
    #[inline]
    pub(super) fn back_is_node(&self) -> bool {
        self.own & BACK_IS_NODE != 0
    }
}

/// Nodes with the sizes of their subtrees, from the last to the first.
pub(super) fn finish(raw: &[RawNode]) -> Vec<Node> {
    // Fragments and nodes of the subtree that begins at each node.
    let mut sizes = vec![(0u32, 0u32); raw.len()];
    let mut nodes = Vec::with_capacity(raw.len());
    for (i, node) in raw.iter().enumerate().rev() {
        let (front_len, front_nodes) = match node.front {
            Child::Leaf(len) => (len, 0),
            Child::Node => sizes[i + 1],
        };
        let (back_len, back_nodes) = match node.back {
            Child::Leaf(len) => (len, 0),
            Child::Node => sizes[i + 1 + front_nodes as usize],
        };
        sizes[i] = (node.own + front_len + back_len, 1 + front_nodes + back_nodes);
        let back_is_node = if node.back == Child::Node { BACK_IS_NODE } else { 0 };
        let own = node.own | back_is_node;
        nodes.push(Node { plane: node.plane, own, front_len, front_nodes });
    }
    nodes.reverse();
    nodes
}
