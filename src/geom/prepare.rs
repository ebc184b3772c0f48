//! From the polygons of an input to convex planar faces on the lattice.

mod outline;

use glam::DVec3;

use super::duplicates::Outlines;
use super::exact::{Plane, cross};
use super::faces::{Face, Faces, Frame, INNER};
use super::growth::reserve;
use super::label::MAX_LABELS;
use super::polygon::Polygon;
use super::{Lattice, parallel, triangulate};
use crate::Error;

/// The default coplanar tolerance as a share of the scene's extent, the longest side of its
/// bounding box.
///
/// Larger, and thin layers that are meant to be apart count as coplanar; smaller, and faces that
/// are coplanar but for the rounding of their coordinates cut each other into slivers.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// The largest coplanar tolerance that counts, about 1/256 of the extent, in lattice units: what is
/// moved onto a plane must stay within the bits that the exact predicates have room for.
const LARGEST_TOLERANCE: f64 = super::lattice::LIMIT / 128.0;

/// So many polygons are prepared by one thread at a time. Smaller: time for changing over; larger:
/// threads wait for each other.
const PART: usize = 1024;
/// So many polygons are prepared before it is asked whether to go on, and before what they have
/// become is put together. Smaller: threads wait for each other; larger: it takes longer to stop,
/// and more memory.
const AT_ONCE: usize = 16 * PART;

/// What became of the polygons of an input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Preparation {
    /// How many polygons were given.
    pub polygons: usize,
    /// Polygons without area, of which no face remains: of fewer than three different corners, or
    /// with all of them on one line. That is decided exactly, after the corners are rounded to the
    /// lattice; corners that are on one line as decimal numbers need not be as `f64`.
    pub dropped: usize,
    /// Polygons with the same corners on the lattice as an earlier one, in the same order around
    /// them or the reverse. They are kept as they are, and the last one of them shows, as coplanar
    /// polygons come in input order.
    pub duplicates: usize,
    /// Polygons that were not convex, or not planar within the tolerance, and became triangles.
    pub triangulated: usize,
    /// Of these, polygons that cross themselves, as their triangles overlap or face both ways: what
    /// such a polygon covers is what ear clipping makes of it.
    pub crossing: usize,
}

impl Faces {
    /// Takes polygons to convex planar faces.
    ///
    /// The tolerance is a length in the polygons' own unit; `None` stands for
    /// [`DEFAULT_TOLERANCE`] of the extent. More than 1/256 of the extent counts as that.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite, the tolerance is negative or not a number, there are more
    /// than 2²⁸ corners, or a polygon is not convex and the feature `triangulate` is off.
    pub fn new<P: Polygon>(
        polygons: impl IntoIterator<Item = P>,
        tolerance: Option<f64>,
    ) -> Result<(Self, Preparation), Error> {
        Self::prepare(polygons, tolerance, usize::MAX, &mut |_| Ok(()))
    }

    /// As [`new`](Self::new), with a limit to the number of polygons, and a function that hears how
    /// many have been read, and stops it all by an error.
    pub(crate) fn prepare<P: Polygon>(
        polygons: impl IntoIterator<Item = P>,
        tolerance: Option<f64>,
        limit: usize,
        watch: &mut dyn FnMut(usize) -> Result<(), Error>,
    ) -> Result<(Self, Preparation), Error> {
        if let Some(value) = tolerance.filter(|&value| value.is_nan() || value < 0.0) {
            return Err(Error::tolerance(value));
        }
        let (points, ends) = collect(polygons, limit, watch)?;
        let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (min, max) = points.iter().fold(empty, |(min, max), &p| (min.min(p), max.max(p)));
        let (min, max) = if points.is_empty() { (DVec3::ZERO, DVec3::ZERO) } else { (min, max) };
        let lattice = Lattice::new(min, max);
        let extent = DVec3::from(lattice.snap(max)) - DVec3::from(lattice.snap(min));
        let tolerance = match tolerance {
            Some(length) => lattice.length_to_lattice(length).min(LARGEST_TOLERANCE),
            None => DEFAULT_TOLERANCE * extent.max_element(),
        };
        let of = |polygon: usize| {
            let start = polygon.checked_sub(1).map_or(0, |before| ends[before]);
            &points[start as usize..ends[polygon] as usize]
        };
        let mut whole = Part::new(lattice, tolerance);
        reserve(&mut whole.faces.corners, points.len());
        reserve(&mut whole.faces.faces, ends.len());
        for start in (0..ends.len()).step_by(AT_ONCE) {
            watch(ends.len())?;
            let end = ends.len().min(start + AT_ONCE);
            let ranges = (start..end).step_by(PART).map(|start| start..end.min(start + PART));
            let parts = parallel::map(ranges.collect(), |range| {
                Part::of(lattice, tolerance, range.map(|polygon| (polygon, of(polygon))))
            });
            for part in parts {
                whole.append(part?)?;
            }
        }
        let Part { mut faces, mut report, outlines } = whole;
        let mut builder = Builder::new(lattice, tolerance);
        report.duplicates = outlines.duplicates(|polygon| {
            builder.keep_distinct(of(polygon));
            builder.kept.iter().map(|&(corner, _)| corner).collect()
        });
        faces.corners.shrink_to_fit();
        faces.numbers.shrink_to_fit();
        faces.numbered.shrink_to_fit();
        faces.faces.shrink_to_fit();
        Ok((faces, report))
    }
}

/// What some polygons in a row become.
struct Part {
    faces: Faces,
    report: Preparation,
    outlines: Outlines,
}

impl Part {
    fn new(lattice: Lattice, tolerance: f64) -> Self {
        let faces = Builder::new(lattice, tolerance).faces;
        Self { faces, report: Preparation::default(), outlines: Outlines::default() }
    }

    fn of<'a>(
        lattice: Lattice,
        tolerance: f64,
        polygons: impl Iterator<Item = (usize, &'a [DVec3])>,
    ) -> Result<Self, Error> {
        let mut builder = Builder::new(lattice, tolerance);
        let (mut report, mut outlines) = (Preparation::default(), Outlines::default());
        for (polygon, points) in polygons {
            report.polygons += 1;
            match builder.add(polygon, points)? {
                Outcome::Whole => {}
                Outcome::Triangulated { crosses_itself } => {
                    report.triangulated += 1;
                    report.crossing += usize::from(crosses_itself);
                }
                Outcome::Dropped => {
                    report.dropped += 1;
                    continue;
                }
            }
            outlines.add(polygon, builder.kept.iter().map(|&(corner, _)| corner));
        }
        Ok(Self { faces: builder.faces, report, outlines })
    }

    fn append(&mut self, next: Self) -> Result<(), Error> {
        let (corners, numbers) = (self.faces.corners.len(), self.faces.numbers.len() as u32);
        if corners + next.faces.corners.len() >= MAX_LABELS {
            return Err(Error::too_many_corners());
        }
        let first = self.faces.faces.len() as u32;
        let numbered = next.faces.numbered.iter();
        self.faces.numbered.extend(numbered.map(|&(face, at)| (first + face, numbers + at)));
        self.faces.numbers.extend(next.faces.numbers);
        reserve(&mut self.faces.corners, next.faces.corners.len());
        self.faces.corners.extend(next.faces.corners);
        reserve(&mut self.faces.faces, next.faces.faces.len());
        let moved = |face: Face| Face { start: face.start + corners as u32, ..face };
        self.faces.faces.extend(next.faces.faces.into_iter().map(moved));
        self.report.polygons += next.report.polygons;
        self.report.dropped += next.report.dropped;
        self.report.triangulated += next.report.triangulated;
        self.report.crossing += next.report.crossing;
        self.outlines.append(next.outlines);
        Ok(())
    }
}

/// All corners, and where those of each polygon end.
fn collect<P: Polygon>(
    polygons: impl IntoIterator<Item = P>,
    limit: usize,
    watch: &mut dyn FnMut(usize) -> Result<(), Error>,
) -> Result<(Vec<DVec3>, Vec<u32>), Error> {
    let polygons = polygons.into_iter();
    let expected = polygons.size_hint().0;
    if expected > limit {
        return Err(Error::polygons(limit));
    }
    let (mut points, mut ends) = (Vec::with_capacity(expected * 3), Vec::with_capacity(expected));
    for (index, polygon) in polygons.enumerate() {
        if index == limit {
            return Err(Error::polygons(limit));
        }
        if index % PART == 0 {
            watch(index)?;
        }
        for point in polygon.corners() {
            if !point.is_finite() {
                return Err(Error::non_finite(index));
            }
            if points.len() >= MAX_LABELS {
                return Err(Error::too_many_corners());
            }
            reserve(&mut points, 1);
            points.push(point);
        }
        ends.push(points.len() as u32);
    }
    Ok((points, ends))
}

enum Outcome {
    Whole,
    Triangulated { crosses_itself: bool },
    Dropped,
}

struct Builder {
    faces: Faces,
    /// The corners of the polygon at hand on the lattice, repeated ones left out, each with its
    /// number.
    kept: Vec<([f64; 3], u32)>,
}

impl Builder {
    fn new(lattice: Lattice, tolerance: f64) -> Self {
        let faces = Faces {
            lattice,
            tolerance,
            corners: vec![],
            numbers: vec![],
            numbered: vec![],
            faces: vec![],
        };
        Self { faces, kept: vec![] }
    }

    fn add(&mut self, polygon: usize, points: &[DVec3]) -> Result<Outcome, Error> {
        self.keep_distinct(points);
        let Some([second, third]) = self.widest_triangle() else {
            return Ok(Outcome::Dropped);
        };
        if self.kept.len() == 3 {
            self.push(polygon, &[0, 1, 2], Frame::TRIANGLE)?;
            return Ok(Outcome::Whole);
        }
        let convex = self.is_convex(second, third);
        if convex
            && self.kept.len() <= Frame::MAX_CORNERS
            && let Some(frame) = self.planar_frame(second, third)
        {
            let all: Vec<usize> = (0..self.kept.len()).collect();
            self.push(polygon, &all, frame)?;
            return Ok(Outcome::Whole);
        }
        let corners: Vec<[f64; 3]> = self.kept.iter().map(|&(point, _)| point).collect();
        let plane = Plane::through([0, second, third].map(|k| corners[k]));
        let (triangles, crosses_itself) = if convex {
            (triangulate::convex(&corners), false)
        } else {
            triangulate::any(&corners, &plane).map_err(|_| Error::not_convex(polygon))?
        };
        let before = self.faces.len();
        for triple in triangles {
            let [p, q, r] = triple.map(|k| corners[k]);
            if cross(p, q, r) != [0; 3] {
                self.push(polygon, &triple, Frame::TRIANGLE)?;
            }
        }
        let any = self.faces.len() > before;
        Ok(if any { Outcome::Triangulated { crosses_itself } } else { Outcome::Dropped })
    }

    fn keep_distinct(&mut self, points: &[DVec3]) {
        self.kept.clear();
        for (number, &point) in points.iter().enumerate() {
            let point = self.faces.lattice.snap(point);
            match self.kept.last_mut() {
                // The edge that goes on from here is that of the last of equal corners.
                Some((last, kept)) if *last == point => *kept = number as u32,
                _ => self.kept.push((point, number as u32)),
            }
        }
        while self.kept.len() > 1 && self.kept[0].0 == self.kept[self.kept.len() - 1].0 {
            self.kept.pop();
        }
    }

    /// Adds a face of some of the polygon's kept corners, in order around it.
    fn push(&mut self, polygon: usize, kept: &[usize], frame: Frame) -> Result<(), Error> {
        let faces = &mut self.faces;
        let start = faces.corners.len();
        if start + kept.len() >= MAX_LABELS {
            return Err(Error::too_many_corners());
        }
        let number = |k: usize| {
            let next = kept[(k + 1) % kept.len()];
            let is_outline = Self::is_outline(&self.kept, kept[k], next);
            self.kept[kept[k]].1 | if is_outline { 0 } else { INNER }
        };
        if (0..kept.len()).any(|k| number(k) != k as u32) {
            faces.numbered.push((faces.faces.len() as u32, faces.numbers.len() as u32));
            faces.numbers.extend((0..kept.len()).map(number));
        }
        reserve(&mut faces.corners, kept.len());
        reserve(&mut faces.faces, 1);
        faces.corners.extend(kept.iter().map(|&k| self.kept[k].0));
        faces.faces.push(Face { start: start as u32, polygon: polygon as u32, frame });
        if let Some(axis) = frame.drop_axis() {
            faces.flatten_last(axis);
        }
        Ok(())
    }
}
