//! Graphs of what comes before what, and their strongly connected components.

use crate::Error;
use crate::build::progress::Watch;
use crate::drawing::halving::VISITED;
use crate::drawing::pairs::Pair;
use crate::drawing::reporter::each;
use crate::memory::{filled, push};

/// Nodes and the pairs that begin at each.
pub(super) struct Graph<'p> {
    pub(super) pairs: &'p [Pair],
    pub(super) starts: Vec<u32>,
    pub(super) is_clipped: Vec<bool>,
    pub(super) is_opaque: &'p dyn Fn(u32) -> bool,
    /// Whether something translucent has to come after each node.
    pub(super) is_seen_through: Vec<bool>,
    /// The strongly connected component of each node, among those that are searched.
    pub(super) component: Vec<u32>,
    pub(super) search: Search,
    pub(super) watch: &'p Watch<'p>,
}

/// What a search for components knows of each node.
#[derive(Default)]
pub(super) struct Search {
    /// When it was met: its number among those that were.
    pub(super) number: Vec<u32>,
    /// The least number that it leads to.
    pub(super) least: Vec<u32>,
    pub(super) is_on_stack: Vec<bool>,
    /// From which node it was reached last, in the search for a cycle.
    pub(super) reached: Vec<u32>,
    /// How many pairs begin and end at it.
    pub(super) counts: Vec<[u32; 2]>,
}

/// No component, and of nodes that are not searched, no number.
pub(super) const NONE: u32 = u32::MAX;
/// The number of nodes that are searched, but were not met so far.
const UNMET: u32 = u32::MAX - 1;

impl<'p> Graph<'p> {
    pub(super) fn new(
        nodes: usize,
        pairs: &'p [Pair],
        is_opaque: &'p dyn Fn(u32) -> bool,
        watch: &'p Watch<'p>,
    ) -> Result<Self, Error> {
        let mut starts = filled(nodes + 1, 0)?;
        for pair in each(watch, 1, pairs) {
            let pair = pair?;
            starts[pair.below as usize + 1] += 1;
        }
        for node in each(watch, 1, 0..nodes) {
            let node = node?;
            starts[node + 1] += starts[node];
        }
        let (is_clipped, component) = (filled(nodes, false)?, filled(nodes, NONE)?);
        let mut is_seen_through = filled(nodes, false)?;
        for pair in each(watch, 1, pairs) {
            let pair = pair?;
            is_seen_through[pair.below as usize] |= !is_opaque(pair.above);
        }
        let (number, least) = (filled(nodes, NONE)?, filled(nodes, NONE)?);
        let (is_on_stack, reached) = (filled(nodes, false)?, filled(nodes, NONE)?);
        let search = Search { number, least, is_on_stack, reached, counts: filled(nodes, [0; 2])? };
        Ok(Self { pairs, starts, is_clipped, is_opaque, is_seen_through, component, search, watch })
    }
}

impl Graph<'_> {
    /// What a node comes before.
    pub(super) fn above(&self, node: u32) -> impl Iterator<Item = u32> + '_ {
        let [start, end] = [node, node + 1].map(|node| self.starts[node as usize] as usize);
        self.pairs[start..end].iter().map(|pair| pair.above)
    }

    /// How many nodes that is.
    pub(super) fn above_count(&self, node: u32) -> u32 {
        self.starts[node as usize + 1] - self.starts[node as usize]
    }

    /// Whether nothing has to come after a node, as it is clipped.
    pub(super) fn is_last(&self, node: u32) -> bool {
        self.is_clipped[node as usize] && !self.is_seen_through[node as usize]
    }

    /// Whether the order has to keep a pair: what is drawn of a clipped node lies under no opaque one.
    pub(super) fn holds(&self, Pair { below, above }: Pair) -> bool {
        !self.is_clipped[below as usize] || !(self.is_opaque)(above)
    }

    /// The strongly connected components of several nodes among these (R. Tarjan, "Depth-first search
    /// and linear graph algorithms", 1972). Their numbers are left in `component`.
    pub(super) fn components(&mut self, nodes: &[u32]) -> Result<Vec<Vec<u32>>, Error> {
        let Search { number, least, is_on_stack, .. } = &mut self.search;
        let (is_clipped, is_opaque) = (&self.is_clipped, self.is_opaque);
        for node in each(self.watch, 1, nodes) {
            number[*node? as usize] = UNMET;
        }
        let (mut stack, mut path, mut found) = (Vec::new(), Vec::new(), Vec::new());
        let mut next = 0;
        for root in each(self.watch, 1, nodes) {
            let root = *root?;
            if number[root as usize] != UNMET {
                continue;
            }
            push(&mut path, (root, self.starts[root as usize]))?;
            while let Some((node, at)) = path.last_mut() {
                self.watch.work(VISITED)?;
                let (v, place) = (*node as usize, *at);
                if place == self.starts[v] {
                    (number[v], least[v]) = (next, next);
                    next += 1;
                    push(&mut stack, *node)?;
                    is_on_stack[v] = true;
                }
                let rest = &self.pairs[place as usize..self.starts[v + 1] as usize];
                let mut unmet = None;
                for (next, pair) in (place + 1..).zip(each(self.watch, 1, rest)) {
                    let above = pair?.above;
                    let w = above as usize;
                    if is_clipped[v] && is_opaque(above) {
                        continue;
                    }
                    if is_on_stack[w] {
                        least[v] = least[v].min(number[w]);
                    }
                    if number[w] == UNMET {
                        unmet = Some((next, above));
                        break;
                    }
                }
                if let Some((next, above)) = unmet {
                    *at = next;
                    // A node is met when its first pair is looked at, so one without pairs as well.
                    push(&mut path, (above, self.starts[above as usize]))?;
                    continue;
                }
                path.pop();
                if let Some(&(parent, _)) = path.last() {
                    least[parent as usize] = least[parent as usize].min(least[v]);
                }
                if least[v] == number[v] {
                    let place = stack.iter().rposition(|&w| w as usize == v).unwrap_or(0);
                    let nodes = stack.split_off(place);
                    for w in each(self.watch, 2, &nodes) {
                        let w = *w?;
                        is_on_stack[w as usize] = false;
                        self.component[w as usize] = if nodes.len() > 1 { v as u32 } else { NONE };
                    }
                    if nodes.len() > 1 {
                        push(&mut found, nodes)?;
                    }
                }
            }
        }
        for node in each(self.watch, 1, nodes) {
            number[*node? as usize] = NONE;
        }
        Ok(found)
    }
}
