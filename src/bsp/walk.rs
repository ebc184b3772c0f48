//! Walking a tree's nodes in memory order, with their fragments and their depths.

use std::ops::Range;

use super::BspTree;
use crate::geom::Kernel;

/// A node on a walk.
#[derive(Clone, Debug)]
pub(super) struct Visit {
    pub(super) node: usize,
    /// How many nodes there are on the path to it, itself included.
    pub(super) depth: usize,
    /// Whether it is in front of its parent.
    pub(super) is_front: bool,
    /// The fragments on its plane.
    pub(super) own: Range<u32>,
    /// The fragments of a front leaf.
    pub(super) front: Range<u32>,
    /// The fragments of a back leaf.
    pub(super) back: Range<u32>,
    /// How many fragments are behind, in a leaf or not.
    pub(super) back_len: u32,
}

impl Visit {
    /// How many fragments are in its leaves.
    pub(super) fn leaves(&self) -> usize {
        self.front.len() + self.back.len()
    }
}

/// Subtrees still to be walked: a node, its depth, its side, how many fragments it has in all.
pub(super) struct Walk {
    stack: Vec<(usize, usize, bool, u32)>,
    next: u32,
}

impl Walk {
    pub(super) fn new<K: Kernel>(tree: &BspTree<K>) -> Self {
        let root = (0, 1, false, tree.records.len() as u32);
        let stack = if tree.nodes.is_empty() { vec![] } else { vec![root] };
        Self { stack, next: 0 }
    }

    /// The next node. `None` at the end, and where sizes contradict each other.
    pub(super) fn next<K: Kernel>(&mut self, tree: &BspTree<K>) -> Option<Visit> {
        let (index, depth, is_front, total) = self.stack.pop()?;
        let node = tree.nodes.get(index)?;
        let back_len = total.checked_sub(node.own())?.checked_sub(node.front_len)?;
        let mut take = |len: u32| {
            let range = self.next..self.next + len;
            self.next += len;
            range
        };
        let own = take(node.own());
        let front = take(if node.front_nodes == 0 { node.front_len } else { 0 });
        let back = take(if node.back_is_node() { 0 } else { back_len });
        if node.back_is_node() {
            let child = index + 1 + node.front_nodes as usize;
            self.stack.push((child, depth + 1, false, back_len));
        }
        if node.front_nodes > 0 {
            self.stack.push((index + 1, depth + 1, true, node.front_len));
        }
        Some(Visit { node: index, depth, is_front, own, front, back, back_len })
    }
}
