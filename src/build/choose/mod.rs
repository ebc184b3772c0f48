//! Chooses the plane that divides a set of pieces.
//!
//! All choices go through `Chooser::choose`. `given` is the caller's function, which has priority. `auto` is
//! the default heuristic; `table` holds the sides of all pieces of a small set at all planes. `own` contains
//! the heuristics that only try the pieces' own planes, and compares these planes. `axis_planes` finds planes
//! perpendicular to the axes. `frame_planes` finds a good enough own plane for a small set in frames.
//! `coplanar` keeps coplanar pieces together. `peel` finds pieces that planes at the boundary of a large set
//! separate without a cut. `cost` compares planes. `tuning` contains the constants, and `set` contains a set's
//! pieces, exact and rounded.

mod auto;
mod axis_planes;
mod coplanar;
mod cost;
mod frame_planes;
mod given;
mod own;
mod peel;
mod set;
mod table;
mod tuning;

use super::options::{BuildOptions, DEFAULT_WEIGHTS, Heuristic};
use super::piece::Division;
use crate::Error;
use crate::exact::PlaneId;
use crate::progress::Watch;
use crate::random::mix;
use auto::Auto;
use given::SortedCorners;
use own::Scored;

pub(super) use coplanar::settle;
pub(crate) use coplanar::{SortedPieces, is_along};
pub(super) use given::GivenChooser;
pub use given::{PieceSet, SplitPlane};
pub(super) use peel::Peeled;
pub(crate) use set::Set;
pub(super) use table::{Chosen, Divided, Mask, Sides, Table};
pub use tuning::{FrameTuning, Tuning};

/// Chooses partition planes, with reused lists.
#[derive(Debug, Default)]
pub(super) struct Chooser {
    scored: Scored,
    auto: Auto,
}

impl Chooser {
    /// Chooses how a set of at least one piece is divided. Not every chosen plane makes progress; the builder
    /// checks this. Writes the plane and the pieces' sides to `division`, if the sides are known.
    pub(super) fn choose(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        division: &mut Division,
    ) -> Result<Choice, Error> {
        division.plane = None;
        if let Some(given) = rules.given {
            if let Some(plane) = given.plane(set, &rules.corners, rules.watch, division)? {
                return Ok(Choice::Split(plane));
            }
            division.plane = None;
        }
        let most = rules.tuning.own_planes;
        let lowest = || (0..set.len()).min_by_key(|&piece| set.pieces[piece].face).unwrap_or(0);
        Ok(Choice::Split(match rules.heuristic {
            Heuristic::First => set.own_plane(lowest()),
            Heuristic::Random { seed } => {
                let lowest = u64::from(set.pieces[lowest()].face);
                let random = mix(seed ^ mix(lowest << 32 | set.len() as u64));
                set.own_plane((random % set.len() as u64) as usize)
            }
            Heuristic::FewestSplits => self.scored.best(set, most, rules.watch, |counts, _| {
                (f64::from(counts.splits), f64::from(counts.imbalance()))
            }),
            Heuristic::Balanced => self.scored.best(set, most, rules.watch, |counts, _| {
                (f64::from(counts.imbalance()), f64::from(counts.splits))
            }),
            Heuristic::Weighted { splits, balance, axial } => {
                self.weighted(rules, set, most, [splits, balance, axial])
            }
            Heuristic::Sampled { candidates } => {
                self.weighted(rules, set, candidates as usize, DEFAULT_WEIGHTS)
            }
            Heuristic::FreePlanes => {
                if let Some(plane) = self.auto.common_plane(set) {
                    return Ok(Choice::Split(plane));
                }
                let free = match self.auto.free.find(set, rules)? {
                    Some(free) => Some(free),
                    None => self.auto.free.best(set, rules.watch)?,
                };
                free.map_or(set.own_plane(0), |free| free.plane)
            }
            Heuristic::Auto => return self.auto.choose(rules, set, division),
        }))
    }

    /// Returns the own plane with the lowest weighted sum.
    fn weighted(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        candidates: usize,
        [splits, balance, axial]: [f64; 3],
    ) -> PlaneId {
        let bonus = axial * set.len() as f64;
        self.scored.best(set, candidates, rules.watch, |counts, is_axial| {
            let reward = if is_axial { bonus } else { 0.0 };
            let imbalance = f64::from(counts.imbalance());
            (splits * f64::from(counts.splits) + balance * imbalance - reward, 0.0)
        })
    }
}

/// The division of a set: by one plane, or by peeling.
#[derive(Debug)]
pub(in crate::build) enum Choice {
    /// This plane divides the set.
    Split(PlaneId),
    /// A table divides the whole set.
    Table,
    /// These pieces are separated from the set, one layer after the other.
    Peel(Peeled),
}

/// The settings of the chooser.
#[derive(Debug)]
pub(in crate::build) struct ChooseContext<'a> {
    /// The caller's function, if any, which chooses first.
    pub(in crate::build) given: Option<&'a GivenChooser>,
    pub(in crate::build) corners: SortedCorners,
    pub(in crate::build) heuristic: Heuristic,
    pub(in crate::build) tuning: &'a Tuning,
    /// The number of planes for which subtrees are tried.
    pub(in crate::build) trials: usize,
    /// Reports cancellation. In a cancelled build, any plane may be chosen, so that the build ends soon.
    pub(in crate::build) watch: &'a Watch<'a>,
}

impl<'a> ChooseContext<'a> {
    pub(in crate::build) fn new(
        options: &'a BuildOptions,
        tuning: &'a Tuning,
        watch: &'a Watch<'a>,
    ) -> Self {
        let (given, corners) = (options.chooser.as_ref(), SortedCorners::default());
        let BuildOptions { heuristic, trials, .. } = *options;
        Self { given, corners, heuristic, tuning, trials, watch }
    }
}

#[cfg(test)]
mod tests;
