//! The order of cells for a viewpoint.

use super::{Partition, Wall};
use crate::exact::{Eye, Plane};
use crate::viewpoint::Viewpoint;

impl Partition {
    /// The numbers of all cells, the furthest first: no cell hides a later one. O(cells). An eye on a plane
    /// between two counts as on either side of it, as in a tree.
    pub fn back_to_front(&self, viewpoint: Viewpoint) -> Vec<usize> {
        let eye = Eye::new(viewpoint, &self.lattice);
        let mut order = Vec::with_capacity(self.cells());
        let mut rest = vec![self.root()];
        while let Some(subtree) = rest.pop() {
            if subtree.cells.len() == 1 {
                order.push(subtree.cells.start);
                continue;
            }
            let Wall { axis, at } = self.planes[subtree.plane];
            let [back, front] = subtree.sides();
            let is_in_front = Plane::axis_at_eye(axis, [at; 3], &eye).is_gt();
            // The nearer side is put below the further one, so that it comes later.
            rest.extend(if is_in_front { [front, back] } else { [back, front] });
        }
        order
    }

    /// The numbers of all cells, the nearest first: the reverse of
    /// [`back_to_front`](Self::back_to_front).
    pub fn front_to_back(&self, viewpoint: Viewpoint) -> Vec<usize> {
        let mut order = self.back_to_front(viewpoint);
        order.reverse();
        order
    }
}
