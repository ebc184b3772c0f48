//! The sweep line: the edges that it crosses, from the lowest to the highest.

use crate::random::mix;

/// The edge number that means "none".
pub(super) const NONE: u32 = u32::MAX;

/// An ordered list of edges with a search tree over it: a treap (Seidel, Aragon, “Randomized search
/// trees”, 1996). Its priorities are hashed edge numbers, so that every run gives the same tree.
/// Edges are numbered from 0 in the order of insertion.
#[derive(Debug)]
pub(super) struct SweepLine {
    nodes: Vec<Node>,
    root: u32,
    lowest: u32,
}

/// An edge's neighbours in the list, and in the tree.
#[derive(Clone, Copy, Debug)]
struct Node {
    below: u32,
    above: u32,
    parent: u32,
    children: [u32; 2],
    on_line: bool,
}

/// Where a point lies against an edge: where a search for it goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Below the edge.
    Below,
    /// On the edge.
    On,
    /// Above the edge.
    Above,
}

impl SweepLine {
    pub(super) const fn new() -> Self {
        Self { nodes: vec![], root: NONE, lowest: NONE }
    }

    /// The edge below this one, or [`NONE`].
    pub(super) fn below(&self, edge: u32) -> u32 {
        self.nodes[edge as usize].below
    }

    /// The edge above this one, or [`NONE`]. Above [`NONE`] is the lowest edge.
    pub(super) fn above(&self, edge: u32) -> u32 {
        if edge == NONE { self.lowest } else { self.nodes[edge as usize].above }
    }

    pub(super) fn contains(&self, edge: u32) -> bool {
        self.nodes.get(edge as usize).is_some_and(|node| node.on_line)
    }

    /// An edge that a point lies on; if there is none, the edge next below it, or [`NONE`].
    pub(super) fn find(&self, mut place: impl FnMut(u32) -> Place) -> (u32, Place) {
        let (mut at, mut below) = (self.root, NONE);
        while at != NONE {
            let children = self.nodes[at as usize].children;
            at = match place(at) {
                Place::On => return (at, Place::On),
                Place::Below => children[0],
                Place::Above => {
                    below = at;
                    children[1]
                }
            };
        }
        (below, Place::Above)
    }

    /// Inserts the edge with the next number above `below`, or as the lowest if that is [`NONE`].
    pub(super) fn insert(&mut self, below: u32) -> u32 {
        let edge = self.nodes.len() as u32;
        let above = self.above(below);
        // Of two neighbours in the list, one is an ancestor of the other in the tree, so one of
        // them has no child on the side of the other: the new edge becomes that child.
        let (parent, side) =
            if below != NONE && self.child(below, 1) == NONE { (below, 1) } else { (above, 0) };
        self.nodes.push(Node { below, above, parent, children: [NONE; 2], on_line: true });
        self.link(below, above, edge, edge);
        match parent {
            NONE => self.root = edge,
            _ => self.nodes[parent as usize].children[side] = edge,
        }
        while self.parent(edge) != NONE && priority(self.parent(edge)) < priority(edge) {
            self.rotate_up(edge);
        }
        edge
    }

    pub(super) fn remove(&mut self, edge: u32) {
        let Node { below, above, .. } = self.nodes[edge as usize];
        self.link(below, above, above, below);
        loop {
            match self.nodes[edge as usize].children {
                [NONE, NONE] => break,
                [child, NONE] | [NONE, child] => self.rotate_up(child),
                [low, high] if priority(low) > priority(high) => self.rotate_up(low),
                [_, high] => self.rotate_up(high),
            }
        }
        self.replace_child(self.parent(edge), edge, NONE);
        self.nodes[edge as usize].on_line = false;
    }

    /// Sets the edge above `below` to `next`, and the edge below `above` to `before`.
    fn link(&mut self, below: u32, above: u32, next: u32, before: u32) {
        match below {
            NONE => self.lowest = next,
            _ => self.nodes[below as usize].above = next,
        }
        if above != NONE {
            self.nodes[above as usize].below = before;
        }
    }

    fn child(&self, edge: u32, side: usize) -> u32 {
        self.nodes[edge as usize].children[side]
    }

    fn parent(&self, edge: u32) -> u32 {
        self.nodes[edge as usize].parent
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        match parent {
            NONE => self.root = new,
            _ => {
                let side = usize::from(self.child(parent, 1) == old);
                self.nodes[parent as usize].children[side] = new;
            }
        }
    }

    /// Rotates the tree so that an edge becomes the parent of its parent.
    fn rotate_up(&mut self, edge: u32) {
        let parent = self.parent(edge);
        let side = usize::from(self.child(parent, 1) == edge);
        let inner = self.child(edge, 1 - side);
        let grandparent = self.parent(parent);
        self.nodes[parent as usize].children[side] = inner;
        if inner != NONE {
            self.nodes[inner as usize].parent = parent;
        }
        self.nodes[edge as usize].children[1 - side] = parent;
        self.nodes[parent as usize].parent = edge;
        self.nodes[edge as usize].parent = grandparent;
        self.replace_child(grandparent, parent, edge);
    }
}

fn priority(edge: u32) -> u64 {
    mix(edge.into())
}

#[cfg(test)]
mod tests {
    use super::{NONE, Place, SweepLine};
    use crate::random::SplitMix64;

    /// Against a sorted list: what is found, who is next to whom, and how deep the tree is.
    #[test]
    fn the_line_is_a_sorted_list() {
        let mut random = SplitMix64::new(3);
        let mut below = |limit: usize| (random.next() >> 16) as usize % limit;
        let (mut line, mut list, mut keys) =
            (SweepLine::new(), Vec::<u32>::new(), Vec::<u64>::new());
        for round in 0..4000 {
            if list.len() > 3 && below(5) < 2 {
                let at = below(list.len());
                line.remove(list.remove(at));
            } else {
                let key = below(1 << 40) as u64;
                let place = |edge: u32| match key.cmp(&keys[edge as usize]) {
                    std::cmp::Ordering::Less => Place::Below,
                    std::cmp::Ordering::Equal => Place::On,
                    std::cmp::Ordering::Greater => Place::Above,
                };
                let mut steps = 0;
                let (next, found) = line.find(|edge| {
                    steps += 1;
                    place(edge)
                });
                assert!(steps < 64, "{steps} steps in a list of {}", list.len());
                assert_eq!(found, Place::Above);
                let at = list.partition_point(|&edge| keys[edge as usize] < key);
                assert_eq!(next, if at == 0 { NONE } else { list[at - 1] });
                keys.push(key);
                list.insert(at, line.insert(next));
            }
            if round % 50 == 0 {
                let mut at = NONE;
                for &edge in &list {
                    assert_eq!((line.above(at), line.below(edge)), (edge, at));
                    assert!(line.contains(edge));
                    at = edge;
                }
                assert_eq!(line.above(at), NONE);
            }
        }
    }
}
