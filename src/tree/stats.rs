//! Statistics of a tree.

use super::BspTree;
use super::walk::Walk;
use crate::exact::{Plane, PlaneId};

/// Statistics of a tree: [`BspTree::stats`]. What became of its polygons before they were divided is in
/// [`BspTree::preparation`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Stats {
    /// Convex faces: polygons, and the triangles of polygons that were triangulated;
    /// [`BspTree::face_count`].
    pub faces: usize,
    /// Fragments in the tree.
    pub fragments: usize,
    /// Partition planes.
    pub nodes: usize,
    /// The most nodes on a path from the root.
    pub depth_max: usize,
    /// The mean number of nodes on the path from the root to a fragment, over all fragments.
    pub depth_mean: f64,
    /// How many times the builder cut a piece in two.
    pub splits: usize,
    /// The size of the tree in bytes: [`BspTree::bytes`].
    pub bytes: usize,
    /// The coplanar tolerance that the tree was built with, a length.
    pub tolerance: f64,
    /// Faces that the tolerance alone made coplanar with a partition plane: the order of those on
    /// one plane is that of the input.
    pub nearly_coplanar: usize,
    /// How far their corners are off that plane at most, a length.
    pub nearly_coplanar_by: f64,
}

impl BspTree {
    /// Statistics of the tree. O(fragments).
    pub fn stats(&self) -> Stats {
        let (mut depth_max, mut depth_sum) = (0, 0);
        let (mut is_near, mut nearly_coplanar_by) = (vec![false; self.faces.len()], 0.0);
        let mut walk = Walk::new(self);
        while let Some(visit) = walk.next(self) {
            depth_max = depth_max.max(visit.depth);
            depth_sum += visit.depth * (visit.own.len() + visit.leaves());
            let id = self.nodes[visit.node].plane;
            let plane = self.faces.plane(id);
            for fragment in visit.own {
                let face = self.records[fragment as usize].face;
                let off = if id == PlaneId::face(face) { 0.0 } else { self.off(face, &plane) };
                is_near[face as usize] |= off > 0.0;
                nearly_coplanar_by = off.max(nearly_coplanar_by);
            }
        }
        let fragments = self.len();
        let lattice = self.faces.lattice();
        Stats {
            faces: self.faces.len(),
            fragments,
            nodes: self.nodes.len(),
            depth_max,
            depth_mean: depth_sum as f64 / fragments.max(1) as f64,
            splits: self.cuts,
            bytes: self.bytes(),
            tolerance: lattice.length_to_world(self.faces.tolerance()),
            nearly_coplanar: is_near.into_iter().filter(|&is_near| is_near).count(),
            nearly_coplanar_by: lattice.length_to_world(nearly_coplanar_by),
        }
    }

    /// How far a face's corners are off a plane at most, in lattice units, rounded; 0 only if all of
    /// them are exactly on it.
    fn off(&self, face: u32, plane: &Plane) -> f64 {
        let values = self.faces.corners(face).iter().map(|corner| plane.at(corner).to_f64().abs());
        values.fold(0.0, f64::max) / plane.normal_f64().length()
    }

    /// The size in bytes, heap included.
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + self.faces.bytes()
            + size_of_val(&*self.nodes)
            + self.planes.bytes()
            + self.schedule.as_ref().map_or(0, |schedule| schedule.bytes())
            + size_of_val(&*self.records)
            + size_of_val(&*self.vertices)
            + size_of_val(&*self.positions)
    }
}
