//! Half-spaces on the lattice, in integers.

use glam::DVec3;

use super::{Lattice, exponent_of};
use crate::exact::Int;
use crate::exact::exact_ray::scaled;

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
const FAR: u32 = 180;
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
        // Exactly the offset less the far coordinates' part, as a sum of seven numbers.
        let (mut offset, mut rest) = (scaled(offset, up), [0.0; 6]);
        for axis in (0..3).filter(|&axis| self.far[axis] != 0.0) {
            let part = unit[axis] * self.far[axis];
            rest[2 * axis] = -unit[axis].mul_add(self.far[axis], -part);
            (offset, rest[2 * axis + 1]) = super::two_sum(offset, -part);
        }
        let offset = scaled(offset, BITS + self.exponent());
        let steps = if offset.abs() < BEYOND {
            let rest = rest.map(|c| scaled(c, BITS + self.exponent()));
            let part = |axis: usize| {
                Int::<2>::from(normal[axis]).times::<2, 5>(&Int::from(self.origin[axis] as i128))
            };
            let origin = part(0) + part(1) + part(2);
            let sum = rest.into_iter().fold(rounded(offset), |sum, c| sum + rounded(c));
            sum - origin
        } else if offset > 0.0 {
            Int::<2>::from(1_i128).shifted(FAR + 1)
        } else {
            -Int::<2>::from(1_i128).shifted::<5>(FAR + 1)
        };
        Some(HalfSpaceNumbers { normal, offset: cut(steps) })
    }
}

/// The nearest integer, of a number below [`BEYOND`]; 0 for what is none.
fn rounded(value: f64) -> Int<5> {
    if value.abs() < BEYOND { Int::from_f64(value.round()) } else { Int::ZERO }
}

/// An offset, cut to what all points of a scene are this side of.
fn cut(offset: Int<5>) -> Int<3> {
    let far = Int::<2>::from(1_i128).shifted::<5>(FAR);
    let within = if (offset - far).is_negative() { offset } else { far };
    let within = if (within + far).is_negative() { -far } else { within };
    within.resize()
}
