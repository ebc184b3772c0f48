//! What became of the polygons of an input.

use crate::exact::Lattice;

/// What became of the polygons of an input.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Preparation {
    /// The number of input polygons.
    pub polygons: usize,
    /// Polygons without area, which become no face: those with fewer than three different corners,
    /// or with all corners on one line. This is decided exactly, after the corners are rounded to
    /// the lattice. Corners that are on one line as decimal numbers need not be on one as `f64`. In a
    /// tree of a cell, polygons of which nothing is in the cell are counted too.
    pub dropped: usize,
    /// Polygons that were not convex, or not planar within the tolerance, and became triangles.
    pub triangulated: usize,
    /// Of the triangulated polygons, those that cross themselves, or whose winding number is not
    /// the same in all of what they enclose, seen along the main axis of their vector area; decided
    /// exactly. If the polygon's edges meet at corners only, the triangles cover everything that it
    /// winds around. Otherwise each two edges that cross are first replaced by two edges between
    /// the same four ends that do not cross: of the two ways to do so, the one that changes less
    /// area. Then the triangles cover what is inside by the even-odd rule. If that takes too long,
    /// or nothing is left, the triangles fan out from the first corner.
    pub crossing: usize,
    /// Polygons with a corner off the plane of the others, but within the tolerance: they are kept
    /// whole, and those corners count as on the plane.
    pub flattened: usize,
    /// How far such a corner is off at most, a length.
    pub flattened_by: f64,
    /// Of the triangulated polygons, those that are convex, with a corner off the plane of the
    /// others by more than the tolerance, but by no more than 10⁻⁵ of the width of the grid (which is
    /// one to two extents) or the polygon's own [`precision`](crate::Polygon::precision) (or 1/256 of the
    /// width, if that is less): bent by a rounding, as it seems. With a tolerance of `bent_by` they would
    /// be whole.
    pub bent: usize,
    /// How far such a corner is off at most, a length.
    pub bent_by: f64,
}

impl Preparation {
    /// Adds what became of other polygons of the same input.
    pub(crate) fn add(&mut self, other: &Self) {
        self.polygons += other.polygons;
        self.dropped += other.dropped;
        self.triangulated += other.triangulated;
        self.crossing += other.crossing;
        self.flattened += other.flattened;
        self.flattened_by = self.flattened_by.max(other.flattened_by);
        self.bent += other.bent;
        self.bent_by = self.bent_by.max(other.bent_by);
    }

    /// The same with lengths in the polygons' unit, where they are in that of the lattice.
    pub(super) fn in_world(mut self, lattice: &Lattice) -> Self {
        for length in [&mut self.flattened_by, &mut self.bent_by] {
            *length = lattice.length_to_world(*length);
        }
        self
    }
}
