//! Passes large sets to other threads as jobs, and joins the outputs of all jobs in depth-first order.

#[cfg(feature = "parallel")]
use std::sync::{Mutex, PoisonError};

use super::piece::Piece;
use super::subtree::{Builder, Shared};
use crate::Error;
use crate::exact::Vertex;
use crate::memory::reserve;
use crate::tree::parts::{Parts, RawNode, Record};

/// The least number of pieces on each side of a plane for which one side becomes a separate job. Too small:
/// more copying. Too large: threads wait for each other at the end.
const JOB: usize = 1024;

/// A set of pieces with their vertices, to be built into a subtree.
pub(super) struct Job {
    pub(super) pieces: Vec<Piece>,
    pub(super) arena: Vec<Vertex>,
    /// The number of nodes above the subtree.
    pub(super) depth: usize,
}

/// Whether one side of a plane becomes a separate job, given the numbers of pieces on both sides. Another
/// thread is worth using only if both sides are large.
pub(super) fn is_worth_a_job(back: usize, front: usize) -> bool {
    back.min(front) >= JOB
}

/// A build of fewer pieces starts on the calling thread. Too large: the pool's threads idle at first. Too
/// small: waking the threads takes longer than the build.
#[cfg(feature = "parallel")]
const ALONE: usize = 2048;

/// The outputs of the jobs so far, by the jobs' numbers; the outputs of unfinished jobs are missing.
#[cfg(feature = "parallel")]
type Outputs = Mutex<Vec<Option<Result<Output, Error>>>>;

/// Builds a job on a thread of the pool, and spawns the jobs that this job hands over. If this job fails, all
/// other jobs stop.
#[cfg(feature = "parallel")]
fn build_and_spawn<'s>(
    scope: &rayon::Scope<'s>,
    shared: &'s Shared<'s>,
    outputs: &'s Outputs,
    (number, job): (usize, Job),
    builder: &mut Builder,
) {
    let mut hand_over = |job| {
        let mut listed = outputs.lock().unwrap_or_else(PoisonError::into_inner);
        let number = listed.len();
        listed.push(None);
        drop(listed);
        scope.spawn(move |scope| {
            build_and_spawn(scope, shared, outputs, (number, job), &mut Builder::default());
        });
        Ok(number)
    };
    let output = builder.build(shared, job, Some(&mut hand_over));
    if output.is_err() {
        shared.stop();
    }
    outputs.lock().unwrap_or_else(PoisonError::into_inner)[number] = Some(output);
}

/// Builds a job, and then repeatedly the jobs that finished jobs handed over. Joins the outputs of all jobs.
pub(super) fn run(shared: &Shared<'_>, job: Job, builder: &mut Builder) -> Result<Parts, Error> {
    #[cfg(feature = "parallel")]
    if job.pieces.len() >= JOB && crate::parallel_map::are_running() {
        return run_in_parallel(shared, job, builder);
    }
    Ok(builder.build(shared, job, None)?.parts)
}

#[cfg(feature = "parallel")]
fn run_in_parallel(shared: &Shared<'_>, job: Job, builder: &mut Builder) -> Result<Parts, Error> {
    let outputs = Mutex::new(vec![None]);
    if job.pieces.len() < ALONE {
        rayon::in_place_scope(|scope| build_and_spawn(scope, shared, &outputs, (0, job), builder));
    } else {
        rayon::scope(|scope| build_and_spawn(scope, shared, &outputs, (0, job), builder));
    }
    let outputs = outputs.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut finished = Vec::new();
    let mut cancelled = None;
    // The scope has waited for every job, so no output is missing.
    for output in outputs.into_iter().flatten() {
        match output {
            Ok(output) => finished.push(output),
            // A job stopped because of another job's error does not report that error.
            Err(error) if error.kind() == crate::ErrorKind::Cancelled => cancelled = Some(error),
            Err(error) => return Err(error),
        }
    }
    cancelled.map_or_else(|| assemble(finished), Err)
}

/// The nodes and fragments that one job built.
#[derive(Debug, Default)]
pub(super) struct Output {
    pub(super) parts: Parts,
    /// The places for the outputs of other jobs.
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
    /// Appends a fragment. `cut` contains the fragment's vertices, or is empty if the fragment is a whole
    /// face. The positions of vertices are stored only if `keeps_positions`.
    pub(super) fn push(
        &mut self,
        face: u32,
        cut: &[Vertex],
        keeps_positions: bool,
    ) -> Result<(), Error> {
        let Parts { records, vertices, positions, .. } = &mut self.parts;
        reserve(records, 1)?;
        records.push(Record { face, vertices: vertices.len() as u32 });
        reserve(vertices, cut.len())?;
        vertices.extend(cut.iter().map(Vertex::stored));
        if keeps_positions {
            reserve(positions, cut.len())?;
            positions.extend(cut.iter().map(Vertex::position));
        }
        Ok(())
    }

    /// Removes everything.
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
    pub(super) fn continue_in(&mut self, job: usize) {
        let gap = self.end(job);
        self.gaps.push(gap);
    }

    /// The place after the last item of this output, where the output of a job is to be inserted.
    fn end(&self, job: usize) -> Gap {
        let Parts { nodes, records, vertices, .. } = &self.parts;
        Gap { nodes: nodes.len(), records: records.len(), vertices: vertices.len(), job }
    }

    /// Appends the part of another output between two gaps of that output.
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

/// Joins the outputs of all jobs. The first output is the root's; gaps in the outputs refer to the other
/// outputs by index.
fn assemble(mut outputs: Vec<Output>) -> Result<Parts, Error> {
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
    // The partly copied outputs: where to continue, and the next gap. A stack rather than recursion, because
    // jobs can be nested deeply.
    let mut stack = vec![start(0)];
    while let Some((from, next)) = stack.pop() {
        let output = &outputs[from.job];
        match output.gaps.get(next) {
            Some(&gap) => {
                whole.append(output, from, gap);
                stack.push((Gap { job: from.job, ..gap }, next + 1));
                stack.push(start(gap.job));
            }
            None => {
                whole.append(output, from, output.end(from.job));
                // Freed at once, so that the copies do not double the memory.
                outputs[from.job] = Output::default();
            }
        }
    }
    Ok(whole.parts)
}

/// Jobs after one job has failed.
#[cfg(all(test, feature = "parallel"))]
mod threads_tests {
    use std::ops::ControlFlow;

    use crate::{BuildOptions, Heuristic};

    /// The depth that one side does not reach and the other side exceeds.
    const MOST: usize = 100;
    /// The number of squares on the shallow side.
    const MANY: u32 = 1 << 15;

    /// A square at a place along the x axis.
    fn square(x: f64) -> [[f64; 3]; 4] {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(y, z)| [x, y, z])
    }

    /// With `Heuristic::First`, the squares in front become a list, and the squares behind a tree without
    /// long branches.
    fn squares() -> impl Iterator<Item = [[f64; 3]; 4]> {
        let list = (1..2000).map(f64::from);
        // Equally often from each half, each quarter, and so on.
        let tree = (0..MANY).map(|k| -1.0 - f64::from(k.reverse_bits() >> 17));
        std::iter::once(0.0).chain(list).chain(tree).map(square)
    }

    /// One thread builds the front first, and then the job behind.
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
        // The job behind is large enough to call the callback.
        let mut calls = 0;
        let behind = squares().filter(|square| square[0][0] < 0.0);
        let tree = options.build_with_progress(behind, |_| {
            calls += 1;
            ControlFlow::Continue(())
        });
        assert!(calls > 5 && tree.unwrap().stats().depth_max < MOST, "{calls}");
    }

    /// One half of the scene is too deep, the other half has too many fragments.
    #[test]
    fn the_error_of_a_budget_does_not_depend_on_the_threads() {
        let boards = (0..8).map(|k| {
            let z = 0.1 * f64::from(k);
            let [near, far] = [-1.5, -f64::from(MANY)];
            [[near, 0.0, z], [far, 0.0, z], [far, 1.0, z], [near, 1.0, z]]
        });
        let scene: Vec<_> = squares().chain(boards).collect();
        let options = BuildOptions::DEFAULT
            .with_heuristic(Heuristic::First)
            .with_max_depth(MOST)
            .with_max_fragments(scene.len() + 100);
        let mut messages = std::collections::BTreeSet::new();
        for threads in [1, 2, 4] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            // One thread builds the front first, which is another half in the mirror image.
            for mirrored in [1.0, -1.0] {
                let scene = scene.iter().map(|square| square.map(|[x, y, z]| [mirrored * x, y, z]));
                messages.insert(pool.install(|| options.build(scene).unwrap_err().to_string()));
            }
        }
        assert_eq!(messages.len(), 1, "{messages:?}");
    }

    /// Whichever job fails, and however many jobs stop because of it, the error of the failed job is
    /// returned.
    #[test]
    fn stopped_jobs_do_not_hide_the_error_that_stopped_them() {
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
