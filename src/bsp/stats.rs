//! What a tree is like.

use super::BspTree;
use super::walk::Walk;
use crate::geom::Kernel;

/// Figures of a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Stats {
    /// Polygons given.
    pub polygons: usize,
    /// Convex faces: polygons, and triangles of those that were triangulated.
    pub faces: usize,
    /// Fragments in the tree.
    pub fragments: usize,
    /// Partition planes.
    pub nodes: usize,
    /// The most nodes on a path from the root.
    pub depth_max: usize,
    /// The mean, over all fragments, of the nodes above it, its own included.
    pub depth_mean: f64,
    /// How often a piece was cut in two.
    pub splits: usize,
    /// Resident bytes of the tree.
    pub bytes: usize,
    /// Polygons without area, left out.
    pub dropped: usize,
    /// Polygons with the same corners as an earlier one, kept.
    pub duplicates: usize,
    /// Polygons that became triangles.
    pub triangulated: usize,
    /// Of these, polygons that cross themselves.
    pub crossing: usize,
}

impl<K: Kernel> BspTree<K> {
    /// Figures of the tree: O(nodes).
    pub fn stats(&self) -> Stats {
        let (mut depth_max, mut depth_sum) = (0, 0);
        let mut walk = Walk::new(self);
        while let Some(visit) = walk.next(self) {
            depth_max = depth_max.max(visit.depth);
            depth_sum += visit.depth * (visit.own.len() + visit.leaves());
        }
        let fragments = self.len();
        Stats {
            polygons: self.preparation.polygons,
            faces: self.faces.len(),
            fragments,
            nodes: self.nodes.len(),
            depth_max,
            depth_mean: depth_sum as f64 / fragments.max(1) as f64,
            splits: fragments - self.faces.len(),
            bytes: self.bytes(),
            dropped: self.preparation.dropped,
            duplicates: self.preparation.duplicates,
            crossing: self.preparation.crossing,
            triangulated: self.preparation.triangulated,
        }
    }

    /// The resident size in bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + self.faces.bytes()
            + size_of_val(&*self.nodes)
            + self.planes.bytes()
            + self.schedule.bytes()
            + size_of_val(&*self.records)
            + size_of_val(&*self.vertices)
    }
}
