//! Orders of polygons in which each polygon precedes the polygons that are visible above it, with few
//! exceptions.
//!
//! An opaque polygon that is drawn whole must precede each opaque polygon that is visible in the area that it
//! paints. A piece of a translucent polygon must precede or follow, by depth, each polygon that is visible in
//! the area of the piece. Where a third polygon hides two polygons, these two need no order.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::map::{each, sort_by, sort_unique};
use super::quadtree::VISITED;
use crate::Error;
use crate::progress::Watch;

/// An order of nodes.
#[derive(Debug)]
pub(super) struct Ordered {
    /// All nodes; for each pair, `below` precedes `above` unless `below` is clipped and `above` is opaque.
    pub(super) order: Vec<u32>,
    /// Whether only the visible part of a node is drawn. Such a node need not precede any opaque node.
    pub(super) is_clipped: Vec<bool>,
}

/// Of a large component, 1/`CLIPPED_AT_ONCE` of the nodes are clipped at once. Too small: more nodes are
/// clipped, and restored one by one. Too large: components are searched many times.
const CLIPPED_AT_ONCE: usize = 64;

/// To restore nodes, this many pairs are examined in each component, or `EXAMINED_PER_PAIR` times the number
/// of the component's pairs, if that is more. Too small: more nodes stay clipped. Too large: components of
/// many thousand nodes take long.
const EXAMINED: usize = 1 << 22;
const EXAMINED_PER_PAIR: usize = 32;

/// Orders nodes so that sorted pairs are kept. Where the pairs leave a choice, lower ranks come first. No
/// cycle may consist of translucent nodes only.
///
/// Cycles are opened by clipping nodes: greedily, the nodes with the most pairs on both sides. Then nodes
/// that close no cycle are restored, until the searches for cycles have examined a limited number of pairs.
/// (Clipping a minimal number of nodes is NP-hard: R. M. Karp, "Reducibility among combinatorial problems",
/// 1972.)
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

/// For each node, given sorted pairs, the number of its strongly connected component; `None` if the node is
/// in no cycle. A component has the number of one of its nodes.
pub(super) fn cycles(
    nodes: usize,
    pairs: &[Pair],
    watch: &Watch<'_>,
) -> Result<Vec<Option<u32>>, Error> {
    let mut graph = Graph::new(nodes, pairs, &|_| true, watch)?;
    let all: Vec<u32> = (0..nodes as u32).collect();
    graph.components(&all)?;
    let number = |&component: &u32| (component != NONE).then_some(component);
    Ok(graph.component.iter().map(number).collect())
}

/// The first and the last place of a visible polygon's pieces in the tree's back-to-front order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ranks {
    /// The places of all pieces.
    pub(super) all: [u32; 2],
    /// The places of the visible pieces.
    pub(super) shown: [u32; 2],
}

impl Ranks {
    /// Whether the polygon has only one piece.
    const fn is_one(&self) -> bool {
        self.all[0] == self.all[1]
    }

    /// Whether all pieces of this polygon precede the visible pieces of another polygon.
    const fn is_before(&self, above: &Self) -> bool {
        self.all[1] < above.shown[0]
    }
}

/// Orders opaque polygons by the places of their pieces in the tree's order. `pairs` finds the requested
/// pairs.
///
/// If `below` has to be drawn before `above`, a piece of `below` is behind a visible piece of `above`. Then
/// all pieces of `below` are behind (`is_before`), or the interval of all pieces of `below` meets the interval of the
/// visible pieces of `above`. Pairs of the first kind need not be found: a chain of nodes, one for each place in the
/// tree's order at which a polygon ends, implies all of them. The chain implies more pairs than necessary,
/// because most of these polygons do not overlap. The chain alone has no cycle, because the place of the last
/// piece increases along it. Pairs of the second kind are found. In each such pair, one polygon has several
/// pieces.
///
/// An order of the strongly connected components of both kinds together keeps all pairs between components.
/// Inside a component, the chain may demand more pairs than the picture needs, so there all pairs are found
/// instead.
pub(super) fn order_by_rank(
    ranks: &[Ranks],
    mut pairs: impl FnMut(Wanted<'_>) -> Result<Vec<Pair>, Error>,
    watch: &Watch<'_>,
) -> Result<Ordered, Error> {
    let count = ranks.len();
    let of = |node: u32| &ranks[node as usize];
    let cut = ranks.iter().filter(|ranks| !ranks.is_one()).count();
    // The chain alone.
    if cut == 0 {
        let mut order: Vec<u32> = (0..count as u32).collect();
        sort_by(&mut order, watch, |&a, &b| of(a).shown[0].cmp(&of(b).shown[0]))?;
        return Ok(Ordered { order, is_clipped: vec![false; count] });
    }
    // If most polygons have several pieces, nearly all polygons are in one component.
    if 2 * cut > count {
        let firsts: Vec<u32> = ranks.iter().map(|ranks| ranks.shown[0]).collect();
        return order(count, &pairs(Wanted::ALL)?, &firsts, &|_| true, watch);
    }
    let around = pairs(Wanted {
        below: &|node| Interval::new(of(node).all[0], of(node).all[1]),
        above: &|node| Interval::new(of(node).shown[0], of(node).shown[1]),
        is_wanted: &|_| true,
    })?;
    // The places where polygons end.
    let mut ends: Vec<u32> = ranks.iter().map(|ranks| ranks.all[1]).collect();
    sort_unique(&mut ends, watch)?;
    let node_of_end = |end: usize| (count + end) as u32;
    let mut all = around.clone();
    for (node, ranks) in (0..).zip(ranks) {
        let end = ends.partition_point(|&end| end < ranks.all[1]);
        all.push(Pair { below: node, above: node_of_end(end) });
        let before = ends.partition_point(|&end| end < ranks.shown[0]);
        all.extend(before.checked_sub(1).map(|end| Pair { below: node_of_end(end), above: node }));
    }
    all.extend(
        (1..ends.len()).map(|end| Pair { below: node_of_end(end - 1), above: node_of_end(end) }),
    );
    sort_unique(&mut all, watch)?;
    let of_nodes: Vec<u32> =
        ranks.iter().map(|ranks| ranks.shown[0]).chain(ends.iter().copied()).collect();
    let components = cycles(of_nodes.len(), &all, watch)?;
    let component = |node: u32| components[node as usize];
    let group = |node: u32| component(node).unwrap_or(node);
    let between = contracted(all.iter(), group, watch)?;
    let outer = order(of_nodes.len(), &between, &of_nodes, &|_| true, watch)?.order;
    if (0..count as u32).all(|node| component(node).is_none()) {
        let order = outer.into_iter().filter(|&node| (node as usize) < count).collect();
        return Ok(Ordered { order, is_clipped: vec![false; count] });
    }
    let is_within = |&Pair { below, above }: &Pair| {
        component(below).is_some() && component(below) == component(above)
    };
    // One interval for each component.
    let own = |node: u32| {
        component(node).map_or(Interval::NONE, |own| Interval::new(2 * own, 2 * own + 1))
    };
    let mut within = pairs(Wanted {
        below: &own,
        above: &own,
        is_wanted: &|pair| is_within(&pair) && of(pair.below).is_before(of(pair.above)),
    })?;
    within.extend(around.into_iter().filter(is_within));
    sort_unique(&mut within, watch)?;
    let Ordered { mut order, is_clipped } =
        order(count, &within, &of_nodes[..count], &|_| true, watch)?;
    let mut positions: Vec<u32> = vec![0; of_nodes.len()];
    for (position, &group) in (0..).zip(&outer) {
        positions[group as usize] = position;
    }
    // A stable sort: inside a component, the order of its own pairs remains.
    let position = |node: u32| positions[group(node) as usize];
    sort_by(&mut order, watch, |&a, &b| position(a).cmp(&position(b)))?;
    Ok(Ordered { order, is_clipped })
}

impl Graph<'_> {
    /// Clips nodes until no cycle remains.
    fn open_cycles(&mut self) -> Result<(), Error> {
        let all: Vec<u32> = (0..self.is_clipped.len() as u32).collect();
        let first = self.components(&all)?;
        for nodes in first {
            let mut clipped = Vec::new();
            let mut open = vec![nodes.to_vec()];
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
                    clipped.push(node);
                }
                for &node in &nodes {
                    if self.is_last(node) {
                        self.component[node as usize] = NONE;
                    }
                }
                nodes.retain(|&node| !self.is_last(node));
                open.append(&mut self.components(&nodes)?);
            }
            self.restore(&nodes, clipped)?;
        }
        Ok(())
    }

    /// For each node, two numbers of pairs in the component multiplied: the pairs that end at the node, and
    /// the pairs that begin at the node.
    fn degrees(&mut self, nodes: &[u32]) -> Result<Vec<(u64, u32)>, Error> {
        let mut counts = std::mem::take(&mut self.search.counts);
        for &node in nodes {
            counts[node as usize] = [0; 2];
        }
        let of = |node: u32| self.component[node as usize];
        for &node in nodes {
            for above in each(self.watch, 1, self.above(node)) {
                let above = above?;
                if of(above) == of(node) && self.holds(Pair { below: node, above }) {
                    counts[node as usize][0] += 1;
                    counts[above as usize][1] += 1;
                }
            }
        }
        let product = |node: u32| counts[node as usize].map(u64::from).into_iter().product();
        let mut degrees = Vec::with_capacity(nodes.len());
        for &node in nodes {
            degrees.push((product(node), node));
        }
        self.search.counts = counts;
        Ok(degrees)
    }

    /// Restores the clipped nodes that close no cycle. All cycles are inside `nodes`.
    fn restore(&mut self, nodes: &[u32], mut clipped: Vec<u32>) -> Result<(), Error> {
        for &node in nodes {
            self.component[node as usize] = nodes[0];
        }
        sort_by(&mut clipped, self.watch, |&a, &b| self.above_count(a).cmp(&self.above_count(b)))?;
        let pairs: usize = nodes.iter().map(|&node| self.above_count(node) as usize).sum();
        let mut left = EXAMINED.max(EXAMINED_PER_PAIR * pairs);
        for node in clipped {
            if left > 0 && !self.closes_cycle(node, nodes[0], &mut left)? {
                self.is_clipped[node as usize] = false;
            }
        }
        for &node in nodes {
            self.component[node as usize] = NONE;
        }
        Ok(())
    }

    /// Whether a node would close a cycle if it were restored; also true if `left` pairs are not enough to
    /// decide.
    fn closes_cycle(
        &mut self,
        start: u32,
        component: u32,
        left: &mut usize,
    ) -> Result<bool, Error> {
        let mut reached = std::mem::take(&mut self.search.reached);
        let (mut stack, mut is_closed) = (vec![start], false);
        while let Some(node) = stack.pop() {
            self.watch.work(VISITED)?;
            *left = left.saturating_sub(self.above_count(node) as usize);
            is_closed |= *left == 0;
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
                    stack.push(above);
                }
            }
            if is_closed {
                break;
            }
        }
        self.search.reached = reached;
        Ok(is_closed)
    }

    /// Sorts all nodes, with lower ranks first where the pairs leave a choice (A. B. Kahn, "Topological
    /// sorting of large networks", 1962).
    fn sorted(&self, rank: &[u32]) -> Result<Vec<u32>, Error> {
        let nodes = self.is_clipped.len();
        let mut waits: Vec<u32> = vec![0; nodes];
        for pair in each(self.watch, 1, self.pairs) {
            let pair = *pair?;
            waits[pair.above as usize] += u32::from(self.holds(pair));
        }
        let mut ready: BinaryHeap<Reverse<(u32, u32)>> = BinaryHeap::new();
        let first = (0..nodes as u32).filter(|&node| waits[node as usize] == 0);
        ready.extend(first.map(|node| Reverse((rank[node as usize], node))));
        let mut order = Vec::with_capacity(nodes);
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

/// Nodes, and for each node the pairs that begin at the node.
struct Graph<'p> {
    pairs: &'p [Pair],
    starts: Vec<u32>,
    is_clipped: Vec<bool>,
    is_opaque: &'p dyn Fn(u32) -> bool,
    /// For each node, whether a translucent node has to follow the node.
    is_seen_through: Vec<bool>,
    /// The strongly connected component of each node that is searched.
    component: Vec<u32>,
    search: Search,
    watch: &'p Watch<'p>,
}

/// The data of a search for components.
#[derive(Default)]
struct Search {
    /// For each node, the number of nodes visited before it.
    number: Vec<u32>,
    /// For each node, the low-link of Tarjan's algorithm: the least `number` reached from the node.
    least: Vec<u32>,
    is_on_stack: Vec<bool>,
    /// For each node, the node from which the search for a cycle reached it last.
    reached: Vec<u32>,
    /// For each node, how many pairs begin and end at the node.
    counts: Vec<[u32; 2]>,
}

/// The number that stands for no component, and for a node that is not searched.
const NONE: u32 = u32::MAX;
/// The number that stands for a node that is searched but was not visited yet.
const UNMET: u32 = u32::MAX - 1;

impl<'p> Graph<'p> {
    fn new(
        nodes: usize,
        pairs: &'p [Pair],
        is_opaque: &'p dyn Fn(u32) -> bool,
        watch: &'p Watch<'p>,
    ) -> Result<Self, Error> {
        let mut starts = vec![0; nodes + 1];
        for pair in pairs {
            starts[pair.below as usize + 1] += 1;
        }
        for node in 0..nodes {
            starts[node + 1] += starts[node];
        }
        let (is_clipped, component) = (vec![false; nodes], vec![NONE; nodes]);
        let mut is_seen_through = vec![false; nodes];
        for pair in each(watch, 1, pairs) {
            let pair = pair?;
            is_seen_through[pair.below as usize] |= !is_opaque(pair.above);
        }
        let (number, least) = (vec![NONE; nodes], vec![NONE; nodes]);
        let (is_on_stack, reached) = (vec![false; nodes], vec![NONE; nodes]);
        let search = Search { number, least, is_on_stack, reached, counts: vec![[0; 2]; nodes] };
        Ok(Self { pairs, starts, is_clipped, is_opaque, is_seen_through, component, search, watch })
    }
}

impl Graph<'_> {
    /// The nodes that have to follow a node.
    fn above(&self, node: u32) -> impl Iterator<Item = u32> + '_ {
        let [start, end] = [node, node + 1].map(|node| self.starts[node as usize] as usize);
        self.pairs[start..end].iter().map(|pair| pair.above)
    }

    /// The number of nodes that have to follow a node.
    fn above_count(&self, node: u32) -> u32 {
        self.starts[node as usize + 1] - self.starts[node as usize]
    }

    /// Whether a node is clipped and no translucent node has to follow it, so no node has to follow it.
    fn is_last(&self, node: u32) -> bool {
        self.is_clipped[node as usize] && !self.is_seen_through[node as usize]
    }

    /// Whether the order has to keep a pair. The order need not keep a pair of a clipped node below an opaque
    /// node, because the clipped node's visible part lies under no opaque node.
    fn holds(&self, Pair { below, above }: Pair) -> bool {
        !self.is_clipped[below as usize] || !(self.is_opaque)(above)
    }

    /// The strongly connected components, among the given nodes, with more than one node (R. Tarjan,
    /// "Depth-first search and linear graph algorithms", 1972). Writes the numbers of the components to
    /// `component`.
    fn components(&mut self, nodes: &[u32]) -> Result<Vec<Vec<u32>>, Error> {
        let Search { number, least, is_on_stack, .. } = &mut self.search;
        let (is_clipped, is_opaque) = (&self.is_clipped, self.is_opaque);
        for &node in nodes {
            number[node as usize] = UNMET;
        }
        let (mut stack, mut path, mut found) = (Vec::new(), Vec::new(), Vec::new());
        let mut next = 0;
        for &root in nodes {
            if number[root as usize] != UNMET {
                continue;
            }
            path.push((root, self.starts[root as usize]));
            while let Some((node, at)) = path.last_mut() {
                self.watch.work(VISITED)?;
                let (v, place) = (*node as usize, *at);
                if place == self.starts[v] {
                    (number[v], least[v]) = (next, next);
                    next += 1;
                    stack.push(*node);
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
                    // A node is numbered when its first pair is examined, so a node without pairs is pushed
                    // as well.
                    path.push((above, self.starts[above as usize]));
                    continue;
                }
                path.pop();
                if let Some(&(parent, _)) = path.last() {
                    least[parent as usize] = least[parent as usize].min(least[v]);
                }
                if least[v] == number[v] {
                    let place = stack.iter().rposition(|&w| w as usize == v).unwrap_or(0);
                    let nodes = stack.split_off(place);
                    for &w in &nodes {
                        is_on_stack[w as usize] = false;
                        self.component[w as usize] = if nodes.len() > 1 { v as u32 } else { NONE };
                    }
                    if nodes.len() > 1 {
                        found.push(nodes);
                    }
                }
            }
        }
        for &node in nodes {
            number[node as usize] = NONE;
        }
        Ok(found)
    }
}

/// The pairs of polygons to find.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'w> {
    /// The interval of a polygon that is below another.
    pub(super) below: &'w (dyn Fn(u32) -> Interval + Sync),
    /// The interval of a polygon that is above another.
    pub(super) above: &'w (dyn Fn(u32) -> Interval + Sync),
    /// Whether a pair is wanted whose two intervals meet.
    pub(super) is_wanted: &'w (dyn Fn(Pair) -> bool + Sync),
}

impl Wanted<'_> {
    pub(super) const ALL: Self = Self {
        below: &|_| Interval::new(0, 1),
        above: &|_| Interval::new(0, 1),
        is_wanted: &|_| true,
    };
}

/// The numbers from `first` to `last`. Only pairs of polygons whose intervals meet are wanted, so that most pairs
/// are not compared. Two intervals of one number, of different polygons, do not meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Interval {
    first: u32,
    last: u32,
}

impl Interval {
    /// The interval that meets no other.
    pub(super) const NONE: Self = Self::new(u32::MAX, 0);

    pub(super) const fn new(first: u32, last: u32) -> Self {
        Self { first, last }
    }

    pub(super) const fn is_none(&self) -> bool {
        self.first > self.last
    }

    pub(super) const fn is_one(&self) -> bool {
        self.first == self.last
    }

    pub(super) const fn meets(&self, other: &Self) -> bool {
        self.first <= other.last && other.first <= self.last
    }

    /// The smallest interval that contains both.
    pub(super) fn hull(&self, other: &Self) -> Self {
        Self { first: self.first.min(other.first), last: self.last.max(other.last) }
    }
}

/// A pair of nodes: the node `below` has to be drawn before the node `above`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Pair {
    pub(super) below: u32,
    pub(super) above: u32,
}

impl Pair {
    /// Applies a function to both numbers.
    pub(super) fn map(self, of: impl Fn(u32) -> u32) -> Self {
        Self { below: of(self.below), above: of(self.above) }
    }
}

/// The pairs between groups of nodes, sorted, each once.
pub(super) fn contracted<'p>(
    pairs: impl Iterator<Item = &'p Pair>,
    of: impl Fn(u32) -> u32,
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let pairs = pairs.map(|pair| pair.map(&of));
    let mut pairs: Vec<Pair> = pairs.filter(|pair| pair.below != pair.above).collect();
    sort_unique(&mut pairs, watch)?;
    Ok(pairs)
}

/// Groups of nodes in an order that keeps all pairs: a topological order of a directed acyclic graph that is
/// updated while nodes are joined (D. J. Pearce, P. H. J. Kelly, "A dynamic topological sort algorithm for
/// directed acyclic graphs", 2006).
#[derive(Debug)]
pub(super) struct Groups {
    /// For each node, its parent in a union-find forest. A group has the number of its root.
    leader: Vec<u32>,
    /// The place of each group in the order.
    place: Vec<u32>,
    /// For each group, the nodes of other groups that have to follow the group (`after`) or precede the group
    /// (`before`). Nodes may be repeated.
    after: Vec<Vec<u32>>,
    before: Vec<Vec<u32>>,
    /// For each group, the last search that visited it.
    met: Vec<u64>,
    search: u64,
}

/// A search for a join gives up after this many groups. Too small: more pieces. Too large: scenes of many
/// crossing polygons take several times as long, for up to a sixth fewer pieces; other scenes do not change.
const BUDGET: usize = 300;

#[derive(Clone, Copy)]
enum Way {
    After,
    Before,
}

impl Groups {
    /// One group for each node, in the order of node numbers. In each pair, `below` must be the lower number.
    pub(super) fn new(nodes: usize, pairs: impl Iterator<Item = Pair>) -> Self {
        let numbers: Vec<u32> = (0..nodes as u32).collect();
        let (mut after, mut before) = (vec![vec![]; nodes], vec![vec![]; nodes]);
        for Pair { below, above } in pairs {
            after[below as usize].push(above);
            before[above as usize].push(below);
        }
        Self {
            leader: numbers.clone(),
            place: numbers,
            after,
            before,
            met: vec![0; nodes],
            search: 0,
        }
    }

    /// The group of a node: the number of one of the group's nodes.
    pub(super) fn group(&mut self, node: u32) -> u32 {
        let mut at = node;
        while self.leader[at as usize] != at {
            let next = self.leader[at as usize];
            self.leader[at as usize] = self.leader[next as usize];
            at = next;
        }
        at
    }

    /// Joins the groups of two nodes, if a search of limited length proves that no third group has to be
    /// between them.
    pub(super) fn join(&mut self, a: u32, b: u32, watch: &Watch<'_>) -> Result<(), Error> {
        watch.work(VISITED)?;
        let [a, b] = [self.group(a), self.group(b)];
        if a == b {
            return Ok(());
        }
        let (a, b) = if self.place[a as usize] < self.place[b as usize] { (a, b) } else { (b, a) };
        if self.bring_together(a, b, BUDGET, watch)? {
            self.unite(a, b);
        }
        Ok(())
    }

    /// Adds a pair of nodes, unless `above` has to precede `below`. Returns whether the pair was added. The
    /// search has no limit: in a grid of 900 crossing triangles, the limit of joins would reject a third of
    /// 39 000 pairs, although nearly all of these can be added. All searches take less than a sixtieth of the
    /// drawing's time.
    pub(super) fn add(&mut self, pair: Pair, watch: &Watch<'_>) -> Result<bool, Error> {
        watch.work(VISITED)?;
        let [below, above] = [self.group(pair.below), self.group(pair.above)];
        let is_in_order = self.place[below as usize] < self.place[above as usize];
        if below == above
            || !is_in_order && !self.bring_together(above, below, usize::MAX, watch)?
        {
            return Ok(false);
        }
        self.after[below as usize].push(above);
        self.before[above as usize].push(below);
        Ok(true)
    }

    /// Moves `b`, which follows `a`, to the place directly before `a`, and keeps all pairs. Returns false,
    /// without a move, if pairs require `a` before `b`, or if a search of `most` groups cannot exclude that.
    fn bring_together(
        &mut self,
        a: u32,
        b: u32,
        most: usize,
        watch: &Watch<'_>,
    ) -> Result<bool, Error> {
        let Some(after) = self.reach([a, b], Way::After, most, watch)? else { return Ok(false) };
        let Some(before) = self.reach([b, a], Way::Before, most, watch)? else { return Ok(false) };
        // First the groups that have to precede, in their order; then the two groups; then the groups that
        // have to follow.
        let groups = [&before[..], &[b, a], &after[..]].concat();
        let mut places: Vec<u32> = groups.iter().map(|&group| self.place[group as usize]).collect();
        places.sort_unstable();
        for (&group, &place) in groups.iter().zip(&places) {
            self.place[group as usize] = place;
        }
        Ok(true)
    }

    /// The groups that are reached from the group `from` without passing the group `to`, in order. `None` if
    /// `to` is reached, or if there are more than `most` groups.
    fn reach(
        &mut self,
        [from, to]: [u32; 2],
        way: Way,
        most: usize,
        watch: &Watch<'_>,
    ) -> Result<Option<Vec<u32>>, Error> {
        self.search += 1;
        let end = self.place[to as usize];
        let mut found: Vec<u32> = vec![];
        let mut next = 0;
        let mut at = from;
        loop {
            let list = match way {
                Way::After => &mut self.after[at as usize],
                Way::Before => &mut self.before[at as usize],
            };
            let mut neighbours = std::mem::take(list);
            let mut is_met = false;
            watch.work(neighbours.len() * VISITED)?;
            for node in &mut neighbours {
                // Replace nodes by their current groups, so that the next search is shorter.
                *node = self.group(*node);
                let (group, place) = (*node as usize, self.place[*node as usize]);
                is_met |= *node == to;
                let is_between = match way {
                    Way::After => place < end,
                    Way::Before => place > end,
                };
                if is_between && self.met[group] != self.search {
                    self.met[group] = self.search;
                    found.push(*node);
                }
            }
            match way {
                Way::After => self.after[at as usize] = neighbours,
                Way::Before => self.before[at as usize] = neighbours,
            }
            if is_met || found.len() > most {
                return Ok(None);
            }
            let Some(&group) = found.get(next) else { break };
            (at, next) = (group, next + 1);
        }
        found.sort_unstable_by_key(|&group| self.place[group as usize]);
        Ok(Some(found))
    }

    fn unite(&mut self, a: u32, b: u32) {
        let place = self.place[a as usize];
        let degree =
            |group: u32| self.after[group as usize].len() + self.before[group as usize].len();
        let (large, small) = if degree(a) < degree(b) { (b, a) } else { (a, b) };
        self.leader[small as usize] = large;
        self.place[large as usize] = place;
        for lists in [&mut self.after, &mut self.before] {
            let mut moved = std::mem::take(&mut lists[small as usize]);
            let list = &mut lists[large as usize];
            list.append(&mut moved);
            list.sort_unstable();
            list.dedup();
        }
    }
}

#[cfg(test)]
mod order_tests {
    use std::ops::ControlFlow;
    use std::sync::atomic::AtomicUsize;
    use std::sync::atomic::Ordering::Relaxed;

    use super::*;

    /// Few pairs are examined before the first call of the callback, between two calls and after the last
    /// call, although all pairs begin at one node. The function `is_opaque` is called for each pair and
    /// counts its calls.
    #[test]
    fn between_two_calls_few_pairs_are_looked_at() {
        let nodes = 1 << 19;
        let mut pairs: Vec<Pair> = (1..nodes).map(|above| Pair { below: 0, above }).collect();
        pairs.push(Pair { below: nodes - 1, above: 0 });
        let ranks: Vec<u32> = (0..nodes).collect();
        let (looked, most, calls) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicUsize::new(0));
        let record = || most.fetch_max(looked.swap(0, Relaxed), Relaxed);
        let callback = |_: &Watch<'_>| {
            calls.fetch_add(1, Relaxed);
            record();
            ControlFlow::Continue(())
        };
        let is_opaque = |_: u32| {
            looked.fetch_add(1, Relaxed);
            true
        };
        let watch = Watch::new(&callback);
        let found = order(nodes as usize, &pairs, &ranks, &is_opaque, &watch).unwrap();
        record();
        assert_eq!(found.order.len(), nodes as usize);
        assert_eq!(found.is_clipped.iter().filter(|&&is_clipped| is_clipped).count(), 1);
        let (most, calls) = (most.into_inner(), calls.into_inner());
        assert!(calls > 50 && most > 1 << 14 && most < 1 << 17, "{most} at most, {calls} calls");
    }
}

#[cfg(test)]
mod join_tests {
    use super::*;
    use crate::random::SplitMix64;

    /// Whether a path of at least one pair leads from one node to another.
    fn leads(pairs: &[[u32; 2]], from: u32, to: u32) -> bool {
        let (mut met, mut stack) = (vec![], vec![from]);
        while let Some(node) = stack.pop() {
            for &[_, next] in pairs.iter().filter(|pair| pair[0] == node) {
                if !met.contains(&next) {
                    met.push(next);
                    stack.push(next);
                }
            }
        }
        met.contains(&to)
    }

    #[test]
    fn groups_are_joined_unless_that_closes_a_cycle() {
        let mut random = SplitMix64::new(1);
        let (mut joined, mut refused) = (0, 0);
        for round in 0..300 {
            let nodes = 2 + round % 14;
            let mut below = |most: u64| (random.next() % most) as u32;
            let mut pairs = vec![];
            for above in 1..nodes as u32 {
                pairs.extend((0..below(4)).map(|_| Pair { below: below(above.into()), above }));
            }
            let mut groups = Groups::new(nodes, pairs.iter().copied());
            for _ in 0..3 * nodes {
                let [a, b] = [below(nodes as u64), below(nodes as u64)];
                let [one, other] = [groups.group(a), groups.group(b)];
                let mut between: Vec<[u32; 2]> = pairs
                    .iter()
                    .map(|pair| [groups.group(pair.below), groups.group(pair.above)])
                    .collect();
                between.retain(|pair| pair[0] != pair[1]);
                let closes = leads(&between, one, other) || leads(&between, other, one);
                groups.join(a, b, &Watch::default()).unwrap();
                assert_eq!(groups.group(a) == groups.group(b), one == other || !closes);
                *if closes { &mut refused } else { &mut joined } += usize::from(one != other);
                // Every pair is still in order.
                for pair in &pairs {
                    let [x, y] = [pair.below, pair.above].map(|node| groups.group(node) as usize);
                    assert!(x == y || groups.place[x] < groups.place[y]);
                }
            }
        }
        assert!(joined > 500 && refused > 500, "{joined} {refused}");
    }

    #[test]
    fn pairs_are_added_unless_they_close_a_cycle() {
        let mut random = SplitMix64::new(2);
        let (mut added, mut moved, mut refused) = (0, 0, 0);
        for round in 0..300 {
            let nodes = 2 + round % 14;
            let mut below = |most: u64| (random.next() % most) as u32;
            let mut groups = Groups::new(nodes, std::iter::empty());
            let mut pairs: Vec<[u32; 2]> = vec![];
            for _ in 0..3 * nodes {
                let [a, b] = [below(nodes as u64), below(nodes as u64)];
                let closes = a == b || leads(&pairs, b, a);
                let is_moved = groups.place[a as usize] > groups.place[b as usize];
                let pair = Pair { below: a, above: b };
                assert_eq!(groups.add(pair, &Watch::default()).unwrap(), !closes);
                if closes {
                    refused += 1;
                    continue;
                }
                *if is_moved { &mut moved } else { &mut added } += 1;
                pairs.push([a, b]);
                for pair in &pairs {
                    let [x, y] = pair.map(|node| groups.place[node as usize]);
                    assert!(x < y);
                }
            }
        }
        assert!(added > 500 && moved > 500 && refused > 500, "{added} {moved} {refused}");
    }

    /// A search visits all nodes between two nodes, and fails if there are more nodes than the budget allows.
    #[test]
    fn searches_end_at_their_budget() {
        for (between, expected) in [(BUDGET - 2, true), (BUDGET + 2, false)] {
            // The first node precedes all nodes except the last.
            let last = between as u32 + 1;
            let pairs: Vec<Pair> = (1..last).map(|above| Pair { below: 0, above }).collect();
            let mut groups = Groups::new(between + 2, pairs.into_iter());
            groups.join(0, last, &Watch::default()).unwrap();
            assert_eq!(groups.group(0) == groups.group(last), expected, "{between}");
        }
    }
}
