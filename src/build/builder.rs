//! Builds a subtree: a stack of sets of pieces, each split by a plane until one piece is left.

mod arena;
mod divide;
mod emit;
mod leaf;
mod settle;
mod state;
mod table;
mod tabled;

use super::assemble::Output;
use super::choose::{Choice, Set};
use super::job::Job;
use crate::Error;
use crate::exact::PlaneId;
use leaf::is_leaf;
use state::{Builder, Pending};
pub(super) use state::{Memory, Shared};

/// Builds the subtree of a job. Large sets are passed to `hand_over`, which returns the number of the
/// job that will build them.
pub(super) fn build<'a>(
    shared: &'a Shared<'a>,
    job: Job,
    memory: &mut Memory,
    mut hand_over: impl FnMut(Job) -> Result<usize, Error>,
) -> Result<Output, Error> {
    let mut builder = Builder::new(shared, job, memory);
    while let Some(pending) = builder.pending.pop() {
        shared.rules.watch.work(0)?;
        if let Some(job) = pending.job {
            builder.output.continue_in(job)?;
            continue;
        }
        builder.pieces.truncate(pending.range.end);
        builder.arena.truncate(pending.arena);
        builder.step(&pending, &mut hand_over)?;
        if builder.arena.len() > builder.compact_at {
            builder.compact()?;
        }
    }
    Ok(builder.end(memory))
}

impl Builder<'_> {
    /// Writes the node of the set on top of the stack, and puts its two sides on the stack.
    fn step(
        &mut self,
        pending: &Pending,
        hand_over: &mut impl FnMut(Job) -> Result<usize, Error>,
    ) -> Result<(), Error> {
        let start = pending.range.start;
        let set = &self.pieces[start..];
        let depth = pending.depth + 1;
        if !set.is_empty() {
            self.shared.budget.check_depth(depth)?;
        }
        if !is_leaf(set)
            && let Some(quick) = self.shared.rules.tabled(set.len())
        {
            return self.divide_tabled(start, pending.depth, quick);
        }
        let plane = if is_leaf(set) {
            // Only the root can be a leaf here: other leaves were stored with their parents.
            let Some(first) = set.first() else { return Ok(()) };
            let plane = PlaneId::face(first.face);
            self.partition(start, plane)?;
            plane
        } else {
            let count = set.len();
            let Shared { faces, rules, .. } = self.shared;
            let set = Set::new(faces, set, &self.arena);
            let plane = match self.chooser.choose(rules, &set, pending.is_peeled)? {
                Choice::Split(plane) => plane,
                Choice::Peel(peeled) => return self.emit_peeled(start, pending.depth, &peeled),
            };
            let plane = self.settle(start, plane)?;
            if self.makes_progress(count) {
                self.divide(start, plane)?;
                plane
            } else {
                // Free planes are counted by rounded distances, so exact decisions can show that one
                // separates nothing. A piece's own plane always does.
                let plane = self.settle(start, PlaneId::face(self.pieces[start].face))?;
                self.divide(start, plane)?;
                plane
            }
        };
        self.emit(plane, start, depth, hand_over)
    }
}
