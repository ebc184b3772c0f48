//! The budgets of a build: how many fragments its tree may have, and how deep it may be.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::options::BuildOptions;
use crate::error::{Error, Limit};
use crate::tree::node_record::MOST_FRAGMENTS;

/// What all jobs of a build may use together.
pub(super) struct Budget {
    /// The pieces that exist by now, over all jobs.
    fragments: AtomicUsize,
    max_fragments: usize,
    max_depth: usize,
}

impl Budget {
    /// The budgets of a build that begins with so many faces.
    pub(super) fn new(options: &BuildOptions, faces: usize) -> Result<Self, Error> {
        let budget = Self {
            fragments: AtomicUsize::new(faces),
            max_fragments: options.max_fragments.min(MOST_FRAGMENTS),
            max_depth: options.max_depth,
        };
        budget.count(0)?;
        Ok(budget)
    }

    /// Counts new pieces; an error if there are too many.
    pub(super) fn count(&self, new: usize) -> Result<(), Error> {
        let total = self.fragments.fetch_add(new, Ordering::Relaxed) + new;
        if total > self.max_fragments {
            Err(Limit::Fragments(self.max_fragments).error())
        } else {
            Ok(())
        }
    }

    /// Checks the depth of a node; an error if it is too deep.
    pub(super) fn check_depth(&self, depth: usize) -> Result<(), Error> {
        if depth > self.max_depth { Err(Limit::Depth(self.max_depth).error()) } else { Ok(()) }
    }
}
