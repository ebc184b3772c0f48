//! Nodes that are done with, and the sets on their sides that are not.

use std::mem::take;

use super::{Builder, JOB, Live, Pending, is_leaf};
use crate::Error;
use crate::bsp::assemble::{Child, RawNode};
use crate::bsp::jobs::Job;
use crate::geom::{Kernel, PlaneId, Side, reserve};

impl<K: Kernel> Builder<'_, K> {
    /// Emits the node of a set that has been divided, and puts off its two sides.
    pub(super) fn emit(
        &mut self,
        plane: PlaneId,
        start: usize,
        depth: usize,
        hand_over: &mut impl FnMut(Job<K::Vertex>) -> usize,
    ) {
        // Coplanar polygons are painted in input order.
        self.scratch.own.sort_by_key(|piece| piece.face);
        let own = self.scratch.own.len();
        (0..own).for_each(|i| self.store(self.scratch.own[i]));
        let (back, front) = (self.pieces.len() - start, self.scratch.front.len());
        let back_is_leaf = is_leaf(&self.pieces[start..]);
        let front_is_leaf = is_leaf(&self.scratch.front);
        if front_is_leaf {
            (0..front).for_each(|i| self.store(self.scratch.front[i]));
        }
        if back_is_leaf {
            (start..start + back).for_each(|i| self.store(self.pieces[i]));
            self.pieces.truncate(start);
        }
        let child =
            |is_leaf, len: usize| if is_leaf { Child::Leaf(len as u32) } else { Child::Node };
        let (back_child, front_child) = (child(back_is_leaf, back), child(front_is_leaf, front));
        let node = RawNode { plane, own: own as u32, front: front_child, back: back_child };
        self.output.nodes.push(node);
        let arena = self.arena.len();
        if !back_is_leaf {
            let both_large = back >= JOB && front >= JOB && !front_is_leaf;
            let job = both_large.then(|| hand_over(self.take(start, depth)));
            let end = self.pieces.len();
            self.pending.push(Pending { start, end, arena, depth, job });
        }
        if !front_is_leaf {
            let start = self.pieces.len();
            if start == 0 {
                std::mem::swap(&mut self.pieces, &mut self.scratch.front);
            } else {
                reserve(&mut self.pieces, front);
                self.pieces.extend_from_slice(&self.scratch.front);
            }
            let end = self.pieces.len();
            self.pending.push(Pending { start, end, arena, depth, job: None });
        }
    }

    /// Emits the nodes of pieces that are taken off a set, each behind or in front of the one
    /// before, and puts off what is left.
    pub(super) fn emit_list(&mut self, start: usize, depth: usize) -> Result<(), Error> {
        let list = take(&mut self.chooser.taken);
        let depth = depth + list.len();
        if depth > self.shared.options.max_depth {
            return Err(Error::depth(self.shared.options.max_depth));
        }
        let mut left = vec![true; self.pieces.len() - start];
        for taken in list.iter() {
            let own = &mut self.scratch.own;
            own.clear();
            for &piece in taken.pieces {
                left[piece as usize] = false;
                own.push(self.pieces[start + piece as usize]);
            }
            own.sort_by_key(|piece| piece.face);
            let own = own.len();
            (0..own).for_each(|i| self.store(self.scratch.own[i]));
            let child = |side| if taken.rest == side { Child::Node } else { Child::Leaf(0) };
            let (front, back) = (child(Side::Front), child(Side::Back));
            self.output.nodes.push(RawNode { plane: taken.plane, own: own as u32, front, back });
        }
        self.chooser.taken = list;
        let mut left = left.iter();
        let mut next = start;
        for i in start..self.pieces.len() {
            if left.next() == Some(&true) {
                self.pieces[next] = self.pieces[i];
                next += 1;
            }
        }
        self.pieces.truncate(next);
        if is_leaf(&self.pieces[start..]) {
            (start..next).for_each(|i| self.store(self.pieces[i]));
            if let Some(node) = self.output.nodes.last_mut() {
                let child = Child::Leaf((next - start) as u32);
                let side = if node.front == Child::Node { &mut node.front } else { &mut node.back };
                *side = child;
            }
        } else {
            let arena = self.arena.len();
            self.pending.push(Pending { start, end: next, arena, depth, job: None });
        }
        Ok(())
    }

    fn store(&mut self, live: Live) {
        let kernel = self.shared.kernel;
        let vertices = live.piece(&self.arena).cut.unwrap_or_default();
        self.output.push(live.face, vertices.iter().map(|vertex| kernel.store(vertex)));
        self.shared.watch.finish(live.cuts);
    }
}
