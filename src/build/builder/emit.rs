//! Writes finished nodes and leaves, and puts the sets on their sides on the stack.

use super::leaf::is_leaf;
use super::state::{Builder, Pending};
use crate::Error;
use crate::build::choose::Peeled;
use crate::build::job::{Job, is_worth_a_job};
use crate::build::piece::Piece;
use crate::exact::{PlaneId, Side};
use crate::memory::{collect, push, reserve};
use crate::tree::parts::{RawChild, RawNode};

impl Builder<'_> {
    /// Writes the node of a set that has been divided, and puts its two sides on the stack.
    pub(super) fn emit(
        &mut self,
        plane: PlaneId,
        start: usize,
        depth: usize,
        hand_over: &mut impl FnMut(Job) -> Result<usize, Error>,
    ) -> Result<(), Error> {
        // Coplanar polygons are painted in input order.
        self.scratch.own.sort_unstable_by_key(Piece::rank);
        let own = self.scratch.own.len();
        (0..own).try_for_each(|i| self.store(self.scratch.own[i]))?;
        let (back, front) = (self.pieces.len() - start, self.scratch.front.len());
        let back_is_leaf = is_leaf(&self.pieces[start..]);
        let front_is_leaf = is_leaf(&self.scratch.front);
        // Leaves are stored here, right behind the node's own fragments and front before back: orders
        // rely on these numbers.
        if front_is_leaf {
            (0..front).try_for_each(|i| self.store(self.scratch.front[i]))?;
        }
        if back_is_leaf {
            (start..start + back).try_for_each(|i| self.store(self.pieces[i]))?;
            self.pieces.truncate(start);
        }
        let child =
            |is_leaf, len: usize| if is_leaf { RawChild::Leaf(len as u32) } else { RawChild::Node };
        let (back_child, front_child) = (child(back_is_leaf, back), child(front_is_leaf, front));
        let node = RawNode { plane, own: own as u32, front: front_child, back: back_child };
        self.output.push_node(node)?;
        // The back goes below the front, so that the front is built first, as nodes stand depth first.
        if !back_is_leaf {
            // The back is handed over because it is on top of the stack just now; this thread goes on
            // with the front.
            let job = match is_worth_a_job(back, front) {
                true => Some(hand_over(self.take(start, depth)?)?),
                false => None,
            };
            let range = start..self.pieces.len();
            let back = Pending::new(range, self.arena.len(), depth);
            push(&mut self.pending, Pending { job, ..back })?;
        }
        if front_is_leaf { Ok(()) } else { self.push_front(depth) }
    }

    /// Puts the pieces in `scratch.front` on the stack.
    fn push_front(&mut self, depth: usize) -> Result<(), Error> {
        let start = self.pieces.len();
        // An empty stack takes the list as it is, so that a large set is not in memory twice.
        if start == 0 {
            std::mem::swap(&mut self.pieces, &mut self.scratch.front);
        } else {
            reserve(&mut self.pieces, self.scratch.front.len())?;
            self.pieces.extend_from_slice(&self.scratch.front);
        }
        let front = Pending::new(start..self.pieces.len(), self.arena.len(), depth);
        push(&mut self.pending, front)
    }

    /// Writes one node for each layer of pieces that is peeled off a set, and puts the rest of the set
    /// on the stack. Each layer's node is the only child of the one before.
    pub(super) fn emit_peeled(
        &mut self,
        start: usize,
        depth: usize,
        peeled: &Peeled,
    ) -> Result<(), Error> {
        let depth = depth + peeled.layers().len();
        self.shared.budget.check_depth(depth)?;
        let mut left = collect((start..self.pieces.len()).map(|_| true))?;
        for layer in peeled.layers() {
            let own = &mut self.scratch.own;
            own.clear();
            reserve(own, peeled.pieces(layer).len())?;
            // Pieces are marked and not removed yet: all layers name them by their places in the set.
            for &piece in peeled.pieces(layer) {
                left[piece as usize] = false;
                own.push(self.pieces[start + piece as usize]);
            }
            own.sort_unstable_by_key(Piece::rank);
            let own = own.len();
            (0..own).try_for_each(|i| self.store(self.scratch.own[i]))?;
            let child = |side| if layer.rest == side { RawChild::Node } else { RawChild::Leaf(0) };
            let (front, back) = (child(Side::Front), child(Side::Back));
            let node = RawNode { plane: layer.plane, own: own as u32, front, back };
            self.output.push_node(node)?;
        }
        let mut next = start;
        for (i, &is_left) in (start..).zip(&left) {
            if is_left {
                self.pieces[next] = self.pieces[i];
                next += 1;
            }
        }
        self.pieces.truncate(next);
        if is_leaf(&self.pieces[start..]) {
            (start..next).try_for_each(|i| self.store(self.pieces[i]))?;
            // The last layer's node was written with a child node that now turns out to be a leaf.
            if let Some(node) = self.output.parts.nodes.last_mut() {
                let child = RawChild::Leaf((next - start) as u32);
                let side =
                    if node.front == RawChild::Node { &mut node.front } else { &mut node.back };
                *side = child;
            }
        } else {
            let rest = Pending::new(start..next, self.arena.len(), depth);
            push(&mut self.pending, Pending { is_peeled: true, ..rest })?;
        }
        Ok(())
    }
}
