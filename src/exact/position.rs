//! Positions of vertices, rounded.
//!
//! The exact position is a quotient of integers of up to 380 bits, whose leading bits nearly always
//! suffice. So numbers are cut off to 124 bits as they arise, with a bound on what that loses. Where
//! the quotient could be off by more than [`OFF`], because terms cancel, it is computed in full.

use super::Int;
use super::faces::Faces;
use super::label::{PlaneId, PlaneKind, Symbol, SymbolKind};
use super::lattice::LIMIT;
use super::plane::{LOW, LOW_BITS, Plane};
use super::vertex::{Definition, Weights};

#[cfg(test)]
mod tests;

/// Bits that are kept of a number, the sign aside.
const KEPT: u32 = 124;
/// Numbers are multiplied by halves of so many bits, whose products fit 128.
const HALF: u32 = KEPT / 2;
const LOW_HALF: i128 = (1 << HALF) - 1;
/// The sum of the weights must be 2⁷⁰ times the error of one. Smaller: positions are off by more;
/// larger: more of them are computed in full.
const MARGIN: u32 = 70;
/// What cutting off adds to the error of a position, at most, in lattice units: for three weights
/// above the line of the quotient and three below, 6 · 2⁻⁷⁰ of the lattice's size.
pub(crate) const OFF: f64 = 6.0 * LIMIT / (1u128 << MARGIN) as f64;

impl Faces {
    /// The rounded position of a vertex in lattice units. Each coordinate is within three of its own
    /// roundings and [`OFF`] of the exact one, and exact along an axis if a plane perpendicular to
    /// that axis defines the vertex. All pieces, of any face, that define the vertex by the same
    /// points and planes get the same bits, whichever way their faces run.
    pub(crate) fn position(&self, face: u32, vertex: Symbol) -> [f64; 3] {
        self.position_by(face, vertex, None)
    }

    /// The same, where one of the planes that may define the vertex is at hand.
    pub(super) fn position_by(
        &self,
        face: u32,
        vertex: Symbol,
        at_hand: Option<(PlaneId, Plane)>,
    ) -> [f64; 3] {
        if let SymbolKind::Corner(k) = vertex.kind() {
            return self.corners(face)[k as usize];
        }
        let leading = match self.definition(face, vertex, at_hand) {
            Definition::Edge(ends, plane) => on_edge(&ends, &plane),
            Definition::Meeting(triangle, [g, h]) => meeting(&triangle, &g, &h),
            Definition::Corner(_) | Definition::Moved { .. } => None,
        };
        let mut position = leading.unwrap_or_else(|| self.position_in_full(face, vertex));
        let mut pin = |plane: PlaneId| {
            if let PlaneKind::Axis(axis, corner) = plane.kind() {
                position[axis] = self.corner(corner)[axis];
            }
        };
        match vertex.kind() {
            SymbolKind::Corner(_) => {}
            SymbolKind::OnEdge(_, plane) => pin(plane),
            SymbolKind::Inside(g, h) => {
                pin(g);
                pin(h);
            }
        }
        position
    }

    #[cold]
    fn position_in_full(&self, face: u32, vertex: Symbol) -> [f64; 3] {
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

/// Where a plane meets the line through two lattice points; `None` if the leading bits do not tell.
fn on_edge(ends: &[[f64; 3]; 2], plane: &Plane) -> Option<[f64; 3]> {
    let Leading { values: [a, b], dropped } = Leading::of(plane, ends);
    let error = u128::from(dropped > 0);
    mean(ends, &[-b, a], error)
}

/// Where two planes meet that of a triangle; `None` if the leading bits do not tell.
fn meeting(triangle: &[[f64; 3]; 3], g: &Plane, h: &Plane) -> Option<[f64; 3]> {
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
    mean(triangle, &weights.map(|weight| weight.without(dropped)), error)
}

/// The weighted mean of lattice points, rounded; `None` if that could be off because each weight is,
/// by up to `error`.
#[inline]
fn mean<const K: usize>(
    points: &[[f64; 3]; K],
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
            let c = i128::from(point[axis] as i64);
            high += i128::from(weight[1]) * c;
            low += i128::from(weight[0]) * c;
        }
        let sum = nearest(high + (low >> HALF), (low & LOW_HALF) as u64);
        *coordinate = sum * (1u64 << HALF) as f64 / total;
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
    /// A plane at some lattice points, see `vertex`.
    #[inline]
    fn of(plane: &Plane, points: &[[f64; 3]; K]) -> Self {
        let normal = plane.normal().map(|c| [(c & LOW) as i64, (c >> LOW_BITS) as i64]);
        let through = plane.point();
        let (mut high, mut low) = ([0i128; K], [0i128; K]);
        for (i, point) in points.iter().enumerate() {
            for axis in 0..3 {
                let arm = i128::from(point[axis] as i64 - through[axis]);
                low[i] += i128::from(normal[axis][0]) * arm;
                high[i] += i128::from(normal[axis][1]) * arm;
            }
            high[i] += low[i] >> LOW_BITS;
            low[i] &= LOW;
        }
        let dropped = (bits_of(high) + LOW_BITS).saturating_sub(KEPT);
        let mut values = [0; K];
        for (value, (high, low)) in values.iter_mut().zip(high.into_iter().zip(low)) {
            let Magnitude { is_negative, high, low } = Magnitude::of(high, low, LOW_BITS);
            let size = (high << (LOW_BITS - dropped)) + (low >> dropped);
            *value = if is_negative { -size } else { size };
        }
        Self { values, dropped }
    }
}

/// The magnitude of a number in two parts.
struct Magnitude {
    is_negative: bool,
    high: i128,
    low: i128,
}

impl Magnitude {
    /// Of `high` · 2^bits + `low`, with `low` from 0 to 2^bits.
    #[inline]
    fn of(high: i128, low: i128, bits: u32) -> Self {
        match (high < 0, low == 0) {
            (false, _) => Self { is_negative: false, high, low },
            (true, true) => Self { is_negative: true, high: -high, low },
            (true, false) => Self { is_negative: true, high: -high - 1, low: (1 << bits) - low },
        }
    }
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

/// A number of up to 250 bits: `high` · 2¹²⁴ + `low`, which is not negative.
#[derive(Clone, Copy, Debug, Default)]
struct Product {
    high: i128,
    low: i128,
}

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

    /// The number times 2^−`dropped`, rounded towards 0; `dropped` are the bits of `high`, so that 124
    /// are left.
    #[inline]
    fn without(self, dropped: u32) -> i128 {
        let Magnitude { is_negative, high, low } = self.magnitude();
        let size = match KEPT.checked_sub(dropped) {
            Some(up) => (high << up) + (low >> dropped),
            None => high >> (dropped - KEPT),
        };
        if is_negative { -size } else { size }
    }

    #[inline]
    fn magnitude(&self) -> Magnitude {
        Magnitude::of(self.high, self.low, KEPT)
    }
}

/// The nearest `f64` to `high` + `low` · 2⁻⁶², ties to even; `low` is below 2⁶².
#[inline]
fn nearest(high: i128, low: u64) -> f64 {
    let (mut magnitude, mut fraction) = (high.unsigned_abs(), low);
    if high < 0 && low > 0 {
        (magnitude, fraction) = (magnitude - 1, (1 << HALF) - low);
    }
    let lead = magnitude.leading_zeros();
    // The leading 64 bits, and the last of them set if any bit below is: the conversion then rounds
    // once, as if it saw every bit.
    let (bits, exponent) = if lead >= 64 {
        // `fraction` has bits among the leading ones.
        let all = magnitude << HALF | u128::from(fraction);
        let lead = all.leading_zeros();
        let all = all.checked_shl(lead).unwrap_or(0);
        ((all >> 64) as u64 | u64::from(all as u64 != 0), 64 - lead as i32 - HALF as i32)
    } else {
        let all = magnitude << lead;
        ((all >> 64) as u64 | u64::from(all as u64 != 0 || fraction != 0), 64 - lead as i32)
    };
    let value = bits as f64 * f64::from_bits(((1023 + exponent) as u64) << 52);
    if high < 0 { -value } else { value }
}
