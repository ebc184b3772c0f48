//! Subtrees built in parallel.

use std::collections::VecDeque;
#[cfg(feature = "parallel")]
use std::sync::{Mutex, PoisonError};

#[cfg(feature = "parallel")]
use super::assemble::Output;
use super::assemble::assemble;
use super::builder::{Memory, Shared, build};
use super::job::Job;
use crate::Error;
use crate::memory;
use crate::tree::parts::Parts;

/// A build of fewer pieces starts on the calling thread. Larger: the pool's threads idle at first;
/// smaller: waking them takes longer than the build.
#[cfg(feature = "parallel")]
const ALONE: usize = 2048;

/// The outputs of the jobs so far, by their numbers; those of jobs that are not finished are missing.
#[cfg(feature = "parallel")]
type Outputs = Mutex<Vec<Option<Result<Output, Error>>>>;

/// Builds a job on a thread of the pool, and spawns the jobs that it hands over. Once it fails, the
/// others stop.
#[cfg(feature = "parallel")]
fn build_and_spawn<'s>(
    scope: &rayon::Scope<'s>,
    shared: &'s Shared<'s>,
    outputs: &'s Outputs,
    (number, job): (usize, Job),
    memory: &mut Memory,
) {
    let output = build(shared, job, memory, |job| {
        let mut listed = outputs.lock().unwrap_or_else(PoisonError::into_inner);
        let number = listed.len();
        memory::push(&mut listed, None)?;
        drop(listed);
        scope.spawn(move |scope| {
            build_and_spawn(scope, shared, outputs, (number, job), &mut Memory::default());
        });
        Ok(number)
    });
    if output.is_err() {
        shared.stop();
    }
    outputs.lock().unwrap_or_else(PoisonError::into_inner)[number] = Some(output);
}

/// Builds a job, and all jobs that it and they hand over, and joins them.
#[cfg(feature = "parallel")]
pub(super) fn run(shared: &Shared<'_>, job: Job, memory: &mut Memory) -> Result<Parts, Error> {
    if job.is_the_last() || !crate::parallel_map::are_running() {
        return in_turn(shared, job, memory);
    }
    let outputs = Mutex::new(vec![None]);
    if job.pieces.len() < ALONE {
        rayon::in_place_scope(|scope| build_and_spawn(scope, shared, &outputs, (0, job), memory));
    } else {
        rayon::scope(|scope| build_and_spawn(scope, shared, &outputs, (0, job), memory));
    }
    let outputs = outputs.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut finished = Vec::new();
    memory::reserve(&mut finished, outputs.len())?;
    let mut cancelled = None;
    // The scope has waited for every job, so none is missing.
    for output in outputs.into_iter().flatten() {
        match output {
            Ok(output) => finished.push(output),
            // What another job's error has stopped says nothing of that error.
            Err(error) if error.is_cancelled() => cancelled = Some(error),
            Err(error) => return Err(error),
        }
    }
    cancelled.map_or_else(|| assemble(finished), Err)
}

#[cfg(not(feature = "parallel"))]
pub(super) use in_turn as run;

/// As above, one after the other.
pub(super) fn in_turn(shared: &Shared<'_>, job: Job, memory: &mut Memory) -> Result<Parts, Error> {
    let mut jobs = VecDeque::new();
    let (mut next, mut outputs) = (Some(job), Vec::new());
    while let Some(job) = next {
        let done = outputs.len() + 1;
        let output = build(shared, job, memory, |job| {
            jobs.try_reserve(1).map_err(|_| Error::out_of_memory())?;
            jobs.push_back(job);
            Ok(done + jobs.len() - 1)
        })?;
        if outputs.is_empty() && jobs.is_empty() {
            return Ok(output.parts);
        }
        memory::push(&mut outputs, output)?;
        next = jobs.pop_front();
    }
    assemble(outputs)
}

/// Jobs after one of them failed.
#[cfg(all(test, feature = "parallel"))]
mod tests {
    use std::ops::ControlFlow;

    use crate::{BuildOptions, Heuristic};

    /// The depth that the sets on one side stay below, and that on the other side does not.
    const MOST: usize = 100;
    /// How many squares there are on the side that needs no more depth.
    const MANY: u32 = 1 << 15;

    /// A square at a place along the x axis.
    fn square(x: f64) -> [[f64; 3]; 4] {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(y, z)| [x, y, z])
    }

    /// By the planes of the first ones, the squares in front become a list, and those behind a tree without
    /// long branches.
    fn squares() -> impl Iterator<Item = [[f64; 3]; 4]> {
        let list = (1..2000).map(f64::from);
        // As often from each half, each quarter, and so on.
        let tree = (0..MANY).map(|k| -1.0 - f64::from(k.reverse_bits() >> 17));
        std::iter::once(0.0).chain(list).chain(tree).map(square)
    }

    /// One thread: the front first, then the job behind.
    #[test]
    fn after_an_error_the_other_jobs_do_not_run_to_their_end() {
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_max_depth(MOST);
        let mut done = 0;
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let tree = one.install(|| {
            options.build_with_progress(squares(), |progress| {
                done = done.max(progress.done);
                ControlFlow::Continue(())
            })
        });
        let error = tree.unwrap_err();
        assert!(error.is_over_budget() && !error.is_cancelled(), "{error}");
        assert!(done < 1000, "{done} faces were stored after the error");
        // The job behind is large enough to be heard of.
        let mut calls = 0;
        let behind = squares().filter(|square| square[0][0] < 0.0);
        let tree = options.build_with_progress(behind, |_| {
            calls += 1;
            ControlFlow::Continue(())
        });
        assert!(calls > 5 && tree.unwrap().stats().depth_max < MOST, "{calls}");
    }

    /// Whichever job fails, and however many stop because of it, the error is that of the first.
    #[test]
    fn what_an_error_has_stopped_does_not_hide_it() {
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_max_depth(MOST);
        for threads in [1, 2, 4] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for mirrored in [1.0, -1.0] {
                let squares = squares().map(|square| square.map(|[x, y, z]| [mirrored * x, y, z]));
                let error = pool.install(|| options.build(squares).unwrap_err());
                assert!(error.is_over_budget(), "{threads} threads, {mirrored}: {error}");
            }
        }
    }
}
