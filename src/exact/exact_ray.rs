//! A ray in integers, and where it meets planes.
//!
//! Coordinates of a ray are below 2¹²⁵, and components of a face's normal below 2¹⁰⁸ (see `plane`), so a
//! plane at a point of the ray, and along its direction, takes 236 bits, and a product of two such 472.

use std::cmp::Ordering;

use super::Int;
use super::lattice::{Lattice, exponent_of, scaled};
use super::plane::Plane;
use crate::ray::Ray;

/// A ray on the finest grid that its coordinates allow.
///
/// Its points are origin + t · direction in units of 2^−`bits` lattice steps. For a segment, t is that of
/// [`Ray`]; the direction of an endless ray has a scale of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExactRay {
    origin: [i128; 3],
    direction: [i128; 3],
    bits: u32,
    is_endless: bool,
    /// The parameter of [`Ray`] is t times two to this power.
    exponent: i32,
}

/// Bits of the largest coordinate of an endless ray's direction.
const DIRECTION_BITS: i32 = 123;

impl ExactRay {
    /// A ray on a scene's lattice. `None` if it is one that meets nothing: see [`Ray`].
    pub(crate) fn new(ray: Ray, lattice: &Lattice) -> Option<Self> {
        match ray {
            Ray::Segment { from, to } => {
                let fine = lattice.fine_points([from, to])?;
                let [origin, end] = fine.points;
                let direction = std::array::from_fn(|axis| end[axis] - origin[axis]);
                Some(Self { origin, direction, bits: fine.bits, is_endless: false, exponent: 0 })
            }
            Ray::Endless { from, direction } => {
                let fine = lattice.fine_points([from])?;
                if !direction.is_finite() {
                    return None;
                }
                let largest = direction.abs().max_element();
                let size = if largest > 0.0 { exponent_of(largest) } else { 0 };
                let up = DIRECTION_BITS - 1 - size;
                let direction = direction.to_array().map(|c| scaled(c, up).round() as i128);
                let exponent = up - lattice.exponent() - fine.bits as i32;
                let [origin] = fine.points;
                Some(Self { origin, direction, bits: fine.bits, is_endless: true, exponent })
            }
        }
    }

    /// Its origin, its direction, and the exponent of their unit, negated.
    #[cfg(test)]
    pub(crate) fn parts(&self) -> ([i128; 3], [i128; 3], u32) {
        (self.origin, self.direction, self.bits)
    }

    /// Whether a parameter is one of the ray: 0 or more, and of a segment 1 or less.
    pub(crate) fn has(&self, t: &Parameter) -> bool {
        !t.numerator.is_negative()
            && (self.is_endless || !(t.denominator - t.numerator).is_negative())
    }

    /// The last parameter; `None` if there is none.
    pub(crate) fn end(&self) -> Option<Parameter> {
        (!self.is_endless).then_some(Parameter::ONE)
    }

    /// Whether it has no length.
    pub(crate) fn is_point(&self) -> bool {
        self.direction == [0; 3]
    }

    /// A plane along the ray.
    pub(crate) fn at(&self, plane: &Plane) -> AtRay {
        let (normal, point) = (plane.normal(), plane.point());
        let along = |v: [i128; 3]| {
            let term = |i: usize| Int::<2>::from(normal[i]).times::<2, 4>(&Int::from(v[i]));
            term(0) + term(1) + term(2)
        };
        let arm = std::array::from_fn(|i| self.origin[i] - (i128::from(point[i]) << self.bits));
        AtRay { start: along(arm), slope: along(self.direction) }
    }

    /// The point of a parameter in lattice units; each coordinate is the nearest `f64`, or its neighbour
    /// where these are about as near.
    pub(crate) fn point(&self, t: &Parameter) -> [f64; 3] {
        std::array::from_fn(|i| {
            let start = t.denominator.times::<2, 6>(&Int::from(self.origin[i]));
            let way = t.numerator.times::<2, 6>(&Int::from(self.direction[i]));
            scaled(quotient(start + way, t.denominator), -(self.bits as i32))
        })
    }

    /// A parameter in the unit of [`Ray`], rounded as a coordinate of [`point`](Self::point) is.
    pub(crate) fn parameter(&self, t: &Parameter) -> f64 {
        scaled(t.to_f64(), self.exponent)
    }

    /// A parameter of an endless ray if its direction's largest coordinate had so many bits before the
    /// point, in lattice units.
    pub(crate) fn rescaled(&self, t: &Parameter, bits: i32) -> f64 {
        let up = DIRECTION_BITS - bits - self.bits as i32;
        scaled(t.to_f64(), if self.is_endless { up } else { 0 })
    }
}

/// A plane along a ray: `start` + t · `slope`, positive in front.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtRay {
    start: Int<4>,
    slope: Int<4>,
}

impl AtRay {
    /// Which side of the plane the ray begins on.
    pub(crate) fn start(&self) -> Ordering {
        self.start.sign()
    }

    /// To which side of the plane the ray goes; `Equal` if it runs along it.
    pub(crate) fn slope(&self) -> Ordering {
        self.slope.sign()
    }

    /// Where the line of the ray meets the plane; it must not run along it.
    pub(crate) fn zero(&self) -> Parameter {
        if self.slope.is_negative() {
            Parameter { numerator: self.start, denominator: -self.slope }
        } else {
            Parameter { numerator: -self.start, denominator: self.slope }
        }
    }

    /// On which side of the plane a point of the ray is.
    pub(crate) fn side(&self, t: &Parameter) -> Ordering {
        let start = self.start.times::<4, 8>(&t.denominator);
        (start + self.slope.times::<4, 8>(&t.numerator)).sign()
    }
}

/// How far along a ray a point is: a fraction, with a denominator above 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parameter {
    numerator: Int<4>,
    denominator: Int<4>,
}

impl Parameter {
    pub(crate) const ZERO: Self =
        Self { numerator: Int::ZERO, denominator: Int::from_limbs([1, 0, 0, 0]) };
    pub(crate) const ONE: Self = Self {
        numerator: Int::from_limbs([1, 0, 0, 0]),
        denominator: Int::from_limbs([1, 0, 0, 0]),
    };

    /// How two parameters compare: exact.
    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        let left = self.numerator.times::<4, 8>(&other.denominator);
        (left - other.numerator.times::<4, 8>(&self.denominator)).sign()
    }

    fn to_f64(self) -> f64 {
        quotient(self.numerator.resize(), self.denominator)
    }
}

/// A quotient, of at most 2¹³⁰ and a denominator above 0, rounded almost as if once: the quotient of the
/// rounded numbers, and that of what it leaves. So fractions of one value have one result.
fn quotient(numerator: Int<6>, denominator: Int<4>) -> f64 {
    let below = denominator.to_f64();
    let first = numerator.to_f64() / below;
    if first == 0.0 {
        return first;
    }
    // `first` = digits · 2^exponent, of 53 bits.
    let exponent = exponent_of(first.abs()) - 52;
    let digits = scaled(first, -exponent) as i64;
    let whole = denominator.times::<1, 6>(&Int::from(digits));
    let rest = if exponent >= 0 {
        (numerator - whole.shifted(exponent as u32)).to_f64() / below
    } else {
        scaled((numerator.shifted(-exponent as u32) - whole).to_f64() / below, exponent)
    };
    first + rest
}
