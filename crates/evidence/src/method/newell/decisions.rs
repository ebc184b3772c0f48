//! What decides how often.

use super::compare::Reason;

/// How often each test of [`Newell`](super::Newell)'s algorithm decided in one view, and what became
/// of the pairs that none decided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Decisions {
    /// Pieces of what is in the picture before any cut.
    pub begun: usize,
    /// Pieces that were painted.
    pub painted: usize,
    /// Pairs P, Q that overlap in depth and were compared.
    pub compared: u64,
    /// Of these, pieces of one face, which cannot hide each other.
    pub of_one_face: u64,
    /// Of these, pairs that each of the five tests decided, where none before it did.
    pub by_test: [u64; 5],
    /// Pairs that no test decided: Q took P's place in the list.
    pub moved: u64,
    /// Pairs that no test decided: a piece was cut.
    pub cuts: u64,
    /// Pairs that no test decided, nor any cut: all is within the epsilon.
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
