//! Half-spaces on the lattice, in integers.

use glam::DVec3;

use super::{Lattice, exponent_of, scaled};
use crate::exact::Int;

/// A half-space in integers: it has the lattice points p with normal·p ≥ offset. Components of the
/// normal are at most 2¹¹⁷ in magnitude, and the offset is at most 2¹⁸⁰.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfSpaceNumbers {
    pub(crate) normal: [i128; 3],
    pub(crate) offset: Int<3>,
}

/// The largest component of a normal is from 2¹¹⁶ to 2¹¹⁷.
const BITS: i32 = 116;
/// Offsets beyond two to this power are cut to it: normal·p is below 2¹⁷¹ at all points of a scene.
const FAR_BITS: u32 = 180;
/// Offsets beyond two to this power stay far beyond, whatever the lattice's origin takes off: it is below
/// 2¹¹⁰, so its part is below 2²³⁰.
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
        let normal = unit.map(|c| scaled(c, BITS).round() as i128);
        // The offset less the far coordinates' part: in a unit in which none of them is beyond 1, so that
        // no product is beyond the range of `f64`, and none that matters below it.
        let exponent = |value: f64, up| (value != 0.0).then(|| exponent_of(value.abs()) + up);
        let far = self.far.into_iter().map(|far| exponent(far, 0));
        let most = far.chain([exponent(offset, up)]).flatten().max().unwrap_or(0) + 1;
        let mut sum = Sum::default();
        sum.add(scaled(offset, up - most));
        for (unit, far) in unit.into_iter().zip(self.far) {
            let far = scaled(far, -most);
            let part = unit * far;
            sum.add(-part);
            sum.add(-unit.mul_add(far, -part));
        }
        let parts = sum.parts.map(|part| scaled(part, BITS + self.exponent() + most));
        // The last that is not 0 is the largest, and nearly the sum.
        let largest = parts.into_iter().rev().find(|&part| part != 0.0).unwrap_or(0.0);
        let steps = if largest.abs() < BEYOND {
            let part = |axis: usize| {
                Int::<2>::from(normal[axis]).times::<2, 5>(&Int::from(self.origin[axis] as i128))
            };
            let origin = part(0) + part(1) + part(2);
            parts.into_iter().fold(-origin, |sum, c| sum + Int::from_f64(c.round()))
        } else if largest > 0.0 {
            Int::<2>::from(1_i128).shifted(FAR_BITS + 1)
        } else {
            -Int::<2>::from(1_i128).shifted::<5>(FAR_BITS + 1)
        };
        Some(HalfSpaceNumbers { normal, offset: cut(steps) })
    }
}

/// An exact sum of up to seven numbers: parts that do not overlap, from the smallest to the largest, but
/// for zeros (J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
/// predicates", 1997, grow-expansion).
struct Sum {
    parts: [f64; 7],
    /// How many have been added.
    len: usize,
}

impl Default for Sum {
    fn default() -> Self {
        Self { parts: [0.0; 7], len: 0 }
    }
}

impl Sum {
    fn add(&mut self, value: f64) {
        let mut value = value;
        for part in &mut self.parts[..self.len] {
            (value, *part) = super::two_sum(value, *part);
        }
        self.parts[self.len] = value;
        self.len += 1;
    }
}

/// An offset, cut to what all points of a scene are this side of.
fn cut(offset: Int<5>) -> Int<3> {
    let far = Int::<2>::from(1_i128).shifted::<5>(FAR_BITS);
    let within = if (offset - far).is_negative() { offset } else { far };
    let within = if (within + far).is_negative() { -far } else { within };
    within.resize()
}
