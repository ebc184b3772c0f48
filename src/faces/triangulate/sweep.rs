//! Triangulates the inside of an outline, in one sweep over its points from left to right.
//!
//! The sweep divides edges on which a point lies, merges edges that overlap, and tests neighbours for a
//! crossing (Shamos and Hoey, “Geometric intersection problems”, 1976; Bentley and Ottmann, 1979). Nothing
//! is rounded, because every end of an edge is one of the polygon's corners. The regions between the edges
//! become monotone polygons during the sweep: see `region`.

use std::cmp::Ordering;
use std::ops::Range;

use super::Outline;
use super::region::{ChainSide, Region, Triangles, Vertex};
use crate::Error;
use crate::progress::{PIECES_AT_ONCE, Watch};

/// A point in lattice units. Points are numbered in the order in which the sweep meets them: by x,
/// then by y.
pub(super) type Point = [i64; 2];

/// The side of the line from `a` to `b` on which `c` lies, exactly. `Greater` is on the left, which is above
/// an edge whose ends are in the sweep's order.
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

/// The number that means "no edge" or "no corner".
pub(super) const NONE: u32 = u32::MAX;

/// A straight part of the outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Edge {
    /// The points at the edge's ends, in the order of the sweep.
    pub(super) ends: [u32; 2],
    /// The polygon's corners at these ends; [`NONE`] where the outline continues straight.
    pub(super) corners: [u32; 2],
    /// The number of times that the outline traverses the edge from the first end to the second, minus the
    /// number of times in reverse.
    pub(super) weight: i32,
}

impl Edge {
    /// An edge between two corners. Each corner is a pair: the corner's number, and the number of the point
    /// at the corner.
    pub(super) fn between(from: (u32, u32), to: (u32, u32)) -> Self {
        let (low, high, weight) = if from.1 < to.1 { (from, to, 1) } else { (to, from, -1) };
        Self { ends: [low.1, high.1], corners: [low.0, high.0], weight }
    }

    /// Divides the edge at a point on it. Returns the part before the point, and the part behind it.
    const fn cut(self, point: u32) -> [Self; 2] {
        [
            Self { ends: [self.ends[0], point], corners: [self.corners[0], NONE], ..self },
            Self { ends: [point, self.ends[1]], corners: [NONE, self.corners[1]], ..self },
        ]
    }
}

/// The polygon's corner at an end that several edges share: preferably the corner of an edge whose direction
/// is the sign of `weight`, the edges' sum.
fn shared_corner(edges: &[Edge], end: usize, weight: i32) -> u32 {
    let at = |edge: &&Edge| edge.corners[end] != NONE;
    let along = |edge: &&Edge| at(edge) && edge.weight.signum() == weight.signum();
    let best = edges.iter().find(along).or_else(|| edges.iter().find(at));
    best.map_or(NONE, |edge| edge.corners[end])
}

/// The fill rule, which also decides how overlapping edges are merged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// The nonzero rule, by direction: opposite edges cancel, two edges of the same direction count 2. A
    /// point is inside if its winding number is not 0. Edges must not cross.
    Signed,
    /// The even-odd rule, by parity: any two overlapping edges cancel.
    Parity,
}

/// A sweep over the points of an outline.
///
/// Allocations of the sweep's lists are not checked. Edges that overlap are merged, so `n` edges and `n`
/// points have O(n^(4/3)) parts (Szemerédi and Trotter, “Extremal problems in discrete geometry”, 1983). Some
/// megabytes suffice for an outline of 20 000 random corners; an outline with the largest allowed number of
/// corners takes a gigabyte.
pub(super) struct Sweep<'a> {
    outline: &'a Outline,
    rule: Rule,
    line: SweepLine,
    /// The edges that are, or were, on the sweep line.
    edges: Vec<SweptEdge>,
    /// The edges that the sweep has not met yet, each with the next edge that begins at the same point.
    waiting: Vec<(Edge, u32)>,
    /// For each point, the last edge that waits for the point: the head of a list in `waiting`.
    heads: Vec<u32>,
    /// For each point, the number of edges on the line that end at the point.
    arriving: Vec<u32>,
    /// The edges that begin at the current point.
    starting: Vec<Edge>,
    /// The same edges before overlapping edges are merged.
    unmerged: Vec<Edge>,
    /// The edges that the current point ends or divides.
    ended: Vec<u32>,
    /// Whether a point divides an edge, or edges overlap.
    touches: bool,
    /// Pairs of edges that cross. These edges are no longer on the line. If there are any, `triangles` is
    /// incomplete.
    pub(super) crossings: Vec<[Edge; 2]>,
    /// The triangles of the inside, counter-clockwise.
    pub(super) triangles: Triangles,
    /// The smallest and the largest winding number met, 0 included.
    windings: [i32; 2],
    /// Work done since the last poll, in points and edges visited.
    steps: usize,
}

/// An edge on the sweep line, and the region above the edge.
struct SweptEdge {
    edge: Edge,
    /// The winding number of the region up to the next edge.
    winding: i32,
    region: Region,
}

/// Search budget: the sweep gives up when edges have been divided into more than this many parts per edge of
/// the polygon. Edges have many parts if an outline passes through the same points many times. Too small:
/// such outlines are treated as if they crossed themselves. Too large: such outlines take time and memory.
const MOST_PARTS: usize = 8;

impl<'a> Sweep<'a> {
    /// A sweep over some edges between the outline's points.
    pub(super) fn new(outline: &'a Outline, edges: &[Edge], rule: Rule) -> Self {
        let points = outline.points.len();
        let mut sweep = Sweep {
            outline,
            rule,
            line: SweepLine { blocks: vec![] },
            edges: vec![],
            waiting: Vec::with_capacity(edges.len()),
            heads: vec![NONE; points],
            arriving: vec![0; points],
            starting: vec![],
            unmerged: vec![],
            ended: vec![],
            touches: false,
            crossings: vec![],
            triangles: vec![],
            windings: [0; 2],
            steps: 0,
        };
        edges.iter().for_each(|&edge| sweep.wait(edge));
        sweep
    }

    /// Sweeps over all points. Returns `None` if there are too many parts. Two edges that cross are removed
    /// from the line when the crossing is found; if the rule does not allow crossings, the sweep ends there.
    pub(super) fn run(mut self, watch: &Watch<'_>) -> Result<Option<Self>, Error> {
        let most = self.waiting.len() * MOST_PARTS;
        for point in 0..self.outline.points.len() as u32 {
            self.steps += 1;
            self.visit(point);
            if self.steps >= PIECES_AT_ONCE {
                watch.work(std::mem::take(&mut self.steps))?;
            }
            let crosses = self.rule == Rule::Signed && !self.crossings.is_empty();
            if crosses {
                break;
            }
            if self.waiting.len() > most {
                return Ok(None);
            }
        }
        watch.work(std::mem::take(&mut self.steps))?;
        Ok(Some(self))
    }

    /// Whether the winding number is 1 everywhere inside, or −1 everywhere.
    pub(super) fn winds_once(&self) -> bool {
        self.windings[1] - self.windings[0] <= 1
    }

    /// Whether an outline of this many corners does not touch itself. Its edges must not cross.
    pub(super) fn is_simple(&self, corners: usize) -> bool {
        !self.touches && self.outline.points.len() == corners
    }

    /// The edges found, without the edges that cross.
    pub(super) fn uncrossed(&self) -> impl Iterator<Item = Edge> {
        self.edges.iter().map(|swept| swept.edge).filter(|edge| edge.weight != 0)
    }

    fn edge(&self, edge: u32) -> &Edge {
        &self.edges[edge as usize].edge
    }

    fn wait(&mut self, edge: Edge) {
        let head = &mut self.heads[edge.ends[0] as usize];
        let next = std::mem::replace(head, self.waiting.len() as u32);
        self.waiting.push((edge, next));
    }

    /// Removes the edges through a point from the line, and inserts the edges that begin at the point.
    fn visit(&mut self, point: u32) {
        let mut head = self.heads[point as usize];
        if self.arriving[point as usize] == 0 && head == NONE {
            return;
        }
        self.starting.clear();
        while head != NONE {
            let (edge, next) = self.waiting[head as usize];
            self.starting.push(edge);
            head = next;
        }
        let place = self.find(point, false);
        let below = self.line.before(place);
        self.end_all(point, place);
        let above = self.line.at(place);
        self.steps += self.starting.len();
        self.merge(point);
        if self.ended.is_empty() && self.starting.is_empty() {
            return;
        }
        let first = self.edges.len() as u32;
        self.begin_all(point, below);
        let begun = first..self.edges.len() as u32;
        self.line.insert(place, begun.clone());
        let [low, high] = if begun.is_empty() { [above, below] } else { [first, begun.end - 1] };
        if self.cross(below, low) || self.cross(high, above) {
            self.remove_crossings(point);
        }
    }

    /// The place of the first edge above a point, on the sweep line. Unless `above_all` is set, edges through
    /// the point are treated as above the point.
    fn find(&mut self, point: u32, above_all: bool) -> Place {
        let mut steps = 0;
        let place = self.line.find(|edge| {
            steps += 1;
            let side = self.side(edge, point);
            side.is_gt() || above_all && side.is_eq()
        });
        self.steps += steps;
        place
    }

    /// The side of an edge on which a point lies: `Greater` is above the edge.
    fn side(&self, edge: u32, point: u32) -> Ordering {
        let [a, b] = self.edge(edge).ends;
        let points = &self.outline.points;
        turn(points[a as usize], points[b as usize], points[point as usize])
    }

    /// Removes the edges through a point from the line, from the lowest to the highest. The parts of these
    /// edges behind the point begin at the point.
    fn end_all(&mut self, point: u32, place: Place) {
        self.ended.clear();
        loop {
            let edge = self.line.at(place);
            if edge == NONE || self.side(edge, point).is_ne() {
                return;
            }
            self.line.remove(place);
            self.ended.push(edge);
            let ending = &mut self.edges[edge as usize].edge;
            self.arriving[ending.ends[1] as usize] -= 1;
            if ending.ends[1] != point {
                let [before, behind] = ending.cut(point);
                *ending = before;
                self.touches = true;
                self.starting.push(behind);
            }
        }
    }

    /// Sorts the edges that begin at a point from the lowest to the highest, and merges overlapping edges.
    /// Where the shortest overlapping edge ends, the remaining parts of the others begin.
    fn merge(&mut self, point: u32) {
        let points = &self.outline.points;
        let at = points[point as usize];
        let end = |edge: &Edge| points[edge.ends[1] as usize];
        let mut all = std::mem::replace(&mut self.starting, std::mem::take(&mut self.unmerged));
        all.sort_unstable_by(|a, b| {
            let side = turn(at, end(b), end(a));
            side.then(a.ends[1].cmp(&b.ends[1])).then(a.corners.cmp(&b.corners))
        });
        self.starting.clear();
        for alike in all.chunk_by(|a, b| turn(at, end(a), end(b)).is_eq()) {
            self.touches |= alike.len() > 1;
            let merged = self.merge_alike(point, alike);
            self.starting.extend(merged);
        }
        self.unmerged = all;
    }

    /// Merges edges that begin at a point in the same direction, given in the order of their ends, into one
    /// edge up to the nearest end. Returns `None` if the edges cancel. The parts beyond the nearest end are
    /// queued at the points where they begin.
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

    /// Adds a point to the regions around the point, and inserts the edges that begin at the point between
    /// these regions.
    fn begin_all(&mut self, point: u32, below: u32) {
        let mut winding = self.edges.get(below as usize).map_or(0, |swept| swept.winding);
        // Once edges have left the line, regions are no longer known.
        let is_known = self.crossings.is_empty();
        let [mut low, mut high] =
            if is_known { self.regions(point, below) } else { Default::default() };
        if self.starting.is_empty() {
            low = low.join(std::mem::take(&mut high));
        }
        if let Some(swept) = self.edges.get_mut(below as usize) {
            swept.region = low;
        }
        for (k, &edge) in self.starting.iter().enumerate() {
            winding += edge.weight;
            let is_inside = match self.rule {
                Rule::Signed => winding != 0,
                Rule::Parity => winding & 1 != 0,
            };
            let region = match self.starting.get(k + 1) {
                None => std::mem::take(&mut high),
                Some(next) if is_inside => {
                    let corners = [edge.corners[0], next.corners[0]];
                    Region::from(self.vertex(point, corners, winding))
                }
                Some(_) => Region::default(),
            };
            let [least, most] = self.windings;
            self.windings = [least.min(winding), most.max(winding)];
            self.arriving[edge.ends[1] as usize] += 1;
            self.edges.push(SweptEdge { edge, winding, region });
        }
    }

    /// Adds a point to the regions around the point. Returns the remaining regions below and above the edges
    /// that begin at the point.
    fn regions(&mut self, point: u32, below: u32) -> [Region; 2] {
        let ends = [self.starting.first(), self.starting.last()];
        let [first, last] = ends.map(|edge| edge.map_or(NONE, |edge| edge.corners[0]));
        if self.ended.is_empty() {
            // The region is divided: a diagonal leads back to its last point.
            let vertices = [first, last].map(|corner| self.vertex(point, [corner; 2], 0));
            return self.take(below).1.split(vertices, &mut self.triangles);
        }
        let (mut owner, mut lower, mut low) = (below, first, Region::default());
        for k in 0..self.ended.len() {
            let edge = self.ended[k];
            let upper = self.edge(edge).corners[1];
            let (winding, region) = self.take(owner);
            let vertex = self.vertex(point, [upper, lower], winding);
            if k == 0 {
                low = region.add(vertex, ChainSide::Upper, &mut self.triangles);
            } else {
                region.close(vertex, &mut self.triangles);
            }
            (owner, lower) = (edge, upper);
        }
        let (winding, region) = self.take(owner);
        let vertex = self.vertex(point, [last, lower], winding);
        [low, region.add(vertex, ChainSide::Lower, &mut self.triangles)]
    }

    /// Removes the region above an edge, and returns the region and its winding number.
    fn take(&mut self, edge: u32) -> (i32, Region) {
        let swept = self.edges.get_mut(edge as usize);
        swept.map_or_else(Default::default, |s| (s.winding, std::mem::take(&mut s.region)))
    }

    /// A point of a region, with the corner of the first of two edges that has a corner there. The direction
    /// of a region's outline decides which of several corners at a point belongs to the region: with a
    /// winding number above 0, the upper boundary leads from right to left, and leaves the point along the
    /// edge on the left.
    fn vertex(&self, point: u32, mut corners: [u32; 2], winding: i32) -> Vertex {
        if winding < 0 {
            corners.reverse();
        }
        let corner = corners.into_iter().find(|&corner| corner != NONE);
        let corner = corner.unwrap_or(self.outline.corners[point as usize]);
        Vertex { point: self.outline.points[point as usize], corner }
    }

    /// Removes pairs of neighbouring edges that cross each other from the sweep line: first below the edges
    /// through a point, and then above these edges. After each removal, the new neighbours are tested too.
    fn remove_crossings(&mut self, point: u32) {
        for above_all in [false, true] {
            loop {
                let place = self.find(point, above_all);
                let pair = [self.line.before(place), self.line.at(place)];
                if !self.cross(pair[0], pair[1]) {
                    break;
                }
                self.line.remove(place);
                self.line.remove((place.0, place.1 - 1));
                self.crossings.push(pair.map(|edge| *self.edge(edge)));
                for edge in pair {
                    let edge = &mut self.edges[edge as usize].edge;
                    edge.weight = 0;
                    self.arriving[edge.ends[1] as usize] -= 1;
                }
            }
        }
    }

    /// Whether two edges on the sweep line, one above the other, cross before one of them ends. In this case
    /// the edge that ends first ends on the wrong side of the other edge.
    fn cross(&self, low: u32, high: u32) -> bool {
        if low == NONE || high == NONE {
            return false;
        }
        let (low_end, high_end) = (self.edge(low).ends[1], self.edge(high).ends[1]);
        match low_end.cmp(&high_end) {
            Ordering::Less => self.side(high, low_end).is_gt(),
            Ordering::Equal => false,
            Ordering::Greater => self.side(low, high_end).is_lt(),
        }
    }
}

/// The edges on the sweep line, from the lowest to the highest, in blocks of bounded length, so that an
/// insertion moves few edges. Blocks are split but never merged.
struct SweepLine {
    /// Blocks of edges, none of which is empty.
    blocks: Vec<Vec<u32>>,
}

/// A block, and a place in it or at its end. Place 0 occurs only in the first block.
type Place = (usize, usize);

impl SweepLine {
    /// The largest size of a block. Too small: there are many blocks. Too large: many edges are moved.
    const MOST: usize = 512;

    /// The place after all edges for which `is_below` holds; these edges are first in the list.
    fn find(&self, mut is_below: impl FnMut(u32) -> bool) -> Place {
        let block = self.blocks.partition_point(|block| is_below(block[0])).saturating_sub(1);
        let edges = self.blocks.get(block).map_or(&[][..], |block| block);
        (block, edges.partition_point(|&edge| is_below(edge)))
    }

    /// The edge before a place, or [`NONE`].
    fn before(&self, (block, at): Place) -> u32 {
        at.checked_sub(1).map_or(NONE, |at| self.blocks[block][at])
    }

    /// The edge at a place, or [`NONE`].
    fn at(&self, (block, at): Place) -> u32 {
        let edge = self.blocks.get(block).and_then(|edges| edges.get(at));
        let edge = edge.or_else(|| self.blocks.get(block + 1)?.first());
        edge.copied().unwrap_or(NONE)
    }

    /// Removes the edge at a place.
    fn remove(&mut self, (block, at): Place) {
        let is_last = at == self.blocks[block].len();
        let (block, at) = if is_last { (block + 1, 0) } else { (block, at) };
        self.blocks[block].remove(at);
        if self.blocks[block].is_empty() {
            self.blocks.remove(block);
        }
    }

    /// Inserts edges at a place.
    fn insert(&mut self, (block, at): Place, edges: Range<u32>) {
        if self.blocks.is_empty() && !edges.is_empty() {
            self.blocks.push(vec![]);
        }
        let Some(list) = self.blocks.get_mut(block) else { return };
        list.splice(at..at, edges);
        while self.blocks[block].len() > Self::MOST {
            let half = self.blocks[block].len() - Self::MOST / 2;
            let rest = self.blocks[block].split_off(half);
            self.blocks.insert(block + 1, rest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{NONE, SweepLine};
    use crate::random::SplitMix64;

    /// Searches and neighbours are the same as in a plain sorted list that grows and then shrinks.
    #[test]
    fn the_line_is_a_sorted_list() {
        let mut random = SplitMix64::new(3);
        let mut below = |limit: usize| (random.next() >> 16) as usize % limit;
        let mut line = SweepLine { blocks: vec![] };
        let (mut list, mut keys, mut most) = (Vec::<u32>::new(), Vec::<u64>::new(), 0);
        for round in 0.. {
            let grows = round < 10_000;
            if !grows && list.is_empty() {
                break;
            }
            let removes = !list.is_empty() && below(5) < if grows { 1 } else { 4 };
            let key = match removes {
                true => keys[list[below(list.len())] as usize],
                false => below(1 << 40) as u64,
            };
            let place = line.find(|edge| keys[edge as usize] < key);
            let at = list.partition_point(|&edge| keys[edge as usize] < key);
            let edge = |at: Option<usize>| at.and_then(|at| list.get(at)).copied();
            let expected = [at.checked_sub(1), Some(at)].map(|at| edge(at).unwrap_or(NONE));
            assert_eq!([line.before(place), line.at(place)], expected);
            if removes {
                line.remove(place);
                list.remove(at);
            } else {
                let more = if grows && below(500) == 0 { 1500 } else { below(3) };
                let first = keys.len() as u32;
                keys.extend(vec![key; more]);
                let new = first..first + more as u32;
                line.insert(place, new.clone());
                list.splice(at..at, new);
            }
            if round % 50 == 0 {
                let is_right = |block: &Vec<u32>| (1..=SweepLine::MOST).contains(&block.len());
                assert!(line.blocks.iter().all(is_right));
                assert_eq!(line.blocks.concat(), list);
            }
            most = most.max(line.blocks.len());
        }
        assert!(most > 50 && line.blocks.is_empty(), "{most}");
    }
}
