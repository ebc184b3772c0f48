//! The nodes of a tree, to be looked at.

use std::cmp::Ordering;
use std::fmt;
use std::iter::FusedIterator;
use std::ops::Range;

use glam::DVec3;

use super::node_record::Ranges;
use super::walk::{Visit, Walk};
use super::{BspTree, grid};
use crate::exact::{Eye, PlaneId, PlaneKind};
use crate::viewpoint::Viewpoint;

/// A node of a tree: a partition plane, the fragments on it, and what is on its sides.
///
/// [`BspTree::root`] and [`children`](Self::front) give nodes one by one, [`BspTree::nodes`] all of
/// them, and [`BspTree::walk_front_to_back`] those that a viewpoint needs, in its order. A node is
/// as cheap to copy as a reference.
///
/// The plane holds the points p with `normal().dot(p) == offset()`; its front is where the left side
/// is larger. Both are rounded. The tree itself decides by the exact plane, which
/// [`grid_points`](Self::grid_points) gives.
///
/// Fragments of a subtree have consecutive numbers, so those of a node, on its plane and on its
/// sides, are ranges.
#[derive(Clone, Copy)]
pub struct Node<'t> {
    pub(super) tree: &'t BspTree,
    pub(super) index: u32,
    pub(super) depth: u32,
    /// The fragments of the whole subtree.
    pub(super) first: u32,
    pub(super) end: u32,
}

/// What is on one side of a [`Node`].
#[derive(Clone, Debug, PartialEq)]
pub enum Child<'t> {
    /// Another node.
    Node(Node<'t>),
    /// The numbers of the fragments of a leaf: one, or none.
    Leaf(Range<u32>),
}

impl<'t> Node<'t> {
    /// Its number, depth first: a node, its front subtree, its back subtree. The root is 0.
    pub fn index(&self) -> usize {
        self.index as usize
    }

    /// How many nodes there are on the path from the root to this one, both included.
    pub fn depth(&self) -> usize {
        self.depth as usize
    }

    /// The unit normal, which points to the front.
    pub fn normal(&self) -> DVec3 {
        grid::unit_normal(&self.tree.faces, self.plane())
    }

    /// The distance of the plane from the origin along the normal, in the polygons' unit. Infinite
    /// if it is too large for `f64`.
    pub fn offset(&self) -> f64 {
        grid::offset(&self.tree.faces, self.plane())
    }

    /// The exact plane: three points of the tree's [grid](BspTree::grid) on it, counter-clockwise seen from
    /// its front.
    pub fn grid_points(&self) -> [[i64; 3]; 3] {
        grid::plane_points(&self.tree.faces, self.plane())
    }

    /// The index, in the input, of the polygon in whose plane the node's plane is. If that polygon
    /// was triangulated, it is the plane of one of the triangles.
    ///
    /// `None` for a free plane, which is perpendicular to an axis: `normal` and `offset` are then
    /// exact, but for the one rounding to the grid that corners have.
    pub fn polygon(&self) -> Option<usize> {
        match self.plane().kind() {
            PlaneKind::Face(face) => Some(self.tree.faces.polygon(face)),
            PlaneKind::Axis(..) => None,
        }
    }

    /// The plane's exact name, by a face or corner of [`BspTree::faces`].
    #[doc(hidden)]
    pub fn plane(&self) -> PlaneId {
        self.tree.nodes[self.index()].plane
    }

    /// Which side of the plane a viewpoint sees, exactly: `Greater` is the front, `Equal` is
    /// neither. The far side, from which orders begin, is the other one; of a plane seen edge-on,
    /// either may be.
    pub fn facing(&self, viewpoint: Viewpoint) -> Ordering {
        let eye = Eye::new(viewpoint, self.tree.faces.lattice());
        self.tree.faces.plane(self.plane()).facing(&eye)
    }

    /// The numbers of the fragments on the plane, and on both sides down to the leaves.
    pub fn fragments(&self) -> Range<u32> {
        self.first..self.end
    }

    /// The numbers of the fragments on the plane, in input order.
    pub fn on(&self) -> Range<u32> {
        self.ranges().own
    }

    /// The numbers of all fragments in front, down to the leaves.
    pub fn in_front(&self) -> Range<u32> {
        self.ranges().front
    }

    /// The numbers of all fragments behind, down to the leaves.
    pub fn behind(&self) -> Range<u32> {
        self.ranges().back
    }

    /// What is in front.
    pub fn front(&self) -> Child<'t> {
        let record = &self.tree.nodes[self.index()];
        self.child(record.front_node(self.index()), self.in_front())
    }

    /// What is behind.
    pub fn back(&self) -> Child<'t> {
        let record = &self.tree.nodes[self.index()];
        self.child(record.back_node(self.index()), self.behind())
    }

    /// The far side, what is on the plane, and the near side: back to front.
    #[inline]
    pub(super) fn parts(&self, is_eye_in_front: bool) -> [Child<'t>; 3] {
        let record = &self.tree.nodes[self.index()];
        let Ranges { own, front, back } = record.ranges(self.fragments());
        let front = self.child(record.front_node(self.index()), front);
        let back = self.child(record.back_node(self.index()), back);
        let own = Child::Leaf(own);
        if is_eye_in_front { [back, own, front] } else { [front, own, back] }
    }

    fn ranges(&self) -> Ranges {
        self.tree.nodes[self.index()].ranges(self.fragments())
    }

    fn child(&self, node: Option<usize>, fragments: Range<u32>) -> Child<'t> {
        match node {
            Some(index) => Child::Node(Node {
                tree: self.tree,
                index: index as u32,
                depth: self.depth + 1,
                first: fragments.start,
                end: fragments.end,
            }),
            None => Child::Leaf(fragments),
        }
    }
}

/// Nodes of one tree are equal if they are the same one.
impl PartialEq for Node<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.tree, other.tree) && self.index == other.index
    }
}

impl Eq for Node<'_> {}

impl fmt::Debug for Node<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Node")
            .field("index", &self.index)
            .field("depth", &self.depth)
            .field("plane", &self.plane())
            .field("on", &self.on())
            .field("in_front", &self.in_front())
            .field("behind", &self.behind())
            .finish()
    }
}

/// The nodes of a tree, depth first: [`BspTree::nodes`].
#[derive(Clone, Debug)]
pub struct Nodes<'t> {
    tree: &'t BspTree,
    walk: Walk,
    left: usize,
}

impl<'t> Nodes<'t> {
    fn take(&mut self, visit: Visit) -> Node<'t> {
        self.left -= 1;
        let fragments = visit.all();
        Node {
            tree: self.tree,
            index: visit.node as u32,
            depth: visit.depth as u32,
            first: fragments.start,
            end: fragments.end,
        }
    }
}

impl<'t> Iterator for Nodes<'t> {
    type Item = Node<'t>;

    fn next(&mut self) -> Option<Node<'t>> {
        let visit = self.walk.next(self.tree)?;
        Some(self.take(visit))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<'t> DoubleEndedIterator for Nodes<'t> {
    fn next_back(&mut self) -> Option<Node<'t>> {
        let visit = self.walk.next_back(self.tree)?;
        Some(self.take(visit))
    }
}

impl ExactSizeIterator for Nodes<'_> {}
impl FusedIterator for Nodes<'_> {}

impl BspTree {
    /// The node at the top, of all fragments. `None` if there are no nodes: in a tree without
    /// fragments, or one of a single fragment that needs no plane.
    pub fn root(&self) -> Option<Node<'_>> {
        let end = self.records.len() as u32;
        (!self.nodes.is_empty()).then_some(Node { tree: self, index: 0, depth: 1, first: 0, end })
    }

    /// The root, or all fragments if there are no nodes.
    pub(super) fn whole(&self) -> Child<'_> {
        self.root().map_or(Child::Leaf(0..self.records.len() as u32), Child::Node)
    }

    /// All nodes, depth first, those in front of each before those behind it: to draw, measure or
    /// check a tree. O(nodes) for all of them.
    pub fn nodes(&self) -> Nodes<'_> {
        Nodes { tree: self, walk: Walk::new(self), left: self.nodes.len() }
    }
}
