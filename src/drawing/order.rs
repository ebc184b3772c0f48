//! An order of polygons in which each comes before those that show above it, but for a few.

mod graph;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use graph::{Graph, NONE};

use super::halving::VISITED;
use super::pairs::Pair;
use super::reporter::{each, sort_by};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{collect, filled, push, reserve};

/// An order of nodes.
#[derive(Debug)]
pub(super) struct Ordered {
    /// All nodes; for each pair, `below` comes first unless it is clipped and `above` is opaque.
    pub(super) order: Vec<u32>,
    /// Nodes of which only what shows is drawn: they need not come before any opaque one.
    pub(super) is_clipped: Vec<bool>,
}

/// Of a large component, one in so many nodes is clipped at once. Larger: components are searched
/// again and again; smaller: more is clipped (and given back one by one).
const CLIPPED_AT_ONCE: usize = 64;

/// Orders nodes by sorted pairs; where these leave a choice, by `rank`. No cycle goes through translucent
/// nodes alone.
///
/// Cycles are opened by cutting out nodes: greedily those with the most pairs on both sides, and then
/// those are given back that close no cycle, so that none is clipped in vain. (To clip as few as
/// possible is hard: R. M. Karp, "Reducibility among combinatorial problems", 1972.)
pub(super) fn order(
    nodes: usize,
    pairs: &[Pair],
    rank: &[u32],
    is_opaque: &dyn Fn(u32) -> bool,
    watch: &Watch<'_>,
) -> Result<Ordered, Error> {
    let mut graph = Graph::new(nodes, pairs, is_opaque, watch)?;
    graph.open_cycles()?;
    let order = graph.sorted(rank)?;
    Ok(Ordered { order, is_clipped: graph.is_clipped })
}

/// Whether each node is in a cycle, by sorted pairs; then the number of its strongly connected
/// component, that of one of its nodes.
pub(super) fn cycles(
    nodes: usize,
    pairs: &[Pair],
    watch: &Watch<'_>,
) -> Result<Vec<Option<u32>>, Error> {
    let mut graph = Graph::new(nodes, pairs, &|_| true, watch)?;
    let all: Vec<u32> = collect(0..nodes as u32)?;
    graph.components(&all)?;
    let number = |&component: &u32| (component != NONE).then_some(component);
    collect(graph.component.iter().map(number))
}

impl Graph<'_> {
    /// Clips nodes until there is no cycle.
    fn open_cycles(&mut self) -> Result<(), Error> {
        let all: Vec<u32> = collect(0..self.is_clipped.len() as u32)?;
        let first = self.components(&all)?;
        for nodes in first {
            let mut clipped = Vec::new();
            let mut open = vec![collect(nodes.iter().copied())?];
            while let Some(mut nodes) = open.pop() {
                let mut degrees = self.degrees(&nodes)?;
                degrees.retain(|&(_, node)| !self.is_clipped[node as usize]);
                let key = |&(product, node): &(u64, u32)| Reverse((product, Reverse(node)));
                sort_by(&mut degrees, self.watch, |a, b| key(a).cmp(&key(b)))?;
                if degrees.is_empty() {
                    continue;
                }
                degrees.truncate((nodes.len() / CLIPPED_AT_ONCE).max(1));
                for (_, node) in degrees {
                    self.is_clipped[node as usize] = true;
                    push(&mut clipped, node)?;
                }
                for &node in &nodes {
                    if self.is_last(node) {
                        self.component[node as usize] = NONE;
                    }
                }
                nodes.retain(|&node| !self.is_last(node));
                let mut left = self.components(&nodes)?;
                reserve(&mut open, left.len())?;
                open.append(&mut left);
            }
            self.give_back(&nodes, clipped)?;
        }
        Ok(())
    }

    /// The number of pairs within the component that end at a node, times that of those that begin.
    fn degrees(&mut self, nodes: &[u32]) -> Result<Vec<(u64, u32)>, Error> {
        let mut counts = std::mem::take(&mut self.search.counts);
        for node in each(self.watch, 1, nodes) {
            counts[*node? as usize] = [0; 2];
        }
        let of = |node: u32| self.component[node as usize];
        for node in each(self.watch, VISITED, nodes) {
            let node = *node?;
            for above in each(self.watch, 1, self.above(node)) {
                let above = above?;
                if of(above) == of(node) && self.holds(Pair { below: node, above }) {
                    counts[node as usize][0] += 1;
                    counts[above as usize][1] += 1;
                }
            }
        }
        let product = |node: u32| counts[node as usize].map(u64::from).into_iter().product();
        let mut degrees = Vec::new();
        reserve(&mut degrees, nodes.len())?;
        for node in each(self.watch, 1, nodes) {
            let node = *node?;
            degrees.push((product(node), node));
        }
        self.search.counts = counts;
        Ok(degrees)
    }

    /// Takes back those of the clipped nodes that close no cycle: all cycles are within `nodes`.
    fn give_back(&mut self, nodes: &[u32], mut clipped: Vec<u32>) -> Result<(), Error> {
        for node in each(self.watch, 1, nodes) {
            self.component[*node? as usize] = nodes[0];
        }
        sort_by(&mut clipped, self.watch, |&a, &b| self.above_count(a).cmp(&self.above_count(b)))?;
        for node in clipped {
            if !self.closes_cycle(node, nodes[0])? {
                self.is_clipped[node as usize] = false;
            }
        }
        for node in each(self.watch, 1, nodes) {
            self.component[*node? as usize] = NONE;
        }
        Ok(())
    }

    fn closes_cycle(&mut self, start: u32, component: u32) -> Result<bool, Error> {
        let mut reached = std::mem::take(&mut self.search.reached);
        let (mut stack, mut is_closed) = (vec![start], false);
        while let Some(node) = stack.pop() {
            self.watch.work(VISITED)?;
            for above in each(self.watch, 1, self.above(node)) {
                let above = above?;
                if node != start && !self.holds(Pair { below: node, above }) {
                    continue;
                }
                let index = above as usize;
                is_closed |= above == start;
                let is_new = reached[index] != start && self.component[index] == component;
                if is_new && !self.is_last(above) {
                    reached[index] = start;
                    push(&mut stack, above)?;
                }
            }
            if is_closed {
                break;
            }
        }
        self.search.reached = reached;
        Ok(is_closed)
    }

    /// All nodes, those of lower rank first where there is a choice (A. B. Kahn, "Topological sorting of
    /// large networks", 1962).
    fn sorted(&self, rank: &[u32]) -> Result<Vec<u32>, Error> {
        let nodes = self.is_clipped.len();
        let mut waits: Vec<u32> = filled(nodes, 0)?;
        for pair in each(self.watch, 1, self.pairs) {
            let pair = *pair?;
            waits[pair.above as usize] += u32::from(self.holds(pair));
        }
        let mut ready: BinaryHeap<Reverse<(u32, u32)>> = BinaryHeap::new();
        // Each node is in it once at most.
        ready.try_reserve_exact(nodes).map_err(|_| Error::out_of_memory())?;
        let first = (0..nodes as u32).filter(|&node| waits[node as usize] == 0);
        ready.extend(first.map(|node| Reverse((rank[node as usize], node))));
        let mut order = Vec::new();
        reserve(&mut order, nodes)?;
        while let Some(Reverse((_, node))) = ready.pop() {
            self.watch.work(2 * VISITED)?;
            order.push(node);
            if self.is_last(node) {
                continue;
            }
            for above in each(self.watch, 1, self.above(node)) {
                let above = above?;
                if !self.holds(Pair { below: node, above }) {
                    continue;
                }
                let waits = &mut waits[above as usize];
                *waits -= 1;
                if *waits == 0 {
                    ready.push(Reverse((rank[above as usize], above)));
                }
            }
        }
        Ok(order)
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    use super::*;

    /// Between two calls of the callback few pairs are looked at, and before the first and after the last one, though
    /// all pairs begin at one node. What is behind each pair is asked of a function that counts.
    #[test]
    fn between_two_calls_few_pairs_are_looked_at() {
        let nodes = 1 << 19;
        let mut pairs: Vec<Pair> = (1..nodes).map(|above| Pair { below: 0, above }).collect();
        pairs.push(Pair { below: nodes - 1, above: 0 });
        let ranks: Vec<u32> = (0..nodes).collect();
        let (looked, most, calls) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicUsize::new(0));
        let hear = || most.fetch_max(looked.swap(0, Relaxed), Relaxed);
        let callback = |_: &Watch<'_>| {
            calls.fetch_add(1, Relaxed);
            hear();
            ControlFlow::Continue(())
        };
        let is_opaque = |_: u32| {
            looked.fetch_add(1, Relaxed);
            true
        };
        let watch = Watch::new(&callback);
        let found = order(nodes as usize, &pairs, &ranks, &is_opaque, &watch).unwrap();
        hear();
        assert_eq!(found.order.len(), nodes as usize);
        assert_eq!(found.is_clipped.iter().filter(|&&is_clipped| is_clipped).count(), 1);
        let (most, calls) = (most.into_inner(), calls.into_inner());
        assert!(calls > 50 && most > 1 << 14 && most < 1 << 17, "{most} at most, {calls} calls");
    }
}
