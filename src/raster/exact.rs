//! Planes in integers, evaluated at exact rays.
//!
//! Planes are computed here from the lattice points that define them, by other formulas and integers than for
//! building trees: rows of signed digits. A product or a sum is first computed digit by digit in 128 bits,
//! without carries; carries are propagated once, at the end. [`Int`](crate::exact::Int) is in two's
//! complement and carries in every step, so a mistake in one type is not repeated in the other.
//!
//! With coordinates below 2⁵¹, a normal has 106 bits and an offset 158; φ and κ (see [`line`](super::line))
//! stay below 2²⁰⁷, and a determinant of φ and κ below 2³⁶⁰.

use std::cmp::Ordering;

use super::rays::{Given, RayOrigin, Rays};
use crate::exact::{Faces, PlaneId, PlaneKind};

/// A plane: the points x with normal · x = offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    normal: [i128; 3],
    offset: Short,
}

impl Plane {
    /// A plane of the scene.
    pub(super) fn new(faces: &Faces, plane: PlaneId) -> Self {
        match plane.kind() {
            PlaneKind::Face(face) => Self::of(faces, face),
            PlaneKind::Axis(axis, corner) => {
                let mut normal = [0; 3];
                normal[axis] = 1;
                Self::with(normal, integer(faces.corner(corner)))
            }
        }
    }

    /// The plane of a face, through its reference triangle p, q, r. The normal is computed as the sum of p ×
    /// q, q × r and r × p, which is (q − p) × (r − p).
    pub(super) fn of(faces: &Faces, face: u32) -> Self {
        let [p, q, r] = faces.reference_triangle(face).map(|corner| integer(faces.corner(corner)));
        let (pq, qr, rp) = (cross(p, q), cross(q, r), cross(r, p));
        let normal = std::array::from_fn(|i| pq[i] + qr[i] + rp[i]);
        Self { normal, offset: dot(qr, p) }
    }

    /// The plane through two lattice points and along an axis. Seen against the axis, the plane's front is to
    /// the right of the line from `a` to `b`.
    pub(super) fn upright(a: [f64; 3], b: [f64; 3], axis: usize) -> Self {
        let (a, b) = (integer(a), integer(b));
        let mut along = [0; 3];
        along[axis] = 1;
        Self::with(cross(std::array::from_fn(|i| b[i] - a[i]), along), a)
    }

    fn with(normal: [i128; 3], point: [i128; 3]) -> Self {
        Self { normal, offset: dot(normal, point) }
    }

    /// The normal, rounded.
    pub(super) fn normal(&self) -> glam::DVec3 {
        glam::DVec3::from_array(self.normal.map(|c| c as f64))
    }

    /// κ: for a perspective, the value of the plane at the eye; for parallel rays, the slope of that value
    /// along the rays.
    pub(super) fn kappa(&self, rays: &Rays) -> Short {
        match rays.pencil {
            RayOrigin::From { eye, shift } => {
                dot(self.normal, eye.map(|c| i128::from(c) << shift)) - self.offset
            }
            RayOrigin::Along { direction } => dot(self.normal, direction.map(i128::from)),
        }
    }

    /// φ at a ray's parameter.
    pub(super) fn phi(&self, given: Given) -> Short {
        match given {
            Given::Step(v) => dot(self.normal, v.map(i128::from)),
            Given::Point(v) => dot(self.normal, v.map(i128::from)) - self.offset,
        }
    }
}

/// Two planes f and h with their κ, which are the same for all rays of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanePair {
    pub(super) planes: [Plane; 2],
    pub(super) kappas: [Short; 2],
}

/// Two planes at a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanePairAt {
    pub(super) phis: [Short; 2],
    /// κ_f φ_h − κ_h φ_f.
    pub(super) determinant: Long,
}

impl PlanePair {
    pub(super) fn new(rays: &Rays, planes: [Plane; 2]) -> Self {
        Self { planes, kappas: planes.each_ref().map(|plane| plane.kappa(rays)) }
    }

    pub(super) fn at(&self, given: Given) -> PlanePairAt {
        let phis = self.planes.each_ref().map(|plane| plane.phi(given));
        let [above, below] = [0, 1].map(|i| [&self.kappas[i], &phis[i]]);
        PlanePairAt { phis, determinant: determinant([above, below]) }
    }

    /// The side of the first plane on which a ray meets the second plane, ahead of the eye: the sign of
    /// sgn κ_h · (κ_h φ_f − κ_f φ_h).
    pub(super) fn side_of_first(&self, given: Given) -> Ordering {
        let across = self.at(given).determinant.sign();
        if self.kappas[1].sign().is_lt() { across } else { across.reverse() }
    }

    /// The divisors of lengths along rays: φ for a perspective, κ for parallel rays. Rounded.
    pub(super) fn divisors(&self, rays: &Rays, at: &PlanePairAt) -> [f64; 2] {
        let values = if rays.is_perspective() { at.phis } else { self.kappas };
        values.map(|value| value.to_f64())
    }
}

/// The volume that a ray spans with the edge from `a` to `b`, in 190 bits. For a perspective it is direction
/// · (a × b − eye × (b − a)). For parallel rays it is (a − point) · ((b − a) × direction).
pub(super) fn volume(rays: &Rays, [a, b]: [[f64; 3]; 2], given: Given) -> Short {
    let (a, b) = (integer(a), integer(b));
    let arm = std::array::from_fn(|i| b[i] - a[i]);
    match (rays.pencil, given) {
        (RayOrigin::From { eye, shift }, Given::Step(v) | Given::Point(v)) => {
            let v = v.map(i128::from);
            dot(cross(a, b), v) - dot(cross(arm, v), eye.map(|c| i128::from(c) << shift))
        }
        (RayOrigin::Along { direction }, Given::Step(v)) => {
            dot(cross(direction.map(i128::from), arm), v.map(i128::from))
        }
        (RayOrigin::Along { direction }, Given::Point(v)) => {
            let to = std::array::from_fn(|i| i128::from(v[i]) - a[i]);
            dot(cross(direction.map(i128::from), arm), to)
        }
    }
}

fn integer(point: [f64; 3]) -> [i128; 3] {
    point.map(|c| c as i128)
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The bits of a digit. A lattice coordinate fits one digit. The sum of 2²⁰ products of two digits fits 128
/// bits.
const BITS: u32 = 52;
const HALF: i128 = 1 << (BITS - 1);

/// The sum of digitᵢ · 2⁵²ⁱ, each digit from −2⁵¹ to 2⁵¹ − 1.
///
/// Nothing checks for overflow in release builds: N digits store magnitudes below 2^(52 N − 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Digits<const N: usize>([i64; N]);

/// Enough for a plane at an eye or at a ray: 207 bits.
pub(super) type Short = Digits<4>;
/// Enough for a product of two [`Short`]s.
pub(super) type Long = Digits<8>;

impl<const N: usize> Digits<N> {
    /// Carries: converts coefficients of powers of 2⁵², each of which may be far larger than a digit.
    fn carried(coefficients: [i128; N]) -> Self {
        let mut carry = 0;
        let digits = coefficients.map(|coefficient| {
            let sum = coefficient + carry;
            // The digit whose difference from the coefficient is a multiple of 2⁵².
            let digit = ((sum + HALF) & (2 * HALF - 1)) - HALF;
            carry = (sum - digit) >> BITS;
            digit as i64
        });
        debug_assert_eq!(carry, 0, "the value does not fit {N} digits");
        Self(digits)
    }

    /// The sign of the leading digit, which outweighs all others.
    pub(super) fn sign(&self) -> Ordering {
        self.0.iter().rev().find(|&&digit| digit != 0).map_or(Ordering::Equal, |d| d.cmp(&0))
    }

    /// The value, rounded once for each digit.
    pub(super) fn to_f64(self) -> f64 {
        let radix = 2.0 * HALF as f64;
        self.0.iter().rev().fold(0.0, |sum, &digit| sum * radix + digit as f64)
    }
}

impl<const N: usize> std::ops::Sub for Digits<N> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::carried(std::array::from_fn(|i| i128::from(self.0[i]) - i128::from(other.0[i])))
    }
}

/// The scalar product of two vectors. Components of `a` are below 2¹²⁰, components of `b` are below 2⁸⁵, and
/// the product is below 2²⁰⁷.
pub(super) fn dot(a: [i128; 3], b: [i128; 3]) -> Short {
    let mut sums = [0; 4];
    for (a, b) in a.into_iter().zip(b) {
        let (Digits(a), Digits(b)) = (Digits::carried([a, 0, 0]), Digits::<2>::carried([b, 0]));
        for (i, &p) in a.iter().enumerate() {
            for (j, &q) in b.iter().enumerate() {
                sums[i + j] += i128::from(p) * i128::from(q);
            }
        }
    }
    Digits::carried(sums)
}

/// a·d − b·c.
pub(super) fn determinant([[a, b], [c, d]]: [[&Short; 2]; 2]) -> Long {
    let mut sums = [0; 8];
    for i in 0..4 {
        for j in 0..4 {
            sums[i + j] +=
                i128::from(a.0[i]) * i128::from(d.0[j]) - i128::from(b.0[i]) * i128::from(c.0[j]);
        }
    }
    Digits::carried(sums)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_int::IBig;
    use proptest::prelude::*;

    fn big<const N: usize>(value: &Digits<N>) -> IBig {
        value.0.iter().rev().fold(IBig::ZERO, |sum, &digit| (sum << BITS as usize) + digit)
    }

    /// Integers below 2^bits in magnitude, often next to a power of 2, where carries propagate through all
    /// digits.
    fn integer(bits: u32) -> impl Strategy<Value = i128> {
        let power = (0..bits, -1..=1i128, any::<bool>());
        let power = power.prop_map(|(k, off, minus)| {
            let value = (1i128 << k) + off;
            if minus { -value } else { value }
        });
        let limit = 1i128 << bits;
        prop_oneof![power, -limit + 1..limit]
    }

    fn vector(bits: u32) -> impl Strategy<Value = [i128; 3]> {
        [integer(bits), integer(bits), integer(bits)]
    }

    fn big_dot(a: [i128; 3], b: [i128; 3]) -> IBig {
        a.into_iter().zip(b).map(|(a, b)| IBig::from(a) * IBig::from(b)).sum()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn digits_agree_with_a_bignum(
            [a, c] in [vector(119), vector(105)], [b, d] in [vector(84), vector(61)],
        ) {
            let (p, q) = (dot(a, b), dot(c, d));
            let (x, y) = (big_dot(a, b), big_dot(c, d));
            prop_assert_eq!(big(&p), x.clone());
            prop_assert_eq!(big(&(p - q)), &x - &y);
            let product = determinant([[&p, &q], [&q, &p]]);
            let expected = &x * &x - &y * &y;
            prop_assert_eq!(big(&product), expected.clone());
            for (value, exact) in [(p.sign(), &x), (q.sign(), &y), (product.sign(), &expected)] {
                prop_assert_eq!(value, exact.cmp(&IBig::ZERO));
            }
            for (value, exact) in [(p.to_f64(), &x), (product.to_f64(), &expected)] {
                let exact = exact.to_f64().value();
                prop_assert!((value - exact).abs() <= 4.0 * f64::EPSILON * exact.abs());
            }
        }

        #[test]
        fn equal_values_cancel_to_zero(a in vector(105), b in vector(82)) {
            let value = dot(a, b);
            prop_assert_eq!((value - value).sign(), Ordering::Equal);
            let nothing = determinant([[&value, &value], [&value, &value]]);
            prop_assert_eq!((nothing.sign(), nothing.to_f64()), (Ordering::Equal, 0.0));
            let next = dot(a, b) - dot([1, 0, 0], [1, 0, 0]);
            prop_assert_eq!((value - next).sign(), Ordering::Greater);
            prop_assert_eq!((next - value).sign(), Ordering::Less);
        }
    }
}
