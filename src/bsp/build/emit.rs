//! Nodes that are done with, and the sets on their sides that are not.

use std::ops::Range;

use super::{Builder, JOB, Live, Pending, is_leaf};
use crate::Error;
use crate::bsp::assemble::{Child, RawNode};
use crate::bsp::convex::Taken;
use crate::bsp::jobs::Job;
use crate::geom::{Kernel, PlaneId, Side};

impl<K: Kernel> Builder<'_, K> {
    /// Emits the node of a set that has been divided, and puts off its two sides.
    pub(super) fn emit(
        &mut self,
        plane: PlaneId,
        start: usize,
        middle: usize,
        depth: usize,
        hand_over: &mut impl FnMut(Job<K::Vertex>) -> usize,
    ) {
        let end = self.pieces.len();
        // Coplanar polygons are painted in input order.
        self.scratch.own.sort_by_key(|piece| piece.face);
        let own = self.scratch.own.len();
        for i in 0..own {
            self.store(self.scratch.own[i]);
        }
        let [back, front] = [start..middle, middle..end].map(|range| {
            let is_leaf = is_leaf(&self.pieces[range.clone()]);
            (range, is_leaf)
        });
        let mut child = |(range, is_leaf): &(Range<usize>, bool)| {
            if !is_leaf {
                return Child::Node;
            }
            for i in range.clone() {
                self.store(self.pieces[i]);
            }
            Child::Leaf(range.len() as u32)
        };
        let node = RawNode { plane, own: own as u32, front: child(&front), back: child(&back) };
        self.output.nodes.push(node);
        let arena = self.arena.len();
        if !back.1 {
            let range = back.0;
            let both_large = range.len() >= JOB && front.0.len() >= JOB && !front.1;
            let job = both_large.then(|| hand_over(self.copy(range.clone(), depth)));
            self.pending.push(Pending { start: range.start, end: range.end, arena, depth, job });
        }
        if !front.1 {
            let (start, end) = (front.0.start, front.0.end);
            self.pending.push(Pending { start, end, arena, depth, job: None });
        }
    }

    /// Emits the nodes of pieces that are taken off a set, each behind or in front of the one
    /// before, and puts off what is left.
    pub(super) fn emit_list(
        &mut self,
        start: usize,
        depth: usize,
        list: &[Taken],
    ) -> Result<(), Error> {
        let depth = depth + list.len();
        if depth > self.shared.options.max_depth {
            return Err(Error::depth(self.shared.options.max_depth));
        }
        let mut left = vec![true; self.pieces.len() - start];
        for taken in list {
            let own = &mut self.scratch.own;
            own.clear();
            for &piece in &taken.pieces {
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
