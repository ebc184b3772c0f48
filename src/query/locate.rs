//! The leaf of a tree that contains a point.

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec3;
use smallvec::SmallVec;

use crate::exact::eye::ExactRay;
use crate::tree::{BspTree, Child, Node};
use crate::viewpoint::Ray;

/// The leaf of a tree that contains a point, and the [partition planes](BspTree#contents) through the point:
/// [`BspTree::locate`]. A *leaf* is a convex region of space that no partition plane divides.
///
/// Two locations are equal if they have the same leaf and the same planes.
#[derive(Clone, Debug)]
pub struct Location<'t> {
    tree: &'t BspTree,
    node: Option<Node<'t>>,
    is_in_front: bool,
    fragments: Range<u32>,
    planes: SmallVec<[Node<'t>; 3]>,
}

impl<'t> Location<'t> {
    /// Returns the node whose front side or back side is the leaf. `None` if the tree has no nodes: then the
    /// whole tree is one leaf.
    pub fn node(&self) -> Option<Node<'t>> {
        self.node
    }

    /// Returns whether the leaf is the front of the [node](Self::node), rather than the back.
    pub fn is_in_front(&self) -> bool {
        self.is_in_front
    }

    /// Returns the number of the leaf's [fragment](crate::Fragment) as a range, or an empty range if the leaf
    /// has no fragment.
    pub fn fragments(&self) -> Range<u32> {
        self.fragments.clone()
    }

    /// Returns the nodes whose planes contain the point exactly, from the root down to the leaf. The
    /// fragments [`on`](Node::on) the plane of such a node are in the same plane as the point, up to the
    /// [tolerance](BspTree#exactness).
    pub fn planes(&self) -> &[Node<'t>] {
        &self.planes
    }
}

impl PartialEq for Location<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.tree, other.tree)
            && self.node == other.node
            && self.is_in_front == other.is_in_front
            && self.planes == other.planes
    }
}

impl BspTree {
    /// Returns the leaf that contains a point, and the partition planes through the point. A *leaf* is a
    /// convex region of space that no partition plane divides. A leaf contains at most one fragment.
    ///
    /// The result is exact for the given point, except for the very small digits that a [`Ray`] ignores. A
    /// point on a partition plane is treated as lying in front of the plane.
    ///
    /// Returns `None` if a coordinate is NaN or infinite. May return `None` if the point is further from the
    /// scene than 2⁶⁸ extents (longest sides of the scene's bounding box). Takes O(depth) time.
    ///
    /// ```
    /// use binspace::{BspTree, Ray};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let tree = BspTree::build([square(0.0), square(2.0), square(1.0)])?;
    ///
    /// let between = tree.locate([0.2, 0.3, 1.5]).expect("a number");
    /// assert_eq!(between, tree.locate([-7.0, 5.0, 1.1]).expect("a number"));
    /// assert_ne!(between, tree.locate([0.2, 0.3, 0.5]).expect("a number"));
    /// // A ray of no length hits the polygons that contain its point.
    /// let point = [0.2, 0.3, 1.0];
    /// assert!(tree.hits(Ray::between(point, point)).map(|hit| hit.polygon()).eq([2]));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    pub fn locate(&self, point: impl Into<DVec3>) -> Option<Location<'_>> {
        let point = point.into();
        let exact = ExactRay::new(Ray::between(point, point), self.faces.lattice())?;
        let mut location = Location {
            tree: self,
            node: None,
            is_in_front: false,
            fragments: 0..self.len() as u32,
            planes: SmallVec::new(),
        };
        let mut next = self.root();
        while let Some(node) = next {
            let side = exact.at(&self.faces.plane(node.plane())).start();
            if side == Ordering::Equal {
                location.planes.push(node);
            }
            let child = if side.is_ge() { node.front() } else { node.back() };
            (location.node, location.is_in_front) = (Some(node), side.is_ge());
            next = match child {
                Child::Node(node) => Some(node),
                Child::Leaf(fragments) => {
                    location.fragments = fragments;
                    None
                }
            };
        }
        Some(location)
    }
}
