//! The faces of a scene: convex, planar, on the lattice.

#[cfg(feature = "layers")]
mod one_plane;
#[cfg(feature = "save")]
mod saved;

use std::cmp::Ordering;
use std::fmt;

use super::Lattice;
use super::names::MAX_NAMES;
use crate::error::{Error, Kind};
use crate::memory::reserve;

/// The faces of a scene in lattice coordinates. Each is convex and planar, and belongs to one input
/// polygon.
///
/// A polygon that is convex, has at most 32 768 corners, and lies within the tolerance of one plane
/// becomes one face; any other becomes triangles. A corner that does not lie exactly on the plane
/// of its face's reference triangle is *defined* to lie on it, moved along the axis in which the
/// plane is least steep. Stored is the lattice point nearest to the moved corner.
#[derive(Clone, Default)]
pub struct Faces {
    pub(crate) lattice: Lattice,
    pub(crate) tolerance: f64,
    pub(crate) corners: Vec<[f64; 3]>,
    /// For the faces in `numbered`: the number of each corner within its polygon, with [`INNER`]
    /// set if the edge to the next corner is not an edge of the polygon. The corners of all other
    /// faces are numbered 0, 1, 2, ….
    pub(crate) numbers: Vec<u32>,
    /// Faces with explicit corner numbers, and where these begin in `numbers`.
    pub(crate) numbered: Vec<(u32, u32)>,
    pub(crate) faces: Vec<Face>,
    /// The corners, counted over all faces, that were moved onto their face's plane, and where they
    /// were. In ascending order.
    pub(crate) moved: Vec<(u32, [f64; 3])>,
    /// For each face, the three corners that define its plane, where some are of other faces; empty if
    /// each face's plane is that of its own reference triangle.
    pub(crate) planes: Vec<[u32; 3]>,
    pub(crate) thin: Thin,
}

impl fmt::Debug for Faces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Faces")
            .field("lattice", &self.lattice)
            .field("tolerance", &self.tolerance)
            .field("corners", &self.corners.len())
            .field("faces", &self.faces.len())
            .finish_non_exhaustive()
    }
}

/// How many of the last faces have no area: first segments, then points.
///
/// A segment has three corners: its ends, and one that is on it with no line through both. The third
/// is never drawn: it only says which plane through the segment is meant by the face's. A point has
/// one corner, and no plane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Thin {
    pub(crate) segments: usize,
    pub(crate) points: usize,
}

/// Marks a corner if the edge from it to the next is not an edge of the polygon.
pub(crate) const INNER: u32 = 1 << 31;

/// Where a face's corners begin, what it came from, and which of its corners span its plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub(crate) start: u32,
    pub(crate) polygon: u32,
    pub(crate) frame: Frame,
}

/// The reference triangle of a face (its corners 0, `second` and `third`), and the axis along which
/// its other corners are moved onto its plane, if any of them is off it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Frame(u32);

impl Frame {
    /// The largest number of corners of a face.
    pub(crate) const MAX_CORNERS: usize = 1 << 15;
    /// The frame of a triangle.
    pub(crate) const TRIANGLE: Self = Self::new(1, 2, None);
    /// The frame of a point, which has no plane.
    pub(crate) const POINT: Self = Self::new(0, 0, None);

    pub(crate) const fn new(second: usize, third: usize, drop: Option<usize>) -> Self {
        let axis = match drop {
            Some(axis) => axis as u32,
            None => 3,
        };
        Self(axis << 30 | (second as u32) << 15 | third as u32)
    }

    pub(crate) const fn triangle(self) -> [u32; 3] {
        [0, self.0 >> 15 & 0x7fff, self.0 & 0x7fff]
    }

    pub(crate) const fn drop_axis(self) -> Option<usize> {
        if self.0 >> 30 == 3 { None } else { Some((self.0 >> 30) as usize) }
    }
}

impl Faces {
    /// How many faces there are.
    pub fn len(&self) -> usize {
        self.faces.len()
    }

    /// Whether there is no face.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// The grid that the corners lie on.
    #[doc(hidden)]
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// The coplanar tolerance in lattice units.
    #[doc(hidden)]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The index of the polygon that a face belongs to.
    #[inline]
    pub fn polygon(&self, face: u32) -> usize {
        self.faces[face as usize].polygon as usize
    }

    /// The lattice points of a face's corners, counter-clockwise seen from its front.
    #[doc(hidden)]
    #[inline]
    pub fn corners(&self, face: u32) -> &[[f64; 3]] {
        &self.corners[self.corner_range(face)]
    }

    /// The range of a face's corners in the list of all corners.
    #[doc(hidden)]
    #[inline]
    pub fn corner_range(&self, face: u32) -> std::ops::Range<usize> {
        let face = face as usize;
        let end = self.faces.get(face + 1).map_or(self.corners.len(), |next| next.start as usize);
        self.faces[face].start as usize..end
    }

    /// How many of a face's corners, from the first on, are part of it: all; two of a segment; one of a
    /// point.
    pub(crate) fn reach(&self, face: u32) -> usize {
        let Thin { segments, points } = self.thin;
        let from_end = self.len() - face as usize;
        if from_end <= points {
            1
        } else if from_end <= points + segments {
            2
        } else {
            self.corner_range(face).len()
        }
    }

    /// The lattice point of a corner, counted over all faces.
    #[doc(hidden)]
    #[inline]
    pub fn corner(&self, corner: u32) -> [f64; 3] {
        self.corners[corner as usize]
    }

    /// The lattice point of a corner, counted over all faces, before it was moved onto its face's
    /// plane. Polygons that share a corner as given have equal points here.
    pub(crate) fn given_corner(&self, corner: u32) -> [f64; 3] {
        match self.moved.binary_search_by_key(&corner, |&(corner, _)| corner) {
            Ok(at) => self.moved[at].1,
            Err(_) => self.corner(corner),
        }
    }

    /// The three corners, counted over all faces, that define a face's plane.
    #[doc(hidden)]
    #[inline]
    pub fn reference_triangle(&self, face: u32) -> [u32; 3] {
        match self.planes.get(face as usize) {
            Some(&triangle) => triangle,
            None => self.own_triangle(face),
        }
    }

    #[inline]
    fn own_triangle(&self, face: u32) -> [u32; 3] {
        let face = &self.faces[face as usize];
        face.frame.triangle().map(|k| face.start + k)
    }

    /// Whether corners of the face itself define its plane.
    pub(crate) fn has_own_plane(&self, face: u32) -> bool {
        self.reference_triangle(face) == self.own_triangle(face)
    }

    /// Adds a face.
    pub(crate) fn push(
        &mut self,
        polygon: usize,
        corners: impl ExactSizeIterator<Item = [f64; 3]>,
        frame: Frame,
    ) -> Result<(), Error> {
        let start = self.corners.len();
        if start + corners.len() >= MAX_NAMES {
            return Err(Kind::CornersInAll(MAX_NAMES).error());
        }
        // Both at first: corners without a face would be those of the face before.
        reserve(&mut self.corners, corners.len())?;
        reserve(&mut self.faces, 1)?;
        self.corners.extend(corners);
        self.faces.push(Face { start: start as u32, polygon: polygon as u32, frame });
        Ok(())
    }

    /// The corners that define a face's plane.
    #[inline]
    pub(crate) fn triangle(&self, face: u32) -> [[f64; 3]; 3] {
        self.reference_triangle(face).map(|corner| self.corner(corner))
    }

    /// The numbers of the polygons that have no face; `polygons` is how many were prepared.
    #[doc(hidden)]
    pub fn dropped(&self, polygons: usize) -> impl Iterator<Item = usize> + Clone {
        let mut faces = (0..self.len() as u32).map(|face| self.polygon(face)).peekable();
        (0..polygons).filter(move |&polygon| {
            let is_dropped = faces.next_if_eq(&polygon).is_none();
            while faces.next_if_eq(&polygon).is_some() {}
            is_dropped
        })
    }

    /// How many corners all faces have together.
    #[doc(hidden)]
    pub fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// The axis along which the corners of a face are moved onto its plane, or `None` if all of
    /// them lie exactly on it. An edge of a face with moved corners lies in the plane through its
    /// two lattice points and along that axis.
    #[inline]
    pub(crate) fn upright_axis(&self, face: u32) -> Option<usize> {
        self.faces[face as usize].frame.drop_axis()
    }

    /// The number within its polygon of a face's corner `k`.
    #[doc(hidden)]
    pub fn corner_number(&self, face: u32, k: u32) -> u32 {
        self.number(face, k) & !INNER
    }

    /// The number of the polygon's edge that a face's edge `k` lies on: the number of the corner
    /// where it begins. `None` for an edge made by triangulation. If a polygon touches itself or
    /// runs along an edge twice, those edges may be `None` as well.
    #[doc(hidden)]
    pub fn outline_edge(&self, face: u32, k: u32) -> Option<u32> {
        let number = self.number(face, k);
        (number & INNER == 0).then_some(number)
    }

    fn number(&self, face: u32, k: u32) -> u32 {
        match self.numbered.binary_search_by_key(&face, |&(face, _)| face) {
            Ok(at) => self.numbers[self.numbered[at].1 as usize + k as usize],
            Err(_) => k,
        }
    }

    /// Removes the faces from number `faces` on, and with them all that have no area.
    pub(crate) fn truncate(&mut self, faces: usize) {
        self.thin = Thin::default();
        self.planes.truncate(faces);
        let Some(face) = self.faces.get(faces) else { return };
        let (corners, first) = (face.start, faces as u32);
        self.faces.truncate(faces);
        self.corners.truncate(corners as usize);
        let numbered = self.numbered.partition_point(|&(face, _)| face < first);
        if let Some(&(_, numbers)) = self.numbered.get(numbered) {
            self.numbers.truncate(numbers as usize);
        }
        self.numbered.truncate(numbered);
        self.moved.truncate(self.moved.partition_point(|&(corner, _)| corner < corners));
    }

    /// The resident size in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.corners)
            + size_of_val(&*self.numbers)
            + size_of_val(&*self.numbered)
            + size_of_val(&*self.faces)
            + size_of_val(&*self.moved)
            + size_of_val(&*self.planes)
    }
}

/// Whether an outline of `n` lattice points is convex and winds once, seen along an axis. Exact.
pub(crate) fn is_convex(n: usize, at: impl Fn(usize) -> [f64; 3], axis: usize) -> bool {
    if n < 3 {
        return false;
    }
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let point = |k: usize| {
        let point = at(if k < n { k } else { k - n });
        [point[x], point[y]]
    };
    if n == 4 && turns_one_way(std::array::from_fn(point)) {
        return true;
    }
    let ascending = |s: [f64; 2]| s[0] > 0.0 || (s[0] == 0.0 && s[1] > 0.0);
    let (mut here, mut next) = (point(0), point(1));
    let (mut rises, mut turn) = (0, Ordering::Equal);
    for then in (2..n + 2).map(point) {
        let (a, b) = (step(here, next), step(next, then));
        (here, next) = (next, then);
        // The projection puts two corners in a row on one point: no direction to turn from.
        if a == [0.0; 2] || b == [0.0; 2] {
            return false;
        }
        let Some(sign) = turn_of(a, b) else { return false };
        if sign.is_ne() {
            if sign == turn.reverse() {
                return false;
            }
            turn = sign;
        }
        rises += u32::from(!ascending(a) && ascending(b));
    }
    // It turns one way only. Each time round it changes once from descending to ascending.
    rises == 1
}

#[inline]
fn step(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

/// Whether four corners certainly turn the same way. Then they wind once: each turn is less than half
/// a turn, and all four together are a whole number of turns.
#[inline]
pub(crate) fn turns_one_way(points: [[f64; 2]; 4]) -> bool {
    let steps: [_; 4] = std::array::from_fn(|k| step(points[k], points[(k + 1) % 4]));
    // No branches: for most faces they could not be foretold.
    let (mut left, mut right) = (true, true);
    for k in 0..4 {
        let (a, b) = (steps[k], steps[(k + 1) % 4]);
        let (one, other) = (a[0] * b[1], a[1] * b[0]);
        let (turn, bound) = (one - other, f64::EPSILON * (one.abs() + other.abs()));
        left &= turn > bound;
        right &= -turn > bound;
    }
    left | right
}

/// Which way an outline turns from one step to the next; `None` if it turns back.
#[inline]
fn turn_of(a: [f64; 2], b: [f64; 2]) -> Option<Ordering> {
    let (left, right) = (a[0] * b[1], a[1] * b[0]);
    // Two products and their difference are rounded.
    if (left - right).abs() > f64::EPSILON * (left.abs() + right.abs()) {
        return Some(if left > right { Ordering::Greater } else { Ordering::Less });
    }
    let product = |p: f64, q: f64| i128::from(p as i64) * i128::from(q as i64);
    let turn = (product(a[0], b[1]) - product(a[1], b[0])).cmp(&0);
    let is_back = turn.is_eq() && product(a[0], b[0]) + product(a[1], b[1]) < 0;
    (!is_back).then_some(turn)
}

#[cfg(test)]
mod convex_outline_tests {
    use std::cmp::Ordering;

    use super::{is_convex, turn_of, turns_one_way};
    use crate::random::SplitMix64;

    #[test]
    fn a_triangle_is_convex_if_it_has_an_area() {
        let convex = |triangle: [[f64; 3]; 3]| is_convex(3, |k| triangle[k], 2);
        for [x, y] in [[1.0, 2.0], [1.0, -2.0], [4.0, 1.0]] {
            assert!(convex([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [x, y, 5.0]]), "{x}, {y}");
            assert!(!convex([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [x, 0.0, 5.0]]), "{x}");
        }
    }

    #[test]
    fn an_outline_with_two_corners_on_one_point_of_the_view_is_not_convex() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        for start in 0..4 {
            let mut corners = square.to_vec();
            corners.rotate_left(start);
            let convex = |corners: &[[f64; 3]]| is_convex(corners.len(), |k| corners[k], 2);
            assert!(convex(&corners));
            let [x, y, _] = corners[3];
            corners.push([x, y, 1.0]);
            assert!(!convex(&corners), "{corners:?}");
        }
    }

    /// By integers: an outline of four corners is convex if all turns have the same sign.
    #[test]
    fn four_corners_that_certainly_turn_one_way_are_convex() {
        let mut random = SplitMix64::new(5);
        let mut told = [0; 2];
        for _ in 0..20_000 {
            let size = 2f64.powf(random.range(1.0, 50.0));
            let points = [(); 4].map(|()| [0, 1].map(|_| random.range(-size, size).round()));
            // The signs of the four areas by integers: all the same, or not.
            let area = |[p, q, r]: [[f64; 2]; 3]| {
                let of = |a: f64, b: f64| (b - a) as i128;
                (of(p[0], q[0]) * of(p[1], r[1]) - of(p[1], q[1]) * of(p[0], r[0])).signum()
            };
            let turns = [0, 1, 2, 3].map(|k| area([0, 1, 2].map(|i| points[(k + i) % 4])));
            let one_way = turns == [1; 4] || turns == [-1; 4];
            let found = turns_one_way(points);
            assert!(one_way || !found, "{points:?}");
            told[usize::from(found)] += 1;
            let corners = points.map(|[x, y]| [x, y, 0.0]);
            // Without area, a turn that is not one way can still be convex.
            if !turns.contains(&0) {
                assert_eq!(is_convex(4, |k| corners[k], 2), one_way, "{points:?}");
            }
        }
        assert!(told[0] > 2000 && told[1] > 2000, "{told:?}");
    }

    /// Steps that all but run on in one line, or back, by integers of 128 bits.
    #[test]
    fn turns_are_exact() {
        let mut random = SplitMix64::new(4);
        let (mut straight, mut back) = (0, 0);
        for _ in 0..20_000 {
            let mut number = |most: f64| random.range(-most, most).round();
            let (size, nudge) = (number(9e6), number(1.4));
            let (unit, nudge) = ([size, size + number(1.4)], [nudge; 2]);
            let [s, t] = [number(9e7), number(9e7)];
            let a = unit.map(|c| c * s);
            let b = [unit[0] * t + nudge[0], unit[1] * t + nudge[1]];
            let [p, q] = [a, b].map(|step| step.map(|c| c as i128));
            let turn = (p[0] * q[1] - p[1] * q[0]).cmp(&0);
            let is_back = turn == Ordering::Equal && p[0] * q[0] + p[1] * q[1] < 0;
            assert_eq!(turn_of(a, b), (!is_back).then_some(turn), "{a:?} {b:?}");
            straight += usize::from(turn.is_eq() && !is_back);
            back += usize::from(is_back);
        }
        assert!(straight > 500 && back > 500, "{straight} {back}");
    }
}
