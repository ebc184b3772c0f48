//! Decides what becomes of each input polygon: one face, triangles, or nothing.

mod collect;
mod planar;
mod tolerance;

pub use collect::MAX_CORNERS;
use collect::{Collected, collect};
use glam::DVec3;
use smallvec::SmallVec;
use tolerance::Ground;
pub use tolerance::{DEFAULT_TOLERANCE, Tolerance};

use super::duplicates::Outlines;
use super::listener::{Listener, Unheard};
use super::triangulate;
use crate::Error;
use crate::exact::faces::{Face, Frame, INNER};
use crate::exact::{Faces, Lattice, MAX_LABELS, Plane, cross};
use crate::input::Polygon;
use crate::memory::reserve;
use crate::parallel_map;

/// Polygons that one thread prepares as one job. Smaller: overhead per job; larger: threads wait
/// for each other.
const PART: usize = 1024;
/// Polygons that are prepared before the jobs' faces are put together and a cancel is noticed.
/// Smaller: threads wait for each other; larger: a cancel takes longer, and more memory is used.
const AT_ONCE: usize = 16 * PART;
/// Corners of a polygon that count as one step of work.
const STEP_CORNERS: usize = 4;

/// What became of the polygons of an input.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Preparation {
    /// The number of input polygons.
    pub polygons: usize,
    /// Polygons without area, which become no face: those with fewer than three different corners,
    /// or with all corners on one line. This is decided exactly, after the corners are rounded to
    /// the lattice. Corners that are on one line as decimal numbers need not be on one as `f64`.
    pub dropped: usize,
    /// Polygons with the same corners on the lattice as an earlier one, in the same cyclic order or
    /// its reverse. They are kept. The last of them shows, as coplanar polygons come in input
    /// order.
    pub duplicates: usize,
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
    /// others by more than the tolerance, but by no more than 10⁻⁵ of the extent: bent by a
    /// rounding, as it seems. With a larger tolerance they would be whole.
    pub bent: usize,
    /// How far such a corner is off at most, a length.
    pub bent_by: f64,
}

impl Preparation {
    /// Adds what became of other polygons of the same input.
    fn add(&mut self, other: &Self) {
        self.polygons += other.polygons;
        self.dropped += other.dropped;
        self.duplicates += other.duplicates;
        self.triangulated += other.triangulated;
        self.crossing += other.crossing;
        self.flattened += other.flattened;
        self.flattened_by = self.flattened_by.max(other.flattened_by);
        self.bent += other.bent;
        self.bent_by = self.bent_by.max(other.bent_by);
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
    /// [`MAX_CORNERS`] corners, there are more than 2²⁸ polygons or corners in total, or memory
    /// runs out.
    pub fn new<P: Polygon>(
        polygons: impl IntoIterator<Item = P>,
        tolerance: impl Into<Tolerance>,
    ) -> Result<(Self, Preparation), Error> {
        Self::prepare(polygons, tolerance.into(), usize::MAX, &Unheard)
    }

    /// Like [`new`](Self::new), with a limit on the number of polygons, and with a listener.
    pub(crate) fn prepare<P: Polygon>(
        polygons: impl IntoIterator<Item = P>,
        tolerance: Tolerance,
        limit: usize,
        listener: &dyn Listener,
    ) -> Result<(Self, Preparation), Error> {
        tolerance.check()?;
        let input = collect(polygons, limit, listener)?;
        let [min, max] = input.bounds();
        let lattice = Lattice::new(min, max);
        let ground = Ground::new(lattice, [min, max], tolerance, input.precision);
        let Part { mut faces, mut report, outlines } = prepare_all(&input, &ground, listener)?;
        let mut builder = Builder::new(&ground);
        report.duplicates = outlines.duplicates(|polygon| {
            listener.work(input.polygon(polygon).len())?;
            builder.keep_distinct(input.polygon(polygon))?;
            Ok(builder.kept.iter().map(|&(corner, _)| corner).collect())
        })?;
        faces.corners.shrink_to_fit();
        faces.numbers.shrink_to_fit();
        faces.numbered.shrink_to_fit();
        faces.faces.shrink_to_fit();
        faces.moved.shrink_to_fit();
        for length in [&mut report.flattened_by, &mut report.bent_by] {
            *length = lattice.length_to_world(*length);
        }
        Ok((faces, report))
    }
}

/// Prepares all polygons, in parts, and puts the parts together in input order.
fn prepare_all(input: &Collected, ground: &Ground, listener: &dyn Listener) -> Result<Part, Error> {
    let mut whole = Part::new(ground);
    reserve(&mut whole.faces.corners, input.corner_count())?;
    reserve(&mut whole.faces.faces, input.len())?;
    for start in (0..input.len()).step_by(AT_ONCE) {
        listener.read(input.len())?;
        let end = input.len().min(start + AT_ONCE);
        let ranges = (start..end).step_by(PART).map(|start| start..end.min(start + PART));
        let parts = parallel_map::map(ranges.collect(), |range| {
            let polygons = range.map(|polygon| (polygon, input.polygon(polygon)));
            Part::of(ground, polygons, listener)
        });
        for part in parts {
            whole.append(part?)?;
        }
    }
    Ok(whole)
}

/// The faces of some consecutive polygons.
struct Part {
    faces: Faces,
    report: Preparation,
    outlines: Outlines,
}

impl Part {
    fn new(ground: &Ground) -> Self {
        let faces = Builder::new(ground).faces;
        Self { faces, report: Preparation::default(), outlines: Outlines::default() }
    }

    fn of<'a>(
        ground: &Ground,
        polygons: impl Iterator<Item = (usize, &'a [DVec3])>,
        listener: &dyn Listener,
    ) -> Result<Self, Error> {
        let mut builder = Builder::new(ground);
        let (mut report, mut outlines) = (Preparation::default(), Outlines::default());
        for (polygon, points) in polygons {
            report.polygons += 1;
            match builder.add(polygon, points, listener)? {
                Outcome::Whole { off } => {
                    report.flattened += usize::from(off > 0.0);
                    report.flattened_by = report.flattened_by.max(off);
                }
                Outcome::Triangulated { crosses_itself, off } => {
                    report.triangulated += 1;
                    report.crossing += usize::from(crosses_itself);
                    if off > 0.0 && off <= ground.rounding {
                        report.bent += 1;
                        report.bent_by = report.bent_by.max(off);
                    }
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
            return Err(Error::too_many_corners(MAX_LABELS));
        }
        let first = self.faces.faces.len() as u32;
        let whole = &mut self.faces;
        reserve(&mut whole.numbered, next.faces.numbered.len())?;
        reserve(&mut whole.numbers, next.faces.numbers.len())?;
        let numbered = next.faces.numbered.iter();
        self.faces.numbered.extend(numbered.map(|&(face, at)| (first + face, numbers + at)));
        self.faces.numbers.extend(next.faces.numbers);
        reserve(&mut self.faces.corners, next.faces.corners.len())?;
        self.faces.corners.extend(next.faces.corners);
        reserve(&mut self.faces.faces, next.faces.faces.len())?;
        let moved = |face: Face| Face { start: face.start + corners as u32, ..face };
        self.faces.faces.extend(next.faces.faces.into_iter().map(moved));
        reserve(&mut self.faces.moved, next.faces.moved.len())?;
        let moved = next.faces.moved.into_iter();
        self.faces.moved.extend(moved.map(|(corner, given)| (corner + corners as u32, given)));
        self.report.add(&next.report);
        self.outlines.append(next.outlines)
    }
}

/// What became of a polygon.
enum Outcome {
    /// One face, with a corner so far off the plane of the others, in lattice units.
    Whole {
        off: f64,
    },
    /// Triangles; of a convex polygon, a corner is so far off the plane of the others.
    Triangulated {
        crosses_itself: bool,
        off: f64,
    },
    Dropped,
}

struct Builder {
    faces: Faces,
    /// The corners of the current polygon on the lattice, each with its number. Of equal corners in
    /// a row one is kept.
    kept: Vec<([f64; 3], u32)>,
    /// For each kept corner, how many corners the straight run of the outline that begins there
    /// passes or ends at; at least 1. Empty if the polygon is not triangulated.
    runs: Vec<u32>,
}

impl Builder {
    fn new(ground: &Ground) -> Self {
        let faces = Faces {
            lattice: ground.lattice,
            tolerance: ground.tolerance,
            corners: vec![],
            numbers: vec![],
            numbered: vec![],
            faces: vec![],
            moved: vec![],
        };
        Self { faces, kept: vec![], runs: vec![] }
    }

    fn add(
        &mut self,
        polygon: usize,
        points: &[DVec3],
        listener: &dyn Listener,
    ) -> Result<Outcome, Error> {
        listener.work(points.len() / STEP_CORNERS)?;
        self.keep_distinct(points)?;
        let Some([second, third]) = self.widest_triangle() else {
            return Ok(Outcome::Dropped);
        };
        if self.kept.len() == 3 {
            self.push(polygon, &[0, 1, 2], Frame::TRIANGLE)?;
            return Ok(Outcome::Whole { off: 0.0 });
        }
        let convex = self.is_convex(second, third);
        let off = if convex { self.off_plane(second, third) } else { 0.0 };
        if convex && self.kept.len() <= Frame::MAX_CORNERS && off <= self.faces.tolerance {
            let all: Vec<usize> = (0..self.kept.len()).collect();
            self.push(polygon, &all, self.frame(second, third, off > 0.0))?;
            return Ok(Outcome::Whole { off });
        }
        let crosses_itself = self.triangulate(polygon, convex, [second, third], listener)?;
        Ok(crosses_itself.map_or(Outcome::Dropped, |crosses_itself| Outcome::Triangulated {
            crosses_itself,
            off,
        }))
    }

    /// Adds triangles in place of a polygon; tells whether it crosses itself, or nothing if there
    /// are no triangles with area.
    fn triangulate(
        &mut self,
        polygon: usize,
        convex: bool,
        [second, third]: [usize; 2],
        listener: &dyn Listener,
    ) -> Result<Option<bool>, Error> {
        let mut corners: Vec<[f64; 3]> = Vec::new();
        reserve(&mut corners, self.kept.len())?;
        corners.extend(self.kept.iter().map(|&(point, _)| point));
        let plane = Plane::through([0, second, third].map(|k| corners[k]));
        let found = if convex {
            triangulate::convex(&corners)
        } else {
            triangulate::any(&corners, &plane, &|steps| listener.work(steps))?
        };
        self.find_runs()?;
        let before = self.faces.len();
        for (index, triple) in found.triangles.iter().enumerate() {
            if index % PART == 0 {
                listener.work(PART)?;
            }
            let triple = triple.map(|k| k as usize);
            let [p, q, r] = triple.map(|k| corners[k]);
            if cross(p, q, r) != [0; 3] {
                self.push(polygon, &triple, Frame::TRIANGLE)?;
            }
        }
        Ok((self.faces.len() > before).then_some(found.crosses_itself))
    }

    fn keep_distinct(&mut self, points: &[DVec3]) -> Result<(), Error> {
        self.kept.clear();
        self.runs.clear();
        reserve(&mut self.kept, points.len())?;
        for (number, &point) in points.iter().enumerate() {
            let point = self.faces.lattice.snap(point);
            match self.kept.last_mut() {
                // Of equal corners the last is kept: its edge is the one that leads on from here.
                Some((last, kept)) if *last == point => *kept = number as u32,
                _ => self.kept.push((point, number as u32)),
            }
        }
        while self.kept.len() > 1 && self.kept[0].0 == self.kept[self.kept.len() - 1].0 {
            self.kept.pop();
        }
        Ok(())
    }

    /// Adds a face made of some of the polygon's kept corners, in order around it.
    fn push(&mut self, polygon: usize, kept: &[usize], frame: Frame) -> Result<(), Error> {
        let numbers: SmallVec<[u32; 8]> = (0..kept.len())
            .map(|k| {
                let is_outline = self.is_outline(kept[k], kept[(k + 1) % kept.len()]);
                self.kept[kept[k]].1 | if is_outline { 0 } else { INNER }
            })
            .collect();
        let faces = &mut self.faces;
        let start = faces.corners.len();
        if start + kept.len() >= MAX_LABELS {
            return Err(Error::too_many_corners(MAX_LABELS));
        }
        if numbers.iter().enumerate().any(|(k, &number)| number != k as u32) {
            reserve(&mut faces.numbered, 1)?;
            reserve(&mut faces.numbers, kept.len())?;
            faces.numbered.push((faces.faces.len() as u32, faces.numbers.len() as u32));
            faces.numbers.extend(numbers);
        }
        reserve(&mut faces.corners, kept.len())?;
        reserve(&mut faces.faces, 1)?;
        faces.corners.extend(kept.iter().map(|&k| self.kept[k].0));
        faces.faces.push(Face { start: start as u32, polygon: polygon as u32, frame });
        if let Some(axis) = frame.drop_axis() {
            reserve(&mut faces.moved, kept.len())?;
            faces.flatten_last(axis);
        }
        Ok(())
    }
}
