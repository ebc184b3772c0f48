//! Which cells a polygon reaches.

use glam::DVec3;
use smallvec::SmallVec;

use super::{CellRange, Partition, Wall};
use crate::exact::LATTICE_LIMIT;
use crate::exact::cell::CellBox;
use crate::input::Polygon;

/// How far beyond its corners a polygon may reach, in tolerances and in steps of the lattice: a corner
/// that is moved onto its plane moves by √3 of the tolerance and half a step, and what is within the
/// tolerance of a cell's plane belongs to one side. Together √3 + 1 = 2.74 tolerances and half a step. Smaller: cells miss what is theirs; larger: more
/// polygons are given to cells that nothing of them is in.
const MARGIN: [f64; 2] = [3.0, 2.0];
/// What rounding adds to the distance of a corner from a plane, as a share of the lengths that it is made
/// of. The normal is any, and taken as it is. With u = 2⁻⁵³: arms of corners are exact, so a scalar product with
/// one is off by 3u, three for the product and the sums on the way; an end of a box by u and its difference
/// from a corner by u, its middle and its half by u more, and their products by 3u each. Together with the sums
/// and differences in `meets`, and the slack itself, that is less than 20u.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl Partition {
    /// Replaces `cells` by the cells that a polygon may have part in, in ascending order. All
    /// that [`build_cell`](crate::BuildOptions::build_cell) needs of a scene are the polygons that reach the cell.
    ///
    /// Conservative: a cell is listed if its box meets the polygon's, widened by the tolerance, and the
    /// layer along its plane. So a few cells are listed that nothing of the polygon is in, which does no
    /// harm. A polygon with a corner beyond the partition's grid, or no number, is listed for all: building
    /// them tells about it.
    ///
    /// O(corners + cells reached · log cells).
    pub fn reached_by(&self, polygon: &(impl Polygon + ?Sized), cells: &mut Vec<usize>) {
        cells.clear();
        let corners: SmallVec<[[f64; 3]; 8]> =
            polygon.corners().map(|corner| self.lattice.snap(corner)).collect();
        let Some(&first) = corners.first() else { return };
        let is_on_lattice = |corner: &[f64; 3]| corner.iter().all(|c| c.abs() <= LATTICE_LIMIT);
        if !corners.iter().all(is_on_lattice) {
            cells.extend(0..self.cells());
            return;
        }
        let margin = MARGIN[0] * self.tolerance + MARGIN[1];
        let [mut low, mut high] = [first; 2];
        for corner in &corners {
            for axis in 0..3 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        let reach = [low.map(|c| c - margin), high.map(|c| c + margin)];
        let mut slot = None;
        let mut rest: SmallVec<[(CellRange, CellBox); 16]> = SmallVec::new();
        rest.push((self.root(), reach));
        while let Some((subtree, part)) = rest.pop() {
            if subtree.cells.len() == 1 {
                // What is in one cell with all that is around it needs no closer look.
                let layer = || Layer::new(&corners, margin);
                if part == reach || slot.get_or_insert_with(layer).meets(&part) {
                    cells.push(subtree.cells.start);
                }
                continue;
            }
            let Wall { axis, at } = self.planes[subtree.plane];
            let [back, front] = subtree.sides();
            let [mut back_part, mut front_part] = [part; 2];
            back_part[1][axis] = at.min(part[1][axis]);
            front_part[0][axis] = at.max(part[0][axis]);
            // What is behind comes off first, so that cells come in ascending order.
            if part[1][axis] >= at {
                rest.push((front, front_part));
            }
            if part[0][axis] < at {
                rest.push((back, back_part));
            }
        }
    }
}

/// The space between two parallel planes around some corners.
struct Layer {
    /// The point that distances are measured from.
    from: DVec3,
    normal: DVec3,
    /// The scalar products of the normal with all points, the margin included.
    least: f64,
    most: f64,
}

impl Layer {
    /// Perpendicular to Newell's normal: of a planar polygon that is thin. Any normal would be right.
    fn new(corners: &[[f64; 3]], margin: f64) -> Self {
        let from = DVec3::from(corners[0]);
        // Differences of lattice coordinates are exact.
        let arms = corners.iter().map(|&corner| DVec3::from(corner) - from);
        let next = arms.clone().cycle().skip(1);
        let normal: DVec3 = arms.clone().zip(next).map(|(arm, next)| arm.cross(next)).sum();
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        let [least, most] = arms.clone().fold(start, |[least, most], arm| {
            let along = normal.dot(arm);
            [least.min(along), most.max(along)]
        });
        let size = arms.map(|arm| arm.abs().max_element()).fold(0.0, f64::max);
        let slack = normal.abs().element_sum() * (margin + ROUNDING * (size + margin));
        Self { from, normal, least: least - slack, most: most + slack }
    }

    /// Whether some of a box, which reaches no further than the corners and the margin, is in it.
    fn meets(&self, [low, high]: &CellBox) -> bool {
        let [low, high] = [low, high].map(|&corner| DVec3::from(corner) - self.from);
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let (along, reach) = (self.normal.dot(middle), self.normal.abs().dot(half));
        along - reach <= self.most && along + reach >= self.least
    }
}
