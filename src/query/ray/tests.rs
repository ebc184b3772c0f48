//! The differences between the floats and the integers of a ray.

use dashu_int::IBig;
use dashu_ratio::RBig;
use glam::DVec3;
use num_traits::{FromPrimitive, Signed};

use super::{RayQuery, SPEED_BITS};
use crate::exact::Lattice;
use crate::exact::eye::ExactRay;
use crate::random::SplitMix64;
use crate::viewpoint::Ray;

/// Half an ulp of 1: one rounding.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// The largest difference between floats and integers, in roundings of a number of magnitude `size`.
fn off(floats: [f64; 3], integers: [i128; 3], bits: u32, size: f64) -> f64 {
    let two = RBig::from(2);
    let differences = floats.into_iter().zip(integers).map(|(float, integer)| {
        let exact = RBig::from(IBig::from(integer)) * two.pow(-(bits as isize));
        (RBig::from_f64(float).unwrap() - exact).abs()
    });
    let rounding = RBig::from_f64(ROUNDING * size).unwrap();
    let largest = differences.max().unwrap() / rounding;
    largest.to_f64().value()
}

/// A number that uses all its digits, near a power of two.
fn long(random: &mut SplitMix64, exponent: i32) -> f64 {
    let sign = if random.next().is_multiple_of(2) { 1.0 } else { -1.0 };
    sign * random.range(1.0, 1.00001) * 2f64.powi(exponent)
}

/// Rays and segments on lattices at the world's origin and far from it. Some segments are the shortest,
/// relative to their largest coordinate, that floats may decide.
#[test]
fn floats_are_off_by_one_rounding_and_a_thousandth() {
    let mut random = SplitMix64::new(1);
    let (mut origins, mut directions, mut short) = (0.0_f64, 0.0_f64, 0);
    let lattices = [0, 20, 57, 70].map(|out| {
        let middle = DVec3::X * if out == 0 { 0.0 } else { 2f64.powi(out) };
        (out, Lattice::new(middle - 1.0, middle + 1.0))
    });
    for round in 0..40_000 {
        let (out, lattice) = &lattices[round % lattices.len()];
        // The largest coordinate, and the length of the segment, as powers of two.
        let far = (*out).max((random.next() % 72) as i32 - 2);
        let length = far - (random.next() % 80) as i32;
        let axis = (random.next() % 3) as usize;
        let mut from = DVec3::ZERO;
        from[axis] = 2f64.powi(far);
        let mut to = from;
        for other in (0..3).filter(|&other| other != axis) {
            // The difference is nearly half a step from the next numbers, and one end has digits that no grid
            // contains.
            from[other] = long(&mut random, length);
            to[other] = from[other] * ROUNDING * random.range(0.9999, 1.0);
        }
        let ray = if round % 5 == 0 { Ray::new(from, to - from) } else { Ray::between(from, to) };
        let query = RayQuery::new(ray, lattice).unwrap();
        let (origin, direction, bits) = ExactRay::new(ray, lattice).unwrap().parts();
        origins = origins.max(off(query.origin, origin, bits, query.reach));
        if query.is_precise {
            // An endless ray has a separate unit.
            let bits = if query.is_endless { 123 - SPEED_BITS as u32 } else { bits };
            directions = directions.max(off(query.direction, direction, bits, query.speed));
            short += usize::from(!query.is_endless && length < far - 56);
        }
    }
    assert!((0.999..1.001).contains(&origins), "{origins} roundings");
    assert!((0.999..1.001).contains(&directions), "{directions} roundings");
    assert!(short > 500, "{short}");
}
