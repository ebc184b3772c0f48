//! Decides whether a polygon becomes one face, triangles or nothing. Every decision is exact, on the lattice,
//! except the comparison of distances with the tolerance.

use std::ops::Range;

use glam::DVec3;
use smallvec::SmallVec;

use super::Preparation;
use super::read::InputPolygons;
use super::tolerance::SnapParams;
use super::triangulate;
use crate::Error;
use crate::exact::faces::{Frame, INNER};
use crate::exact::{
    Faces, Flattener, Lattice, Plane, RoundedNormal, cross, have_area, is_convex, turns_one_way,
};
use crate::memory::{push, reserve};
use crate::progress::{PIECES_AT_ONCE, Watch};

/// What became of a polygon.
enum Outcome {
    /// One face. `off` is the largest distance of a corner from the plane, in lattice units.
    Whole { off: f64 },
    /// Triangles. `off` is the same distance if the polygon is convex, and 0 otherwise.
    Triangulated { crosses_itself: bool, off: f64 },
    /// No face, as the polygon has no area.
    Dropped,
}

/// Adds the faces of polygons, one after the other.
#[derive(Debug)]
pub(super) struct FaceBuilder<'a> {
    pub(super) faces: &'a mut Faces,
    /// The corners of the current polygon.
    pub(super) corners: &'a mut Corners,
}

impl FaceBuilder<'_> {
    /// Adds a range of the input's polygons. Lengths in the report are in lattice units.
    pub(super) fn add_all(
        &mut self,
        params: &SnapParams,
        input: &InputPolygons,
        polygons: Range<usize>,
        watch: &Watch<'_>,
    ) -> Result<Preparation, Error> {
        let mut report = Preparation { polygons: polygons.len(), ..Preparation::default() };
        for polygon in polygons {
            match self.add(polygon, input.polygon(polygon), params.bend, watch)? {
                Outcome::Whole { off } => {
                    report.flattened += usize::from(off > 0.0);
                    report.flattened_by = report.flattened_by.max(off);
                }
                Outcome::Triangulated { crosses_itself, off } => {
                    report.triangulated += 1;
                    report.crossing += usize::from(crosses_itself);
                    if params.may_be_rounding(off, input.precision_of(polygon)) {
                        report.bent += 1;
                        report.bent_by = report.bent_by.max(off);
                    }
                }
                Outcome::Dropped => report.dropped += 1,
            }
        }
        Ok(report)
    }

    /// Adds the faces of one polygon. Corners up to `bend` off its plane are moved onto it.
    fn add(
        &mut self,
        polygon: usize,
        points: &[DVec3],
        bend: f64,
        watch: &Watch<'_>,
    ) -> Result<Outcome, Error> {
        let snap = |point| self.faces.lattice.snap(point);
        if let &[a, b, c, d] = points
            && let Some(quad) = Quad::of([snap(a), snap(b), snap(c), snap(d)])
            && let Some(off) = quad.push(polygon, self.faces, bend)?
        {
            return Ok(Outcome::Whole { off });
        }
        watch.work(points.len())?;
        self.corners.keep_distinct(points, &self.faces.lattice);
        let Some(widest) = self.corners.widest_triangle() else {
            return Ok(Outcome::Dropped);
        };
        if self.corners.kept.len() == 3 {
            self.push(polygon, 0..3, Frame::TRIANGLE)?;
            return Ok(Outcome::Whole { off: 0.0 });
        }
        let plane = Plane::through([0, widest[0], widest[1]].map(|k| self.corners.kept[k].0));
        let axis = plane.main_axis();
        let convex = self.corners.is_convex(axis);
        let mut off = 0.0;
        if convex && self.corners.kept.len() <= Frame::MAX_CORNERS {
            off = self.push_flat(polygon, widest, axis)?;
            if off <= bend {
                return Ok(Outcome::Whole { off });
            }
            self.faces.truncate(self.faces.len() - 1);
        } else if convex {
            off = self.corners.off_plane(&plane, [0, widest[0], widest[1]]);
        }
        let crosses_itself = self.triangulate(polygon, convex, &plane, watch)?;
        Ok(crosses_itself.map_or(Outcome::Dropped, |crosses_itself| Outcome::Triangulated {
            crosses_itself,
            off,
        }))
    }

    /// Adds the polygon as one face, with its corners moved along an axis onto its plane. Returns the
    /// largest distance from the plane.
    fn push_flat(
        &mut self,
        polygon: usize,
        [second, third]: [usize; 2],
        axis: usize,
    ) -> Result<f64, Error> {
        reserve(&mut self.faces.moved, self.corners.kept.len())?;
        self.push(polygon, 0..self.corners.kept.len(), Frame::new(second, third, None))?;
        let off = self.faces.flatten_last(axis);
        if off > 0.0
            && let Some(face) = self.faces.faces.last_mut()
        {
            face.frame = Frame::new(second, third, Some(axis));
        }
        Ok(off)
    }

    /// Adds triangles in place of a polygon. Returns whether it crosses itself, or `None` if no triangle
    /// has area.
    fn triangulate(
        &mut self,
        polygon: usize,
        convex: bool,
        plane: &Plane,
        watch: &Watch<'_>,
    ) -> Result<Option<bool>, Error> {
        let corners: Vec<_> = self.corners.kept.iter().map(|&(point, _)| point).collect();
        let found = if convex {
            triangulate::convex(&corners)
        } else {
            triangulate::any(&corners, plane, watch)?
        };
        self.corners.find_runs();
        let before = self.faces.len();
        for some in found.triangles.chunks(PIECES_AT_ONCE) {
            watch.work(some.len())?;
            for triple in some {
                let triple = triple.map(|k| k as usize);
                let [p, q, r] = triple.map(|k| corners[k]);
                if cross(p, q, r) != [0; 3] {
                    self.push(polygon, triple.into_iter(), Frame::TRIANGLE)?;
                }
            }
        }
        Ok((self.faces.len() > before).then_some(found.crosses_itself))
    }

    /// Adds a face made of some of the polygon's kept corners, in order around it.
    fn push(
        &mut self,
        polygon: usize,
        kept: impl ExactSizeIterator<Item = usize> + Clone,
        frame: Frame,
    ) -> Result<(), Error> {
        let corners = kept.clone().map(|k| self.corners.kept[k].0);
        self.faces.push(polygon, corners, frame)?;
        // Most polygons become one face with the same corners, which needs no numbers.
        if kept.len() < self.corners.given {
            self.number_last(kept)?;
        }
        Ok(())
    }

    /// Numbers the corners of the last face, unless they are the polygon's first corners in order and all
    /// edges of the face are edges of the polygon.
    fn number_last(
        &mut self,
        kept: impl ExactSizeIterator<Item = usize> + Clone,
    ) -> Result<(), Error> {
        let Some(first) = kept.clone().next() else { return Ok(()) };
        let number = |(from, to): (usize, usize)| {
            self.corners.kept[from].1 | if self.corners.is_outline(from, to) { 0 } else { INNER }
        };
        let ends = kept.clone().skip(1).chain([first]);
        let numbers = kept.clone().zip(ends).map(number);
        if (0..).zip(numbers.clone()).all(|(k, number)| number == k) {
            return Ok(());
        }
        let numbers: SmallVec<[u32; 8]> = numbers.collect();
        let faces = &mut *self.faces;
        reserve(&mut faces.numbered, 1)?;
        reserve(&mut faces.numbers, kept.len())?;
        faces.numbered.push((faces.faces.len() as u32 - 1, faces.numbers.len() as u32));
        faces.numbers.extend(numbers);
        Ok(())
    }
}

/// A corner on the lattice, and its number.
pub(super) type Corner = ([f64; 3], u32);

/// Replaces `kept` by the corners of an outline or a polyline. Of equal corners in a row, only the last is
/// kept: its edge leads to the next corner.
pub(super) fn keep_distinct(points: &[DVec3], lattice: &Lattice, kept: &mut Vec<Corner>) {
    kept.clear();
    for (number, &point) in (0..).zip(points) {
        let point = lattice.snap(point);
        match kept.last_mut() {
            Some((last, kept)) if *last == point => *kept = number,
            _ => kept.push((point, number)),
        }
    }
}

/// The corners of a polygon on the lattice.
#[derive(Debug, Default)]
pub(super) struct Corners {
    /// The corners, each with its number. Of equal corners in a row one is kept.
    kept: Vec<Corner>,
    /// The number of corners in the input.
    given: usize,
    /// For each kept corner, how many corners the straight run of the outline that begins there
    /// passes or ends at; at least 1. Empty if the polygon is not triangulated.
    runs: Vec<u32>,
}

impl Corners {
    /// Replaces the corners by those of another polygon.
    fn keep_distinct(&mut self, points: &[DVec3], lattice: &Lattice) {
        self.runs.clear();
        self.given = points.len();
        keep_distinct(points, lattice, &mut self.kept);
        while self.kept.len() > 1 && self.kept[0].0 == self.kept[self.kept.len() - 1].0 {
            self.kept.pop();
        }
    }

    /// Two corners that span a large triangle with corner 0; `None` if all corners lie on one line.
    fn widest_triangle(&self) -> Option<[usize; 2]> {
        let point = |k: usize| DVec3::from(self.kept[k].0);
        let (origin, n) = (self.kept.first().map(|_| point(0))?, self.kept.len());
        let mut others = 1..n;
        let far = largest(others.clone(), |k| point(k).distance_squared(origin))?;
        let arm = point(far) - origin;
        let rest = others.clone().filter(|&k| k != far);
        let best = largest(rest, |k| arm.cross(point(k) - origin).length_squared())?;
        let exact = |third: usize| {
            let (low, high) = (far.min(third), far.max(third));
            have_area([0, low, high].map(|k| self.kept[k].0)).then_some([low, high])
        };
        // In a nearly straight polygon the rounded areas may choose a corner exactly on the line.
        exact(best).or_else(|| others.find_map(exact))
    }

    /// How far the corner furthest from the plane of three corners is off it, in lattice units,
    /// rounded; 0 only if every corner is exactly on it.
    fn off_plane(&self, plane: &Plane, three: [usize; 3]) -> f64 {
        let others = (0..self.kept.len()).filter(|k| !three.contains(k));
        let off = others.map(|k| plane.at(&self.kept[k].0)).filter(|off| off.sign().is_ne());
        let furthest = off.map(|off| off.to_f64().abs()).fold(0.0, f64::max);
        if furthest > 0.0 { furthest / plane.normal_f64().length() } else { 0.0 }
    }

    /// Whether the polygon is convex and winds once, seen along an axis. Exact.
    fn is_convex(&self, axis: usize) -> bool {
        is_convex(self.kept.len(), |k| self.kept[k].0, axis)
    }

    /// Whether the straight line from one kept corner to another is part of the outline: the second
    /// is the next corner, or all corners in between are on the line.
    fn is_outline(&self, from: usize, to: usize) -> bool {
        let n = self.kept.len();
        let next = if from + 1 == n { 0 } else { from + 1 };
        let ahead = if to > from { to - from } else { to + n - from };
        let run = self.runs.get(from).map_or(1, |&run| run as usize);
        self.kept[next].0 == self.kept[to].0 || ahead <= run
    }

    /// Finds how far the outline runs straight from each corner, in linear time.
    fn find_runs(&mut self) {
        let n = self.kept.len();
        self.runs.clear();
        self.runs.resize(n, 1);
        // Twice round, backwards: the run of the last corner depends on that of the first.
        for k in (0..2 * n).rev() {
            let [a, b, c] = [k, k + 1, k + 2].map(|k| self.kept[k % n].0);
            let is_straight = cross(a, b, c) == [0; 3];
            // This ends, because a polygon with area has corners that are not on one line.
            self.runs[k % n] = if is_straight { self.runs[(k + 1) % n] + 1 } else { 1 };
        }
    }
}

/// The number of the largest size, the last of equals.
fn largest(numbers: impl Iterator<Item = usize>, size: impl Fn(usize) -> f64) -> Option<usize> {
    let (mut best, mut most) = (None, f64::NEG_INFINITY);
    for k in numbers {
        let size = size(k);
        if size >= most {
            (best, most) = (Some(k), size);
        }
    }
    best
}

/// A convex quadrilateral with its frame. Most polygons are one; rounded numbers with error bounds decide,
/// and the face is the one that the general rules make.
#[derive(Debug)]
struct Quad {
    corners: [[f64; 3]; 4],
    /// The corners that span the plane together with corner 0.
    second: usize,
    third: usize,
    /// The axis in which the plane is least steep.
    axis: usize,
}

impl Quad {
    /// The quadrilateral of four lattice points, if it is certain that they are one.
    fn of(corners: [[f64; 3]; 4]) -> Option<Self> {
        let [second, third] = widest(&corners);
        let plane = RoundedNormal::through([0, second, third].map(|k| corners[k]));
        let quad = Self { corners, second, third, axis: plane.certain_axis()? };
        // Seen along the axis.
        let (x, y) = ((quad.axis + 1) % 3, (quad.axis + 2) % 3);
        turns_one_way(corners.map(|corner| [corner[x], corner[y]])).then_some(quad)
    }

    /// Adds the quadrilateral as one face and returns how far a corner is off the plane of the others, unless
    /// this is more than `bend`.
    fn push(&self, polygon: usize, faces: &mut Faces, bend: f64) -> Result<Option<f64>, Error> {
        let Self { mut corners, second, third, axis } = *self;
        let spare = 6 - second - third;
        let given = corners[spare];
        let flattener = Flattener::new([0, second, third].map(|k| corners[k]), axis);
        let off = flattener.off(&given);
        if off.distance > bend {
            return Ok(None);
        }
        let start = faces.corners.len();
        corners[spare][axis] -= off.steps;
        let frame = Frame::new(second, third, (off.distance > 0.0).then_some(axis));
        faces.push(polygon, corners.into_iter(), frame)?;
        if off.steps != 0.0 {
            push(&mut faces.moved, ((start + spare) as u32, given))?;
        }
        Ok(Some(off.distance))
    }
}

/// Two corners that span a large triangle with corner 0, as `widest_triangle` chooses them.
fn widest(corners: &[[f64; 3]; 4]) -> [usize; 2] {
    let [origin, arms @ ..] = corners.map(DVec3::from);
    let [a, b, c] = arms.map(|corner| corner - origin);
    let [aa, bb, cc] = [a, b, c].map(DVec3::length_squared);
    let areas = |arm: DVec3, one: DVec3, other: DVec3| {
        arm.cross(one).length_squared() > arm.cross(other).length_squared()
    };
    if cc >= aa && cc >= bb {
        if areas(c, a, b) { [1, 3] } else { [2, 3] }
    } else if bb >= aa {
        if areas(b, a, c) { [1, 2] } else { [2, 3] }
    } else if areas(a, b, c) {
        [1, 2]
    } else {
        [1, 3]
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::{Faces, Quad};
    use crate::random::SplitMix64;

    /// Four corners around a point: flat but for noise of any size, bent, not convex, on small integers
    /// where sizes are equal, or all but on one line.
    fn corners(random: &mut SplitMix64) -> [DVec3; 4] {
        let [at, u, v] = [(); 3].map(|()| random.point(-1.0, 1.0));
        let noise = 2f64.powf(random.range(-60.0, -10.0));
        let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let kind = random.next() % 6;
        let v = if kind == 1 { u + v * noise } else { v };
        let mut quad = signs.map(|[x, y]| at + x * u + y * v + random.point(-noise, noise));
        match kind {
            2 => quad[2] = quad[0].lerp(quad[2], random.range(-0.5, 0.9)),
            3 => quad.swap(1, 2),
            4 => quad = quad.map(|corner| (2.0 * corner).round()),
            5 => quad = signs.map(|[x, y]| DVec3::new(x, y, x * y * noise)),
            _ => {}
        }
        quad
    }

    /// A fifth corner, the same as the first, is dropped, but not by the rules for four.
    #[test]
    fn quads_become_the_faces_that_the_general_rules_make() {
        let mut random = SplitMix64::new(9);
        let (mut taken, mut moved, mut bent) = (0, 0, 0);
        for _ in 0..20_000 {
            let quad = corners(&mut random);
            let [a, b, c, d] = quad;
            let tolerance = Some(2f64.powf(random.range(-55.0, -8.0)));
            let (faces, report) = Faces::new([quad], tolerance).unwrap();
            let (others, general) = Faces::new([[a, b, c, d, a]], tolerance).unwrap();
            assert_eq!(report, general, "{quad:?}");
            assert_eq!(
                (&faces.corners, &faces.moved),
                (&others.corners, &others.moved),
                "{quad:?}"
            );
            let frame =
                |faces: &Faces| faces.faces.iter().map(|face| face.frame).collect::<Vec<_>>();
            assert_eq!(frame(&faces), frame(&others), "{quad:?}");
            taken += usize::from(Quad::of(quad.map(|p| faces.lattice().snap(p))).is_some());
            moved += faces.moved.len();
            bent += report.triangulated;
        }
        assert!(taken > 8000 && moved > 3000 && bent > 2000, "{taken} {moved} {bent}");
    }
}
