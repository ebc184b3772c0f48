//! The cells of a tree: on which side of each plane the tree reports a fragment, and whether a point is in
//! the cell, exactly.

use super::exact::{Plane, Spot};
use super::ray::Targets;
use crate::prelude::*;
use std::ops::Range;

/// A partition plane and the fragments around it.
struct Node {
    plane: Plane,
    parent: Option<usize>,
    on: Range<u32>,
    front: Range<u32>,
    back: Range<u32>,
}

pub struct Cells {
    nodes: Vec<Node>,
    /// The last node above each fragment.
    above: Vec<Option<usize>>,
}

impl Cells {
    pub fn new(targets: &Targets<'_>, tree: &BspTree) -> Self {
        let mut nodes: Vec<Node> = Vec::new();
        let mut above = vec![None; tree.len()];
        // The last node seen at each depth.
        let mut path: Vec<usize> = Vec::new();
        for node in tree.nodes() {
            path.truncate(node.depth() - 1);
            let index = nodes.len();
            let plane = targets.named(tree, node.plane());
            let (on, front, back) = (node.on(), node.in_front(), node.behind());
            for range in [&on, &front, &back] {
                above[range.start as usize..range.end as usize].fill(Some(index));
            }
            nodes.push(Node { plane, parent: path.last().copied(), on, front, back });
            path.push(index);
        }
        Self { nodes, above }
    }

    /// Returns whether the tree reports two fragments on the plane of one node.
    pub fn share_a_plane(&self, a: u32, b: u32) -> bool {
        let [above, other] = [a, b].map(|fragment| self.above[fragment as usize]);
        above.is_some_and(|node| {
            self.nodes[node].on.contains(&a) && self.nodes[node].on.contains(&b)
        }) && above == other
    }

    /// Returns whether a point of a fragment's polygon is in the cell of the fragment: inside, on the border,
    /// or (`None`) outside. Returns an error if the tree reports the fragment on a plane that does not
    /// contain the point.
    pub fn within(&self, fragment: u32, spot: &Spot) -> Result<Option<Border>, String> {
        let mut border = Border::Inside;
        let mut next = self.above[fragment as usize];
        while let Some(index) = next {
            let node = &self.nodes[index];
            let side = node.plane.side(spot);
            if node.on.contains(&fragment) {
                if side.is_ne() {
                    return Err(format!("fragment {fragment} is not on the plane of node {index}"));
                }
            } else if node.front.contains(&fragment) || node.back.contains(&fragment) {
                let is_front = node.front.contains(&fragment);
                match (side, is_front) {
                    (Ordering::Equal, _) => border = Border::On,
                    (Ordering::Greater, true) | (Ordering::Less, false) => {}
                    _ => return Ok(None),
                }
            } else {
                return Err(format!("fragment {fragment} is not at node {index}"));
            }
            next = node.parent;
        }
        Ok(Some(border))
    }
}

/// The place of a point in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    Inside,
    On,
}
