//! Subtrees built in parallel.

use std::collections::VecDeque;

use super::assemble::assemble;
use super::builder::{Memory, Shared, build};
use super::job::Job;
use crate::Error;
use crate::exact::Kernel;
use crate::memory;
use crate::tree::parts::Parts;

/// A build of fewer pieces starts on the calling thread. Larger: the pool's threads idle at first;
/// smaller: waking them takes longer than the build.
#[cfg(feature = "parallel")]
const ALONE: usize = 2048;

/// Builds a job, and all jobs that it and they hand over, and joins them.
#[cfg(feature = "parallel")]
pub(super) fn run<K: Kernel>(
    shared: &Shared<'_, K>,
    job: Job<K::Vertex>,
    memory: &mut Memory<K>,
) -> Result<Parts<K::Stored>, Error> {
    use super::assemble::Output;
    use std::sync::Mutex;

    type Slot<T> = Option<Result<T, Error>>;

    struct Work<'s, K: Kernel> {
        shared: &'s Shared<'s, K>,
        slots: &'s Mutex<Vec<Slot<Output<K::Stored>>>>,
    }

    impl<'s, K: Kernel> Work<'s, K> {
        fn run(
            &'s self,
            scope: &rayon::Scope<'s>,
            number: usize,
            job: Job<K::Vertex>,
            memory: &mut Memory<K>,
        ) {
            let output = build(self.shared, job, memory, |job| {
                let number = push(self.slots, None)?;
                scope.spawn(move |scope| self.run(scope, number, job, &mut Memory::default()));
                Ok(number)
            });
            let mut slots = self.slots.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            slots[number] = Some(output);
        }
    }

    fn push<T>(slots: &Mutex<Vec<T>>, slot: T) -> Result<usize, Error> {
        let mut slots = slots.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        memory::push(&mut slots, slot)?;
        Ok(slots.len() - 1)
    }

    if job.is_the_last() || !crate::parallel_map::are_running() {
        return in_turn(shared, job, memory);
    }
    let slots = Mutex::new(vec![None]);
    let work = Work { shared, slots: &slots };
    if job.pieces.len() < ALONE {
        rayon::in_place_scope(|scope| work.run(scope, 0, job, memory));
    } else {
        rayon::scope(|scope| work.run(scope, 0, job, memory));
    }
    let slots = slots.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    // The scope has waited for every job, so every slot is filled.
    let mut outputs = Vec::new();
    memory::reserve(&mut outputs, slots.len())?;
    for output in slots.into_iter().flatten() {
        outputs.push(output?);
    }
    assemble(outputs)
}

#[cfg(not(feature = "parallel"))]
pub(super) use in_turn as run;

/// As above, one after the other.
pub(super) fn in_turn<K: Kernel>(
    shared: &Shared<'_, K>,
    job: Job<K::Vertex>,
    memory: &mut Memory<K>,
) -> Result<Parts<K::Stored>, Error> {
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
