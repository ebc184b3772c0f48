//! A ray, prepared to be held against a tree, and which of two places where it meets fragments comes first.

use std::cmp::Ordering;

use super::chord::{Spot, chord};
use super::filter::{Guess, guess};
use crate::exact::eye::{ExactRay, Parameter};
use crate::exact::lattice::{MAX_CORNER, exponent_of, scaled};
use crate::exact::{Faces, Lattice, PlaneId};
use crate::tree::Fragment;
use crate::viewpoint::Ray;

/// A ray in lattice units, rounded, and in integers as soon as they are needed.
#[derive(Clone, Debug)]
pub(super) struct RayQuery {
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

impl RayQuery {
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

/// How far along a ray a spot is: between two parameters, and exactly, by what defines the spot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    pub(super) spot: Spot,
    pub(super) low: f64,
    pub(super) high: f64,
}

/// What a ray and a fragment have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    pub(super) fragment: u32,
    pub(super) face: u32,
    pub(super) enter: Depth,
    pub(super) leave: Depth,
    /// The side of the fragment that the ray comes from; `Equal` if it lies in the plane.
    pub(super) facing: Ordering,
}

/// A parameter that is rounded from the exact one is off by less than this share of it.
///
/// With ε = 2⁻⁵², a quotient of integers has one rounding and what is lost of its second part, ε / 2 and some
/// ε²; the product with 1 ± this share has another ε / 2. So this is about four times as much as is needed.
/// Smaller: depths compare in the wrong order; larger: more of them are compared by integers.
const QUOTIENT_ERROR: f64 = 4.0 * f64::EPSILON;

impl Depth {
    fn between(spot: Spot, low: f64, high: f64) -> Self {
        Self { spot, low, high }
    }

    fn exact(spot: Spot, probe: &mut RayQuery, faces: &Faces) -> Option<Self> {
        let exact = probe.exact()?;
        let t = RayQuery::rounded(exact, &spot.parameter(exact, faces));
        Some(Self::between(spot, t * (1.0 - QUOTIENT_ERROR), t * (1.0 + QUOTIENT_ERROR)))
    }

    /// How the depths of two spots of a ray compare: exact.
    pub(super) fn compare(&self, other: &Self, probe: &mut RayQuery, faces: &Faces) -> Ordering {
        if self.high < other.low {
            return Ordering::Less;
        }
        if self.low > other.high {
            return Ordering::Greater;
        }
        if self.spot == other.spot {
            return Ordering::Equal;
        }
        let Some(ray) = probe.exact() else { return Ordering::Equal };
        self.spot.parameter(ray, faces).compare(&other.spot.parameter(ray, faces))
    }
}

impl Meeting {
    /// Where a ray meets a fragment; `None` if it does not.
    pub(super) fn new(
        probe: &mut RayQuery,
        fragment: &Fragment<'_>,
        faces: &Faces,
    ) -> Option<Self> {
        let (enter, leave, facing) = match guess(probe, fragment, faces) {
            Guess::Misses => return None,
            Guess::Meets { low, high, from_front } => {
                let spot = Spot::Plane(PlaneId::face(fragment.face()));
                let depth = Depth::between(spot, low, high);
                (depth, depth, if from_front { Ordering::Greater } else { Ordering::Less })
            }
            Guess::Unsure => {
                let chord = chord(probe.exact()?, fragment, faces)?;
                let enter = Depth::exact(chord.enter, probe, faces)?;
                let leave = Depth::exact(chord.leave, probe, faces)?;
                (enter, leave, chord.facing)
            }
        };
        Some(Self { fragment: fragment.index(), face: fragment.face(), enter, leave, facing })
    }

    /// Nearest first; at the same point, in the order of the input.
    pub(super) fn compare(&self, other: &Self, probe: &mut RayQuery, faces: &Faces) -> Ordering {
        // Faces are numbered in the order of their polygons.
        self.enter
            .compare(&other.enter, probe, faces)
            .then(self.face.cmp(&other.face))
            .then(self.fragment.cmp(&other.fragment))
    }
}

#[cfg(test)]
mod tests;
