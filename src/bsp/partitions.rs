//! The partition planes of a tree, to be looked at.

use std::ops::Range;

use super::BspTree;
use super::walk::Walk;
use crate::geom::{Kernel, PlaneId};

/// A partition plane, and which fragments of its set lie where; see [`BspTree::partitions`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Partition {
    /// The plane, named by a face or corner of [`BspTree::faces`].
    pub plane: PlaneId,
    /// How many planes there are on the path to it, itself included.
    pub depth: usize,
    /// The numbers of the fragments on the plane.
    pub on: Range<u32>,
    /// The numbers of all fragments in front.
    pub front: Range<u32>,
    /// The numbers of all fragments behind.
    pub back: Range<u32>,
}

impl<K: Kernel> BspTree<K> {
    /// The partition planes, depth first, what is in front of each before what is behind: to
    /// draw, measure or check a tree. O(nodes) for all of them.
    pub fn partitions(&self) -> impl Iterator<Item = Partition> {
        let mut walk = Walk::new(self);
        std::iter::from_fn(move || {
            let visit = walk.next(self)?;
            let node = &self.nodes[visit.node];
            // Subtrees are numbered behind the leaves of their parent.
            let mut next = visit.back.end;
            let mut subtree = |len: u32| {
                next += len;
                next - len..next
            };
            let front =
                if node.front_nodes > 0 { subtree(node.front_len) } else { visit.front.clone() };
            let back = if node.back_is_node() { subtree(visit.back_len) } else { visit.back };
            Some(Partition { plane: node.plane, depth: visit.depth, on: visit.own, front, back })
        })
    }
}
