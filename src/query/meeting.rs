//! Where a ray meets fragments: which meeting comes first.

use std::cmp::Ordering;

use super::chord::{Spot, chord};
use super::filter::{Guess, guess};
use super::probe::Probe;
use crate::exact::{Faces, PlaneId};
use crate::tree::Fragment;

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

    fn exact(spot: Spot, probe: &mut Probe, faces: &Faces) -> Option<Self> {
        let exact = probe.exact()?;
        let t = Probe::rounded(exact, &spot.parameter(exact, faces));
        Some(Self::between(spot, t * (1.0 - QUOTIENT_ERROR), t * (1.0 + QUOTIENT_ERROR)))
    }

    /// How the depths of two spots of a ray compare: exact.
    pub(super) fn compare(&self, other: &Self, probe: &mut Probe, faces: &Faces) -> Ordering {
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
    pub(super) fn new(probe: &mut Probe, fragment: &Fragment<'_>, faces: &Faces) -> Option<Self> {
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
    pub(super) fn compare(&self, other: &Self, probe: &mut Probe, faces: &Faces) -> Ordering {
        // Faces are numbered in the order of their polygons.
        self.enter
            .compare(&other.enter, probe, faces)
            .then(self.face.cmp(&other.face))
            .then(self.fragment.cmp(&other.fragment))
    }
}
