//! Subtrees built in parallel.

use super::assemble::Output;
use super::builder::{Shared, build};
use super::job::Job;
use crate::Error;
use crate::exact::Kernel;

/// A build of fewer pieces starts on the calling thread. Larger: the pool's threads idle at first;
/// smaller: waking them takes longer than the build.
#[cfg(feature = "parallel")]
const ALONE: usize = 2048;

/// Builds a job, and all jobs that it and they hand over. The first output is the job's own; gaps in
/// the outputs refer to the others by their index.
#[cfg(feature = "parallel")]
pub(super) fn run<K: Kernel>(
    shared: &Shared<'_, K>,
    job: Job<K::Vertex>,
) -> Result<Vec<Output<K::Stored>>, Error> {
    use std::sync::Mutex;

    type Slot<T> = Option<Result<T, Error>>;

    fn work<'s, K: Kernel>(
        scope: &rayon::Scope<'s>,
        shared: &'s Shared<'s, K>,
        slots: &'s Mutex<Vec<Slot<Output<K::Stored>>>>,
        number: usize,
        job: Job<K::Vertex>,
    ) {
        let output = build(shared, job, |job| {
            let number = push(slots, None);
            scope.spawn(move |scope| work(scope, shared, slots, number, job));
            number
        });
        let mut slots = slots.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        slots[number] = Some(output);
    }

    fn push<T>(slots: &Mutex<Vec<T>>, slot: T) -> usize {
        let mut slots = slots.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        slots.push(slot);
        slots.len() - 1
    }

    let slots = Mutex::new(vec![None]);
    if job.pieces.len() < ALONE {
        rayon::in_place_scope(|scope| work(scope, shared, &slots, 0, job));
    } else {
        rayon::scope(|scope| work(scope, shared, &slots, 0, job));
    }
    let slots = slots.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    // The scope has waited for every job, so every slot is filled.
    slots.into_iter().flatten().collect()
}

/// As above, one after the other.
#[cfg(not(feature = "parallel"))]
pub(super) fn run<K: Kernel>(
    shared: &Shared<'_, K>,
    job: Job<K::Vertex>,
) -> Result<Vec<Output<K::Stored>>, Error> {
    let mut jobs = std::collections::VecDeque::from([job]);
    let mut outputs = Vec::new();
    while let Some(job) = jobs.pop_front() {
        let done = outputs.len() + 1;
        let output = build(shared, job, |job| {
            jobs.push_back(job);
            done + jobs.len() - 1
        })?;
        outputs.push(output);
    }
    Ok(outputs)
}
