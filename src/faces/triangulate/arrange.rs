//! Divides an outline into edges that meet at their ends only, and finds where it crosses itself.
//!
//! A sweep (Shamos and Hoey, “Geometric intersection problems”, 1976; Bentley and Ottmann, 1979)
//! passes over the points from left to right. Edges on which a point lies are divided there,
//! overlapping edges become one, and neighbouring edges are tested for a crossing. Nothing is
//! rounded, as every end of an edge is one of the polygon's corners.

use std::cmp::Ordering;

use super::arrangement::{Arrangement, Rule, Stop};
use super::edge::{Edge, Point, shared_corner, turn};
use super::sweep_line::{NONE, Place, SweepLine};
use crate::Error;
use crate::progress::{PIECES_AT_ONCE, Watch};

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
/// again. Smaller: such outlines are treated as if they crossed themselves; larger: they take time
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
