//! Choosing the prepared of a set of pieces.
//!
//! | file | decides |
//! |---|---|
//! | `auto` | the default heuristic: what is tried, and in which order |
//! | `cost` | what a plane costs; the lowest cost wins |
//! | `free` | which planes perpendicular to the axes are candidates |
//! | `own` | which of the pieces' own planes is best, by successive halving |
//! | `quick` | in frames: which own plane of a small set is good enough to end the search |
//! | `peel` | which pieces are taken off one after the other, cutting nothing |
//! | `sample`, `sketch` | with which pieces planes are compared, and on which side these are, rounded |
//! | `scored` | the heuristics that count what each own plane does to all pieces |
//! | `set` | what is known of a set and of its pieces |
//! | `crossing` | whether two pieces cross |
//! | `rules` | what the chooser is told, and what it answers |
//! | `tuning` | the numbers |

mod auto;
mod cost;
mod crossing;
mod free;
mod own;
mod peel;
mod quick;
mod rules;
mod sample;
mod scored;
mod set;
mod sketch;
#[cfg(test)]
mod tests;
mod tuning;

use super::heuristic::{DEFAULT_WEIGHTS, Heuristic};
use crate::Error;
use crate::exact::PlaneId;
use crate::random::mix;
use auto::Auto;
pub(super) use crossing::crosses;
pub(super) use peel::Peeled;
pub(super) use quick::Best;
pub(super) use rules::{Choice, MOST_IN_TABLE, Rules};
use scored::Scored;
pub(super) use set::Set;
pub use tuning::{Quick, Tuning};

/// Chooses splitters; its lists are kept to be used again.
#[derive(Debug, Default)]
pub(super) struct Chooser {
    scored: Scored,
    auto: Auto,
}

impl Chooser {
    /// Chooses what to do with a set of at least one piece. `is_peeled`: it is what peeling left; then
    /// peeling is not tried again if the set is small. Not every plane chosen makes progress; the
    /// builder checks.
    pub(super) fn choose(
        &mut self,
        rules: &Rules<'_>,
        set: &Set<'_>,
        is_peeled: bool,
    ) -> Result<Choice, Error> {
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
            })?,
            Heuristic::Balanced => self.scored.best(set, most, rules.watch, |counts, _| {
                (f64::from(counts.imbalance()), f64::from(counts.splits))
            })?,
            Heuristic::Weighted { splits, balance, axial } => {
                self.weighted(rules, set, most, [splits, balance, axial])?
            }
            Heuristic::Sampled { candidates } => {
                self.weighted(rules, set, candidates as usize, DEFAULT_WEIGHTS)?
            }
            Heuristic::FreePlanes => {
                if let Some(plane) = self.auto.common_plane(set, rules.tuning) {
                    return Ok(Choice::Split(plane));
                }
                let free = self.auto.free.best(set, rules.tuning, rules.watch)?;
                free.map_or(set.own_plane(0), |free| free.plane)
            }
            Heuristic::Auto => return self.auto.choose(rules, set, is_peeled),
        }))
    }

    /// A free plane that cuts nothing.
    pub(super) fn clean(
        &mut self,
        rules: &Rules<'_>,
        set: &Set<'_>,
    ) -> Result<Option<PlaneId>, Error> {
        Ok(self.auto.free.clean(set, rules.tuning)?.map(|free| free.plane))
    }

    /// The own plane of least weighted sum.
    fn weighted(
        &mut self,
        rules: &Rules<'_>,
        set: &Set<'_>,
        candidates: usize,
        [splits, balance, axial]: [f64; 3],
    ) -> Result<PlaneId, Error> {
        let bonus = axial * set.len() as f64;
        self.scored.best(set, candidates, rules.watch, |counts, is_axial| {
            let reward = if is_axial { bonus } else { 0.0 };
            let imbalance = f64::from(counts.imbalance());
            (splits * f64::from(counts.splits) + balance * imbalance - reward, 0.0)
        })
    }
}
