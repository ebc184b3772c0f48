//! A node of the finished tree.

use super::assemble::{Child, RawNode};
use crate::geom::{Faces, LATTICE_LIMIT, PlaneId};

const BACK_IS_NODE: u32 = 1 << 31;
/// One fragment on the plane, and all others on one side, in a node: that is the next in memory.
const LINK: u32 = 1 << 30;
/// No more than one fragment on the plane, and in each leaf.
const PLAIN: u32 = 1 << 29;

/// The most fragments of a tree: what else [`Node::own`] has no bits for.
pub(super) const MOST_FRAGMENTS: usize = PLAIN as usize - 1;

/// A node: 32 bytes, of which the first 16 decide almost always on which side an eye is.
///
/// Nodes stand depth first, the front subtree right behind its root and before the back subtree.
/// Fragments are numbered likewise: those on the node's plane, then those of a side that is a
/// leaf, front before back, then those of the subtrees, front before back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    /// The plane's unit normal, rounded.
    normal: [f32; 3],
    /// The plane's distance from the lattice's origin, in 2⁵¹ lattice units, rounded.
    offset: f32,
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
        self.own & !(BACK_IS_NODE | LINK | PLAIN)
    }

    /// Whether one fragment is on the plane, and the rest on one side, in the next node.
    #[inline]
    pub(super) fn is_link(&self) -> bool {
        self.own & LINK != 0
    }

    /// Whether no more than one fragment is on the plane, and in each leaf.
    #[inline]
    pub(super) fn is_plain(&self) -> bool {
        self.own & PLAIN != 0
    }

    /// Whether the back is a node rather than a leaf.
    #[inline]
    pub(super) fn back_is_node(&self) -> bool {
        self.own & BACK_IS_NODE != 0
    }

    /// The rounded distance of a homogeneous point, in 2⁵¹ lattice units.
    #[inline]
    pub(super) fn distance(&self, (e, w): ([f64; 3], f64)) -> f64 {
        let n = self.normal.map(f64::from);
        n[0] * e[0] + n[1] * e[1] + n[2] * e[2] - w * f64::from(self.offset)
    }

    /// What [`distance`](Self::distance) may be off by, for every node: each of the four numbers
    /// is off by 2⁻²⁴ of at most 1 (the offset, of at most √3), and an ulp of f64 or two.
    pub(super) fn bound((e, w): ([f64; 3], f64)) -> f64 {
        let size = e[0].abs() + e[1].abs() + e[2].abs() + 2.0 * w;
        size * f64::from(f32::EPSILON) * 0.6
    }
}

/// Nodes with the sizes of their subtrees, from the last to the first.
pub(super) fn finish(faces: &Faces, raw: &[RawNode]) -> Vec<Node> {
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
        let plane = faces.plane(node.plane);
        let (normal, offset) = (plane.normal_f64(), plane.offset_f64());
        let length = normal.length();
        nodes.push(Node {
            normal: (normal / length).as_vec3().to_array(),
            offset: (offset / length / LATTICE_LIMIT) as f32,
            plane: node.plane,
            own: node.own | flags(node),
            front_len,
            front_nodes,
        });
    }
    nodes.reverse();
    nodes
}

/// What is known of a node ahead.
fn flags(node: &RawNode) -> u32 {
    let empty = Child::Leaf(0);
    let sides = (node.front, node.back);
    let link = node.own == 1 && (sides == (Child::Node, empty) || sides == (empty, Child::Node));
    let few = |child| !matches!(child, Child::Leaf(2..));
    let plain = node.own <= 1 && few(node.front) && few(node.back);
    let back = if node.back == Child::Node { BACK_IS_NODE } else { 0 };
    back | if link { LINK } else { 0 } | if plain { PLAIN } else { 0 }
}
