//! Walking a tree's nodes in memory order, with their fragments and their depths.

use std::collections::VecDeque;
use std::ops::Range;

use super::BspTree;
use super::node_record::Ranges;
use crate::exact::Side;

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
    /// All fragments in front, in a leaf or not.
    pub(super) in_front: Range<u32>,
    /// All fragments behind, in a leaf or not.
    pub(super) behind: Range<u32>,
}

impl Visit {
    /// The fragments of the whole subtree.
    pub(super) fn all(&self) -> Range<u32> {
        self.own.start..self.in_front.end.max(self.behind.end)
    }

    /// How many fragments are in its leaves.
    pub(super) fn leaves(&self) -> usize {
        self.front.len() + self.back.len()
    }

    /// The fragments on its plane and in its leaves.
    pub(super) fn fragments(&self) -> Range<u32> {
        self.own.start..self.back.end
    }

    /// The same, by the side of the plane that they are on.
    pub(super) fn groups(&self) -> [(Range<u32>, Side); 3] {
        [
            (self.own.clone(), Side::Coplanar),
            (self.front.clone(), Side::Front),
            (self.back.clone(), Side::Back),
        ]
    }
}

/// A subtree still to be walked, or its root alone.
#[derive(Clone, Debug)]
struct Subtree {
    node: usize,
    depth: usize,
    is_front: bool,
    /// The fragments of the whole subtree.
    fragments: Range<u32>,
    /// Whether the nodes below are on the walk as subtrees of their own.
    is_root_alone: bool,
}

/// The nodes that are still to be visited, from both ends: subtrees in memory order.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    subtrees: VecDeque<Subtree>,
}

impl Walk {
    pub(super) fn new(tree: &BspTree) -> Self {
        let all = Subtree {
            node: 0,
            depth: 1,
            is_front: false,
            fragments: 0..tree.records.len() as u32,
            is_root_alone: false,
        };
        Self { subtrees: if tree.nodes.is_empty() { [].into() } else { [all].into() } }
    }

    /// The next node. `None` at the end, and where sizes contradict each other.
    pub(super) fn next(&mut self, tree: &BspTree) -> Option<Visit> {
        let subtree = self.subtrees.pop_front()?;
        let visit = visit(tree, &subtree)?;
        if !subtree.is_root_alone {
            let [front, back] = below(tree, &subtree, &visit);
            for below in [back, front].into_iter().flatten() {
                self.subtrees.push_front(below);
            }
        }
        Some(visit)
    }

    /// The last node that has not been visited from either end. `None` as for [`next`](Self::next).
    pub(super) fn next_back(&mut self, tree: &BspTree) -> Option<Visit> {
        loop {
            let mut subtree = self.subtrees.pop_back()?;
            let visit = visit(tree, &subtree)?;
            if subtree.is_root_alone {
                return Some(visit);
            }
            // The root comes before everything below it, so from this end it comes last.
            let below = below(tree, &subtree, &visit);
            subtree.is_root_alone = true;
            self.subtrees.push_back(subtree);
            self.subtrees.extend(below.into_iter().flatten());
        }
    }
}

/// The root of a subtree; `None` if there is no such node, or it has more fragments than the
/// subtree.
fn visit(tree: &BspTree, subtree: &Subtree) -> Option<Visit> {
    let &Subtree { node: index, depth, is_front, ref fragments, .. } = subtree;
    let node = tree.nodes.get(index)?;
    let total = fragments.end - fragments.start;
    total.checked_sub(node.own())?.checked_sub(node.front_len)?;
    let Ranges { own, front: in_front, back: behind } = node.ranges(fragments.clone());
    let front = if node.front_nodes == 0 { in_front.clone() } else { own.end..own.end };
    let back = if node.back_is_node() { front.end..front.end } else { behind.clone() };
    Some(Visit { node: index, depth, is_front, own, front, back, in_front, behind })
}

/// The subtrees in front of a root and behind it, where they are not leaves.
fn below(tree: &BspTree, subtree: &Subtree, root: &Visit) -> [Option<Subtree>; 2] {
    let node = &tree.nodes[root.node];
    let child = |node, is_front, fragments: &Range<u32>| {
        let (depth, fragments) = (subtree.depth + 1, fragments.clone());
        Subtree { node, depth, is_front, fragments, is_root_alone: false }
    };
    [
        node.front_node(root.node).map(|front| child(front, true, &root.in_front)),
        node.back_node(root.node).map(|back| child(back, false, &root.behind)),
    ]
}
