//! Families of hard scenes: each has one difficulty, a number that is swept over decades.

mod bodies;
mod crowds;
mod pose;
mod range;
mod sheets;
#[cfg(test)]
mod tests;
mod trial;

use std::fmt;
use std::str::FromStr;

use binspace::Error;
use binspace::scene::Scene;
use binspace::view::Camera;
use trial::{Look, Trial};

/// A family of scenes that are hard to decide. One parameter, the difficulty, makes them harder.
///
/// ```
/// use binspace_evidence::Family;
///
/// let family: Family = "gap".parse()?;
/// for &gap in family.sweep(true) {
///     let scene = family.scene(gap, 1);
///     let cameras = family.cameras(gap, 1, [160, 120])?;
///     assert!(!scene.is_empty() && !cameras.is_empty());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Scenes and cameras are the same, bit for bit, on every machine. Build trees of them with the tolerance
/// [`TOLERANCE`](Self::TOLERANCE), which is 0. The default tolerance is larger than most difficulties, and
/// would hide them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Family {
    /// Triangles that cross each other; the difficulty is the angle between them in radians.
    Angle,
    /// Nested triangles in layers; the difficulty is the gap between layers, as a share of the
    /// extent.
    Gap,
    /// Triangles that cross in a unit cube, and another triangle at the origin; the difficulty is
    /// the cube's distance from the origin.
    Offset,
    /// Crossing triangles, layers and bars, all multiplied by a factor.
    Scale,
    /// Long narrow triangles woven through each other; the difficulty is their width, as a share of
    /// their length.
    Sliver,
    /// One triangle that other triangles pierce, so that each of them cuts it; the difficulty is the number
    /// of the others.
    Nesting,
    /// Squares and diagonals of an integer grid, with ties everywhere; the difficulty is the number
    /// of cells per side.
    Lattice,
    /// Touching boxes in a rotated grid, with labels: faces that are coplanar except for rounding. The
    /// difficulty is the number of boxes per side.
    Boxes,
    /// Bars in a cycle: each covers the next, and the last covers the first. The difficulty is
    /// their number.
    Cycle,
    /// Triangles in a cube, most of which pass through each other; the difficulty is their number.
    Penetration,
    /// Pairs of crossing triangles at depths from 1 to the difficulty.
    DepthRange,
}

impl Family {
    /// All families, in the order in which they are listed.
    pub const ALL: [Self; 11] = [
        Self::Angle,
        Self::Gap,
        Self::Offset,
        Self::Scale,
        Self::Sliver,
        Self::Nesting,
        Self::Lattice,
        Self::Boxes,
        Self::Cycle,
        Self::Penetration,
        Self::DepthRange,
    ];

    /// The coplanar tolerance for the families.
    pub const TOLERANCE: f64 = 0.0;

    /// Returns the family's name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Angle => "angle",
            Self::Gap => "gap",
            Self::Offset => "offset",
            Self::Scale => "scale",
            Self::Sliver => "sliver",
            Self::Nesting => "nesting",
            Self::Lattice => "lattice",
            Self::Boxes => "boxes",
            Self::Cycle => "cycle",
            Self::Penetration => "penetration",
            Self::DepthRange => "depth-range",
        }
    }

    /// Returns a one-line description of the scenes.
    pub fn description(self) -> &'static str {
        match self {
            Self::Angle => "six triangles that cross each other at a small angle",
            Self::Gap => "twelve nested triangles in thin layers, their order shuffled",
            Self::Offset => "forty triangles that cross in a unit cube, far from another one",
            Self::Scale => "crossing triangles, layers and bars, all multiplied by a factor",
            Self::Sliver => "sixteen narrow triangles woven through each other, seen from nearby",
            Self::Nesting => "one triangle that others pierce, so that it is cut many times",
            Self::Lattice => "squares and diagonals of an integer grid: exact ties everywhere",
            Self::Boxes => "turned boxes that touch, faces coplanar except for rounding",
            Self::Cycle => "bars in a cycle: each covers the next, the last covers the first",
            Self::Penetration => "triangles that pass through each other, drawn at random",
            Self::DepthRange => "crossing triangles from very near to very far",
        }
    }

    /// Returns the meaning of the difficulty, for the axis of a plot.
    pub fn parameter(self) -> &'static str {
        match self {
            Self::Angle => "angle between triangles [rad]",
            Self::Gap => "gap between layers [extent]",
            Self::Offset => "distance from the origin [size]",
            Self::Scale => "factor",
            Self::Sliver => "width [length]",
            Self::Nesting => "piercing triangles",
            Self::Lattice => "cells per side",
            Self::Boxes => "boxes per side",
            Self::Cycle => "bars in the cycle",
            Self::Penetration => "triangles",
            Self::DepthRange => "furthest depth / nearest depth",
        }
    }

    /// Returns the difficulties, from the easiest to the hardest. For [`Scale`](Self::Scale), returns the
    /// factors from the smallest to the largest. If `quick`, returns only a few difficulties.
    pub fn sweep(self, quick: bool) -> &'static [f64] {
        const DECADES: &[f64] =
            &[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];
        match (self, quick) {
            (Self::Angle | Self::Sliver, false) => DECADES,
            (Self::Angle | Self::Sliver, true) => &[1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-12],
            (Self::Gap, false) => &DECADES[1..],
            (Self::Gap, true) => &[1e-2, 1e-4, 1e-6, 1e-7, 1e-9],
            (Self::Offset, false) => &[1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9],
            (Self::Offset, true) => &[1.0, 1e3, 1e5, 1e7, 1e9],
            (Self::Scale, false) => &[1e-30, 1e-20, 1e-10, 1e-5, 1.0, 1e5, 1e10, 1e20, 1e30],
            (Self::Scale, true) => &[1e-30, 1.0, 1e30],
            (Self::Nesting, false) => &[10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4],
            (Self::Nesting, true) => &[10.0, 100.0, 1e3],
            (Self::Lattice, false) => &[2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0],
            (Self::Lattice, true) => &[2.0, 4.0, 6.0],
            (Self::Boxes, false) => &[2.0, 3.0, 4.0, 5.0, 6.0, 8.0],
            (Self::Boxes, true) => &[2.0, 3.0, 4.0],
            (Self::Cycle, false) => &[3.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0],
            (Self::Cycle, true) => &[3.0, 10.0, 50.0],
            (Self::Penetration, false) => &[3.0, 10.0, 30.0, 100.0, 300.0, 500.0],
            (Self::Penetration, true) => &[3.0, 10.0, 30.0, 100.0],
            (Self::DepthRange, false) => &[10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7],
            (Self::DepthRange, true) => &[10.0, 1e3, 1e5, 1e7],
        }
    }

    /// Returns the scene of a difficulty. A difficulty that counts things is rounded down, and is at least
    /// the smallest of the sweep.
    pub fn scene(self, difficulty: f64, seed: u64) -> Scene {
        self.trial(difficulty, seed).scene
    }

    /// Cameras that show the difficulty in many pixels, from the front, from behind, from within and from
    /// around, for pictures of `[width, height]` pixels. The first camera shows the difficulty best.
    ///
    /// # Errors
    ///
    /// If the size is zero or too large, or the difficulty is so large or small that no camera can be made.
    pub fn cameras(self, difficulty: f64, seed: u64, size: [u32; 2]) -> Result<Vec<Camera>, Error> {
        let Trial { looks, half_height, .. } = self.trial(difficulty, seed);
        let camera = |look: &Look| {
            Camera::perspective_by_slope(look.eye, look.target, look.up, half_height, size)
        };
        looks.iter().map(camera).collect()
    }

    fn trial(self, difficulty: f64, seed: u64) -> Trial {
        let least = self.sweep(false)[0];
        let count = difficulty.max(least) as u32;
        match self {
            Self::Angle => sheets::angle(difficulty, seed),
            Self::Gap => sheets::gap(difficulty, seed),
            Self::Offset => crowds::offset(difficulty, seed),
            Self::Scale => range::scale(difficulty, seed),
            Self::Sliver => sheets::sliver(difficulty, seed),
            Self::Nesting => crowds::nesting(count, seed),
            Self::Lattice => bodies::lattice(count, seed),
            Self::Boxes => bodies::boxes(count, seed),
            Self::Cycle => bodies::cycle(count, seed),
            Self::Penetration => crowds::penetration(count, seed),
            Self::DepthRange => range::depth_range(difficulty, seed),
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The error for a name that is not a family's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FamilyError(String);

impl fmt::Display for FamilyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = Family::ALL.map(Family::name).join(", ");
        write!(f, "no family of scenes is called {:?}; the families are {names}", self.0)
    }
}

impl std::error::Error for FamilyError {}

impl FromStr for Family {
    type Err = FamilyError;

    fn from_str(text: &str) -> Result<Self, FamilyError> {
        let found = Self::ALL.into_iter().find(|family| family.name() == text);
        found.ok_or_else(|| FamilyError(text.to_owned()))
    }
}
