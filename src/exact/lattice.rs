//! The scene lattice: corners are rounded to the lattice once, and every later step is exact. Points and
//! half-spaces of queries are rounded more finely.

use glam::DVec3;
use smallvec::SmallVec;

use super::Int;

/// The largest magnitude of a lattice coordinate.
pub const LIMIT: f64 = (1u64 << 51) as f64;

/// A distance from the world's origin, in steps. This far away, two neighbouring `f64` are further apart than
/// the scene is wide: 2¹¹⁰ · 2⁻⁵² > 2⁵². Too large: coordinates that no longer fit integers are treated as if
/// they did. Too small: a scene far from the origin loses coordinates that differ.
pub(super) const FAR_ORIGIN: f64 = (1u128 << 110) as f64;

/// The largest coplanar tolerance, in lattice units: about 1/256 of the extent. Larger tolerances are reduced
/// to this length, so that corners moved onto a plane fit the integers of the exact predicates.
pub(crate) const MAX_TOLERANCE: f64 = LIMIT / 128.0;
/// More than the largest coordinate of any corner or vertex: the largest tolerance moves a corner by at most
/// √3 of the tolerance, to 1.0136 times the limit.
pub(crate) const MAX_CORNER: f64 = 1.014 * LIMIT;

/// A cubic grid over a scene, so fine that rounding moves no corner by more than 2⁻⁵² of the scene's extent.
///
/// A lattice coordinate is an integer of magnitude at most 2⁵¹. Such an integer is exact as an `i64` and as
/// an `f64`, and so is the difference of two such integers. The grid's spacing is a power of two, so scenes
/// in `f32`, on integers, or far from the origin are usually not moved at all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lattice {
    /// Lattice coordinate = world coordinate · steps − origin.
    pub(super) steps: PowerOfTwo,
    /// The origin, in steps; integers.
    pub(super) origin: [f64; 3],
    /// The coordinate that all corners have along an axis, if the scene is so far from the origin that
    /// corners of a scene of its size cannot have different coordinates. Otherwise 0.
    pub(super) far: [f64; 3],
}

impl Lattice {
    /// Creates the lattice of a scene with the given bounding box, whose corners must be finite.
    pub fn new(min: DVec3, max: DVec3) -> Self {
        // Halved before they are combined, so that nothing overflows.
        let centre = min * 0.5 + max * 0.5;
        // Not half the extent: in a box a few ulps wide the centre is rounded to one of the sides.
        let radius = (max - centre).max(centre - min).max_element();
        // In steps the radius is less than 2^51, by at least a quarter of a step. The centre and a
        // corner are rounded by half a step each, so that coordinates reach 2^51 at most.
        let exponent = if radius > 0.0 {
            50 - exponent_of(radius)
        } else if centre != DVec3::ZERO {
            52 - exponent_of(centre.abs().max_element())
        } else {
            0
        };
        let steps = PowerOfTwo::new(exponent);
        let far =
            centre.to_array().map(|c| if steps.times(c).abs() > FAR_ORIGIN { c } else { 0.0 });
        let origin = std::array::from_fn(|axis| match far[axis] {
            0.0 => steps.times(centre[axis]).round(),
            _ => 0.0,
        });
        Self { steps, origin, far }
    }

    /// Returns the lattice point nearest to a point of the scene's bounding box.
    #[inline]
    pub fn snap(&self, point: DVec3) -> [f64; 3] {
        let world = point.to_array();
        // The difference of two integers is exact if it fits an f64. Adding 0 turns −0 into 0.
        std::array::from_fn(|axis| {
            nearest(self.steps.times(world[axis] - self.far[axis])) - self.origin[axis] + 0.0
        })
    }

    /// Converts any point to lattice units, rounded to `f64` once. The point may be far away, even infinite.
    pub fn to_lattice(&self, point: DVec3) -> [f64; 3] {
        let world = point.to_array();
        std::array::from_fn(|axis| {
            self.steps.times(world[axis] - self.far[axis]) - self.origin[axis]
        })
    }

    /// Any point in lattice units, exactly: each coordinate as a number and its rounding error. A coordinate
    /// that is infinite, or beyond the range of `f64`, has error 0. NaN counts as 0.
    pub(super) fn exactly(&self, point: DVec3) -> [[f64; 2]; 3] {
        let steps = self.in_steps(point);
        std::array::from_fn(|axis| match steps[axis] {
            [whole, _] if whole.is_nan() => [0.0; 2],
            [whole, _] if whole.is_infinite() => [whole, 0.0],
            // If the scene is far from the origin, the lattice's origin is 0; otherwise there is no rounding
            // error so far.
            [whole, lost] => two_sum(whole, lost - self.origin[axis]).into(),
        })
    }

    /// Returns the world position of a point in lattice units, rounded to `f64`. The point may be far away.
    #[inline]
    pub fn to_world(&self, lattice: [f64; 3]) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|axis| {
            let world = self.steps.divides(lattice[axis] + self.origin[axis]) + self.far[axis];
            // Clamped, so that rounding does not make a corner at the end of f64's range infinite.
            world.clamp(f64::MIN, f64::MAX)
        }))
    }

    /// The world coordinates of a box in lattice units, rounded outwards: all points of the box are inside,
    /// also after rounding by [`to_world`](Self::to_world).
    pub(crate) fn enclose(&self, low: [f64; 3], high: [f64; 3]) -> [DVec3; 2] {
        let bound = |lattice: [f64; 3], outwards: fn(f64) -> f64, sign: f64| {
            DVec3::from_array(std::array::from_fn(|axis| {
                let (mut sum, lost) = two_sum(lattice[axis], self.origin[axis]);
                if lost * sign > 0.0 {
                    sum = outwards(sum);
                }
                let mut world = self.steps.divides(sum);
                // A power of two divides exactly, except where digits are lost near 0.
                if world.abs() < f64::MIN_POSITIVE && sum != 0.0 {
                    world = outwards(world);
                }
                if self.far[axis] != 0.0 {
                    world = outwards(world + self.far[axis]);
                }
                world.clamp(f64::MIN, f64::MAX)
            }))
        };
        [bound(low, f64::next_down, -1.0), bound(high, f64::next_up, 1.0)]
    }

    /// Converts a world length to lattice units.
    pub fn length_to_lattice(&self, length: f64) -> f64 {
        self.steps.times(length)
    }

    /// Converts a length in lattice units to a world length.
    pub fn length_to_world(&self, length: f64) -> f64 {
        self.steps.divides(length)
    }
}

/// A sum and its rounding error (Knuth 1969).
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// The nearest integer, ties to even. Not `f64::round`, which calls a function on processors without
/// an instruction for it.
#[inline]
pub(super) fn nearest(value: f64) -> f64 {
    /// Every `f64` of at least this is an integer; from this number up to twice this number, neighbours are 1
    /// apart.
    const WHOLE: f64 = (1u64 << 52) as f64;
    let shift = if value.abs() < WHOLE { WHOLE.copysign(value) } else { 0.0 };
    value + shift - shift
}

/// A lattice point as integers.
#[inline]
pub(crate) fn integers(point: [f64; 3]) -> [i64; 3] {
    point.map(|c| c as i64)
}

/// The exponent `e` with `2^e <= value < 2^(e+1)`, for a positive finite value.
pub(crate) fn exponent_of(value: f64) -> i32 {
    let bits = (value.to_bits() >> 52) as i32;
    if bits > 0 { bits - 1023 } else { exponent_of(value * 2f64.powi(64)) - 64 }
}

/// A number times a power of two that may be beyond the range of `f64`.
pub(crate) fn scaled(mut value: f64, mut exponent: i32) -> f64 {
    while exponent != 0 {
        let step = exponent.clamp(-1000, 1000);
        value *= 2f64.powi(step);
        exponent -= step;
    }
    value
}

/// A power of two that may be beyond the range of `f64`, as two factors inside that range, and the inverses
/// of the factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PowerOfTwo {
    factors: [f64; 2],
    inverses: [f64; 2],
}

impl Default for PowerOfTwo {
    /// The number 1.
    fn default() -> Self {
        Self::new(0)
    }
}

impl PowerOfTwo {
    pub(super) fn new(exponent: i32) -> Self {
        let halves = [exponent / 2, exponent - exponent / 2];
        // Each half of the exponent is within the range of `f64`.
        let power = |e: i32| f64::from_bits(((1023 + e) as u64) << 52);
        Self { factors: halves.map(power), inverses: halves.map(|e| power(-e)) }
    }

    fn times(&self, value: f64) -> f64 {
        value * self.factors[0] * self.factors[1]
    }

    fn divides(&self, value: f64) -> f64 {
        value * self.inverses[0] * self.inverses[1]
    }
}

/// Points in units of 2^−`bits` lattice steps. Coordinates are below 2¹²⁴ in magnitude, and so are the
/// coordinates of all lattice points in this unit.
pub(crate) struct FinePoints<const N: usize> {
    pub(crate) points: [[i128; 3]; N],
    pub(crate) bits: u32,
}

/// Coordinates in lattice steps, and the lattice's origin, are below two to this power, so they take this
/// many bits of an `i128`. Differences of two points, and differences of such differences, take up to three
/// bits more.
const FINE_BITS: i32 = 123;

impl Lattice {
    /// Points in the finest unit in which all points are below 2¹²⁴, rounded to the nearest. `None` if a
    /// coordinate is NaN, infinite, or 2¹²³ lattice steps or more.
    pub(crate) fn fine_points<const N: usize>(&self, points: [DVec3; N]) -> Option<FinePoints<N>> {
        let largest = self.largest_in_steps(&points)?;
        let bits = (FINE_BITS - 1 - exponent_of(largest)) as u32;
        let origin = self.origin.map(|c| fixed(c, bits));
        let points = points.map(|point| {
            let steps = self.in_steps(point);
            std::array::from_fn(|axis| {
                let [sum, lost] = steps[axis].map(|part| fixed(part, bits));
                sum + lost - origin[axis]
            })
        });
        Some(FinePoints { points, bits })
    }

    /// The largest of the coordinates that define the finest grid of some points. The steps of that grid are
    /// at most 2⁻¹²² of this number. `None` where [`fine_points`](Self::fine_points) returns `None`.
    pub(crate) fn largest_in_steps(&self, points: &[DVec3]) -> Option<f64> {
        let mut largest = self.origin.iter().fold(2.0 * LIMIT, |largest, c| largest.max(c.abs()));
        for [c, _] in points.iter().flat_map(|&point| self.in_steps(point)) {
            if !c.is_finite() {
                return None;
            }
            largest = largest.max(c.abs());
        }
        (exponent_of(largest) < FINE_BITS).then_some(largest)
    }

    /// The exponent e such that a unit of length has 2ᵉ steps.
    pub(crate) fn exponent(&self) -> i32 {
        self.steps.factors.map(exponent_of).iter().sum()
    }

    /// A point in lattice steps from the world's origin, or, along an axis where `far` is not 0, from `far`.
    /// Each coordinate is a number and its rounding error.
    fn in_steps(&self, point: DVec3) -> [[f64; 2]; 3] {
        let world = point.to_array();
        std::array::from_fn(|axis| {
            let (sum, lost) = two_sum(world[axis], -self.far[axis]);
            [sum, lost].map(|part| self.steps.times(part))
        })
    }
}

/// A number times 2^`bits`, rounded to the nearest integer. The product must be below 2¹²³ in magnitude.
fn fixed(value: f64, bits: u32) -> i128 {
    (value * (1u128 << bits) as f64).round() as i128
}

/// A half-space in integers: it contains the lattice points p with normal·p ≥ offset. Components of the
/// normal are at most 2¹¹⁷ in magnitude, and the offset is at most 2¹⁸⁰.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfSpaceNumbers {
    pub(crate) normal: [i128; 3],
    pub(crate) offset: Int<3>,
}

/// The largest component of a normal is from 2¹¹⁶ to 2¹¹⁷.
const NORMAL_BITS: i32 = 116;
/// Offsets beyond two to this power are clamped to it: normal·p is below 2¹⁷¹ at all points of a scene.
const FAR_BITS: u32 = 180;
/// Offsets beyond this are clamped before the lattice's origin is subtracted. Such offsets would stay beyond
/// the clamp: the origin is below 2¹¹⁰, so the subtracted number is below 2²³⁰.
const BEYOND: f64 = (1u128 << 120) as f64 * (1u128 << 120) as f64;

impl Lattice {
    /// The points p with `normal.dot(p) >= offset`. `None` if a number is infinite or NaN.
    pub(crate) fn half_space(&self, normal: DVec3, offset: f64) -> Option<HalfSpaceNumbers> {
        if !normal.is_finite() || !offset.is_finite() {
            return None;
        }
        let size = normal.abs().max_element();
        let up = if size > 0.0 { -exponent_of(size) } else { 0 };
        let unit = normal.to_array().map(|c| scaled(c, up));
        let normal = unit.map(|c| scaled(c, NORMAL_BITS).round() as i128);
        // The offset minus the part of the far coordinates, in a unit in which no term is above 1, so that no
        // product overflows `f64`, and no product that matters underflows.
        let exponent = |value: f64, up| (value != 0.0).then(|| exponent_of(value.abs()) + up);
        let far = self.far.into_iter().map(|far| exponent(far, 0));
        let most = far.chain([exponent(offset, up)]).flatten().max().unwrap_or(0) + 1;
        let mut sum = SmallVec::new();
        add(&mut sum, scaled(offset, up - most));
        for (unit, far) in unit.into_iter().zip(self.far) {
            let far = scaled(far, -most);
            let part = unit * far;
            add(&mut sum, -part);
            add(&mut sum, -unit.mul_add(far, -part));
        }
        let unit = NORMAL_BITS + self.exponent() + most;
        let parts = sum.into_iter().map(|part| scaled(part, unit));
        // The last part that is not 0 is the largest, and nearly the sum.
        let largest = parts.clone().rev().find(|&part| part != 0.0).unwrap_or(0.0);
        let steps = if largest.abs() < BEYOND {
            let part = |axis: usize| {
                Int::<2>::from(normal[axis]).times::<2, 5>(&Int::from(self.origin[axis] as i128))
            };
            let origin = part(0) + part(1) + part(2);
            parts.fold(-origin, |sum, c| sum + Int::from_f64(c.round()))
        } else if largest > 0.0 {
            Int::<2>::from(1_i128).shifted(FAR_BITS + 1)
        } else {
            -Int::<2>::from(1_i128).shifted::<5>(FAR_BITS + 1)
        };
        Some(HalfSpaceNumbers { normal, offset: cut(steps) })
    }
}

/// Adds a number to an exact sum: parts that do not overlap, from the smallest to the largest, except for
/// zeros (J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
/// predicates", 1997, grow-expansion).
fn add(sum: &mut SmallVec<[f64; 7]>, mut value: f64) {
    for part in sum.iter_mut() {
        (value, *part) = two_sum(value, *part);
    }
    sum.push(value);
}

/// An offset, clamped to a bound that no point of a scene exceeds.
fn cut(offset: Int<5>) -> Int<3> {
    let far = Int::<2>::from(1_i128).shifted::<5>(FAR_BITS);
    let within = if (offset - far).is_negative() { offset } else { far };
    let within = if (within + far).is_negative() { -far } else { within };
    within.resize()
}

#[cfg(test)]
mod tests {
    use super::{LIMIT, Lattice};
    use glam::DVec3;
    use proptest::prelude::*;

    #[test]
    fn coordinates_on_a_power_of_two_grid_do_not_move() {
        let (min, max) = (DVec3::new(-4136.0, -1736.0, -96.0), DVec3::new(3544.0, 2816.5, 288.25));
        let lattice = Lattice::new(min, max);
        for point in [min, max, DVec3::ZERO, DVec3::new(0.1f32.into(), 3.3f32.into(), 1.0)] {
            assert_eq!(lattice.to_world(lattice.snap(point)), point);
        }
    }

    #[test]
    fn zero_has_one_form() {
        let lattice = Lattice::new(DVec3::NEG_ONE, DVec3::ONE);
        let snapped = lattice.snap(DVec3::new(-0.0, -1e-30, 0.0));
        assert_eq!(snapped.map(f64::to_bits), [0; 3]);
    }

    #[test]
    fn a_point_beyond_128_bits_of_lattice_steps_comes_back() {
        let lattice = Lattice::new(DVec3::splat(1.0), DVec3::new(2.0, 3.0, 4.0));
        for size in [1e29, 1e31, 1.6e38, 1e40, 1e200] {
            let point = DVec3::new(size, -size, size * 0.5);
            assert_eq!(lattice.to_world(lattice.to_lattice(point)), point, "{size:e}");
        }
        let end = lattice.to_world([f64::INFINITY, f64::NEG_INFINITY, 0.0]);
        assert_eq!([end.x, end.y], [f64::MAX, f64::MIN]);
    }

    #[test]
    fn extremes_of_the_range_stay_finite() {
        for size in [f64::MIN_POSITIVE * 1e-10, 1e-300, 1e-30, 1.0, 1e30, f64::MAX] {
            let corner = DVec3::splat(size);
            let lattice = Lattice::new(-corner, corner);
            let snapped = lattice.snap(corner);
            assert!(snapped.iter().all(|c| c.abs() <= LIMIT && c.fract() == 0.0), "{snapped:?}");
            let error = (lattice.to_world(snapped) - corner).abs().max_element();
            assert!(error <= size * 2f64.powi(-51), "size {size:e}, error {error:e}");
        }
    }

    #[test]
    fn a_flat_scene_far_out_for_its_size_keeps_its_height() {
        for (height, size) in [(1.0, 1e-30), (1e24, 1.0), (-1e30, 1.0), (1e300, 1e-300)] {
            let corners = [DVec3::new(0.0, 0.0, height), DVec3::new(size, size, height)];
            let lattice = Lattice::new(corners[0], corners[1]);
            for corner in corners {
                let error = lattice.to_world(lattice.snap(corner)) - corner;
                assert!(error.z == 0.0 && error.abs().max_element() <= size * 2f64.powi(-51));
                let [snapped, rounded] = [lattice.snap(corner), lattice.to_lattice(corner)];
                assert!(snapped.iter().zip(rounded).all(|(a, b)| (a - b).abs() <= 0.5));
            }
        }
    }

    /// Boxes whose ends, added to the lattice's origin, have more digits than an `f64` stores.
    #[test]
    fn boxes_are_rounded_outwards() {
        let lattice = Lattice::new(DVec3::splat(2.0), DVec3::splat(4.0));
        let fixed = |c: f64| (c * (1u64 << 20) as f64) as i128;
        let mut rounded = 0;
        for k in 0..1000 {
            let at = f64::from(k) * 1048.6875 - 500_000.0;
            let [low, high] = lattice.enclose([at; 3], [at; 3]);
            // 3 · 2⁵⁰ steps from the world's origin.
            let exact = fixed(at) + (3 << 70);
            let [low, high] = [low, high].map(|end| fixed(lattice.length_to_lattice(end.x)));
            assert!(low <= exact && exact <= high, "{at}");
            rounded += usize::from(low < high);
        }
        assert!(rounded > 500, "{rounded}");
    }

    proptest! {
        #[test]
        fn rounding_stays_below_the_promise(
            a in prop::array::uniform3(-1.0..1.0f64),
            b in prop::array::uniform3(-1.0..1.0f64),
            offset in prop_oneof![Just(0.0), Just(1e8), Just(-1e15)],
            scale in prop_oneof![Just(1e-30), Just(1.0), Just(1e30)],
            t in prop::array::uniform3(0.0..1.0f64),
        ) {
            let place = |p: [f64; 3]| (DVec3::from(p) + offset) * scale;
            let (a, b) = (place(a), place(b));
            let (min, max) = (a.min(b), a.max(b));
            let point = (min + (max - min) * DVec3::from(t)).clamp(min, max);
            let lattice = Lattice::new(min, max);
            for corner in [min, max, point] {
                let snapped = lattice.snap(corner);
                prop_assert!(snapped.iter().all(|c| c.abs() <= LIMIT && c.fract() == 0.0));
                let back = lattice.to_world(snapped);
                let extent = (max - min).max_element();
                let ulp = corner.abs().max_element() * f64::EPSILON;
                prop_assert!((back - corner).abs().max_element() <= extent * 2f64.powi(-50) + ulp);
            }
        }
    }
}

#[cfg(test)]
mod fine_tests {
    use super::*;

    #[test]
    fn points_of_any_size_keep_120_bits() {
        let lattice = Lattice::new(DVec3::splat(-1.0), DVec3::splat(1.0));
        let step = lattice.length_to_world(1.0);
        for size in [1e-18, 1e-3, 0.7, 3.0, 1e5, 1e15, 4e20] {
            let points = [DVec3::new(size, -size, 0.0), DVec3::new(0.5, 0.25, 0.1)];
            let fine = lattice.fine_points(points).expect("within reach");
            let unit = step / (1u128 << fine.bits) as f64;
            assert!(unit <= size.max(1.0) * 2f64.powi(-120), "{size}: {unit:e}");
            for (fine, point) in fine.points.iter().zip(points) {
                let back = DVec3::from(fine.map(|c| c as f64 * unit));
                let slack = DVec3::splat(unit) + point.abs() * f64::EPSILON;
                assert!((back - point).abs().cmple(slack).all(), "{size}: {point}, {back}");
            }
        }
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e30, f64::MAX] {
            assert!(lattice.fine_points([DVec3::ZERO, DVec3::new(0.0, bad, 0.0)]).is_none());
        }
    }

    #[test]
    fn lattice_points_are_multiples_of_the_steps() {
        let (low, high) = (DVec3::new(1e6, -3.0, 2e-9), DVec3::new(1e6 + 0.3, -1.0, 7e-9));
        let lattice = Lattice::new(low, high);
        for point in [low, high, high * 0.25 + low * 0.75] {
            let on_lattice = lattice.snap(point);
            let fine = lattice.fine_points([lattice.to_world(on_lattice)]).expect("within reach");
            assert_eq!(fine.points[0], on_lattice.map(|c| (c as i128) << fine.bits));
        }
    }
}
