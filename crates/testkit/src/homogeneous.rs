//! Points as integers over one denominator: signs without reducing fractions, and sums of areas
//! in residues, so that large numbers stay affordable.

use super::rational::{Plane, Point, Rational};
use dashu_int::IBig;
use num_traits::{Euclid, Zero};
use std::cmp::Ordering;

/// A prime: equal numbers have equal residues, and others one in 2⁶¹ times.
const PRIME: u128 = (1 << 61) - 1;

/// A point: coordinates over a weight above 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Homogeneous {
    coordinates: [IBig; 3],
    weight: IBig,
}

impl Homogeneous {
    pub fn new(point: &Point) -> Self {
        let [x, y, z] = point.each_ref().map(Rational::denominator);
        let weight = IBig::from(x * y * z);
        let coordinates = point.each_ref().map(|c| c.numerator() * (&weight / c.denominator()));
        Self { coordinates, weight }
    }

    /// A number of the sign of a plane of integer coefficients here.
    pub fn side(&self, plane: &Plane) -> IBig {
        let term = |i: usize| plane.normal[i].numerator() * &self.coordinates[i];
        term(0) + term(1) + term(2) - plane.offset.numerator() * &self.weight
    }

    /// The coordinates behind an axis, and the weight: the point as seen along the axis.
    fn along(&self, axis: usize) -> [&IBig; 3] {
        let [j, k] = [(axis + 1) % 3, (axis + 2) % 3];
        [&self.coordinates[j], &self.coordinates[k], &self.weight]
    }
}

/// Which way three points turn, seen along an axis.
pub fn turn(points: [&Homogeneous; 3], axis: usize) -> Ordering {
    let [a, b, c] = points.map(|point| point.along(axis));
    let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
    let value = a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1);
    value.cmp(&IBig::zero())
}

/// Twice the area of an outline seen along an axis, as a residue.
pub fn area(outline: &[Homogeneous], axis: usize) -> u128 {
    let flat = |point: &Homogeneous| {
        let [x, y, weight] = point.along(axis).map(residue);
        let inverse = power(weight, PRIME - 2);
        [x * inverse % PRIME, y * inverse % PRIME]
    };
    let points: Vec<[u128; 2]> = outline.iter().map(flat).collect();
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).fold(0, |sum, (a, b)| {
        let (plus, minus) = (a[0] * b[1] % PRIME, a[1] * b[0] % PRIME);
        (sum + plus + PRIME - minus) % PRIME
    })
}

/// The sum of two residues.
pub fn add(a: u128, b: u128) -> u128 {
    (a + b) % PRIME
}

fn residue(value: &IBig) -> u128 {
    value.rem_euclid(&PRIME.into()).try_into().expect("below the prime")
}

fn power(mut base: u128, mut exponent: u128) -> u128 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = result * base % PRIME;
        }
        base = base * base % PRIME;
        exponent >>= 1;
    }
    result
}
