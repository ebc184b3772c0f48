//! The scene lattice: corners are rounded to it once, and everything after that is exact.

mod fine;
pub(crate) mod half_space;
#[cfg(feature = "save")]
mod saved;

use glam::DVec3;

/// The largest magnitude of a lattice coordinate.
pub const LIMIT: f64 = (1u64 << 51) as f64;

/// This many steps from the world's origin, two neighbouring `f64` are further apart than the scene
/// is wide: 2¹¹⁰ · 2⁻⁵² > 2⁵². Larger: coordinates that no longer fit integers are treated as if
/// they did; smaller: a scene far out loses coordinates that differ.
const FAR_ORIGIN: f64 = (1u128 << 110) as f64;

/// The largest coplanar tolerance, in lattice units: about 1/256 of the extent. Larger ones are reduced to
/// it, so that corners moved onto a plane fit the integers of the exact predicates.
pub(crate) const MAX_TOLERANCE: f64 = LIMIT / 128.0;
/// More than the largest coordinate of any corner or vertex: the largest tolerance moves a corner by √3 of
/// it at most, which makes 1.0136 times the limit.
pub(crate) const MAX_CORNER: f64 = 1.014 * LIMIT;

/// A cubic grid laid over a scene, fine enough that rounding its corners to it moves none by more
/// than 2⁻⁵² of the scene's extent.
///
/// A lattice coordinate is an integer of magnitude at most 2⁵¹. It is exact as an `i64` and as an
/// `f64`, and so is the difference of two. The grid's spacing is a power of two, so scenes given in
/// `f32`, on integers, or far from the origin are usually not moved at all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lattice {
    /// Lattice coordinate = world coordinate · steps − origin.
    steps: PowerOfTwo,
    /// In steps; integers.
    origin: [f64; 3],
    /// Per axis: if the scene lies so far out along it, for its size, that all corners must have
    /// the same coordinate, that coordinate; otherwise 0.
    far: [f64; 3],
}

impl Lattice {
    /// The lattice of a scene with the given bounding box, whose corners must be finite.
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

    /// The lattice point nearest to a point of the scene's bounding box.
    #[inline]
    pub fn snap(&self, point: DVec3) -> [f64; 3] {
        let world = point.to_array();
        // The difference of two integers is exact if an f64 can hold it. Adding 0 turns −0 into 0.
        std::array::from_fn(|axis| {
            nearest(self.steps.times(world[axis] - self.far[axis])) - self.origin[axis] + 0.0
        })
    }

    /// Any point in lattice units, rounded to `f64` once. It may be far out, even infinite.
    pub fn to_lattice(&self, point: DVec3) -> [f64; 3] {
        let world = point.to_array();
        std::array::from_fn(|axis| {
            self.steps.times(world[axis] - self.far[axis]) - self.origin[axis]
        })
    }

    /// Any point in lattice units, exactly: each coordinate as a number and what its rounding has lost. Of one
    /// that is infinite, or beyond the range of `f64`, nothing is lost; NaN counts as 0.
    pub(super) fn exactly(&self, point: DVec3) -> [[f64; 2]; 3] {
        let steps = self.in_steps(point);
        std::array::from_fn(|axis| match steps[axis] {
            [whole, _] if whole.is_nan() => [0.0; 2],
            [whole, _] if whole.is_infinite() => [whole, 0.0],
            // Where the scene is far out, the origin is 0; elsewhere nothing is lost so far.
            [whole, lost] => two_sum(whole, lost - self.origin[axis]).into(),
        })
    }

    /// The world position of a point given in lattice units, rounded to `f64`; may be far out.
    #[inline]
    pub fn to_world(&self, lattice: [f64; 3]) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|axis| {
            let world = self.steps.divides(lattice[axis] + self.origin[axis]) + self.far[axis];
            // Clamped, so that rounding does not make a corner at the end of f64's range infinite.
            world.clamp(f64::MIN, f64::MAX)
        }))
    }

    /// The world coordinates of a box in lattice units, rounded outwards: all of its points are
    /// inside, and so are these as [`to_world`](Self::to_world) rounds them.
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

    /// A world length in lattice units.
    pub fn length_to_lattice(&self, length: f64) -> f64 {
        self.steps.times(length)
    }

    /// A length in lattice units as a world length.
    pub fn length_to_world(&self, length: f64) -> f64 {
        self.steps.divides(length)
    }
}

/// A sum and what its rounding has lost (Knuth 1969).
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// The nearest integer, ties to even. Not `f64::round`, which calls a function on processors without
/// an instruction for it.
#[inline]
pub(super) fn nearest(value: f64) -> f64 {
    /// From here on, numbers are integers, and up to the double of it they are 1 apart.
    const WHOLE: f64 = (1u64 << 52) as f64;
    let size = value.abs();
    if size < WHOLE { (size + WHOLE - WHOLE).copysign(value) } else { value }
}

/// A lattice point as integers.
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

/// A power of two that may be beyond the range of `f64`, as two factors within it, and the inverses
/// of these.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PowerOfTwo {
    factors: [f64; 2],
    inverses: [f64; 2],
}

impl Default for PowerOfTwo {
    /// One.
    fn default() -> Self {
        Self::new(0)
    }
}

impl PowerOfTwo {
    fn new(exponent: i32) -> Self {
        let halves = [exponent / 2, exponent - exponent / 2];
        Self { factors: halves.map(|e| 2f64.powi(e)), inverses: halves.map(|e| 2f64.powi(-e)) }
    }

    fn times(&self, value: f64) -> f64 {
        value * self.factors[0] * self.factors[1]
    }

    fn divides(&self, value: f64) -> f64 {
        value * self.inverses[0] * self.inverses[1]
    }
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

    /// Where a box's ends and the lattice's origin have more digits together than a number holds.
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
