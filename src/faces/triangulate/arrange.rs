//! Divides an outline into edges that meet at their ends only, and finds where it crosses itself.
//!
//! A sweep (Shamos and Hoey, “Geometric intersection problems”, 1976; Bentley and Ottmann, 1979)
//! passes over the points from left to right. Edges on which a point lies are divided there,
//! overlapping edges become one, and neighbouring edges are tested for a crossing. Nothing is
//! rounded, as every end of an edge is one of the polygon's corners.

use std::cmp::Ordering;

use crate::Error;
use crate::progress::{PIECES_AT_ONCE, Watch};
use crate::random::mix;

/// A point in lattice units. Points are numbered in the order in which the sweep meets them: by x,
/// then by y.
pub(super) type Point = [i64; 2];

/// On which side of the line from `a` to `b` a point lies: `Greater` is to the left, above an edge
/// whose ends come in the sweep's order. Exact.
#[inline]
pub(super) fn turn(a: Point, b: Point, c: Point) -> Ordering {
    area(a, b, c).cmp(&0)
}

/// Twice the signed area of a triangle, below 2¹⁰⁶.
#[inline]
pub(super) fn area(a: Point, b: Point, c: Point) -> i128 {
    let product = |p: i64, q: i64| i128::from(p) * i128::from(q);
    product(b[0] - a[0], c[1] - a[1]) - product(b[1] - a[1], c[0] - a[0])
}

/// A straight part of the outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Edge {
    /// The points at its ends, the first one first in the sweep.
    pub(super) ends: [u32; 2],
    /// The polygon's corners at its ends; [`NONE`] where the outline goes straight on.
    pub(super) corners: [u32; 2],
    /// How often the outline runs along it from the first end to the second, minus how often it
    /// runs back.
    pub(super) weight: i32,
}

impl Edge {
    /// An edge between two corners, each given by its number and its point.
    pub(super) fn between(from: (u32, u32), to: (u32, u32)) -> Self {
        let (low, high, weight) = if from.1 < to.1 { (from, to, 1) } else { (to, from, -1) };
        Self { ends: [low.1, high.1], corners: [low.0, high.0], weight }
    }

    /// Divides the edge at a point on it: the part before the point, and the part behind it.
    const fn cut(self, point: u32) -> [Self; 2] {
        [
            Self { ends: [self.ends[0], point], corners: [self.corners[0], NONE], ..self },
            Self { ends: [point, self.ends[1]], corners: [NONE, self.corners[1]], ..self },
        ]
    }
}

/// The corner at an end that edges share: preferably of an edge with the direction of their sum.
fn shared_corner(edges: &[Edge], end: usize, weight: i32) -> u32 {
    let at = |edge: &&Edge| edge.corners[end] != NONE;
    let along = |edge: &&Edge| at(edge) && edge.weight.signum() == weight.signum();
    let best = edges.iter().find(along).or_else(|| edges.iter().find(at));
    best.map_or(NONE, |edge| edge.corners[end])
}

/// How overlapping edges count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// By direction: opposite edges cancel, two of the same direction count 2.
    Signed,
    /// By parity: any two cancel.
    Parity,
}

/// Edges that meet at their ends only.
#[derive(Debug)]
pub(super) struct Arrangement {
    /// In the order of their first ends; those of one point from the lowest to the highest.
    pub(super) edges: Vec<Edge>,
    /// The points at which edges begin or end, in order.
    pub(super) stops: Vec<Stop>,
}

/// A point at which edges begin or end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    pub(super) point: u32,
    /// The edge next below it, or [`NONE`].
    pub(super) below: u32,
    /// The first edge that begins here, or the next one that begins anywhere.
    pub(super) first: u32,
}

/// The edges that the sweep has met, and those that it has yet to meet.
///
/// Its lists are not checked for memory. Edges that overlap are merged, so `n` edges and `n` points have
/// O(n^(4/3)) parts (Szemerédi and Trotter, “Extremal problems in discrete geometry”, 1983). An outline of
/// 20 000 random corners takes some megabytes, one of the most corners that a polygon may have a gigabyte.
pub(super) struct ArrangementSweep<'a> {
    points: &'a [Point],
    rule: Rule,
    line: SweepLine,
    arrangement: Arrangement,
    waiting: Vec<Waiting>,
    /// For each point, the last edge that waits for it: the head of a list in `waiting`.
    heads: Vec<u32>,
    /// For each point, the edges on the line that end there.
    arriving: Vec<Arriving>,
    /// The edges that begin at the current point.
    starting: Vec<Edge>,
    /// Pairs of edges that cross. They have been taken off the line.
    pub(super) crossings: Vec<[u32; 2]>,
    /// Work done since the last report, in edges looked at.
    steps: usize,
}

/// The edges on the line that end at a point.
#[derive(Clone, Copy)]
struct Arriving {
    count: u32,
    /// The last one that was inserted. It may have been taken off since.
    last: u32,
}

struct Waiting {
    edge: Edge,
    next: u32,
}

/// Search budget: the sweep gives up when edges have been divided into more than this many parts
/// per edge of the polygon. This happens to outlines that pass through the same points again and
/// again. Too small: such outlines are treated as if they crossed themselves; too large: they take time
/// and memory.
const MOST_PARTS: usize = 8;

impl<'a> ArrangementSweep<'a> {
    pub(super) fn new(points: &'a [Point], edges: &[Edge], rule: Rule) -> Self {
        let mut sweep = ArrangementSweep {
            points,
            rule,
            line: SweepLine::new(),
            arrangement: Arrangement { edges: vec![], stops: vec![] },
            waiting: Vec::with_capacity(edges.len()),
            heads: vec![NONE; points.len()],
            arriving: vec![Arriving { count: 0, last: NONE }; points.len()],
            starting: vec![],
            crossings: vec![],
            steps: 0,
        };
        edges.iter().for_each(|&edge| sweep.wait(edge));
        sweep
    }

    /// Sweeps over all points. `None` if there are too many parts, or if edges cross and
    /// `stop_at_crossing` is set; if it is not set, edges that cross are left out from there on.
    pub(super) fn run(
        mut self,
        stop_at_crossing: bool,
        watch: &Watch<'_>,
    ) -> Result<Option<Self>, Error> {
        let most = self.waiting.len() * MOST_PARTS;
        for point in 0..self.points.len() as u32 {
            self.visit(point);
            if self.steps >= PIECES_AT_ONCE {
                watch.work(std::mem::take(&mut self.steps))?;
            }
            let crosses = stop_at_crossing && !self.crossings.is_empty();
            if crosses || self.waiting.len() > most {
                return Ok(None);
            }
        }
        watch.work(self.steps)?;
        Ok(Some(self))
    }

    pub(super) fn finish(self) -> Arrangement {
        self.arrangement
    }

    /// The edges found, without those that cross.
    pub(super) fn uncrossed(&self) -> impl Iterator<Item = Edge> {
        self.arrangement.edges.iter().copied().filter(|edge| edge.weight != 0)
    }

    pub(super) fn edge(&self, edge: u32) -> &Edge {
        &self.arrangement.edges[edge as usize]
    }

    fn wait(&mut self, edge: Edge) {
        let head = &mut self.heads[edge.ends[0] as usize];
        let next = std::mem::replace(head, self.waiting.len() as u32);
        self.waiting.push(Waiting { edge, next });
    }

    /// Takes the edges that end at a point off the line, and inserts those that begin there.
    fn visit(&mut self, point: u32) {
        self.steps += 1;
        let arriving = self.arriving[point as usize];
        let mut head = self.heads[point as usize];
        if arriving.count == 0 && head == NONE {
            return;
        }
        self.starting.clear();
        while head != NONE {
            let waiting = &self.waiting[head as usize];
            self.starting.push(waiting.edge);
            head = waiting.next;
        }
        let (below, ended) = self.end_all(point, arriving.last);
        self.steps += self.starting.len();
        self.merge(point);
        if ended || !self.starting.is_empty() {
            self.begin_all(point, below);
        }
    }

    /// Takes the edges through a point off the line. Their parts behind the point begin there.
    /// Returns the edge next below, and whether there was an edge through the point.
    fn end_all(&mut self, point: u32, hint: u32) -> (u32, bool) {
        // The edge inserted last among those that end here is usually still on the line: then no
        // search is needed.
        let hits = self.line.contains(hint) && self.edge(hint).ends[1] == point;
        let (at, place) = if hits { (hint, Place::On) } else { self.find(point) };
        if place != Place::On {
            return (at, false);
        }
        // All edges through the point are neighbours on the line. Go down to the lowest of them,
        // then take them off upwards.
        let mut lowest = at;
        let is_on = |edge: u32| edge != NONE && self.place(edge, point) == Place::On;
        while is_on(self.line.below(lowest)) {
            lowest = self.line.below(lowest);
        }
        let below = self.line.below(lowest);
        let mut edge = lowest;
        while edge != NONE && (edge == at || self.place(edge, point) == Place::On) {
            let above = self.line.above(edge);
            self.line.remove(edge);
            let ending = &mut self.arrangement.edges[edge as usize];
            self.arriving[ending.ends[1] as usize].count -= 1;
            if ending.ends[1] != point {
                let [before, behind] = ending.cut(point);
                *ending = before;
                self.starting.push(behind);
            }
            edge = above;
        }
        (below, true)
    }

    fn find(&mut self, point: u32) -> (u32, Place) {
        let mut steps = 0;
        let found = self.line.find(|edge| {
            steps += 1;
            self.place(edge, point)
        });
        self.steps += steps;
        found
    }

    fn place(&self, edge: u32, point: u32) -> Place {
        let [a, b] = self.edge(edge).ends.map(|end| self.points[end as usize]);
        match turn(a, b, self.points[point as usize]) {
            Ordering::Less => Place::Below,
            Ordering::Equal => Place::On,
            Ordering::Greater => Place::Above,
        }
    }

    /// Sorts the edges that begin at a point from the lowest to the highest, and merges overlapping
    /// ones. Where the shortest of them ends, the rest begins again.
    fn merge(&mut self, point: u32) {
        let (points, at) = (self.points, self.points[point as usize]);
        let end = |edge: &Edge| points[edge.ends[1] as usize];
        let mut all = std::mem::take(&mut self.starting);
        all.sort_unstable_by(|a, b| {
            let side = turn(at, end(b), end(a));
            side.then(a.ends[1].cmp(&b.ends[1])).then(a.corners.cmp(&b.corners))
        });
        let mut kept = 0;
        let mut start = 0;
        while start < all.len() {
            let first = all[start];
            let alike = |edge: &Edge| turn(at, end(&first), end(edge)).is_eq();
            let count = all[start..].iter().take_while(|edge| alike(edge)).count();
            if let Some(edge) = self.merge_alike(point, &all[start..start + count]) {
                all[kept] = edge;
                kept += 1;
            }
            start += count;
        }
        all.truncate(kept);
        self.starting = all;
    }

    /// Merges edges that begin at a point in the same direction, given in the order of their ends,
    /// into one edge up to the nearest end, or none if they cancel. The parts further on wait for
    /// the points where they begin.
    fn merge_alike(&mut self, point: u32, edges: &[Edge]) -> Option<Edge> {
        let (mut weight, mut from, mut kept) = (edges.iter().map(|e| e.weight).sum(), point, None);
        let mut corner = shared_corner(edges, 0, weight);
        for part in edges.chunk_by(|a, b| a.ends[1] == b.ends[1]) {
            let to = part[0].ends[1];
            let corners = [corner, shared_corner(part, 1, weight)];
            let reduced = match self.rule {
                Rule::Signed => weight,
                Rule::Parity => weight & 1,
            };
            let edge = Edge { ends: [from, to], corners, weight: reduced };
            if reduced != 0 && from == point {
                kept = Some(edge);
            } else if reduced != 0 {
                self.wait(edge);
            }
            weight -= part.iter().map(|edge| edge.weight).sum::<i32>();
            (from, corner) = (to, NONE);
        }
        kept
    }

    /// Inserts the edges that begin at a point, and tests new neighbours for crossings.
    fn begin_all(&mut self, point: u32, below: u32) {
        let above = self.line.above(below);
        let Arrangement { edges, stops } = &mut self.arrangement;
        stops.push(Stop { point, below, first: edges.len() as u32 });
        let mut next = below;
        for &edge in &self.starting {
            edges.push(edge);
            next = self.line.insert(next);
            let arriving = &mut self.arriving[edge.ends[1] as usize];
            *arriving = Arriving { count: arriving.count + 1, last: next };
        }
        self.remove_crossing(below, self.line.above(below));
        // The first call may have taken `above` off the line.
        if self.line.contains(above) {
            self.remove_crossing(self.line.below(above), above);
        }
    }

    /// Takes two neighbours off the line if they cross, and goes on with those that become
    /// neighbours by it.
    fn remove_crossing(&mut self, mut low: u32, mut high: u32) {
        while low != NONE && high != NONE && self.cross(low, high) {
            let (below, above) = (self.line.below(low), self.line.above(high));
            for edge in [low, high] {
                self.line.remove(edge);
                let edge = &mut self.arrangement.edges[edge as usize];
                edge.weight = 0;
                self.arriving[edge.ends[1] as usize].count -= 1;
            }
            self.crossings.push([low, high]);
            (low, high) = (below, above);
        }
    }

    /// Whether two edges on the line, one above the other, cross before either ends: then the one
    /// that ends first ends on the wrong side of the other.
    fn cross(&self, low: u32, high: u32) -> bool {
        let (low_end, high_end) = (self.edge(low).ends[1], self.edge(high).ends[1]);
        match low_end.cmp(&high_end) {
            Ordering::Less => self.place(high, low_end) == Place::Above,
            Ordering::Equal => false,
            Ordering::Greater => self.place(low, high_end) == Place::Below,
        }
    }
}

/// The edge number that means "none".
pub(super) const NONE: u32 = u32::MAX;

/// An ordered list of edges with a search tree over it: a treap (Seidel, Aragon, “Randomized search
/// trees”, 1996). Its priorities are hashed edge numbers, so that every run gives the same tree.
/// Edges are numbered from 0 in the order of insertion.
#[derive(Debug)]
struct SweepLine {
    nodes: Vec<Node>,
    root: u32,
    lowest: u32,
}

/// An edge's neighbours in the list, and in the tree.
#[derive(Clone, Copy, Debug)]
struct Node {
    below: u32,
    above: u32,
    parent: u32,
    children: [u32; 2],
    on_line: bool,
}

/// Where a point lies against an edge: where a search for it goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// Below the edge.
    Below,
    /// On the edge.
    On,
    /// Above the edge.
    Above,
}

impl SweepLine {
    const fn new() -> Self {
        Self { nodes: vec![], root: NONE, lowest: NONE }
    }

    /// The edge below this one, or [`NONE`].
    fn below(&self, edge: u32) -> u32 {
        self.nodes[edge as usize].below
    }

    /// The edge above this one, or [`NONE`]. Above [`NONE`] is the lowest edge.
    fn above(&self, edge: u32) -> u32 {
        if edge == NONE { self.lowest } else { self.nodes[edge as usize].above }
    }

    fn contains(&self, edge: u32) -> bool {
        self.nodes.get(edge as usize).is_some_and(|node| node.on_line)
    }

    /// An edge that a point lies on; if there is none, the edge next below it, or [`NONE`].
    fn find(&self, mut place: impl FnMut(u32) -> Place) -> (u32, Place) {
        let (mut at, mut below) = (self.root, NONE);
        while at != NONE {
            let children = self.nodes[at as usize].children;
            at = match place(at) {
                Place::On => return (at, Place::On),
                Place::Below => children[0],
                Place::Above => {
                    below = at;
                    children[1]
                }
            };
        }
        (below, Place::Above)
    }

    /// Inserts the edge with the next number above `below`, or as the lowest if that is [`NONE`].
    fn insert(&mut self, below: u32) -> u32 {
        let edge = self.nodes.len() as u32;
        let above = self.above(below);
        // Of two neighbours in the list, one is an ancestor of the other in the tree, so one of
        // them has no child on the side of the other: the new edge becomes that child.
        let (parent, side) =
            if below != NONE && self.child(below, 1) == NONE { (below, 1) } else { (above, 0) };
        self.nodes.push(Node { below, above, parent, children: [NONE; 2], on_line: true });
        self.link(below, above, edge, edge);
        match parent {
            NONE => self.root = edge,
            _ => self.nodes[parent as usize].children[side] = edge,
        }
        while self.parent(edge) != NONE && priority(self.parent(edge)) < priority(edge) {
            self.rotate_up(edge);
        }
        edge
    }

    fn remove(&mut self, edge: u32) {
        let Node { below, above, .. } = self.nodes[edge as usize];
        self.link(below, above, above, below);
        loop {
            match self.nodes[edge as usize].children {
                [NONE, NONE] => break,
                [child, NONE] | [NONE, child] => self.rotate_up(child),
                [low, high] if priority(low) > priority(high) => self.rotate_up(low),
                [_, high] => self.rotate_up(high),
            }
        }
        self.replace_child(self.parent(edge), edge, NONE);
        self.nodes[edge as usize].on_line = false;
    }

    /// Sets the edge above `below` to `next`, and the edge below `above` to `before`.
    fn link(&mut self, below: u32, above: u32, next: u32, before: u32) {
        match below {
            NONE => self.lowest = next,
            _ => self.nodes[below as usize].above = next,
        }
        if above != NONE {
            self.nodes[above as usize].below = before;
        }
    }

    fn child(&self, edge: u32, side: usize) -> u32 {
        self.nodes[edge as usize].children[side]
    }

    fn parent(&self, edge: u32) -> u32 {
        self.nodes[edge as usize].parent
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        match parent {
            NONE => self.root = new,
            _ => {
                let side = usize::from(self.child(parent, 1) == old);
                self.nodes[parent as usize].children[side] = new;
            }
        }
    }

    /// Rotates the tree so that an edge becomes the parent of its parent.
    fn rotate_up(&mut self, edge: u32) {
        let parent = self.parent(edge);
        let side = usize::from(self.child(parent, 1) == edge);
        let inner = self.child(edge, 1 - side);
        let grandparent = self.parent(parent);
        self.nodes[parent as usize].children[side] = inner;
        if inner != NONE {
            self.nodes[inner as usize].parent = parent;
        }
        self.nodes[edge as usize].children[1 - side] = parent;
        self.nodes[parent as usize].parent = edge;
        self.nodes[edge as usize].parent = grandparent;
        self.replace_child(grandparent, parent, edge);
    }
}

fn priority(edge: u32) -> u64 {
    mix(edge.into())
}

#[cfg(test)]
mod tests {
    use super::{NONE, Place, SweepLine};
    use crate::random::SplitMix64;

    /// Against a sorted list: what is found, who is next to whom, and how deep the tree is.
    #[test]
    fn the_line_is_a_sorted_list() {
        let mut random = SplitMix64::new(3);
        let mut below = |limit: usize| (random.next() >> 16) as usize % limit;
        let (mut line, mut list, mut keys) =
            (SweepLine::new(), Vec::<u32>::new(), Vec::<u64>::new());
        for round in 0..4000 {
            if list.len() > 3 && below(5) < 2 {
                let at = below(list.len());
                line.remove(list.remove(at));
            } else {
                let key = below(1 << 40) as u64;
                let place = |edge: u32| match key.cmp(&keys[edge as usize]) {
                    std::cmp::Ordering::Less => Place::Below,
                    std::cmp::Ordering::Equal => Place::On,
                    std::cmp::Ordering::Greater => Place::Above,
                };
                let mut steps = 0;
                let (next, found) = line.find(|edge| {
                    steps += 1;
                    place(edge)
                });
                assert!(steps < 64, "{steps} steps in a list of {}", list.len());
                assert_eq!(found, Place::Above);
                let at = list.partition_point(|&edge| keys[edge as usize] < key);
                assert_eq!(next, if at == 0 { NONE } else { list[at - 1] });
                keys.push(key);
                list.insert(at, line.insert(next));
            }
            if round % 50 == 0 {
                let mut at = NONE;
                for &edge in &list {
                    assert_eq!((line.above(at), line.below(edge)), (edge, at));
                    assert!(line.contains(edge));
                    at = edge;
                }
                assert_eq!(line.above(at), NONE);
            }
        }
    }
}
