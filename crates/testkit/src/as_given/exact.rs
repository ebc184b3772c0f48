//! Planes and signs in big integers.

use crate::prelude::*;
use crate::vector::main_axis;
use dashu_int::IBig;

pub use crate::vector::{product, scalar, sign};

use super::scene::{Point, minus};

/// A vector of whole numbers below 2¹²⁰.
pub type Vector = [i128; 3];

pub type Big = [IBig; 3];

pub fn big(v: Vector) -> Big {
    v.map(IBig::from)
}

pub fn wide(p: Point) -> Vector {
    p.map(i128::from)
}

pub fn float(value: &IBig) -> f64 {
    value.to_f64().value()
}

/// The sign of a result in `f64` is certain if the result exceeds this share of the sum of magnitudes: a
/// hundred times the error of a dozen operations.
const BELIEVED: f64 = 1e-13;

/// Returns the sign of the determinant of three rows.
pub fn turn(rows: [&Vector; 3]) -> Ordering {
    let [a, b, c] = rows.map(|row| row.map(|x| x as f64));
    let (mut value, mut size) = (0.0, 0.0);
    for (i, x) in a.iter().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (plus, minus) = (x * b[j] * c[k], x * b[k] * c[j]);
        value += plus - minus;
        size += plus.abs() + minus.abs();
    }
    if value.abs() > BELIEVED * size {
        return if value > 0.0 { Ordering::Greater } else { Ordering::Less };
    }
    let [a, b, c] = rows.map(|&row| big(row));
    sign(&scalar(&a, &product(&b, &c)))
}

/// A plane: normal · x = offset.
#[derive(Clone, Debug)]
pub struct Plane {
    pub normal: Big,
    pub offset: IBig,
    /// The plane, rounded.
    pub rounded: [f64; 4],
}

impl Plane {
    pub fn new(normal: Big, point: Point) -> Self {
        let offset = scalar(&normal, &big(wide(point)));
        let [x, y, z] = normal.each_ref().map(float);
        let rounded = [x, y, z, float(&offset)];
        Self { normal, offset, rounded }
    }

    /// Creates the plane of a polygon: twice its area vector is the normal.
    pub fn of(polygon: &[Point]) -> Self {
        let first = polygon[0];
        let from_first = |p: Point| big(wide(minus(p, first)));
        let mut normal = [0, 0, 0].map(IBig::from);
        for pair in polygon[1..].windows(2) {
            let part = product(&from_first(pair[0]), &from_first(pair[1]));
            normal.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        }
        Self::new(normal, first)
    }

    pub fn across(axis: usize, at: i64) -> Self {
        let mut normal = [0, 0, 0].map(IBig::from);
        normal[axis] = 1.into();
        Self::new(normal, [at; 3])
    }

    /// Returns whether the normal is not zero.
    pub fn is_proper(&self) -> bool {
        self.normal.iter().any(|c| !c.is_zero())
    }

    pub fn at(&self, p: Point) -> IBig {
        scalar(&self.normal, &big(wide(p))) - &self.offset
    }

    /// Returns the first of the axes along which the normal is longest.
    pub fn main_axis(&self) -> usize {
        main_axis(&self.normal)
    }

    pub fn length(&self) -> f64 {
        let [x, y, z, _] = self.rounded;
        (x * x + y * y + z * z).sqrt()
    }

    pub fn is_same_as(&self, other: &Self) -> bool {
        let parallel = product(&self.normal, &other.normal).iter().all(Zero::is_zero);
        let axis = self.main_axis();
        parallel && &self.offset * &other.normal[axis] == &other.offset * &self.normal[axis]
    }

    /// Returns the side on which a point is.
    pub fn side(&self, spot: &Spot) -> Ordering {
        let ([a, b, c, d], [x, y, z]) = (self.rounded, spot.rounded);
        let (value, size) =
            (a * x + b * y + c * z - d, (a * x).abs() + (b * y).abs() + (c * z).abs() + d.abs());
        if value.abs() > BELIEVED * size {
            return if value > 0.0 { Ordering::Greater } else { Ordering::Less };
        }
        sign(&(scalar(&self.normal, &spot.numerators) - &self.offset * &spot.denominator))
    }

    /// Returns the distance of a point, rounded, with the sign of its side.
    pub fn distance(&self, spot: &Spot) -> f64 {
        let value = scalar(&self.normal, &spot.numerators) - &self.offset * &spot.denominator;
        float(&value) / float(&spot.denominator) / self.length()
    }
}

/// A point of fractions: numerators over a denominator above 0.
#[derive(Clone, Debug)]
pub struct Spot {
    pub numerators: Big,
    pub denominator: IBig,
    pub rounded: [f64; 3],
}

impl Spot {
    pub fn new(numerators: Big, denominator: IBig) -> Self {
        let below = float(&denominator);
        let rounded = numerators.each_ref().map(|c| float(c) / below);
        Self { numerators, denominator, rounded }
    }
}
