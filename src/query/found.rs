//! Where a ray meets the fragments that a walk has reached, the nearest first: a heap.

use smallvec::SmallVec;

use super::meeting::Meeting;
use super::probe::Probe;
use crate::exact::Faces;

/// A binary heap: each meeting comes before the two below it. (That of the standard library compares
/// without the ray, by which these are compared.)
///
/// To push takes a few comparisons if the meeting comes later than most, as at one place, where faces
/// are reached in input order; to pop takes one or two a level.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    heap: SmallVec<[Meeting; 8]>,
}

impl Found {
    /// The nearest.
    pub(super) fn first(&self) -> Option<&Meeting> {
        self.heap.first()
    }

    /// Puts one in: O(log n) comparisons.
    pub(super) fn push(&mut self, meeting: Meeting, probe: &mut Probe, faces: &Faces) {
        self.heap.push(meeting);
        self.rise(self.heap.len() - 1, probe, faces);
    }

    /// Takes the nearest out: O(log n) comparisons.
    pub(super) fn pop(&mut self, probe: &mut Probe, faces: &Faces) -> Option<Meeting> {
        if self.heap.len() <= 1 {
            return self.heap.pop();
        }
        let first = self.heap.swap_remove(0);
        // The last goes down as far as it can without being compared: mostly it belongs there.
        let (mut at, mut below) = (0, 1);
        while below < self.heap.len() {
            let other = below + 1;
            if other < self.heap.len()
                && self.heap[other].compare(&self.heap[below], probe, faces).is_lt()
            {
                below = other;
            }
            self.heap.swap(at, below);
            (at, below) = (below, 2 * below + 1);
        }
        self.rise(at, probe, faces);
        Some(first)
    }

    /// Moves a meeting up before those that it comes before.
    fn rise(&mut self, mut at: usize, probe: &mut Probe, faces: &Faces) {
        while at > 0 {
            let above = (at - 1) / 2;
            if self.heap[at].compare(&self.heap[above], probe, faces).is_gt() {
                break;
            }
            self.heap.swap(at, above);
            at = above;
        }
    }
}
