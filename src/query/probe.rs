//! A ray, prepared to be held against a tree.

#[cfg(test)]
mod tests;

use crate::exact::Lattice;
use crate::exact::eye::{ExactRay, Parameter};
use crate::exact::lattice::{MAX_CORNER, exponent_of, scaled};
use crate::ray::Ray;

/// A ray in lattice units, rounded, and in integers as soon as they are needed.
#[derive(Clone, Debug)]
pub(super) struct Probe {
    ray: Ray,
    lattice: Lattice,
    exact: Option<ExactRay>,
    pub(super) origin: [f64; 3],
    /// The point of parameter t is at origin + t · direction. For an endless ray t has a unit of its
    /// own, in which the largest coordinate here is from 2⁵¹ to 2⁵².
    pub(super) direction: [f64; 3],
    /// More than any coordinate of the origin less one of a corner.
    pub(super) reach: f64,
    /// The largest magnitude in the direction.
    pub(super) speed: f64,
    pub(super) is_endless: bool,
    /// Whether each coordinate of the direction is off, from that in integers, by no more than one rounding
    /// and a thousandth of one, as those of the origin always are.
    pub(super) is_precise: bool,
}

/// Bits of the largest coordinate of an endless ray's rounded direction.
const SPEED_BITS: i32 = 52;

/// Segments that are shorter than this share of their largest coordinate lose more of their direction, in
/// integers, than a thousandth of a rounding in floats.
///
/// The grid of a segment's ends has steps of up to 2⁻¹²² of that coordinate, and each end is off by half a
/// step: together 2⁻¹²², where a thousandth of a rounding is 2⁻⁶³ of the length. So 2⁻⁵⁹ is enough, and this is
/// its double. (Where the places half way between two floats are on that grid, down to 2⁻⁶⁹, rounding to it
/// leads to the same float, so that nothing is lost. An origin is off by half a step as well, 2⁻¹²³ of the largest coordinate. Its rounding is
/// 2⁻⁵³ of the reach, which is 2⁵¹ or more, and no lattice at all is further than 2¹¹⁰ from the world's origin:
/// so that is less than a thousandth, however far out it is.)
/// Smaller: floats decide what integers decide otherwise; larger: more is decided by integers.
const SHORT: f64 = 1.0 / (1u64 << 58) as f64;

impl Probe {
    /// A ray on a scene's lattice. `None` if it is one that meets nothing: see [`Ray`].
    pub(super) fn new(ray: Ray, lattice: &Lattice) -> Option<Self> {
        let (from, direction, least) = match ray {
            Ray::Segment { from, to } => {
                let largest = lattice.largest_in_steps(&[from, to])?;
                let direction = std::array::from_fn(|axis| {
                    let [a, b] = [from[axis], to[axis]];
                    if (b - a).is_finite() {
                        lattice.length_to_lattice(b - a)
                    } else {
                        2.0 * lattice.length_to_lattice(0.5 * b - 0.5 * a)
                    }
                });
                (from, direction, largest * SHORT)
            }
            Ray::Endless { from, direction } => {
                lattice.largest_in_steps(&[from])?;
                if !direction.is_finite() {
                    return None;
                }
                let largest = direction.abs().max_element();
                let up = if largest > 0.0 { SPEED_BITS - 1 - exponent_of(largest) } else { 0 };
                (from, direction.to_array().map(|c| scaled(c, up)), f64::MIN_POSITIVE)
            }
        };
        let origin = lattice.to_lattice(from);
        let largest = |v: [f64; 3]| v.into_iter().fold(0.0, |max: f64, c| max.max(c.abs()));
        let (reach, speed) = (largest(origin) + MAX_CORNER, largest(direction));
        Some(Self {
            ray,
            lattice: *lattice,
            exact: None,
            origin,
            direction,
            reach,
            speed,
            is_endless: matches!(ray, Ray::Endless { .. }),
            is_precise: speed >= least,
        })
    }

    /// The ray in integers. Never `None`, as there is a probe.
    pub(super) fn exact(&mut self) -> Option<&ExactRay> {
        if self.exact.is_none() {
            self.exact = ExactRay::new(self.ray, &self.lattice);
        }
        self.exact.as_ref()
    }

    /// A parameter in the unit of the floats here, rounded.
    pub(super) fn rounded(exact: &ExactRay, t: &Parameter) -> f64 {
        exact.rescaled(t, SPEED_BITS)
    }
}
