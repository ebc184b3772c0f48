//! Pairs of what has to be drawn before what.

use std::collections::HashSet;
use std::hash::BuildHasherDefault;

use super::reporter::{each, sort_unique};
use super::table::Mixer;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::reserve;

/// "`below` has to be drawn before `above`", by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Pair {
    pub(super) below: u32,
    pub(super) above: u32,
}

impl Pair {
    /// The pair of what a function has for both.
    pub(super) fn map(self, of: impl Fn(u32) -> u32) -> Self {
        Self { below: of(self.below), above: of(self.above) }
    }
}

/// Pairs that were found so far, each once.
pub(super) type Found = HashSet<Pair, BuildHasherDefault<Mixer>>;

/// Adds a pair.
pub(super) fn add(found: &mut Found, pair: Pair) -> Result<(), Error> {
    found.try_reserve(1).map_err(|_| Error::out_of_memory())?;
    found.insert(pair);
    Ok(())
}

/// All pairs of several sets, sorted, each once.
pub(super) fn sorted(parts: Vec<Found>, watch: &Watch<'_>) -> Result<Vec<Pair>, Error> {
    let mut pairs = Vec::new();
    for part in parts {
        reserve(&mut pairs, part.len())?;
        for pair in each(watch, 1, part) {
            pairs.push(pair?);
        }
    }
    sort_unique(&mut pairs, watch)?;
    Ok(pairs)
}
