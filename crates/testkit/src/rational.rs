//! Points and planes in exact rationals.

use super::vector;
use binspace::glam::DVec3;
use binspace::internals::Lattice;
use dashu_int::IBig;
use dashu_ratio::RBig;
use num_traits::{FromPrimitive, Signed, Zero};

pub use super::vector::{difference, product, scalar, sign, sum};

pub type Rational = RBig;
pub type Point = [Rational; 3];
pub type Plane = vector::Plane<Rational>;

/// Returns the exact value of a finite `f64`.
pub fn exact(value: f64) -> Rational {
    Rational::from_f64(value).expect("finite")
}

/// Returns the exact value of a lattice coordinate.
pub fn integer(value: f64) -> IBig {
    assert_eq!(value.fract(), 0.0, "a lattice coordinate");
    IBig::from_f64(value).expect("finite")
}

/// Returns the exact value of a point.
pub fn point(p: impl Into<DVec3>) -> Point {
    p.into().to_array().map(exact)
}

/// Returns the length of a lattice step in the world: a power of two, which may be too small for `f64`.
pub fn step(lattice: &Lattice) -> Rational {
    /// The length of this many steps is an exact `f64`.
    const MANY: f64 = (1u128 << 100) as f64;
    let one = lattice.length_to_world(1.0);
    if one >= 1.0 {
        return exact(one);
    }
    exact(lattice.length_to_world(MANY)) / exact(MANY)
}

/// Returns the sum of some numbers.
pub fn total(numbers: impl IntoIterator<Item = Rational>) -> Rational {
    numbers.into_iter().fold(Rational::zero(), |sum, number| sum + number)
}

/// Returns twice the vector area of a closed outline.
pub fn area(outline: &[Point]) -> Point {
    let zero = [Rational::zero(), Rational::zero(), Rational::zero()];
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).fold(zero, |total, (a, b)| {
        let (a, b) = (difference(a, &outline[0]), difference(b, &outline[0]));
        sum(&total, &product(&a, &b))
    })
}

/// Returns the largest difference between the coordinates of an exact point and of a rounded point.
pub fn distance_to_rounded(exact_point: &Point, rounded: [f64; 3]) -> f64 {
    let offsets = (0..3).map(|i| (&exact_point[i] - exact(rounded[i])).abs());
    offsets.map(|offset| offset.to_f64().value()).fold(0.0, f64::max)
}

/// Returns a plane perpendicular to an axis.
pub fn perpendicular_to_axis(axis: usize, at: &Point) -> Plane {
    let mut normal = [Rational::zero(), Rational::zero(), Rational::zero()];
    normal[axis] = Rational::from(1);
    Plane { normal, offset: at[axis].clone() }
}

/// Returns the point in which three planes meet.
pub fn meeting(a: &Plane, b: &Plane, c: &Plane) -> Point {
    let pairs = [(b, c), (c, a), (a, b)].map(|(g, h)| product(&g.normal, &h.normal));
    let determinant = scalar(&a.normal, &pairs[0]);
    assert!(!determinant.is_zero(), "three planes that meet in a point");
    std::array::from_fn(|i| {
        let numerator =
            &pairs[0][i] * &a.offset + &pairs[1][i] * &b.offset + &pairs[2][i] * &c.offset;
        numerator / &determinant
    })
}

/// Returns the point of a segment in which it crosses a plane, given the plane at both ends.
pub fn crossing([a, b]: [&Point; 2], [at_a, at_b]: [&Rational; 2]) -> Point {
    let total = at_a - at_b;
    std::array::from_fn(|i| (at_a * &b[i] - at_b * &a[i]) / &total)
}
