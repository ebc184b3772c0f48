//! Statistics of a tree.

use super::BspTree;
use super::walk::Walk;

/// Statistics of a tree: [`BspTree::stats`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Stats {
    /// Polygons in the input.
    pub polygons: usize,
    /// Convex faces: polygons, and the triangles of polygons that were triangulated.
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
    /// Polygons without area, which were dropped.
    pub dropped: usize,
    /// Polygons with the same corners as an earlier one; they are kept.
    pub duplicates: usize,
    /// Polygons that were triangulated.
    pub triangulated: usize,
    /// Of these, polygons that cross themselves.
    pub crossing: usize,
}

impl BspTree {
    /// Statistics of the tree. O(nodes).
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
            splits: self.cuts,
            bytes: self.bytes(),
            dropped: self.preparation.dropped,
            duplicates: self.preparation.duplicates,
            crossing: self.preparation.crossing,
            triangulated: self.preparation.triangulated,
        }
    }

    /// The size in bytes, heap included.
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
