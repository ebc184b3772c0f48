//! Prepares polygons: reads them, chooses the lattice and the tolerance, and makes faces of them.

use glam::DVec3;

use super::polygon::{Corner, Corners, FaceBuilder, keep_distinct};
use super::read::InputPolygons;
use super::tolerance::{Precision, SnapParams, Tolerance};
use crate::error::{Error, Kind, Shape};
use crate::exact::faces::Frame;
use crate::exact::{Faces, LATTICE_LIMIT, Lattice, cross};
use crate::input::{Point, Polygon};
use crate::memory::reserve;
use crate::parallel_map;
use crate::progress::Watch;

/// Polygons that one thread prepares as one job. Too small: overhead per job; too large: threads wait
/// for each other.
const POLYGONS_A_THREAD: usize = 1024;
/// Polygons that are prepared before the jobs' faces are put together and a cancel is noticed.
/// Too small: threads wait for each other; too large: a cancel takes longer, and more memory is used.
const POLYGONS_AT_ONCE: usize = 16 * POLYGONS_A_THREAD;

/// How far the third corner of a segment is, if the segment's neighbours give none: a quarter of the
/// lattice. Any distance gives the same plane.
const ARM: f64 = LATTICE_LIMIT / 2.0;

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
    /// Adds the report of other polygons of the same input.
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

    /// The same report with lengths converted from lattice units to the polygons' unit.
    fn in_world(mut self, lattice: &Lattice) -> Self {
        for length in [&mut self.flattened_by, &mut self.bent_by] {
            *length = lattice.length_to_world(*length);
        }
        self
    }
}

impl Faces {
    /// Prepares polygons: turns them into convex planar faces.
    ///
    /// Instead of a [`Tolerance`], a length may be given, or `None` for the default.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite, the tolerance is negative or NaN, a polygon has more than
    /// 2²² corners, there are more than 2²⁸ polygons or corners in total, or memory
    /// runs out.
    pub fn new<P: Polygon>(
        polygons: impl IntoIterator<Item = P>,
        tolerance: impl Into<Tolerance>,
    ) -> Result<(Self, Preparation), Error> {
        let mut faces = Self::default();
        let report = Preparer::default().prepare(
            &mut faces,
            polygons,
            tolerance.into(),
            usize::MAX,
            &Watch::default(),
        )?;
        faces.shrink_to_fit();
        Ok((faces, report))
    }
}

/// Prepares polygons, and keeps its lists for the next time.
#[derive(Debug, Default)]
pub(crate) struct Preparer {
    input: InputPolygons,
    corners: Corners,
    /// A box that the lattice holds besides the polygons.
    room: Option<[DVec3; 2]>,
    /// Whether all polygons are flat by definition.
    pub(crate) are_flat: bool,
}

impl Preparer {
    /// Replaces faces by those of some polygons, as [`Faces::new`] does, with a limit on the number of
    /// polygons. Progress is reported to `watch`, which can cancel. After an error, some of the faces may
    /// be there.
    pub(crate) fn prepare<P: Polygon>(
        &mut self,
        faces: &mut Faces,
        polygons: impl IntoIterator<Item = P>,
        tolerance: Tolerance,
        limit: usize,
        watch: &Watch<'_>,
    ) -> Result<Preparation, Error> {
        faces.clear();
        tolerance.check()?;
        self.input.read(polygons, limit, watch)?;
        let [min, max] = self.input.bounds(self.room);
        // The room does not say how precise the polygons are.
        let own = if self.room.is_some() { self.input.bounds(None) } else { [min, max] };
        let precision = Precision::new(self.input.precision, own);
        let params = SnapParams::new(Lattice::new(min, max), [min, max], tolerance, precision);
        let params = if self.are_flat { params.of_flat_polygons() } else { params };
        (faces.lattice, faces.tolerance) = (params.lattice, params.tolerance);
        self.add_all(faces, &params, watch)
    }

    /// Adds the faces of all polygons: few on this thread, more in parts, which are put together in input
    /// order.
    fn add_all(
        &mut self,
        faces: &mut Faces,
        params: &SnapParams,
        watch: &Watch<'_>,
    ) -> Result<Preparation, Error> {
        let Self { input, corners, .. } = self;
        reserve(&mut faces.corners, input.corner_count())?;
        reserve(&mut faces.faces, input.len())?;
        let mut report = Preparation::default();
        if input.len() <= POLYGONS_A_THREAD {
            watch.expect(input.len())?;
            report =
                FaceBuilder { faces, corners }.add_all(params, input, 0..input.len(), watch)?;
            return Ok(report.in_world(&params.lattice));
        }
        let empty = faces.without_faces();
        for start in (0..input.len()).step_by(POLYGONS_AT_ONCE) {
            watch.expect(input.len())?;
            let end = input.len().min(start + POLYGONS_AT_ONCE);
            let ranges = (start..end)
                .step_by(POLYGONS_A_THREAD)
                .map(|start| start..end.min(start + POLYGONS_A_THREAD));
            let parts = parallel_map::map(ranges.collect(), |range| {
                let (mut faces, mut corners) = (empty.clone(), Corners::default());
                let mut builder = FaceBuilder { faces: &mut faces, corners: &mut corners };
                let report = builder.add_all(params, input, range, watch)?;
                Ok::<_, Error>((faces, report))
            })?;
            for (part, part_report) in parts {
                faces.append(part)?;
                report.add(&part_report);
            }
        }
        Ok(report.in_world(&params.lattice))
    }

    /// Makes later lattices hold a box, given by its lower and upper corner, besides the polygons.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite.
    pub(crate) fn hold(&mut self, room: Option<[DVec3; 2]>) -> Result<(), Error> {
        if room.iter().flatten().any(|corner| !corner.is_finite()) {
            return Err(Kind::Bounds.error());
        }
        self.room = room;
        Ok(())
    }

    /// Appends the faces of more polygons to those of a finished scene, on its lattice and with its
    /// tolerance. More than `limit` are an error. The polygons are numbered from `first` on.
    /// After an error, some of their faces may have been appended.
    pub(crate) fn append<P: Polygon>(
        &mut self,
        faces: &mut Faces,
        polygons: impl IntoIterator<Item = P>,
        first: usize,
        limit: usize,
        watch: &Watch<'_>,
    ) -> Result<Preparation, Error> {
        self.input.read(polygons, limit, watch)?;
        if let Some(polygon) = self.input.first_off(faces.lattice()) {
            return Err(Kind::OffGrid.of_polygon(polygon));
        }
        let before = faces.len();
        let report = self.add_all(faces, &SnapParams::of(faces), watch);
        faces.faces[before..].iter_mut().for_each(|face| face.polygon += first as u32);
        report
    }

    /// Appends the segments of lines, on the lattice of the faces, and lists their numbers in their
    /// lines. Segments whose ends are rounded to one lattice point are left out. There may be no points
    /// yet. After an error, some segments may have been appended.
    pub(crate) fn append_lines<P: Polygon>(
        &mut self,
        faces: &mut Faces,
        lines: impl IntoIterator<Item = P>,
        numbers: &mut Vec<u32>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        numbers.clear();
        self.read_thin(faces, lines, Shape::Line, watch)?;
        let mut corners = Vec::new();
        for line in 0..self.input.len() {
            let given = self.input.polygon(line);
            watch.work(given.len())?;
            keep_distinct(given, &faces.lattice, &mut corners);
            reserve(numbers, corners.len())?;
            for (k, ends) in corners.windows(2).enumerate() {
                let [(from, number), (to, _)] = *ends else { continue };
                let third = third_corner([from, to], neighbours(&corners, k).into_iter().flatten());
                faces.push(line, [from, to, third].into_iter(), Frame::TRIANGLE)?;
                numbers.push(number);
            }
        }
        faces.thin.segments = numbers.len();
        Ok(())
    }

    /// Appends points, on the lattice of the faces. After an error, some may have been appended.
    pub(crate) fn append_points<P: Point>(
        &mut self,
        faces: &mut Faces,
        points: impl IntoIterator<Item = P>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let points = points.into_iter().map(|point| [point]);
        self.read_thin(faces, points, Shape::Point, watch)?;
        for number in 0..self.input.len() {
            let lattice = faces.lattice;
            let at = self.input.polygon(number).iter().map(|&point| lattice.snap(point));
            faces.push(number, at, Frame::POINT)?;
        }
        faces.thin.points = self.input.len();
        Ok(())
    }

    fn read_thin<P: Polygon>(
        &mut self,
        faces: &Faces,
        shapes: impl IntoIterator<Item = P>,
        kind: Shape,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        self.input.read(shapes, usize::MAX, watch).map_err(|error| error.of(kind))?;
        match self.input.first_off(&faces.lattice) {
            Some(number) => Err(Kind::OffGrid.of_polygon(number).of(kind)),
            None => Ok(()),
        }
    }
}

/// The corner behind a segment's end, and the one ahead of its beginning. Where a line is closed, they
/// are those on the other side of the closing corner.
fn neighbours(corners: &[Corner], segment: usize) -> [Option<[f64; 3]>; 2] {
    let segments = corners.len() - 1;
    let is_closed = corners[0].0 == corners[segments].0;
    let after = match segment + 2 {
        next if next <= segments => Some(next),
        _ => is_closed.then_some(1),
    };
    let before = match segment.checked_sub(1) {
        None => is_closed.then_some(segments - 1),
        before => before,
    };
    [after, before].map(|corner| corner.map(|corner| corners[corner].0))
}

/// A lattice point that is not on the line through two others.
///
/// If a neighbour is such a point, it is taken: all segments of a planar polyline then have its plane, and
/// none of them cuts another.
fn third_corner([p, q]: [[f64; 3]; 2], neighbours: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    // Without a neighbour, the plane is upright. Upright planes cut each other as lines do, which makes
    // fewer pieces than planes in all directions.
    let along = |axis: usize| {
        let mut third = p;
        third[axis] -= if p[axis] < 0.0 { -ARM } else { ARM };
        third
    };
    let is_off = |third: &[f64; 3]| cross(p, q, *third) != [0; 3];
    neighbours.chain([along(2)]).find(is_off).unwrap_or_else(|| along(0))
}
