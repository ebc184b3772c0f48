//! A node of the finished tree.

use std::ops::Range;

use super::parts::{RawChild, RawNode};
use crate::Error;
use crate::exact::PlaneId;
use crate::memory::reserve;

const BACK_IS_NODE: u32 = 1 << 31;

/// The most fragments of a tree. While a [`Schedule`](super::order::schedule::Schedule) is laid out, its
/// parts are numbered in 30 bits, and there are fewer than two parts per fragment.
pub(crate) const MOST_FRAGMENTS: usize = (1 << 29) - 1;

/// A node.
///
/// Nodes are stored depth first: the root, its front subtree, its back subtree. Fragments are numbered
/// in this order: those on the node's plane, those of a front leaf, those of a back leaf, those of the
/// front subtree, those of the back subtree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NodeRecord {
    pub(crate) plane: PlaneId,
    own: u32,
    /// How many fragments are in front.
    pub(crate) front_len: u32,
    /// How many nodes are in front; if none, the front is a leaf.
    pub(crate) front_nodes: u32,
}

impl NodeRecord {
    /// How many fragments lie on the plane.
    #[inline]
    pub(crate) fn own(&self) -> u32 {
        self.own & !BACK_IS_NODE
    }

    /// Whether the back is a node rather than a leaf.
    #[inline]
    pub(crate) fn back_is_node(&self) -> bool {
        self.own & BACK_IS_NODE != 0
    }

    /// The number of the node in front, given that of this one; `None` if the front is a leaf.
    #[inline]
    pub(crate) fn front_node(&self, index: usize) -> Option<usize> {
        (self.front_nodes > 0).then_some(index + 1)
    }

    /// The number of the node behind, given that of this one; `None` if the back is a leaf.
    #[inline]
    pub(crate) fn back_node(&self, index: usize) -> Option<usize> {
        self.back_is_node().then_some(index + 1 + self.front_nodes as usize)
    }

    /// Where the fragments of the subtree of this node are, given the numbers of all of them.
    #[inline]
    pub(crate) fn ranges(&self, all: Range<u32>) -> Ranges {
        let own = all.start..all.start + self.own();
        // A leaf is numbered before a subtree, so it is only here that the back comes first.
        if self.front_nodes > 0 && !self.back_is_node() {
            let middle = all.end - self.front_len;
            return Ranges { front: middle..all.end, back: own.end..middle, own };
        }
        let middle = own.end + self.front_len;
        Ranges { front: own.end..middle, back: middle..all.end, own }
    }
}

/// The fragments of a subtree by the side of its root's plane: on it, and all in front and behind,
/// down to the leaves.
#[derive(Clone, Debug)]
pub(crate) struct Ranges {
    pub(crate) own: Range<u32>,
    pub(crate) front: Range<u32>,
    pub(crate) back: Range<u32>,
}

/// How many fragments and nodes a subtree has.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sizes {
    fragments: u32,
    nodes: u32,
}

/// Makes the room that [`finish`] needs for so many nodes.
pub(crate) fn make_room(
    raw: usize,
    sizes: &mut Vec<Sizes>,
    nodes: &mut Vec<NodeRecord>,
) -> Result<(), Error> {
    sizes.clear();
    nodes.clear();
    reserve(sizes, raw)?;
    nodes.try_reserve_exact(raw).map_err(|_| Error::out_of_memory())
}

/// Computes the sizes of all subtrees, and replaces a list of nodes.
pub(crate) fn finish(
    raw: impl DoubleEndedIterator<Item = RawNode> + ExactSizeIterator,
    sizes: &mut Vec<Sizes>,
    nodes: &mut Vec<NodeRecord>,
) {
    // Nodes are read from the last to the first, so children come before their parents: what waits for
    // its parent is on a stack, the front above the back.
    sizes.clear();
    nodes.clear();
    nodes.reserve_exact(raw.len());
    for node in raw.rev() {
        let mut size = |child| match child {
            RawChild::Leaf(fragments) => Sizes { fragments, nodes: 0 },
            RawChild::Node => sizes.pop().unwrap_or_default(),
        };
        let (front, back) = (size(node.front), size(node.back));
        sizes.push(Sizes {
            fragments: node.own + front.fragments + back.fragments,
            nodes: 1 + front.nodes + back.nodes,
        });
        let back_is_node = if node.back == RawChild::Node { BACK_IS_NODE } else { 0 };
        let own = node.own | back_is_node;
        let Sizes { fragments: front_len, nodes: front_nodes } = front;
        nodes.push(NodeRecord { plane: node.plane, own, front_len, front_nodes });
    }
    nodes.reverse();
}
