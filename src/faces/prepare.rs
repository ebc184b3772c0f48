//! Decides what becomes of each input polygon: one face, triangles, or nothing.

mod append;
mod collect;
mod planar;
mod tolerance;

use collect::Collected;
pub use collect::MAX_CORNERS;
use std::ops::Range;

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
        let mut faces = Self::default();
        let report = Preparer::default().prepare(
            &mut faces,
            polygons,
            tolerance.into(),
            usize::MAX,
            &Unheard,
        )?;
        faces.shrink_to_fit();
        Ok((faces, report))
    }
}

/// Prepares polygons; its lists are kept to be used again.
#[derive(Debug, Default)]
pub(crate) struct Preparer {
    input: Collected,
    builder: Builder,
    outlines: Outlines,
    /// What the lattice has to hold besides the polygons.
    room: Option<[DVec3; 2]>,
}

impl Preparer {
    /// Replaces faces by those of some polygons, as [`Faces::new`] does, with a limit on the number of
    /// polygons, and with a listener. After an error there is no face.
    pub(crate) fn prepare<P: Polygon>(
        &mut self,
        faces: &mut Faces,
        polygons: impl IntoIterator<Item = P>,
        tolerance: Tolerance,
        limit: usize,
        listener: &dyn Listener,
    ) -> Result<Preparation, Error> {
        let mut kept = std::mem::take(faces);
        kept.clear();
        tolerance.check()?;
        self.input.read(polygons, limit, listener)?;
        let [min, max] = self.input.bounds(self.room);
        let lattice = Lattice::new(min, max);
        let ground = Ground::new(lattice, [min, max], tolerance, self.input.precision);
        self.builder.faces = kept;
        self.builder.faces.lattice = lattice;
        self.builder.faces.tolerance = ground.tolerance;
        self.outlines.clear();
        let mut report = self.prepare_all(&ground, listener)?;
        let (input, builder) = (&self.input, &mut self.builder);
        report.duplicates = self.outlines.duplicates(|polygon| {
            listener.work(input.polygon(polygon).len())?;
            builder.keep_distinct(input.polygon(polygon))?;
            Ok(builder.kept.iter().map(|&(corner, _)| corner).collect())
        })?;
        for length in [&mut report.flattened_by, &mut report.bent_by] {
            *length = lattice.length_to_world(*length);
        }
        *faces = std::mem::take(&mut self.builder.faces);
        Ok(report)
    }

    /// Prepares all polygons: few on this thread, more in parts, which are put together in input
    /// order.
    fn prepare_all(
        &mut self,
        ground: &Ground,
        listener: &dyn Listener,
    ) -> Result<Preparation, Error> {
        let Self { input, builder, outlines, .. } = self;
        reserve(&mut builder.faces.corners, input.corner_count())?;
        reserve(&mut builder.faces.faces, input.len())?;
        if input.len() <= PART {
            listener.read(input.len())?;
            return builder.add_all(ground, input, 0..input.len(), outlines, listener);
        }
        let mut report = Preparation::default();
        for start in (0..input.len()).step_by(AT_ONCE) {
            listener.read(input.len())?;
            let end = input.len().min(start + AT_ONCE);
            let ranges = (start..end).step_by(PART).map(|start| start..end.min(start + PART));
            let parts = parallel_map::map(ranges.collect(), |range| {
                let (mut part, mut outlines) = (Builder::new(ground), Outlines::default());
                let report = part.add_all(ground, input, range, &mut outlines, listener)?;
                Ok::<_, Error>((part.faces, report, outlines))
            });
            for part in parts {
                let (faces, part_report, part_outlines) = part?;
                builder.faces.append(faces)?;
                report.add(&part_report);
                outlines.append(part_outlines)?;
            }
        }
        Ok(report)
    }
}

impl Faces {
    fn clear(&mut self) {
        self.corners.clear();
        self.numbers.clear();
        self.numbered.clear();
        self.faces.clear();
        self.moved.clear();
    }

    /// Gives memory back that is not needed.
    pub(crate) fn shrink_to_fit(&mut self) {
        self.corners.shrink_to_fit();
        self.numbers.shrink_to_fit();
        self.numbered.shrink_to_fit();
        self.faces.shrink_to_fit();
        self.moved.shrink_to_fit();
    }

    /// Adds the faces of the polygons that follow.
    fn append(&mut self, next: Self) -> Result<(), Error> {
        let (corners, numbers) = (self.corners.len(), self.numbers.len() as u32);
        if corners + next.corners.len() >= MAX_LABELS {
            return Err(Error::too_many_corners(MAX_LABELS));
        }
        let first = self.faces.len() as u32;
        reserve(&mut self.numbered, next.numbered.len())?;
        reserve(&mut self.numbers, next.numbers.len())?;
        let numbered = next.numbered.iter();
        self.numbered.extend(numbered.map(|&(face, at)| (first + face, numbers + at)));
        self.numbers.extend(next.numbers);
        reserve(&mut self.corners, next.corners.len())?;
        self.corners.extend(next.corners);
        reserve(&mut self.faces, next.faces.len())?;
        let moved = |face: Face| Face { start: face.start + corners as u32, ..face };
        self.faces.extend(next.faces.into_iter().map(moved));
        reserve(&mut self.moved, next.moved.len())?;
        let moved = next.moved.into_iter();
        self.moved.extend(moved.map(|(corner, given)| (corner + corners as u32, given)));
        Ok(())
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

/// Makes faces of polygons, one after the other.
#[derive(Debug, Default)]
struct Builder {
    faces: Faces,
    /// The corners of the current polygon on the lattice, each with its number. Of equal corners in
    /// a row one is kept.
    kept: Vec<([f64; 3], u32)>,
    /// How many corners it was given with.
    given: usize,
    /// For each kept corner, how many corners the straight run of the outline that begins there
    /// passes or ends at; at least 1. Empty if the polygon is not triangulated.
    runs: Vec<u32>,
}

impl Builder {
    fn new(ground: &Ground) -> Self {
        let Ground { lattice, tolerance, .. } = *ground;
        let faces = Faces { lattice, tolerance, ..Faces::default() };
        Self { faces, ..Self::default() }
    }

    /// Adds a range of the input's polygons.
    fn add_all(
        &mut self,
        ground: &Ground,
        input: &Collected,
        polygons: Range<usize>,
        outlines: &mut Outlines,
        listener: &dyn Listener,
    ) -> Result<Preparation, Error> {
        let mut report = Preparation::default();
        reserve(&mut outlines.seen, polygons.len())?;
        for polygon in polygons {
            report.polygons += 1;
            match self.add(polygon, input.polygon(polygon), listener)? {
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
            outlines.add(polygon, self.kept.iter().map(|&(corner, _)| corner));
        }
        Ok(report)
    }

    fn add(
        &mut self,
        polygon: usize,
        points: &[DVec3],
        listener: &dyn Listener,
    ) -> Result<Outcome, Error> {
        listener.work(points.len() / STEP_CORNERS)?;
        self.keep_distinct(points)?;
        let Some(([second, third], plane)) = self.widest_triangle() else {
            return Ok(Outcome::Dropped);
        };
        if self.kept.len() == 3 {
            self.push(polygon, 0..3, Frame::TRIANGLE)?;
            return Ok(Outcome::Whole { off: 0.0 });
        }
        let convex = self.is_convex(&plane);
        let off = if convex { self.off_plane(&plane, [0, second, third]) } else { 0.0 };
        if convex && self.kept.len() <= Frame::MAX_CORNERS && off <= self.faces.tolerance {
            let axis = (off > 0.0).then(|| plane.main_axis());
            self.push(polygon, 0..self.kept.len(), Frame::new(second, third, axis))?;
            if let Some(axis) = axis {
                reserve(&mut self.faces.moved, self.kept.len())?;
                self.faces.flatten_last(axis, &plane);
            }
            return Ok(Outcome::Whole { off });
        }
        let crosses_itself = self.triangulate(polygon, convex, &plane, listener)?;
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
        plane: &Plane,
        listener: &dyn Listener,
    ) -> Result<Option<bool>, Error> {
        let mut corners: Vec<[f64; 3]> = Vec::new();
        reserve(&mut corners, self.kept.len())?;
        corners.extend(self.kept.iter().map(|&(point, _)| point));
        let found = if convex {
            triangulate::convex(&corners)
        } else {
            triangulate::any(&corners, plane, &|steps| listener.work(steps))?
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
                self.push(polygon, triple.into_iter(), Frame::TRIANGLE)?;
            }
        }
        Ok((self.faces.len() > before).then_some(found.crosses_itself))
    }

    fn keep_distinct(&mut self, points: &[DVec3]) -> Result<(), Error> {
        self.kept.clear();
        self.runs.clear();
        self.given = points.len();
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
    fn push(
        &mut self,
        polygon: usize,
        kept: impl ExactSizeIterator<Item = usize> + Clone,
        frame: Frame,
    ) -> Result<(), Error> {
        let faces = &mut self.faces;
        let start = faces.corners.len();
        if start + kept.len() >= MAX_LABELS {
            return Err(Error::too_many_corners(MAX_LABELS));
        }
        reserve(&mut faces.corners, kept.len())?;
        reserve(&mut faces.faces, 1)?;
        faces.corners.extend(kept.clone().map(|k| self.kept[k].0));
        faces.faces.push(Face { start: start as u32, polygon: polygon as u32, frame });
        // Most polygons become one face with the same corners, which needs no numbers.
        if frame == Frame::TRIANGLE || self.kept.len() < self.given {
            self.number_last(kept)?;
        }
        Ok(())
    }

    /// Numbers the corners of the last face, if they are not the first of the polygon in order, with
    /// its edges for edges.
    fn number_last(
        &mut self,
        kept: impl ExactSizeIterator<Item = usize> + Clone,
    ) -> Result<(), Error> {
        let Some(first) = kept.clone().next() else { return Ok(()) };
        let number = |(from, to): (usize, usize)| {
            self.kept[from].1 | if self.is_outline(from, to) { 0 } else { INNER }
        };
        let ends = kept.clone().skip(1).chain([first]);
        let numbers = kept.clone().zip(ends).map(number);
        if (0..).zip(numbers.clone()).all(|(k, number)| number == k) {
            return Ok(());
        }
        let numbers: SmallVec<[u32; 8]> = numbers.collect();
        let faces = &mut self.faces;
        reserve(&mut faces.numbered, 1)?;
        reserve(&mut faces.numbers, kept.len())?;
        faces.numbered.push((faces.faces.len() as u32 - 1, faces.numbers.len() as u32));
        faces.numbers.extend(numbers);
        Ok(())
    }
}
