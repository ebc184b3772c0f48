//! Large sets as jobs for other threads, and the outputs of all jobs joined depth first.

use std::collections::VecDeque;
#[cfg(feature = "parallel")]
use std::sync::{Mutex, PoisonError};

use super::piece::Piece;
use super::subtree::{Memory, Shared, build};
use crate::exact::{StoredVertex, Vertex};
use crate::memory::{push, reserve};
use crate::tree::parts::{Parts, RawNode, Record};
use crate::{Error, ErrorKind, memory};

#[cfg(not(feature = "parallel"))]
pub(super) use in_turn as run;

/// Where both sides of a plane have at least this many pieces, one side becomes a job of its own.
/// Smaller: more copying; larger: threads wait for each other at the end.
const JOB: usize = 1024;

/// A set of pieces with their vertices, to be built into a subtree.
pub(super) struct Job {
    pub(super) pieces: Vec<Piece>,
    pub(super) arena: Vec<Vertex>,
    /// How many nodes lie above it.
    pub(super) depth: usize,
}

impl Job {
    /// Whether it is too small to hand any set over: neither side of a plane has more pieces.
    #[cfg(feature = "parallel")]
    pub(super) fn is_the_last(&self) -> bool {
        self.pieces.len() < JOB
    }
}

/// Whether one side of a plane becomes a job of its own, by the numbers of pieces on both sides: only
/// where both are large is there work for another thread.
pub(super) fn is_worth_a_job(back: usize, front: usize) -> bool {
    back.min(front) >= JOB
}

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
            Err(error) if error.kind() == ErrorKind::Cancelled => cancelled = Some(error),
            Err(error) => return Err(error),
        }
    }
    cancelled.map_or_else(|| assemble(finished), Err)
}

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

/// The nodes and fragments that one job built.
#[derive(Debug, Default)]
pub(super) struct Output {
    pub(super) parts: Parts,
    /// Where the outputs of other jobs are to be inserted.
    gaps: Vec<Gap>,
}

#[derive(Clone, Copy, Debug)]
struct Gap {
    nodes: usize,
    records: usize,
    vertices: usize,
    job: usize,
}

impl Output {
    /// Appends a fragment.
    pub(super) fn push(
        &mut self,
        face: u32,
        vertices: impl ExactSizeIterator<Item = StoredVertex>,
    ) -> Result<(), Error> {
        reserve(&mut self.parts.records, 1)?;
        self.parts.records.push(Record { face, vertices: self.parts.vertices.len() as u32 });
        reserve(&mut self.parts.vertices, vertices.len())?;
        self.parts.vertices.extend(vertices);
        Ok(())
    }

    /// Appends the positions of the last fragment's vertices.
    pub(super) fn push_positions(
        &mut self,
        positions: impl ExactSizeIterator<Item = [f64; 3]>,
    ) -> Result<(), Error> {
        reserve(&mut self.parts.positions, positions.len())?;
        self.parts.positions.extend(positions);
        Ok(())
    }

    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.parts.clear();
        self.gaps.clear();
    }

    /// Appends a node.
    pub(super) fn push_node(&mut self, node: RawNode) -> Result<(), Error> {
        reserve(&mut self.parts.nodes, 1)?;
        self.parts.nodes.push(node);
        Ok(())
    }

    /// Records that the output of another job belongs here.
    pub(super) fn continue_in(&mut self, job: usize) -> Result<(), Error> {
        let (nodes, records) = (self.parts.nodes.len(), self.parts.records.len());
        push(&mut self.gaps, Gap { nodes, records, vertices: self.parts.vertices.len(), job })
    }

    /// Appends what another output has between two of its gaps.
    fn append(&mut self, other: &Self, from: Gap, to: Gap) {
        let shift = self.parts.vertices.len() as u32 - from.vertices as u32;
        self.parts.nodes.extend_from_slice(&other.parts.nodes[from.nodes..to.nodes]);
        self.parts.records.extend(
            other.parts.records[from.records..to.records]
                .iter()
                .map(|record| Record { vertices: record.vertices + shift, ..*record }),
        );
        self.parts.vertices.extend_from_slice(&other.parts.vertices[from.vertices..to.vertices]);
        let positions = other.parts.positions.get(from.vertices..to.vertices);
        self.parts.positions.extend_from_slice(positions.unwrap_or_default());
    }
}

/// Joins the outputs of all jobs. The first is that of the root; gaps in the outputs refer to the
/// others by their index.
pub(super) fn assemble(mut outputs: Vec<Output>) -> Result<Parts, Error> {
    if outputs.len() == 1 {
        return Ok(outputs.pop().unwrap_or_default().parts);
    }
    let sum = |len: fn(&Output) -> usize| outputs.iter().map(len).sum();
    let mut whole = Output::default();
    whole.parts.cuts = sum(|output| output.parts.cuts);
    reserve(&mut whole.parts.nodes, sum(|output| output.parts.nodes.len()))?;
    reserve(&mut whole.parts.records, sum(|output| output.parts.records.len()))?;
    reserve(&mut whole.parts.vertices, sum(|output| output.parts.vertices.len()))?;
    reserve(&mut whole.parts.positions, sum(|output| output.parts.positions.len()))?;
    let start = |job| (Gap { nodes: 0, records: 0, vertices: 0, job }, 0);
    // The outputs that are copied in part: from where to go on, and which gap comes next. A stack
    // rather than recursion, because jobs can be nested deeply.
    let mut stack = vec![start(0)];
    while let Some((from, next)) = stack.pop() {
        let output = &outputs[from.job];
        let end = Gap {
            nodes: output.parts.nodes.len(),
            records: output.parts.records.len(),
            vertices: output.parts.vertices.len(),
            job: from.job,
        };
        match output.gaps.get(next) {
            Some(&gap) => {
                whole.append(output, from, gap);
                push(&mut stack, (Gap { job: from.job, ..gap }, next + 1))?;
                push(&mut stack, start(gap.job))?;
            }
            None => {
                whole.append(output, from, end);
                // Freed at once, so that the copies do not double the memory.
                outputs[from.job] = Output::default();
            }
        }
    }
    Ok(whole.parts)
}

/// Jobs after one of them failed.
#[cfg(all(test, feature = "parallel"))]
mod threads_tests {
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
        assert!(error.kind() == crate::ErrorKind::OverBudget, "{error}");
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
                assert!(
                    error.kind() == crate::ErrorKind::OverBudget,
                    "{threads} threads, {mirrored}: {error}"
                );
            }
        }
    }
}
