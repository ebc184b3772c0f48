//! Whether two viewpoints have the same order.

use super::eye_sides::View;
use crate::tree::BspTree;
use crate::viewpoint::Viewpoint;

impl BspTree {
    /// Whether no partition plane lies between two viewpoints: then their orders are the same, and
    /// what was sorted or uploaded for one need not be for the other. (Orders may be the same even
    /// if a plane lies between.)
    ///
    /// It stops at the first plane between the two; O(nodes) if there is none. Nothing is allocated.
    ///
    /// ```
    /// use binspace::{BspTree, Viewpoint};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let tree = BspTree::build([square(2.0), square(0.0), square(1.0)])?;
    /// let eye = |z: f64| Viewpoint::eye([0.5, 0.5, z]);
    /// assert!(tree.same_order(eye(3.0), eye(9.0)));
    /// assert!(!tree.same_order(eye(-1.0), eye(9.0)));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    pub fn same_order(&self, one: Viewpoint, other: Viewpoint) -> bool {
        View::new(self, one).agrees_with(&View::new(self, other), self)
    }
}
