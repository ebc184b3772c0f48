//! Joins the outputs of all jobs into one tree in depth-first order.

use crate::Error;
use crate::exact::StoredVertex;
use crate::memory::{push, reserve};
use crate::tree::parts::{Parts, RawNode, Record};

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
