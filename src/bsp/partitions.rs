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

    /// The partition plane between two fragments, or that both lie on; `None` if they are in one
    /// leaf, as pieces of one face are. O(depth).
    ///
    /// # Panics
    ///
    /// If there are no such fragments.
    pub fn plane_between(&self, a: u32, b: u32) -> Option<PlaneId> {
        let (low, high) = (a.min(b), a.max(b));
        assert!((high as usize) < self.records.len(), "no fragment {high}");
        let (mut index, mut total, mut start) = (0, self.records.len() as u32, 0);
        loop {
            let node = &self.nodes[index];
            let back_len = total - node.own() - node.front_len;
            let front = start + node.own();
            let back = front + if node.front_nodes > 0 { 0 } else { node.front_len };
            let subtrees = back + if node.back_is_node() { 0 } else { back_len };
            if low < subtrees {
                let same_leaf = low >= back && high < subtrees || low >= front && high < back;
                return (!same_leaf).then_some(node.plane);
            }
            let in_front = if node.front_nodes > 0 { node.front_len } else { 0 };
            if low < subtrees + in_front {
                if high >= subtrees + in_front {
                    return Some(node.plane);
                }
                (index, total, start) = (index + 1, node.front_len, subtrees);
            } else {
                index += 1 + node.front_nodes as usize;
                (total, start) = (back_len, subtrees + in_front);
            }
        }
    }
}
