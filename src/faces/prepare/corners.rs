//! The corners of a polygon: are they planar, are they convex, where does the outline run straight?
//! All are decided exactly, on the lattice, except the comparison of distances with the tolerance.

use glam::DVec3;

use crate::exact::{Lattice, Plane, cross, have_area, is_convex};

/// A corner on the lattice, and its number.
pub(super) type Corner = ([f64; 3], u32);

/// Replaces `kept` by the corners of an outline or a line, without those that equal the one before. Of equal
/// ones the last is kept: its edge is the one that leads on from there.
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
    pub(super) kept: Vec<Corner>,
    /// How many corners it was given with.
    pub(super) given: usize,
    /// For each kept corner, how many corners the straight run of the outline that begins there
    /// passes or ends at; at least 1. Empty if the polygon is not triangulated.
    runs: Vec<u32>,
}

impl Corners {
    /// Replaces them by those of another polygon.
    pub(super) fn keep_distinct(&mut self, points: &[DVec3], lattice: &Lattice) {
        self.runs.clear();
        self.given = points.len();
        keep_distinct(points, lattice, &mut self.kept);
        while self.kept.len() > 1 && self.kept[0].0 == self.kept[self.kept.len() - 1].0 {
            self.kept.pop();
        }
    }

    /// Two corners that span a large triangle with corner 0; `None` if all corners lie on one line.
    pub(super) fn widest_triangle(&self) -> Option<[usize; 2]> {
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
    pub(super) fn off_plane(&self, plane: &Plane, three: [usize; 3]) -> f64 {
        let others = (0..self.kept.len()).filter(|k| !three.contains(k));
        let off = others.map(|k| plane.at(&self.kept[k].0)).filter(|off| off.sign().is_ne());
        let furthest = off.map(|off| off.to_f64().abs()).fold(0.0, f64::max);
        if furthest > 0.0 { furthest / plane.normal_f64().length() } else { 0.0 }
    }

    /// Whether the polygon is convex and winds once, seen along an axis. Exact.
    pub(super) fn is_convex(&self, axis: usize) -> bool {
        is_convex(self.kept.len(), |k| self.kept[k].0, axis)
    }

    /// Whether the straight line from one kept corner to another is part of the outline: the second
    /// is the next corner, or all corners in between are on the line.
    pub(super) fn is_outline(&self, from: usize, to: usize) -> bool {
        let n = self.kept.len();
        let next = if from + 1 == n { 0 } else { from + 1 };
        let ahead = if to > from { to - from } else { to + n - from };
        let run = self.runs.get(from).map_or(1, |&run| run as usize);
        self.kept[next].0 == self.kept[to].0 || ahead <= run
    }

    /// Finds how far the outline runs straight from each corner, in linear time.
    pub(super) fn find_runs(&mut self) {
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
