//! Decides exactly, on the lattice, whether a polygon becomes one face, triangles or nothing; only the
//! comparison of distances with the tolerance is rounded. Also finds equal polygons.

use std::cmp::Ordering;
use std::collections::HashSet;
use std::ops::Range;

use glam::DVec3;
use smallvec::SmallVec;

use super::tolerance::SnapParams;
use super::triangulate;
use super::{InputPolygons, Preparation};
use crate::Error;
use crate::exact::faces::{Frame, INNER};
use crate::exact::{
    Faces, Flattener, Lattice, Off, cross, have_area, integers, is_convex, turns_one_way,
};
use crate::memory::{push, reserve};
use crate::progress::{PIECES_AT_ONCE, Watch};

/// Adds the faces of polygons, one after the other.
pub(super) struct FaceBuilder<'a> {
    pub(super) faces: &'a mut Faces,
    /// The corners of the current polygon.
    pub(super) corners: &'a mut Corners,
    pub(super) params: &'a SnapParams,
    pub(super) watch: &'a Watch<'a>,
    /// The report, with lengths in lattice units.
    pub(super) report: Preparation,
}

impl FaceBuilder<'_> {
    /// Adds a range of the input's polygons.
    pub(super) fn add_all(
        mut self,
        input: &InputPolygons,
        polygons: Range<usize>,
    ) -> Result<Preparation, Error> {
        self.report.polygons = polygons.len();
        for polygon in polygons {
            self.add(polygon, input.polygon(polygon), input.precision_of(polygon))?;
        }
        Ok(self.report)
    }

    /// Adds the faces of one polygon.
    fn add(&mut self, polygon: usize, points: &[DVec3], precision: f64) -> Result<(), Error> {
        let snap = |point| self.faces.lattice.snap(point);
        if let &[a, b, c, d] = points
            && self.add_quad(polygon, [snap(a), snap(b), snap(c), snap(d)])?
        {
            return Ok(());
        }
        self.watch.work(points.len())?;
        self.corners.keep_distinct(points, &self.faces.lattice);
        let Some([second, third]) = self.corners.widest_triangle() else {
            self.report.dropped += 1;
            return Ok(());
        };
        let count = self.corners.kept.len();
        if count == 3 {
            return self.push(polygon, 0..3, Frame::TRIANGLE);
        }
        let flattener = Flattener::new([0, second, third].map(|k| self.corners.kept[k].0));
        let convex = is_convex(count, |k| self.corners.kept[k].0, flattener.axis);
        let mut off = 0.0f64;
        if convex {
            let mut moves = SmallVec::<[(usize, f64); 8]>::new();
            for k in (1..count).filter(|&k| k != second && k != third) {
                let Off { distance, steps } = flattener.off(&self.corners.kept[k].0);
                off = off.max(distance);
                if steps != 0.0 {
                    moves.push((k, steps));
                }
            }
            if off <= self.params.bend && count <= Frame::MAX_CORNERS {
                let (start, axis) = (self.faces.corners.len(), flattener.axis);
                let frame = Frame::new(second, third, (off > 0.0).then_some(axis));
                self.push(polygon, 0..count, frame)?;
                reserve(&mut self.faces.moved, moves.len())?;
                for (k, steps) in moves {
                    let corner = &mut self.faces.corners[start + k];
                    self.faces.moved.push(((start + k) as u32, *corner));
                    corner[axis] -= steps;
                }
                self.report_flat(off);
                return Ok(());
            }
        }
        let before = self.faces.len();
        let crosses_itself = self.triangulate(polygon, convex, &flattener, precision)?;
        let report = &mut self.report;
        if self.faces.len() == before {
            report.dropped += 1;
            return Ok(());
        }
        report.triangulated += 1;
        report.crossing += usize::from(crosses_itself);
        if self.params.may_be_rounding(off, precision) {
            report.bent += 1;
            report.bent_by = report.bent_by.max(off);
        }
        Ok(())
    }

    /// Reports a polygon that became one face. The polygon's corners are off the face's plane by at most
    /// `off`.
    fn report_flat(&mut self, off: f64) {
        self.report.flattened += usize::from(off > 0.0);
        self.report.flattened_by = self.report.flattened_by.max(off);
    }

    /// Adds four corners as one face: the same face as [`add`](Self::add) makes, in less time. Returns false
    /// and adds nothing if floats cannot prove that the corners are convex, or if a corner is too far off the
    /// plane.
    fn add_quad(&mut self, polygon: usize, mut corners: [[f64; 3]; 4]) -> Result<bool, Error> {
        let Some([far, best]) = widest(4, |k| corners[k].into()) else { return Ok(false) };
        let (second, third) = (far.min(best), far.max(best));
        let flattener = Flattener::new([0, second, third].map(|k| corners[k]));
        let (axis, spare) = (flattener.axis, 6 - second - third);
        let given = corners[spare];
        let Off { distance, steps } = flattener.off(&given);
        let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
        if !turns_one_way(corners.map(|corner| [corner[x], corner[y]]))
            || distance > self.params.bend
        {
            return Ok(false);
        }
        corners[spare][axis] -= steps;
        let corner = self.faces.corners.len() + spare;
        let frame = Frame::new(second, third, (distance > 0.0).then_some(axis));
        self.faces.push(polygon, corners.into_iter(), frame)?;
        if steps != 0.0 {
            push(&mut self.faces.moved, (corner as u32, given))?;
        }
        self.report_flat(distance);
        Ok(true)
    }

    /// Adds triangles in place of a polygon, if any triangle has area. Returns whether the polygon crosses
    /// itself.
    fn triangulate(
        &mut self,
        polygon: usize,
        convex: bool,
        flattener: &Flattener,
        precision: f64,
    ) -> Result<bool, Error> {
        let corners: Vec<_> = self.corners.kept.iter().map(|&(point, _)| point).collect();
        let found = if convex {
            triangulate::convex(&corners)
        } else {
            let from_first = |&corner| DVec3::from(corner).distance(corners[0].into());
            let planar =
                self.params.planar(precision, corners.iter().map(from_first).fold(0.0, f64::max));
            let is_planar = corners.iter().all(|corner| flattener.off(corner).distance <= planar);
            let triangulate = if is_planar { triangulate::planar } else { triangulate::bent };
            triangulate(&corners, &flattener.plane, self.watch)?
        };
        self.corners.find_runs();
        for some in found.triangles.chunks(PIECES_AT_ONCE) {
            self.watch.work(some.len())?;
            for triple in some {
                let triple = triple.map(|k| k as usize);
                let [p, q, r] = triple.map(|k| corners[k]);
                if cross(p, q, r) != [0; 3] {
                    self.push(polygon, triple.into_iter(), Frame::TRIANGLE)?;
                }
            }
        }
        Ok(found.crosses_itself)
    }

    /// Adds a face made of some of the polygon's kept corners, in the polygon's order.
    fn push(
        &mut self,
        polygon: usize,
        kept: impl ExactSizeIterator<Item = usize> + Clone,
        frame: Frame,
    ) -> Result<(), Error> {
        let corners = kept.clone().map(|k| self.corners.kept[k].0);
        self.faces.push(polygon, corners, frame)?;
        // Most polygons become one face with the same corners, which needs no corner numbers.
        if kept.len() < self.corners.given {
            self.number_last(kept)?;
        }
        Ok(())
    }

    /// Numbers the corners of the last face, unless these corners are the polygon's first corners in order
    /// and all edges of the face are edges of the polygon.
    fn number_last(&mut self, kept: impl Iterator<Item = usize> + Clone) -> Result<(), Error> {
        let number = |(from, to): (usize, usize)| {
            self.corners.kept[from].1 | if self.corners.is_outline(from, to) { 0 } else { INNER }
        };
        let ends = kept.clone().cycle().skip(1);
        let numbers: SmallVec<[u32; 8]> = kept.zip(ends).map(number).collect();
        if (0..).zip(&numbers).any(|(k, &number)| number != k) {
            let faces = &mut *self.faces;
            push(&mut faces.numbered, (faces.faces.len() as u32 - 1, faces.numbers.len() as u32))?;
            reserve(&mut faces.numbers, numbers.len())?;
            faces.numbers.extend(numbers);
        }
        Ok(())
    }
}

/// A corner on the lattice, and its number.
pub(super) type Corner = ([f64; 3], u32);

/// Replaces `kept` by the corners of an outline or a polyline. Of equal consecutive corners only the last is
/// kept, because the edge of the last leads to the next corner.
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
    /// The corners, each with its number. Of equal consecutive corners only the last is kept.
    kept: Vec<Corner>,
    /// The number of corners in the input.
    given: usize,
    /// For each kept corner, the number of later corners on the straight run of the outline that begins at
    /// the corner; at least 1. Empty if the polygon is not triangulated.
    runs: Vec<u32>,
}

impl Corners {
    /// Replaces the corners by the corners of another polygon.
    fn keep_distinct(&mut self, points: &[DVec3], lattice: &Lattice) {
        self.runs.clear();
        self.given = points.len();
        keep_distinct(points, lattice, &mut self.kept);
        while self.kept.len() > 1 && self.kept[0].0 == self.kept[self.kept.len() - 1].0 {
            self.kept.pop();
        }
    }

    /// Two corners that span a large triangle with corner 0; `None` if all corners are collinear.
    fn widest_triangle(&self) -> Option<[usize; 2]> {
        let [far, best] = widest(self.kept.len(), |k| self.kept[k].0.into())?;
        let exact = |third: usize| {
            let pair = [far.min(third), far.max(third)];
            have_area([0, pair[0], pair[1]].map(|k| self.kept[k].0)).then_some(pair)
        };
        // In a nearly straight polygon the rounded areas may choose a corner exactly on the line.
        exact(best).or_else(|| (1..self.kept.len()).find_map(exact))
    }

    /// Whether the straight line from one kept corner to another is part of the outline: the second corner is
    /// the next corner, or all corners in between are on the line.
    fn is_outline(&self, from: usize, to: usize) -> bool {
        let n = self.kept.len();
        let next = if from + 1 == n { 0 } else { from + 1 };
        let ahead = if to > from { to - from } else { to + n - from };
        let run = self.runs.get(from).map_or(1, |&run| run as usize);
        self.kept[next].0 == self.kept[to].0 || ahead <= run
    }

    /// Finds the straight run of the outline from each corner, in linear time.
    fn find_runs(&mut self) {
        let n = self.kept.len();
        self.runs.clear();
        self.runs.resize(n, 1);
        // Twice around, backwards: the run of the last corner depends on the run of the first.
        for k in (0..2 * n).rev() {
            let [a, b, c] = [k, k + 1, k + 2].map(|k| self.kept[k % n].0);
            let is_straight = cross(a, b, c) == [0; 3];
            // The loop ends, because a polygon with area has corners that are not collinear.
            self.runs[k % n] = if is_straight { self.runs[(k + 1) % n] + 1 } else { 1 };
        }
    }
}

/// The corner that is furthest from corner 0, and the corner that spans the largest triangle with both, by
/// rounded numbers.
#[inline]
fn widest(n: usize, point: impl Fn(usize) -> DVec3) -> Option<[usize; 2]> {
    /// The number with the largest size. Of equal sizes, the last number.
    fn largest(numbers: impl Iterator<Item = usize>, size: impl Fn(usize) -> f64) -> Option<usize> {
        let larger =
            |best: (f64, usize), next: (f64, usize)| if next.0 >= best.0 { next } else { best };
        numbers.map(|k| (size(k), k)).reduce(larger).map(|(_, k)| k)
    }
    let origin = (n > 0).then(|| point(0))?;
    let far = largest(1..n, |k| point(k).distance_squared(origin))?;
    let arm = point(far) - origin;
    let area = |k: usize| arm.cross(point(k) - origin).length_squared();
    Some([far, largest((1..n).filter(|&k| k != far), area)?])
}

impl Faces {
    /// Counts the polygons that have the corners of an earlier polygon, in the same cyclic order or its
    /// reverse. The count is exact and takes O(n log n) time and O(n) memory for n corners.
    ///
    /// A polygon's corners are taken from its faces, at the positions before the tolerance moved them.
    /// Corners that belong to no face are not compared.
    #[doc(hidden)]
    pub fn duplicates(&self) -> usize {
        let (mut outlines, mut first) = (HashSet::new(), 0);
        let polygons = self.faces.chunk_by(|a, b| a.polygon == b.polygon);
        let is_known = polygons.map(|own| {
            let faces = first..first + own.len() as u32;
            first = faces.end;
            !outlines.insert(canonical(self.outline(faces)))
        });
        is_known.filter(|&is_known| is_known).count()
    }

    /// The given corners of a polygon, taken from its faces.
    fn outline(&self, faces: Range<u32>) -> Outline {
        let mut corners = Vec::new();
        for face in faces {
            corners.extend((0..).zip(self.corner_range(face)).map(|(k, corner)| {
                (self.corner_number(face, k), integers(self.given_corner(corner as u32)))
            }));
        }
        corners.sort_unstable();
        corners.dedup();
        corners.into_iter().map(|(_, corner)| corner).collect()
    }
}

/// The lattice points of a polygon's corners.
type Outline = Vec<[i64; 3]>;

/// The canonical form of an outline: the same list for every start and either direction.
fn canonical(corners: Outline) -> Outline {
    let reverse: Outline = corners.iter().rev().copied().collect();
    let least = |mut corners: Outline| {
        let start = least_rotation(&corners);
        corners.rotate_left(start);
        corners
    };
    least(corners).min(least(reverse))
}

/// The start of the lexicographically least rotation, in linear time (Shiloach, “Fast canonization
/// of circular strings”, 1981).
fn least_rotation(corners: &[[i64; 3]]) -> usize {
    let n = corners.len();
    let (mut i, mut j, mut same) = (0, 1, 0);
    while i < n && j < n && same < n {
        let [a, b] = [i, j].map(|start| corners[(start + same) % n]);
        match a.cmp(&b) {
            Ordering::Equal => {
                same += 1;
                continue;
            }
            Ordering::Less => j += same + 1,
            Ordering::Greater => i += same + 1,
        }
        j += usize::from(i == j);
        same = 0;
    }
    i.min(j)
}

#[cfg(test)]
mod tests {
    use super::{Corners, Outline, canonical, least_rotation};
    use crate::random::SplitMix64;

    /// All sequences of a length over three corners.
    fn sequences(len: u32) -> impl Iterator<Item = Outline> {
        (0..3i64.pow(len)).map(move |code| (0..len).map(|k| [code / 3i64.pow(k) % 3; 3]).collect())
    }

    /// Counted corner by corner, around outlines with long straight sides that begin anywhere.
    #[test]
    fn straight_runs_go_on_past_the_first_corner() {
        let mut random = SplitMix64::new(8);
        let mut past = 0;
        for round in 0..400 {
            let mut whole = |most: u64| (random.next() % most) as i64;
            let [a, b] = [[1 + whole(5), whole(5)], [-whole(5), 1 + whole(5)]];
            let (mut at, mut points) = ([0; 2], vec![]);
            for (way, count) in [(a, 1 + whole(6)), (b, 1 + whole(6)), ([-3, -4], 1)] {
                for _ in 0..count {
                    points.push(at);
                    at = [at[0] + way[0], at[1] + way[1]];
                }
            }
            let n = points.len();
            points.rotate_left(round % n);
            let kept = (0..).zip(&points).map(|(k, p)| ([p[0] as f64, p[1] as f64, 0.0], k));
            let mut corners = Corners { kept: kept.collect(), given: n, runs: vec![] };
            corners.find_runs();
            for k in 0..n {
                let point = |i: usize| points[(k + i) % n];
                let step = |i: usize| [0, 1].map(|axis| point(i + 1)[axis] - point(i)[axis]);
                let is_straight = |i: &usize| {
                    let ([ax, ay], [bx, by]) = (step(i - 1), step(*i));
                    ax * by == ay * bx
                };
                let run = 1 + (1..n).take_while(is_straight).count();
                assert_eq!(corners.runs[k], run as u32, "{points:?} {k}");
                past += usize::from(k + run > n + 1);
            }
        }
        assert!(past > 200, "{past}");
    }

    #[test]
    fn the_least_rotation_is_the_least_of_all() {
        for corners in (1..7).flat_map(sequences) {
            let rotated = |start: usize| {
                let mut corners = corners.clone();
                corners.rotate_left(start);
                corners
            };
            let least = (0..corners.len()).map(rotated).min();
            assert_eq!(Some(rotated(least_rotation(&corners))), least);
        }
    }

    #[test]
    fn every_start_and_direction_has_one_form() {
        for corners in (1..7).flat_map(sequences) {
            let form = canonical(corners.clone());
            let mut other: Outline = corners.iter().rev().copied().collect();
            for _ in 0..corners.len() {
                other.rotate_left(1);
                assert_eq!(canonical(other.clone()), form);
            }
        }
    }
}
