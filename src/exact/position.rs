//! Positions of vertices, rounded.
//!
//! The exact position is a quotient of integers of up to 380 bits, whose leading bits nearly always
//! suffice. So numbers are cut off to 124 bits as they arise, with a bound on what that loses. Where
//! the quotient could be off by more than [`OFF`], because terms cancel, it is computed in full.

use super::Int;
use super::edge::{ExactEdge, Moved};
use super::faces::Faces;
use super::lattice::LIMIT;
use super::names::{PlaneKind, VertexId, VertexKind};
use super::plane::{LOW, LOW_BITS, Plane, rounded};
use super::vertex::Weights;

#[cfg(test)]
mod tests;

/// Bits that are kept of a number, the sign aside.
const KEPT: u32 = 124;
/// Numbers are multiplied by halves of so many bits, whose products fit 128.
const HALF: u32 = KEPT / 2;
const LOW_HALF: i128 = (1 << HALF) - 1;
/// 1 in numbers of which a half is below it.
const UNIT: f64 = (1u64 << HALF) as f64;
/// The sum of the weights must be 2⁷⁰ times the error of one. Smaller: positions are off by more;
/// larger: more of them are computed in full.
const MARGIN: u32 = 70;
/// The same for vertices on edges. Their two weights do not cancel, so 62 bits of each are enough; with
/// a larger margin than that, no position could be computed from them.
const EDGE_MARGIN: u32 = 60;
/// What cutting off adds to the error of a position, at most, in lattice units: on an edge as long as
/// the lattice is wide, 2 · 2⁻⁶⁰ of twice the lattice's size. (For other vertices it is
/// less: 6 · 2⁻⁷⁰ of its size, as three weights are in the numerator and three in the denominator.)
pub(crate) const OFF: f64 = 4.0 * LIMIT / (1u64 << EDGE_MARGIN) as f64;

impl Faces {
    /// The rounded position of a vertex in lattice units. Each coordinate is within three of its own
    /// roundings and [`OFF`] of the exact one, and exact along an axis if a plane perpendicular to
    /// that axis defines the vertex. All pieces, of any face, that define the vertex by the same
    /// points and planes get the same bits, whichever way their faces run.
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
        match self.weights(face, vertex) {
            Weights::Corner(point) => point,
            Weights::Edge(points, weights) => ratio(&points, &weights.map(|w| w.resize())),
            Weights::Inside(points, weights) => ratio(&points, &weights),
        }
    }
}

/// The weighted mean of lattice points, rounded.
fn ratio<const K: usize>(points: &[[f64; 3]; K], weights: &[Int<5>; K]) -> [f64; 3] {
    let total = weights.iter().fold(Int::<5>::ZERO, |sum, &w| sum + w).to_f64();
    std::array::from_fn(|axis| {
        let terms = points.iter().zip(weights);
        let sum = terms.fold(Int::<6>::ZERO, |sum, (point, weight)| {
            sum + weight.times::<1, 6>(&Int::from(point[axis] as i64))
        });
        sum.to_f64() / total
    })
}

/// Where a plane meets an edge; `None` if the leading bits do not tell.
fn on_edge(edge: &ExactEdge, plane: &Plane) -> Option<[f64; 3]> {
    let ExactEdge { ends, moved } = edge;
    let ends = ends.map(whole);
    let values = ends.map(|end| at(plane, end));
    let dropped = (bits_of(values.map(|value| value.high)) + LOW_BITS).saturating_sub(HALF);
    let [mut a, mut b] = values.map(|value| value.without(dropped) as i64);
    // What is cut off is less than 1.
    let mut error = u64::from(dropped > 0);
    let mut moves = [0.0; 2];
    if let Some(Moved { axis, offs, slope }) = moved {
        let [own_slope, slope] = [*slope, plane.normal()[*axis]].map(rounded);
        // Off by five roundings, and the plane's gain by eight.
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
            // Rounded towards 0, so that it has the same magnitude for weights of the other sign.
            sum += terms(moves.map(|by| (by * UNIT) as i64)) / (1 << HALF);
        }
        sum as f64 / total as f64
    }))
}

/// Where two planes meet that of a triangle; `None` if the leading bits do not tell.
fn meeting(triangle: &[[f64; 3]; 3], g: &Plane, h: &Plane) -> Option<[f64; 3]> {
    let triangle = triangle.map(whole);
    let (g, h) = (Leading::of(g, triangle), Leading::of(h, triangle));
    let is_exact = g.dropped == 0 && h.dropped == 0;
    let (g, h) = (g.values.map(halves), h.values.map(halves));
    // As in `vertex`, the weights are the vector product of the two triples of values.
    let mut weights = [Product::default(); 3];
    for (i, weight) in weights.iter_mut().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        *weight = Product::of(g[j], h[k], g[k], h[j]);
    }
    // All bits above the first 124 are dropped at the other end.
    let dropped = bits_of(weights.map(|weight| weight.magnitude().high));
    // A value is off by less than 1, its products with others by 2¹²⁴, and a weight by four of these.
    let inexact = if is_exact { 0 } else { 1 << (KEPT + 2).saturating_sub(dropped) };
    let error = inexact + u128::from(dropped > 0);
    mean(&triangle, &weights.map(|weight| weight.without(dropped)), error)
}

/// A lattice point's coordinates as integers.
#[inline]
fn whole(point: [f64; 3]) -> [i64; 3] {
    point.map(|c| c as i64)
}

/// The weighted mean of lattice points, rounded; `None` if that could be off because each weight is,
/// by up to `error`.
#[inline]
fn mean<const K: usize>(
    points: &[[i64; 3]; K],
    weights: &[i128; K],
    error: u128,
) -> Option<[f64; 3]> {
    let total = weights.iter().sum::<i128>();
    if total == 0 || total.unsigned_abs() >> MARGIN < error {
        return None;
    }
    let total = nearest(total, 0);
    let weights = weights.map(halves);
    let mut position = [0.0; 3];
    for (axis, coordinate) in position.iter_mut().enumerate() {
        let (mut high, mut low) = (0, 0);
        for (point, weight) in points.iter().zip(&weights) {
            let c = i128::from(point[axis]);
            high += i128::from(weight[1]) * c;
            low += i128::from(weight[0]) * c;
        }
        let sum = nearest(high + (low >> HALF), (low & LOW_HALF) as u64);
        *coordinate = sum * UNIT / total;
    }
    Some(position)
}

/// Numbers without their last bits.
struct Leading<const K: usize> {
    /// Each is the number times 2^−`dropped`, rounded towards 0: so that of a plane and its reverse
    /// they differ in sign alone. Below 2¹²⁴ in magnitude.
    values: [i128; K],
    dropped: u32,
}

impl<const K: usize> Leading<K> {
    /// A plane at some lattice points.
    #[inline]
    fn of(plane: &Plane, points: [[i64; 3]; K]) -> Self {
        let parts = points.map(|point| at(plane, point));
        let dropped = (bits_of(parts.map(|parts| parts.high)) + LOW_BITS).saturating_sub(KEPT);
        Self { values: parts.map(|parts| parts.without(dropped)), dropped }
    }
}

/// A number in two parts: `high` · 2^BITS + `low`, which is not negative.
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

/// A plane at a lattice point, see `vertex`.
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

/// How many bits the largest magnitude of some numbers has.
#[inline]
fn bits_of<const K: usize>(numbers: [i128; K]) -> u32 {
    let all = numbers.iter().fold(0, |all, number| all | number.unsigned_abs());
    128 - all.leading_zeros()
}

/// The two halves of a number, the lower one first and not negative.
#[inline]
fn halves(number: i128) -> [i64; 2] {
    [(number & LOW_HALF) as i64, (number >> HALF) as i64]
}

/// A number of up to 250 bits.
type Product = HighLow<KEPT>;

impl Product {
    /// a · b − c · d, of the halves of each.
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
        // The last bit set if any bit below is: then the conversion rounds once, as if it saw all.
        return (high | i128::from(low > 0)) as f64;
    }
    ((high << HALF | i128::from(low)) as f64) / (1u64 << HALF) as f64
}
