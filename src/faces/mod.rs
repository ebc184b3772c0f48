//! Preparation: reads the input polygons, chooses the lattice and the tolerance, and makes convex planar
//! faces on the lattice.

mod polygon;
mod tolerance;
mod triangulate;

use glam::DVec3;

use crate::error::{Error, Kind, Shape};
use crate::exact::faces::Frame;
use crate::exact::lattice::MAX_TOLERANCE;
use crate::exact::{Faces, LATTICE_LIMIT, Lattice, MAX_NAMES, cross};
use crate::input::{MAX_CORNERS, Point, Polygon};
use crate::memory::{push, reserve};
use crate::parallel_map;
use crate::progress::{PIECES_AT_ONCE, Watch};
use polygon::{Corner, Corners, FaceBuilder, keep_distinct};
use tolerance::SnapParams;
pub use tolerance::{DEFAULT_TOLERANCE, Tolerance};
pub(crate) use tolerance::{Precision, empty_faces};

/// The number of polygons that one thread prepares as one job. Too small: overhead per job. Too large:
/// threads wait for each other.
const POLYGONS_A_THREAD: usize = 1024;
/// The number of polygons prepared between two polls for cancellation; after each, the jobs' faces are
/// joined. Too small: threads wait for each other. Too large: cancelling takes longer, and more memory is
/// used.
const POLYGONS_AT_ONCE: usize = 16 * POLYGONS_A_THREAD;

/// The distance of a segment's third corner, if no neighbour of the segment can be used: a quarter of the
/// lattice. Any distance makes the same plane.
const ARM: f64 = LATTICE_LIMIT / 2.0;

/// Counts of the input polygons that are dropped, triangulated or flattened before a tree is built:
/// [`BspTree::preparation`](crate::BspTree::preparation).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Preparation {
    /// The number of input polygons.
    pub polygons: usize,
    /// The number of polygons without area, which have no [fragments](crate::Fragment): polygons with fewer
    /// than three different corners, with collinear corners, or with an outline that returns along itself.
    /// The count is exact after corners are rounded to the [grid](crate::Grid). Corners that are collinear as
    /// decimal numbers may not be collinear as `f64`. In the tree of a cell of a
    /// [partition](crate::partition), polygons outside the cell are counted too.
    pub dropped: usize,
    /// The number of polygons that were not convex, or not planar within the [tolerance](crate::Tolerance),
    /// and became triangles.
    pub triangulated: usize,
    /// The number of triangulated planar polygons that are self-intersecting, or whose winding number differs
    /// between inner points. A polygon counts as planar if no corner is further from a plane through three
    /// corners than the [tolerance](crate::Tolerance), or than rounding explains: the polygon's
    /// [`precision`](crate::Polygon::precision), at most 10⁻⁵ of the grid's width and 1/64 of the polygon's
    /// size. The count is exact in the polygon's projection along the largest component of the polygon's area
    /// vector. (A polygon that is not planar is never counted: it keeps its edges.) The triangles of a counted
    /// polygon depend on its edges:
    ///
    /// - If edges meet only at corners, the triangles cover every point with a nonzero winding number.
    /// - If edges cross, each pair of crossing edges is replaced by two edges between the same four ends that
    ///   do not cross, so that as little area as possible changes. Then the triangles cover the inside by the
    ///   even-odd rule.
    /// - If these replacements take too long, or leave no area, the triangles are a fan from the first
    ///   corner.
    pub crossing: usize,
    /// The number of polygons with a corner off the plane of the other corners, but within the tolerance.
    /// These polygons stay whole, and their corners are treated as lying on the plane.
    pub flattened: usize,
    /// The largest distance of a flattened polygon's corner from the plane of the other corners, a length.
    pub flattened_by: f64,
    /// The number of convex polygons that were probably meant to be planar, but became triangles because
    /// rounding moved a corner off the plane of the other corners by more than the tolerance. With a
    /// tolerance of `bent_by`, these polygons would stay whole.
    ///
    /// A polygon is counted if the corner's distance from the plane is at most 10⁻⁵ of the grid's width, or
    /// at most the polygon's own [`precision`](crate::Polygon::precision). (The grid is one to two times as
    /// wide as the longest side of the scene's bounding box. A precision above 1/256 of this width counts as
    /// 1/256.)
    pub bent: usize,
    /// The largest distance of a bent polygon's corner from the plane of the other corners, a length.
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
    /// Prepares polygons for a build: converts the polygons to convex planar faces.
    ///
    /// `tolerance` is a [`Tolerance`], a length, or `None` for the default.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite, if the tolerance is negative or NaN, if a polygon has more than 2²²
    /// corners, if there are more than 2²⁸ polygons or corners in total, or if memory runs out.
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

/// Prepares polygons, in reused lists.
#[derive(Debug, Default)]
pub(crate) struct Preparer {
    input: InputPolygons,
    corners: Corners,
    /// A box that the lattice contains in addition to the polygons.
    room: Option<[DVec3; 2]>,
    /// Whether all polygons are flat by definition.
    pub(crate) are_flat: bool,
    /// Whether appended shapes that are less precise than the scene raise the tolerance, as in overlays. (All
    /// cells of a scene have one tolerance.)
    raises_tolerance: bool,
}

impl Preparer {
    /// Prepares the shapes of overlays.
    pub(crate) fn for_overlays() -> Self {
        Self { raises_tolerance: true, ..Self::default() }
    }

    /// Replaces faces by the faces of other polygons, like [`Faces::new`], with a limit on the number of
    /// polygons. Reports progress to `watch`, which can cancel. After an error, some of the faces may be
    /// present.
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
        // The precision of the polygons does not depend on the added box.
        let own = if self.room.is_some() { self.input.bounds(None) } else { [min, max] };
        let precision = Precision::new(self.input.precision, own);
        let lattice = Lattice::new(min, max);
        let mut params = SnapParams::new(lattice, [min, max], tolerance, precision);
        if self.are_flat {
            // Any distance from the plane is a rounding error.
            params.bend = MAX_TOLERANCE;
        }
        (faces.lattice, faces.tolerance) = (params.lattice, params.tolerance);
        self.add_all(faces, &params, watch)
    }

    /// Adds the faces of all polygons. Few polygons are prepared on this thread, and many polygons as
    /// parallel jobs, whose results are joined in input order.
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
            let builder = FaceBuilder { faces, corners, params, watch, report };
            return Ok(builder.add_all(input, 0..input.len())?.in_world(&params.lattice));
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
                let (faces_of_part, corners) = (&mut faces, &mut corners);
                let report = Preparation::default();
                let builder = FaceBuilder { faces: faces_of_part, corners, params, watch, report };
                let report = builder.add_all(input, range)?;
                Ok::<_, Error>((faces, report))
            })?;
            for (part, part_report) in parts {
                faces.append(part)?;
                report.add(&part_report);
            }
        }
        Ok(report.in_world(&params.lattice))
    }

    /// Makes later lattices contain a box in addition to the polygons. The box is given by its lower and
    /// upper corner.
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

    /// Appends the faces of more polygons to a finished scene, on the scene's lattice and with the scene's
    /// tolerance. More polygons than `limit` are an error. The polygons are numbered from `first` on. After
    /// an error, some of the new faces may have been appended.
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
        self.raise_tolerance(faces);
        let before = faces.len();
        let report = self.add_all(faces, &SnapParams::of(faces), watch);
        faces.faces[before..].iter_mut().for_each(|face| face.polygon += first as u32);
        report
    }

    /// Appends the segments of lines, on the lattice of the faces, and writes the number of each segment
    /// within its line to `numbers`. Segments whose ends are rounded to one lattice point are left out. No
    /// points may have been appended before. After an error, some segments may have been appended.
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

    /// Appends points, on the lattice of the faces. After an error, some points may have been appended.
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

    /// Raises the tolerance of a scene to the default tolerance of the shapes that were read last, if wanted: a
    /// decal in `f32` lies on a wall in `f64`. A tolerance of 0 remains.
    fn raise_tolerance(&self, faces: &mut Faces) {
        if !self.raises_tolerance || faces.tolerance == 0.0 || self.input.len() == 0 {
            return;
        }
        let bounds = self.input.bounds(None);
        let precision = Precision::new(self.input.precision, bounds);
        let own = SnapParams::new(faces.lattice, bounds, Tolerance::Default, precision);
        faces.tolerance = faces.tolerance.max(own.tolerance);
    }

    fn read_thin<P: Polygon>(
        &mut self,
        faces: &mut Faces,
        shapes: impl IntoIterator<Item = P>,
        kind: Shape,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        self.input.read(shapes, usize::MAX, watch).map_err(|error| error.of(kind))?;
        match self.input.first_off(&faces.lattice) {
            Some(number) => Err(Kind::OffGrid.of_polygon(number).of(kind)),
            None => {
                self.raise_tolerance(faces);
                Ok(())
            }
        }
    }
}

/// The corner after a segment's end, and the corner before its start. In a closed line, these two corners may
/// lie beyond the corner where the line closes.
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

/// A lattice point that is not collinear with two others.
///
/// A neighbour that is not collinear is preferred: then all segments of a planar polyline have the polyline's
/// plane, and no segment cuts another.
fn third_corner([p, q]: [[f64; 3]; 2], neighbours: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    // Without a neighbour, the plane is vertical. Vertical planes cut each other like lines in the plane,
    // which makes fewer pieces than planes in all directions.
    let along = |axis: usize| {
        let mut third = p;
        third[axis] -= if p[axis] < 0.0 { -ARM } else { ARM };
        third
    };
    let is_off = |third: &[f64; 3]| cross(p, q, *third) != [0; 3];
    neighbours.chain([along(2)]).find(is_off).unwrap_or_else(|| along(0))
}

const _: () = assert!(MAX_CORNERS.is_multiple_of(PIECES_AT_ONCE), "the limit is checked there");

/// The largest number of polygons for which memory is reserved because of an iterator's size hint. Too
/// large: a wrong hint wastes memory. Too small: polygons are copied more often as lists grow.
const TRUSTED: usize = 1 << 16;

/// After this many polygons, a size hint that exceeds the rest of the limit is an error. Too small: wrong
/// hints are errors more often. Too large: an endless iterator is noticed later.
const DOUBTED: usize = 1 << 20;

/// A polygon is read in one step if the polygon's size hint promises at most this many corners. Too large:
/// memory is reserved because of a wrong hint.
const READ_AT_ONCE: usize = 64;

/// All corners, and the end of each polygon's corners.
#[derive(Debug, Default)]
struct InputPolygons {
    points: Vec<DVec3>,
    ends: Vec<u32>,
    /// The largest [`precision`](Polygon::precision) of the polygons.
    precision: f64,
    /// The precision of each polygon.
    precisions: Vec<f64>,
}

impl InputPolygons {
    /// The number of polygons.
    fn len(&self) -> usize {
        self.ends.len()
    }

    fn corner_count(&self) -> usize {
        self.points.len()
    }

    /// The corners of a polygon.
    fn polygon(&self, polygon: usize) -> &[DVec3] {
        let start = polygon.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.points[start as usize..self.ends[polygon] as usize]
    }

    /// The [`precision`](Polygon::precision) of a polygon.
    fn precision_of(&self, polygon: usize) -> f64 {
        self.precisions[polygon]
    }

    /// The bounding box of the polygons and, if given, of `room`. Without corners and `room`, the box is the
    /// origin.
    fn bounds(&self, room: Option<[DVec3; 2]>) -> [DVec3; 2] {
        let first = self.points.first().copied().or(room.map(|[corner, _]| corner));
        let start = [first.unwrap_or_default(); 2];
        let points = self.points.iter().chain(room.iter().flatten());
        points.fold(start, |[min, max], &p| [min.min(p), max.max(p)])
    }

    /// The first polygon with a corner beyond the ends of a lattice.
    fn first_off(&self, lattice: &Lattice) -> Option<usize> {
        let is_off = |point: &DVec3| lattice.snap(*point).iter().any(|c| c.abs() > LATTICE_LIMIT);
        (0..self.len()).find(|&polygon| self.polygon(polygon).iter().any(is_off))
    }

    /// Replaces the polygons by the polygons of an iterator; more polygons than `limit` are an error.
    fn read<P: Polygon>(
        &mut self,
        polygons: impl IntoIterator<Item = P>,
        limit: usize,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let mut polygons = polygons.into_iter();
        let too_many = match limit <= MAX_NAMES {
            true => Kind::PolygonsOfBudget(limit),
            false => Kind::Polygons(MAX_NAMES),
        };
        let limit = limit.min(MAX_NAMES);
        let expected = polygons.size_hint().0;
        self.points.clear();
        self.ends.clear();
        self.precision = 0.0;
        self.precisions.clear();
        reserve(&mut self.points, 3 * expected.min(TRUSTED))?;
        reserve(&mut self.ends, expected.min(TRUSTED))?;
        reserve(&mut self.precisions, expected.min(TRUSTED))?;
        let mut index = 0;
        while let Some(polygon) = polygons.next() {
            if index == limit {
                return Err(too_many.error());
            }
            if index == DOUBTED && polygons.size_hint().0 >= limit - index {
                return Err(too_many.error());
            }
            if index % PIECES_AT_ONCE == 0 {
                watch.expect(index)?;
            }
            self.add(index, &polygon, watch)?;
            index += 1;
        }
        Ok(())
    }

    fn add<P: Polygon>(
        &mut self,
        index: usize,
        polygon: &P,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let mut corners = polygon.corners().map(Point::to_dvec3);
        let mut read = 0;
        if let (least, Some(most)) = corners.size_hint()
            && least == most
            && most <= READ_AT_ONCE
        {
            reserve(&mut self.points, most)?;
            let before = self.points.len();
            self.points.extend(corners.by_ref().take(most));
            // Infinity and NaN times 0 are NaN.
            let zero = self.points[before..].iter().fold(DVec3::ZERO, |sum, &p| sum + p * 0.0);
            if zero != DVec3::ZERO {
                return Err(Kind::NonFinite.of_polygon(index));
            }
            read = self.points.len() - before;
        }
        // All corners, or the corners beyond the size hint.
        for (corner, point) in (read..).zip(corners) {
            if corner % PIECES_AT_ONCE == 0 && corner > 0 {
                if corner == MAX_CORNERS {
                    return Err(Kind::Corners(MAX_CORNERS).of_polygon(index));
                }
                self.check_count()?;
                watch.expect(index)?;
            }
            if !point.is_finite() {
                return Err(Kind::NonFinite.of_polygon(index));
            }
            push(&mut self.points, point)?;
        }
        self.check_count()?;
        // `max` ignores NaN.
        let precision = polygon.precision().max(0.0);
        push(&mut self.precisions, precision)?;
        self.precision = self.precision.max(precision);
        push(&mut self.ends, self.points.len() as u32)
    }

    /// Returns an error if there are more than [`MAX_NAMES`] corners.
    fn check_count(&self) -> Result<(), Error> {
        if self.points.len() > MAX_NAMES {
            return Err(Kind::CornersInAll(MAX_NAMES).error());
        }
        Ok(())
    }
}
