//! Vertices of pieces: the sides of planes on which vertices lie, decided in integers, and rounded positions.
//!
//! Lattice coordinates are below 2⁵¹ in magnitude, so the components of a face's normal are below 2¹⁰⁵. The
//! value of the face's plane at a lattice point is a determinant of differences, below 2¹⁵⁹ (160 bits with
//! the sign). A vertex is a combination of one, two or three lattice points of its face:
//!
//! | vertex | combination of | with weights | plane at the vertex, times the sum of weights |
//! |---|---|---|---|
//! | a corner | the corner | 1 | 160 bits |
//! | edge `ab` cut by h | a, b | −h(b), h(a): 160 bits | h(a)·g(b) − h(b)·g(a): 320 bits |
//! | h₁ and h₂ in the face's plane | its reference triangle | h₁ × h₂ over A, B, C: 320 bits | 482 bits |
//!
//! A corner that only the tolerance puts on its face's plane is defined to lie on that plane, moved along the
//! axis `e` in which the plane is least steep. Its edges then lie in the planes through their two lattice
//! points and along `e`; such a plane replaces h in the table. The corner's own weights over A, B, C are the
//! areas of triangles seen along `e`.

use std::cmp::Ordering;

use glam::DVec3;
use smallvec::{SmallVec, smallvec};

use super::Int;
use super::faces::Faces;
use super::lattice::{LIMIT, integers};
use super::names::{PlaneId, PlaneKind, VertexId, VertexKind};
use super::plane::{LOW, LOW_BITS, Plane, cross, largest, relative_to, rounded};

/// A vertex as a weighted mean of lattice points: one corner; two points between which it lies; or three
/// points in whose plane it lies. The weights and their sum may have either sign; the sum is not zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weights<const W: usize> {
    points: [[f64; 3]; 3],
    /// Weights beyond the number of points are 0.
    weights: [Int<W>; 3],
    len: usize,
}

impl<const W: usize> Weights<W> {
    /// The point where a plane cuts a segment, from the plane's values at the segment's ends.
    fn on_segment([a, b]: [[f64; 3]; 2], [at_a, at_b]: [Int<3>; 2]) -> Self {
        let weights = [(-at_b).resize(), at_a.resize(), Int::ZERO];
        Self { points: [a, b, b], weights, len: 2 }
    }

    /// The point where three planes meet: the plane of a triangle, and two planes given by their values at
    /// the triangle's corners.
    pub(crate) fn meeting(points: [[f64; 3]; 3], g: &[Int<3>; 3], h: &[Int<3>; 3]) -> Self {
        // Barycentric weights w with Σ wᵢ gᵢ = Σ wᵢ hᵢ = 0 are perpendicular to both triples of values:
        // their vector product.
        let weights = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            g[j].times::<3, W>(&h[k]) - g[k].times::<3, W>(&h[j])
        });
        Self { points, weights, len: 3 }
    }

    /// The exact sign of a linear function at the vertex, from its values at lattice points.
    pub(crate) fn sign(&self, value: impl Fn(&[f64; 3]) -> Int<3>) -> Ordering {
        // The value at the vertex is Σ wᵢ · value(pᵢ) / Σ wᵢ. There is no division: only the sign
        // of the quotient is needed, and the numerator and the denominator are exact.
        let sum = match self.len {
            1 => return value(&self.points[0]).sign(),
            2 => {
                let weight = |i: usize| self.weights[i].resize::<3>();
                let term = |i: usize| weight(i).times::<3, 6>(&value(&self.points[i]));
                (term(0) + term(1)).sign()
            }
            _ => {
                let term = |i: usize| self.weights[i].times::<3, 9>(&value(&self.points[i]));
                (term(0) + term(1) + term(2)).sign()
            }
        };
        relative_to(sum, self.total().sign())
    }

    fn total(&self) -> Int<W> {
        self.weights[0] + self.weights[1] + self.weights[2]
    }
}

impl Weights<5> {
    /// The coordinate along an axis.
    pub(crate) fn along(&self, axis: usize) -> Fraction {
        let terms = self.points.iter().zip(&self.weights);
        let numerator = terms.fold(Int::ZERO, |sum, (point, weight)| {
            sum + weight.times::<1, 6>(&Int::from(point[axis] as i64))
        });
        Fraction { numerator, denominator: self.total() }
    }

    /// The position in lattice units; each coordinate is off by at most three roundings.
    pub(crate) fn position(&self) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let Fraction { numerator, denominator } = self.along(axis);
            numerator.to_f64() / denominator.to_f64()
        })
    }

    /// Each corner's share of the sum of weights.
    fn shares<const K: usize>(&self, corners: [u32; K]) -> SmallVec<[(u32, f64); 3]> {
        let total = self.total().to_f64();
        let shares = self.weights.map(|weight| weight.to_f64() / total);
        corners.into_iter().zip(shares).collect()
    }
}

impl Faces {
    /// A partition plane in integers.
    pub(crate) fn plane(&self, plane: PlaneId) -> Plane {
        match plane.kind() {
            PlaneKind::Face(face) => Plane::through(self.triangle(face)),
            PlaneKind::Axis(axis, corner) => Plane::axis(axis, self.corner(corner)),
        }
    }

    /// The ends of the edge on which a vertex lies. `None` if the vertex is not on an edge, or if corners of
    /// the face are moved.
    pub(super) fn edge_ends(&self, face: u32, vertex: VertexId) -> Option<[[f64; 3]; 2]> {
        let VertexKind::OnEdge(k, _) = vertex.kind() else { return None };
        if self.moved_axis(face).is_some() {
            return None;
        }
        let corners = self.corners(face);
        Some([corners[k as usize], corners[(k as usize + 1) % corners.len()]])
    }

    /// A vertex as a combination of corners of its face.
    pub(crate) fn weights<const W: usize>(&self, face: u32, vertex: VertexId) -> Weights<W> {
        let meeting = |g: &Plane, h: &Plane| {
            let [a, b, c] = self.triangle(face);
            let at = |plane: &Plane| [plane.at(&a), plane.at(&b), plane.at(&c)];
            Weights::meeting([a, b, c], &at(g), &at(h))
        };
        match vertex.kind() {
            VertexKind::Corner(k) => {
                let corner = self.corners(face)[k as usize];
                let Some(axis) = self.axis_of_move(face, k) else {
                    let weights = [Int::from(1_i64), Int::ZERO, Int::ZERO];
                    return Weights { points: [corner; 3], weights, len: 1 };
                };
                let [a, b, c] = self.triangle(face);
                let area = |p, q| Int::from(cross(corner, p, q)[axis]);
                let weights = [area(b, c), area(c, a), area(a, b)];
                Weights { points: [a, b, c], weights, len: 3 }
            }
            VertexKind::OnEdge(k, plane) => {
                let ExactEdge { ends, moved } = self.edge(face, k);
                let plane = self.plane(plane);
                match moved {
                    None => {
                        let [a, b] = ends;
                        Weights::on_segment(ends, [plane.at(&a), plane.at(&b)])
                    }
                    Some(Moved { axis, .. }) => {
                        meeting(&Plane::upright(ends[0], ends[1], axis), &plane)
                    }
                }
            }
            VertexKind::Inside(g, h) => meeting(&self.plane(g), &self.plane(h)),
        }
    }

    /// The point where a plane cuts the segment between two lattice points; `None` unless the two points are
    /// strictly on opposite sides of the plane.
    pub(crate) fn cut_of_segment(&self, ends: [[f64; 3]; 2], plane: PlaneId) -> Option<Weights<5>> {
        let plane = self.plane(plane);
        let values = ends.map(|end| plane.at(&end));
        let [a, b] = values.map(|value| value.sign());
        (a.is_ne() && a == b.reverse()).then(|| Weights::on_segment(ends, values))
    }

    /// A coordinate of a vertex.
    pub(crate) fn along(&self, face: u32, vertex: VertexId, axis: usize) -> Fraction {
        self.weights(face, vertex).along(axis)
    }

    /// The weights of a vertex over its face's corners: pairs of a corner's number in the face and its
    /// weight. The weights sum to 1.
    pub(crate) fn barycentric(&self, face: u32, vertex: VertexId) -> SmallVec<[(u32, f64); 3]> {
        if let VertexKind::Corner(k) = vertex.kind() {
            return smallvec![(k, 1.0)];
        }
        let len = self.corners(face).len() as u32;
        let weights = self.weights(face, vertex);
        match vertex.kind() {
            VertexKind::Corner(k) => smallvec![(k, 1.0)],
            VertexKind::OnEdge(k, _) if weights.len == 2 => weights.shares([k, (k + 1) % len]),
            VertexKind::OnEdge(k, _) => {
                // The edge of a face that is planar only by definition: the exact weights are over the
                // reference triangle, so use the rounded position's share of the edge.
                let edge = [k, (k + 1) % len];
                let [a, b] = edge.map(|k| DVec3::from(self.corners(face)[k as usize]));
                let arm = b - a;
                let point = DVec3::from(self.position(face, vertex));
                let t = ((point - a).dot(arm) / arm.length_squared()).clamp(0.0, 1.0);
                smallvec![(edge[0], 1.0 - t), (edge[1], t)]
            }
            VertexKind::Inside(..) if self.has_own_plane(face) => {
                weights.shares(self.faces[face as usize].frame.triangle())
            }
            // The exact weights are over corners of other faces.
            VertexKind::Inside(..) => self.rounded_shares(face, self.position(face, vertex)),
        }
    }

    /// The weights of a point of a face's plane over the face's own corners, by its rounded position.
    fn rounded_shares(&self, face: u32, position: [f64; 3]) -> SmallVec<[(u32, f64); 3]> {
        let triangle = self.faces[face as usize].frame.triangle();
        let [a, b, c] = triangle.map(|k| DVec3::from(self.corners(face)[k as usize]));
        let normal = (b - a).cross(c - a);
        let point = DVec3::from(position);
        let area = |p: DVec3, q: DVec3| (p - point).cross(q - point).dot(normal);
        let areas = [area(b, c), area(c, a), area(a, b)];
        let total: f64 = areas.iter().sum();
        triangle.into_iter().zip(areas).map(|(k, area)| (k, area / total)).collect()
    }
}

/// A coordinate of a point, in lattice units. The denominator is not zero, and has either sign.
///
/// Numerator and denominator are sums over the weights of [`Weights`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fraction {
    numerator: Int<6>,
    denominator: Int<5>,
}

impl Fraction {
    /// The coordinate of a lattice point.
    pub(crate) fn whole(value: f64) -> Self {
        Self { numerator: Int::from(value as i64), denominator: Int::from(1_i64) }
    }

    /// Compares two coordinates, exactly.
    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        let left = self.numerator.times::<5, 12>(&other.denominator);
        let right = other.numerator.times::<5, 12>(&self.denominator);
        let flipped = self.denominator.is_negative() != other.denominator.is_negative();
        let denominators = if flipped { Ordering::Less } else { Ordering::Greater };
        relative_to((left - right).sign(), denominators)
    }

    /// The position between two lattice coordinates as a rounded share, 0 at `from` and 1 at `to`.
    pub(crate) fn share(&self, from: f64, to: f64) -> f64 {
        let before = self.denominator.times::<1, 6>(&Int::from(from as i64));
        (self.numerator - before).to_f64() / (self.denominator.to_f64() * (to - from))
    }
}

impl Faces {
    /// The axis in which the line where a plane cuts a face is longest.
    pub(crate) fn axis_of_cut(&self, face: u32, plane: PlaneId) -> usize {
        let own = Plane::through(self.triangle(face)).normal();
        let other = self.plane(plane).normal();
        let product = |j: usize, k: usize| Int::<2>::from(own[j]).times::<2, 4>(&other[k].into());
        let length = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            (product(j, k) - product(k, j)).to_f64().abs()
        };
        largest([length(0), length(1), length(2)])
    }
}

/// An edge of a face.
#[derive(Clone, Copy, Debug)]
struct ExactEdge {
    /// The lattice points of the edge's two corners.
    ends: [[f64; 3]; 2],
    /// The move of the edge's ends onto the face's plane; `None` if both ends are on the plane.
    moved: Option<Moved>,
}

/// The move of an edge's ends: along an axis, by at most half a step.
#[derive(Clone, Copy, Debug)]
struct Moved {
    axis: usize,
    /// The values of the face's plane at the ends, and the increase of the value with each step along the
    /// axis.
    offs: [i128; 2],
    slope: i128,
}

impl Faces {
    /// The edge of a face that begins at the face's corner `k`.
    #[inline]
    fn edge(&self, face: u32, k: u32) -> ExactEdge {
        let corners = self.corners(face);
        let next = if k as usize + 1 == corners.len() { 0 } else { k + 1 };
        let ends = [k, next].map(|k| corners[k as usize]);
        let moved = self.moved_axis(face).and_then(|axis| {
            let is_on = [k, next].map(|k| self.is_on_triangle(face, k));
            if is_on == [true; 2] {
                return None;
            }
            let own = Plane::through(self.triangle(face));
            let off = |i: usize| if is_on[i] { 0 } else { own.last_bits_at(&ends[i]) };
            let (offs, slope) = ([off(0), off(1)], own.normal()[axis]);
            // An edge between two corners that are not moved must be treated as an edge, not as a cut by an
            // upright plane. The neighbour across the edge may have moved no corner, and both faces must
            // compute the same bits.
            (offs != [0; 2]).then_some(Moved { axis, offs, slope })
        });
        ExactEdge { ends, moved }
    }

    /// The axis along which a corner is moved onto its face's plane, if the corner is off the plane.
    fn axis_of_move(&self, face: u32, k: u32) -> Option<usize> {
        let axis = self.moved_axis(face).filter(|_| !self.is_on_triangle(face, k))?;
        let own = Plane::through(self.triangle(face));
        (own.last_bits_at(&self.corners(face)[k as usize]) != 0).then_some(axis)
    }

    /// Whether corner `k` is one of the three corners that define its face's plane. Other corners are within
    /// half a step of the plane along the axis, so the plane's value at those corners fits 128 bits.
    fn is_on_triangle(&self, face: u32, k: u32) -> bool {
        let first = self.faces[face as usize].start;
        self.reference_triangle(face).contains(&(first + k))
    }
}

// Positions. The exact position is a quotient of integers of up to 380 bits, whose leading bits nearly always
// suffice. So intermediate numbers are truncated to 124 bits, with a bound on the loss. If the quotient could
// be off by more than `OFF`, because terms cancel, it is computed in full.

/// The number of bits that are kept of a number, without the sign.
const KEPT: u32 = 124;
/// The bits of half a number. The product of two halves fits 128 bits.
const HALF: u32 = KEPT / 2;
const LOW_HALF: i128 = (1 << HALF) - 1;
/// The value 1 of fixed-point numbers with `HALF` bits below the point.
const UNIT: f64 = (1u64 << HALF) as f64;
/// The sum of the weights must be 2⁷⁰ times the error of a weight. Too small: positions are off by more. Too
/// large: more positions are computed in full.
const MARGIN: u32 = 70;
/// The margin for vertices on edges. The two weights of such a vertex do not cancel, so 62 bits of each
/// weight are enough. A margin above 62 would never be reached with these bits.
const EDGE_MARGIN: u32 = 60;
/// The largest error of a position from truncation, in lattice units: on an edge as long as the lattice is
/// wide, 2 · 2⁻⁶⁰ of twice the lattice's size. (For other vertices the error is less: 6 · 2⁻⁷⁰ of the
/// lattice's size, because three weights are in the numerator and three in the denominator.)
pub(crate) const OFF: f64 = 4.0 * LIMIT / (1u64 << EDGE_MARGIN) as f64;

impl Faces {
    /// The rounded position of a vertex in lattice units. Each coordinate is off by at most three of its own
    /// roundings plus [`OFF`]. The position is exact along an axis if a plane perpendicular to that axis
    /// defines the vertex. All pieces, of any face, that define the vertex by the same points and planes
    /// compute the same bits, also if their faces have opposite orientations.
    pub(crate) fn position(&self, face: u32, vertex: VertexId) -> [f64; 3] {
        let (leading, planes) = match vertex.kind() {
            VertexKind::Corner(k) => return self.corners(face)[k as usize],
            VertexKind::OnEdge(k, g) => (on_edge(&self.edge(face, k), &self.plane(g)), [g; 2]),
            VertexKind::Inside(g, h) => {
                (meeting(&self.triangle(face), &self.plane(g), &self.plane(h)), [g, h])
            }
        };
        let mut position = leading.unwrap_or_else(|| self.position_in_full(face, vertex));
        for plane in planes {
            if let PlaneKind::Axis(axis, corner) = plane.kind() {
                position[axis] = self.corner(corner)[axis];
            }
        }
        position
    }

    #[cold]
    fn position_in_full(&self, face: u32, vertex: VertexId) -> [f64; 3] {
        self.weights(face, vertex).position()
    }
}

/// The point where a plane meets an edge; `None` if the leading bits do not decide.
fn on_edge(edge: &ExactEdge, plane: &Plane) -> Option<[f64; 3]> {
    let ExactEdge { ends, moved } = edge;
    let ends = ends.map(integers);
    let values = ends.map(|end| at(plane, end));
    let dropped = (bits_of(values.map(|value| value.high)) + LOW_BITS).saturating_sub(HALF);
    let [mut a, mut b] = values.map(|value| value.without(dropped) as i64);
    // Truncation loses less than 1.
    let mut error = u64::from(dropped > 0);
    let mut moves = [0.0; 2];
    if let Some(Moved { axis, offs, slope }) = moved {
        let [own_slope, slope] = [*slope, plane.normal()[*axis]].map(rounded);
        // The moves are off by five roundings, and the plane's gains by eight.
        moves = offs.map(|off| -rounded(off) / own_slope);
        let scale = f64::from_bits(u64::from(1023 - dropped) << 52);
        let gains = moves.map(|by| by * slope * scale);
        let most = gains[0].abs().max(gains[1].abs());
        (a, b) = (a.saturating_add(gains[0] as i64), b.saturating_add(gains[1] as i64));
        error += 1 + (most * (4.0 * f64::EPSILON)) as u64;
    }
    let weights = [b.checked_neg()?, a];
    let total = a.checked_sub(b)?;
    if total == 0 || total.unsigned_abs() >> EDGE_MARGIN < error {
        return None;
    }
    Some(std::array::from_fn(|axis| {
        let terms = |factors: [i64; 2]| {
            let [x, y] = [0, 1].map(|i| i128::from(weights[i]) * i128::from(factors[i]));
            x + y
        };
        let mut sum = terms(ends.map(|end| end[axis]));
        if moved.is_some_and(|moved| moved.axis == axis) {
            // Rounded towards 0, so that the sum has the same magnitude if the weights have the opposite
            // sign.
            sum += terms(moves.map(|by| (by * UNIT) as i64)) / (1 << HALF);
        }
        sum as f64 / total as f64
    }))
}

/// The point where two planes meet the plane of a triangle; `None` if the leading bits do not decide.
fn meeting(triangle: &[[f64; 3]; 3], g: &Plane, h: &Plane) -> Option<[f64; 3]> {
    let triangle = triangle.map(integers);
    let ((g, dropped_of_g), (h, dropped_of_h)) = (leading(g, triangle), leading(h, triangle));
    let (g, h) = (g.map(halves), h.map(halves));
    // As in `Weights::meeting`, the weights are the vector product of the two triples of values.
    let mut weights = [Product::default(); 3];
    for (i, weight) in weights.iter_mut().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        *weight = Product::of(g[j], h[k], g[k], h[j]);
    }
    // Of the largest weight, 124 bits are kept. All weights lose as many low bits as that weight.
    let dropped = bits_of(weights.map(|weight| weight.magnitude().high));
    // A value is off by less than 1, its products with others by 2¹²⁴, and a weight by four times as much.
    let is_exact = dropped_of_g == 0 && dropped_of_h == 0;
    let inexact = if is_exact { 0 } else { 1 << (KEPT + 2).saturating_sub(dropped) };
    let error = inexact + u128::from(dropped > 0);
    let weights = weights.map(|weight| weight.without(dropped));
    let total = weights.iter().sum::<i128>();
    if total == 0 || total.unsigned_abs() >> MARGIN < error {
        return None;
    }
    let total = nearest(total, 0);
    let weights = weights.map(halves);
    let mut position = [0.0; 3];
    for (axis, coordinate) in position.iter_mut().enumerate() {
        let (mut high, mut low) = (0, 0);
        for (point, weight) in triangle.iter().zip(&weights) {
            let c = i128::from(point[axis]);
            high += i128::from(weight[1]) * c;
            low += i128::from(weight[0]) * c;
        }
        let sum = nearest(high + (low >> HALF), (low & LOW_HALF) as u64);
        *coordinate = sum * UNIT / total;
    }
    Some(position)
}

/// A plane's values at some lattice points, without the last bits, and the number of bits dropped. Each value
/// is below 2¹²⁴ in magnitude and rounded towards 0, so the values of a plane and of its reverse differ only
/// in sign.
#[inline]
fn leading(plane: &Plane, points: [[i64; 3]; 3]) -> ([i128; 3], u32) {
    let parts = points.map(|point| at(plane, point));
    let dropped = (bits_of(parts.map(|parts| parts.high)) + LOW_BITS).saturating_sub(KEPT);
    (parts.map(|parts| parts.without(dropped)), dropped)
}

/// A number in two parts: `high` · 2^BITS + `low`, where `low` is not negative.
#[derive(Clone, Copy, Debug, Default)]
struct HighLow<const BITS: u32> {
    high: i128,
    low: i128,
}

impl<const BITS: u32> HighLow<BITS> {
    /// The number times 2^−`dropped`, rounded towards 0.
    #[inline]
    fn without(self, dropped: u32) -> i128 {
        let Self { high, low } = self.magnitude();
        let size = match BITS.checked_sub(dropped) {
            Some(up) => (high << up) + (low >> dropped),
            None => high >> (dropped - BITS),
        };
        if self.high < 0 { -size } else { size }
    }

    /// The absolute value.
    #[inline]
    fn magnitude(self) -> Self {
        match (self.high < 0, self.low == 0) {
            (false, _) => self,
            (true, true) => Self { high: -self.high, low: 0 },
            (true, false) => Self { high: -self.high - 1, low: (1 << BITS) - self.low },
        }
    }
}

/// The value of a plane at a lattice point.
#[inline]
fn at(plane: &Plane, point: [i64; 3]) -> HighLow<LOW_BITS> {
    let (mut high, mut low) = (0, 0);
    for ((component, x), through) in plane.normal().into_iter().zip(point).zip(plane.point()) {
        let arm = i128::from(x - through);
        low += i128::from((component & LOW) as i64) * arm;
        high += i128::from((component >> LOW_BITS) as i64) * arm;
    }
    HighLow { high: high + (low >> LOW_BITS), low: low & LOW }
}

/// The number of bits of the largest magnitude.
#[inline]
fn bits_of<const K: usize>(numbers: [i128; K]) -> u32 {
    let all = numbers.iter().fold(0, |all, number| all | number.unsigned_abs());
    128 - all.leading_zeros()
}

/// The two halves of a number, the lower half first and not negative.
#[inline]
fn halves(number: i128) -> [i64; 2] {
    [(number & LOW_HALF) as i64, (number >> HALF) as i64]
}

/// A number of up to 250 bits.
type Product = HighLow<KEPT>;

impl Product {
    /// a · b − c · d, from the halves of each.
    #[inline]
    fn of(a: [i64; 2], b: [i64; 2], c: [i64; 2], d: [i64; 2]) -> Self {
        let times = |x: i64, y: i64| i128::from(x) * i128::from(y);
        let low = times(a[0], b[0]) - times(c[0], d[0]);
        let middle = times(a[1], b[0]) + times(a[0], b[1]) - times(c[1], d[0]) - times(c[0], d[1])
            + (low >> HALF);
        let high = times(a[1], b[1]) - times(c[1], d[1]) + (middle >> HALF);
        Self { high, low: (middle & LOW_HALF) << HALF | (low & LOW_HALF) }
    }
}

/// The nearest `f64` to `high` + `low` · 2⁻⁶², ties to even; `low` is below 2⁶².
#[inline]
fn nearest(high: i128, low: u64) -> f64 {
    if high.unsigned_abs() >> HALF > 0 {
        // The last bit is set if any bit below is: then the conversion rounds once, as if it saw all bits.
        return (high | i128::from(low > 0)) as f64;
    }
    ((high << HALF | i128::from(low)) as f64) / (1u64 << HALF) as f64
}

#[cfg(test)]
mod tests;

#[cfg(test)]
mod along_tests {
    use super::*;

    #[test]
    fn fractions_compare_exactly_whatever_the_signs_of_their_denominators() {
        let fraction = |n: i64, d: i64| Fraction { numerator: n.into(), denominator: d.into() };
        let third = fraction(1, 3);
        for (other, expected) in [
            (fraction(-1, -3), Ordering::Equal),
            (fraction(333_333_333_333_333, 1_000_000_000_000_000), Ordering::Greater),
            (fraction(-333_333_333_333_334, -1_000_000_000_000_000), Ordering::Less),
            (fraction(1, -3), Ordering::Greater),
            (Fraction::whole(0.0), Ordering::Greater),
            (Fraction::whole(1.0), Ordering::Less),
        ] {
            assert_eq!(third.compare(&other), expected, "{other:?}");
            assert_eq!(other.compare(&third), expected.reverse(), "{other:?}");
        }
        assert_eq!(fraction(-7, -2).share(3.0, 5.0), 0.25);
        assert_eq!(fraction(7, 2).share(5.0, 3.0), 0.75);
    }
}
