//! A viewpoint on the lattice, and the sides of planes on which it lies; a ray in integers and its
//! intersections with planes.

use std::cmp::Ordering;

use super::lattice::{Lattice, exponent_of, scaled, two_sum};
use super::plane::Plane;
use super::{Faces, Int, PlaneId};
use crate::viewpoint::{Ray, Viewpoint};

/// A viewpoint in lattice units, rounded once: the point integer · 2^shift. Without a shift, the integers are
/// the direction to an eye at infinity.
///
/// An eye within about 500 extents of the scene is rounded to the lattice, whose step is 2⁻⁵² of the extent.
/// An eye further away is rounded to one part in 2⁶¹ of its distance. Directions are rounded to one part in
/// 2⁵² of their largest component. Eyes beyond 2⁴²¹ lattice units are treated as directions. If the direction
/// is parallel to a plane, the eye is on the side on which the lattice's origin lies. A NaN coordinate counts
/// as 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    integer: [i64; 3],
    shift: Option<u32>,
    float: [f64; 3],
}

/// The largest magnitude of an eye's integers is two to this power. Eyes within that distance need no shift.
const NEAR_BITS: i32 = 61;
const NEAR: f64 = (1u64 << NEAR_BITS) as f64;
/// The largest shift. For eyes further away, the planes' offsets do not matter: only the direction does.
const LARGEST_SHIFT: u32 = 360;

/// The largest component of a direction is scaled to a magnitude from 2ᵏ to 2ᵏ⁺¹, where k is this number.
const DIRECTION_BITS: i32 = 52;

impl Eye {
    /// Creates a viewpoint on a scene's lattice.
    pub fn new(viewpoint: Viewpoint, lattice: &Lattice) -> Self {
        match viewpoint {
            Viewpoint::Eye(point) => Self::at(lattice.exactly(point)),
            Viewpoint::Direction(direction) => {
                let number = |c: f64| if c.is_nan() { 0.0 } else { c };
                Self::towards(direction.to_array().map(|c| -number(c)))
            }
        }
    }

    /// The eye at a point in lattice units, each coordinate a number and its rounding error.
    fn at(point: [[f64; 2]; 3]) -> Self {
        // Not less than the exact size, and beyond the same powers of two as the exact size.
        let size = largest(point.map(|[c, lost]| {
            let is_outwards = if c > 0.0 { lost > 0.0 } else { lost < 0.0 };
            if is_outwards { c.abs().next_up() } else { c }
        }));
        let Some(shift) = shift_of(size) else { return Self::towards(point.map(|[c, _]| c)) };
        let unit = 2f64.powi(-(shift as i32));
        let integer = point.map(|[c, lost]| nearest_integer(c * unit, lost * unit));
        let float = integer.map(|c| c as f64 / unit);
        Self { integer, shift: Some(shift), float }
    }

    /// An eye infinitely far away in a direction.
    fn towards(direction: [f64; 3]) -> Self {
        // An infinite component outweighs all finite components.
        let finite = if largest(direction).is_infinite() {
            direction.map(|c| if c.is_infinite() { c.signum() } else { 0.0 })
        } else {
            direction
        };
        let size = largest(finite);
        let direction = if size > 0.0 { finite } else { [0.0, 0.0, 1.0] };
        // Scaled by a power of two, so that a direction of short numbers stays exactly parallel to the same
        // planes.
        let exponent = DIRECTION_BITS - exponent_of(largest(direction));
        let integer = direction.map(|c| scaled(c, exponent).round() as i64);
        let unit = (1i64 << DIRECTION_BITS) as f64;
        Self { integer, shift: None, float: integer.map(|c| c as f64 / unit) }
    }

    /// Returns the integer part: lattice units over 2^shift, or a direction.
    pub fn integer(&self) -> [i64; 3] {
        self.integer
    }

    /// Returns the exponent of the power of two to multiply the integer part by; `None` for an eye at
    /// infinity.
    pub fn shift(&self) -> Option<u32> {
        self.shift
    }

    /// Returns the eye in homogeneous coordinates. For an eye at a point: the point in lattice units, rounded
    /// again to `f64`, and 1. For an eye at infinity: the direction towards the eye, and 0.
    pub fn homogeneous(&self) -> ([f64; 3], f64) {
        (self.float, if self.shift.is_some() { 1.0 } else { 0.0 })
    }
}

impl Faces {
    /// Returns the side of a plane on which an eye lies.
    pub fn eye_side(&self, plane: PlaneId, eye: &Eye) -> Ordering {
        self.plane(plane).at_eye(eye)
    }
}

impl Plane {
    /// The side of the plane on which an eye lies: `Greater` is in front.
    pub(crate) fn at_eye(&self, eye: &Eye) -> Ordering {
        let p = self.point();
        match eye.shift() {
            // Near: both products fit three limbs.
            Some(0) => {
                let e = eye.integer();
                let side = self.along(e) - self.along(p);
                side.sign()
            }
            Some(shift) => {
                let far = self.along(eye.integer()).shifted::<9>(shift);
                (far - self.along(p).resize()).sign()
            }
            None => {
                let side = self.along(eye.integer()).sign();
                if side.is_ne() { side } else { self.along(p).sign().reverse() }
            }
        }
    }

    /// The side of the plane that an eye sees: `Greater` is the front, and `Equal` is neither. The eye sees
    /// the side on which it lies, except that an eye at infinity along the plane sees the plane edge-on.
    pub(crate) fn facing(&self, eye: &Eye) -> Ordering {
        match eye.shift() {
            Some(_) => self.at_eye(eye),
            None => self.along(eye.integer()).sign(),
        }
    }
}

/// The exponent of the least power of two by which to divide a size, so that it is at most [`NEAR`]; `None`
/// if the exponent is larger than [`LARGEST_SHIFT`].
fn shift_of(size: f64) -> Option<u32> {
    if size <= NEAR {
        return Some(0);
    }
    let exponent = exponent_of(size / NEAR);
    // A power of two itself is within the limit, and no larger size is.
    let shift = exponent as u32 + u32::from(scaled(NEAR, exponent) < size);
    (shift <= LARGEST_SHIFT).then_some(shift)
}

fn largest(v: [f64; 3]) -> f64 {
    v.into_iter().fold(0.0, |max, c| max.max(c.abs()))
}

/// The integer nearest to a number and its rounding error, ties away from zero.
fn nearest_integer(rounded: f64, lost: f64) -> i64 {
    let whole = rounded.trunc();
    // A number that is not whole has a rounding error of less than the distance to the next number.
    let (rest, lost) = two_sum(rounded - whole, lost);
    let nearest = match (rest - rest.trunc()).abs() == 0.5 {
        true if lost > 0.0 || lost == 0.0 && rounded > 0.0 => rest.ceil(),
        true => rest.floor(),
        false => rest.round(),
    };
    whole as i64 + nearest as i64
}

/// A ray on the finest grid that its coordinates allow.
///
/// The points of the ray are origin + t · direction in units of 2^−`bits` lattice steps. For a segment, t is
/// the parameter of [`Ray`]; the direction of an endless ray has a separate scale.
///
/// Coordinates of a ray are below 2¹²⁵, and components of a face's normal below 2¹⁰⁸ (see `plane`), so the
/// value of a plane at a point of the ray, and its slope along the ray, take 236 bits each. A product of two
/// such numbers takes 472 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExactRay {
    origin: [i128; 3],
    direction: [i128; 3],
    bits: u32,
    is_endless: bool,
    /// The parameter of [`Ray`] is t times two to this power.
    exponent: i32,
}

/// The number of bits of the largest coordinate of an endless ray's direction.
const RAY_BITS: i32 = 123;

impl ExactRay {
    /// A ray on a scene's lattice. `None` if the ray cannot meet anything; see [`Ray`].
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
                let up = RAY_BITS - 1 - size;
                let direction = direction.to_array().map(|c| scaled(c, up).round() as i128);
                let exponent = up - lattice.exponent() - fine.bits as i32;
                let [origin] = fine.points;
                Some(Self { origin, direction, bits: fine.bits, is_endless: true, exponent })
            }
        }
    }

    /// The origin, the direction, and the exponent of their unit, negated.
    #[cfg(test)]
    pub(crate) fn parts(&self) -> ([i128; 3], [i128; 3], u32) {
        (self.origin, self.direction, self.bits)
    }

    /// Whether a parameter belongs to the ray: 0 or more, and for a segment 1 or less.
    pub(crate) fn has(&self, t: &Parameter) -> bool {
        !t.numerator.is_negative()
            && (self.is_endless || !(t.denominator - t.numerator).is_negative())
    }

    /// The last parameter; `None` for an endless ray.
    pub(crate) fn end(&self) -> Option<Parameter> {
        (!self.is_endless).then_some(Parameter::ONE)
    }

    /// Whether the ray has no length.
    pub(crate) fn is_point(&self) -> bool {
        self.direction == [0; 3]
    }

    /// A plane, as a function of the parameter along the ray.
    pub(crate) fn at(&self, plane: &Plane) -> AtRay {
        let (normal, point) = (plane.normal(), plane.point());
        let along = |v: [i128; 3]| {
            let term = |i: usize| Int::<2>::from(normal[i]).times::<2, 4>(&Int::from(v[i]));
            term(0) + term(1) + term(2)
        };
        let arm = std::array::from_fn(|i| self.origin[i] - (i128::from(point[i]) << self.bits));
        AtRay { start: along(arm), slope: along(self.direction) }
    }

    /// The point of a parameter in lattice units; each coordinate is the nearest `f64`, or the second nearest
    /// if the two are about equally near.
    pub(crate) fn point(&self, t: &Parameter) -> [f64; 3] {
        std::array::from_fn(|i| {
            let start = t.denominator.times::<2, 6>(&Int::from(self.origin[i]));
            let way = t.numerator.times::<2, 6>(&Int::from(self.direction[i]));
            scaled(quotient(start + way, t.denominator), -(self.bits as i32))
        })
    }

    /// A parameter in the unit of [`Ray`], rounded like a coordinate of [`point`](Self::point).
    pub(crate) fn parameter(&self, t: &Parameter) -> f64 {
        scaled(t.to_f64(), self.exponent)
    }

    /// Converts a parameter to `f64`. For an endless ray, scales it as if the largest coordinate of the
    /// direction, in lattice units, had `bits` bits before the binary point.
    pub(crate) fn rescaled(&self, t: &Parameter, bits: i32) -> f64 {
        let up = RAY_BITS - bits - self.bits as i32;
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
    /// The side of the plane on which the ray begins.
    pub(crate) fn start(&self) -> Ordering {
        self.start.sign()
    }

    /// The side of the plane to which the ray leads; `Equal` if the ray is parallel to the plane.
    pub(crate) fn slope(&self) -> Ordering {
        self.slope.sign()
    }

    /// The parameter where the line of the ray meets the plane. The ray must not be parallel to the plane.
    pub(crate) fn zero(&self) -> Parameter {
        if self.slope.is_negative() {
            Parameter { numerator: self.start, denominator: -self.slope }
        } else {
            Parameter { numerator: -self.start, denominator: self.slope }
        }
    }

    /// The side of the plane on which a point of the ray lies.
    pub(crate) fn side(&self, t: &Parameter) -> Ordering {
        let start = self.start.times::<4, 8>(&t.denominator);
        (start + self.slope.times::<4, 8>(&t.numerator)).sign()
    }
}

/// The parameter of a point of a ray: a fraction, with a denominator above 0.
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

    /// Compares two parameters, exactly.
    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        let left = self.numerator.times::<4, 8>(&other.denominator);
        (left - other.numerator.times::<4, 8>(&self.denominator)).sign()
    }

    fn to_f64(self) -> f64 {
        quotient(self.numerator.resize(), self.denominator)
    }
}

/// A quotient rounded almost as if once: the quotient of the rounded numbers, plus the quotient of the
/// remainder. So equal fractions have equal results. The quotient must be at most 2¹³⁰, and the denominator
/// above 0.
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

#[cfg(test)]
mod tests {
    use super::{Eye, LARGEST_SHIFT, NEAR, largest, shift_of};
    use crate::random::SplitMix64;

    #[test]
    fn directions_are_rounded_to_the_nearest() {
        let unit = (1_i64 << 52) as f64;
        // The largest component is a power of two, so the expected values are the other components in units
        // of the last bit.
        for (part, nearest) in [(0.25, 0), (0.75, 1), (-0.75, -1), (6.75, 7), (-6.25, -6)] {
            let eye = Eye::towards([1.0, part / unit, -part / unit]);
            assert_eq!(eye.integer(), [1 << 52, nearest, -nearest], "{part}");
        }
    }

    /// Directions scaled by powers of two.
    #[test]
    fn directions_of_short_numbers_are_kept() {
        for short in [[3i32, 2, 1], [-7, 5, 0], [0, 0, 11], [1023, -1, 640]] {
            for exponent in [0, 1, -3, 1000, -1060] {
                let given = short.map(|c| super::scaled(f64::from(c), exponent));
                let found = Eye::towards(given).integer();
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    let [a, b] = [found[i], found[j]].map(i128::from);
                    let [c, d] = [short[i], short[j]].map(i128::from);
                    assert_eq!(a * d, b * c, "{given:?}");
                }
                assert!((0..3).all(|i| found[i].signum() == i64::from(short[i]).signum()));
            }
        }
    }

    /// Tests sizes at and near every power of two, and random sizes.
    #[test]
    fn a_far_eye_is_halved_until_it_is_near() {
        let halved = |mut size: f64| {
            (0..=LARGEST_SHIFT).find(|_| {
                let is_near = size <= NEAR;
                size /= 2.0;
                is_near
            })
        };
        let powers = (-1074..1024).map(|exponent| super::scaled(1.0, exponent));
        let beside = powers.flat_map(|size| [size.next_down(), size, size.next_up()]);
        let mut random = SplitMix64::new(1);
        let others =
            (0..2000).map(|_| super::scaled(random.range(1.0, 2.0), (random.next() % 900) as i32));
        let mut shifts = [0; 3];
        for size in beside.chain(others).chain([0.0, f64::MAX, f64::INFINITY]) {
            let shift = shift_of(size);
            assert_eq!(shift, halved(size), "{size:e}");
            shifts[shift.map_or(2, |shift| usize::from(shift > 0))] += 1;
            let eye = Eye::at([size, -0.5 * size, 1.0].map(|c| [c, 0.0]));
            assert_eq!(eye.shift(), shift, "{size:e}");
            if shift.is_some() {
                let largest = largest(eye.integer().map(|c| c as f64));
                assert!(largest <= NEAR && (shift == Some(0) || largest >= 0.5 * NEAR), "{size:e}");
            }
        }
        assert!(shifts.iter().all(|&count| count > 1000), "{shifts:?}");
    }
}
