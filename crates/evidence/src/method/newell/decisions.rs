//! Counts of decisions by test.

use super::compare::Reason;

/// Counts of decisions by each test of [`Newell`](super::Newell)'s algorithm in one view, and the outcome of
/// pairs that no test decided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Decisions {
    /// Pieces of the faces in the picture before any cut.
    pub begun: usize,
    /// Pieces that were painted.
    pub painted: usize,
    /// Pairs P, Q that overlap in depth and were compared.
    pub compared: u64,
    /// Compared pairs of pieces of one face, which cannot hide each other.
    pub of_one_face: u64,
    /// Compared pairs that each of the five tests decided, after the earlier tests did not.
    pub by_test: [u64; 5],
    /// Pairs that no test decided: Q took P's place in the list.
    pub moved: u64,
    /// Pairs that no test decided: a piece was cut.
    pub cuts: u64,
    /// Pairs that neither a test nor a cut decided, because everything is within the epsilon.
    pub passed: u64,
}

impl Decisions {
    pub(super) fn add(&mut self, reason: Option<Reason>) {
        self.compared += 1;
        match reason {
            Some(Reason::OneFace) => self.of_one_face += 1,
            Some(Reason::Test(number)) => self.by_test[number] += 1,
            None => {}
        }
    }
}
