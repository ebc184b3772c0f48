//! Pieces that are taken off a set one after the other, and cut nothing of what is left.

use crate::geom::{PlaneId, Side};

/// Which pieces of a set are taken off it, in turn.
#[derive(Debug, Default)]
pub(super) struct TakenApart {
    steps: Vec<Step>,
    /// The pieces of all steps, by their numbers in the set.
    pieces: Vec<u32>,
}

#[derive(Debug)]
struct Step {
    plane: PlaneId,
    rest: Side,
    /// Where its pieces end; they begin where those of the step before end.
    end: usize,
}

/// What is taken off a set in one step.
#[derive(Debug)]
pub(super) struct Taken<'a> {
    pub(super) plane: PlaneId,
    /// Where all others are that are not yet taken.
    pub(super) rest: Side,
    /// The pieces on the plane.
    pub(super) pieces: &'a [u32],
}

impl TakenApart {
    pub(super) fn clear(&mut self) {
        self.steps.clear();
        self.pieces.clear();
    }

    /// How many steps there are.
    pub(super) fn len(&self) -> usize {
        self.steps.len()
    }

    /// How many pieces are taken.
    pub(super) fn pieces(&self) -> usize {
        self.pieces.len()
    }

    pub(super) fn push(&mut self, plane: PlaneId, rest: Side, pieces: &[u32]) {
        self.pieces.extend_from_slice(pieces);
        self.steps.push(Step { plane, rest, end: self.pieces.len() });
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Taken<'_>> {
        self.steps.iter().enumerate().map(|(i, &Step { plane, rest, end })| {
            let start = if i == 0 { 0 } else { self.steps[i - 1].end };
            Taken { plane, rest, pieces: &self.pieces[start..end] }
        })
    }
}
