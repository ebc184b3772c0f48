//! From the jobs' outputs to one tree in depth-first order.

use crate::geom::PlaneId;

/// A node as it is first written.
#[derive(Clone, Copy, Debug)]
pub(super) struct RawNode {
    pub(super) plane: PlaneId,
    /// How many fragments lie on the plane.
    pub(super) own: u32,
    pub(super) front: Child,
    pub(super) back: Child,
}

/// What is on one side of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Child {
    /// So many fragments, stored with the node's own.
    Leaf(u32),
    /// A node.
    Node,
}

/// A fragment as it is stored: its vertices end where those of the next begin; a whole face has
/// none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Record {
    pub(super) face: u32,
    pub(super) vertices: u32,
}

/// Nodes depth first, the front before the back, and their fragments in the same order: those on
/// the plane, those of a front leaf, those of a back leaf, then those of the nodes below.
#[derive(Debug)]
pub(super) struct Output<S> {
    pub(super) nodes: Vec<RawNode>,
    pub(super) records: Vec<Record>,
    pub(super) vertices: Vec<S>,
    /// Where the outputs of other jobs belong.
    gaps: Vec<Gap>,
}

#[derive(Clone, Copy, Debug)]
struct Gap {
    nodes: usize,
    records: usize,
    vertices: usize,
    job: usize,
}

impl<S> Default for Output<S> {
    fn default() -> Self {
        Self { nodes: vec![], records: vec![], vertices: vec![], gaps: vec![] }
    }
}

impl<S: Copy> Output<S> {
    /// Appends a fragment.
    pub(super) fn push(&mut self, face: u32, vertices: impl Iterator<Item = S>) {
        self.records.push(Record { face, vertices: self.vertices.len() as u32 });
        self.vertices.extend(vertices);
    }

    /// Notes that another job's output comes next.
    pub(super) fn continue_in(&mut self, job: usize) {
        let (nodes, records) = (self.nodes.len(), self.records.len());
        self.gaps.push(Gap { nodes, records, vertices: self.vertices.len(), job });
    }

    /// Appends what another output has between two gaps.
    fn append(&mut self, other: &Self, from: Gap, to: Gap) {
        let shift = self.vertices.len() as u32 - from.vertices as u32;
        self.nodes.extend_from_slice(&other.nodes[from.nodes..to.nodes]);
        self.records.extend(
            other.records[from.records..to.records]
                .iter()
                .map(|record| Record { vertices: record.vertices + shift, ..*record }),
        );
        self.vertices.extend_from_slice(&other.vertices[from.vertices..to.vertices]);
    }
}

/// Puts the outputs of all jobs, the first one's being the root's, into one.
pub(super) fn assemble<S: Copy>(mut outputs: Vec<Output<S>>) -> Output<S> {
    if outputs.len() == 1 {
        return outputs.pop().unwrap_or_default();
    }
    let sum = |len: fn(&Output<S>) -> usize| outputs.iter().map(len).sum();
    let mut whole = Output {
        nodes: Vec::with_capacity(sum(|output| output.nodes.len())),
        records: Vec::with_capacity(sum(|output| output.records.len())),
        vertices: Vec::with_capacity(sum(|output| output.vertices.len())),
        gaps: vec![],
    };
    let start = |job| (Gap { nodes: 0, records: 0, vertices: 0, job }, 0);
    // What is still to be copied of each output: from where, and which gap comes next.
    let mut stack = vec![start(0)];
    while let Some((from, next)) = stack.pop() {
        let output = &outputs[from.job];
        let end = Gap {
            nodes: output.nodes.len(),
            records: output.records.len(),
            vertices: output.vertices.len(),
            job: from.job,
        };
        match output.gaps.get(next) {
            Some(&gap) => {
                whole.append(output, from, gap);
                stack.push((Gap { job: from.job, ..gap }, next + 1));
                stack.push(start(gap.job));
            }
            None => {
                whole.append(output, from, end);
                // Its memory is needed no more.
                outputs[from.job] = Output::default();
            }
        }
    }
    whole
}
