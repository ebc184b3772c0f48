//! Triangulates the inside of edges that meet at their ends only. The sweep of Lee and Preparata
//! (“Location of a point in a planar subdivision”, 1977) divides the regions between edges into
//! monotone polygons. Each of them is triangulated while the sweep passes over it (Garey, Johnson,
//! Preparata and Tarjan, “Triangulating a simple polygon”, 1978).

use std::cmp::Ordering;
use std::ops::Range;

use super::arrange::{Arrangement, NONE, Point, Rule, Stop, turn};
use crate::Error;
use crate::progress::{PIECES_AT_ONCE, Watch};

/// The triangles of the inside, counter-clockwise, and whether the outline winds around all of it
/// exactly once and in the same direction.
pub(super) struct Covered {
    pub(super) triangles: Triangles,
    pub(super) winds_once: bool,
}

/// The region between two neighbouring edges on the sweep line.
#[derive(Debug, Default)]
enum Region {
    /// Not inside the polygon.
    #[default]
    Outside,
    /// A monotone polygon.
    One(Chain),
    /// Two monotone polygons, the lower one first, that share their last point: two regions became
    /// one there.
    Two(Box<[Chain; 2]>),
}

struct RegionSweep<'a> {
    points: &'a [Point],
    /// For each point, a corner of the polygon there.
    corners: &'a [u32],
    arrangement: &'a Arrangement,
    rule: Rule,
    /// For each edge that the sweep has met, what lies above it.
    above: Vec<Above>,
    /// The lowest edge on the line.
    lowest: u32,
    triangles: Triangles,
    /// The smallest and the largest winding number met, 0 included.
    least: i32,
    most: i32,
}

/// What lies above an edge: the next edge, and the region up to it with its winding number.
#[derive(Debug)]
struct Above {
    edge: u32,
    winding: i32,
    region: Region,
}

/// Triangulates all that is inside the edges by a rule.
pub(super) fn triangulate(
    points: &[Point],
    corners: &[u32],
    arrangement: &Arrangement,
    rule: Rule,
    watch: &Watch<'_>,
) -> Result<Covered, Error> {
    let above = Vec::with_capacity(arrangement.edges.len());
    let triangles = Vec::with_capacity(points.len());
    let (lowest, least, most) = (NONE, 0, 0);
    let mut sweep =
        RegionSweep { points, corners, arrangement, rule, above, lowest, triangles, least, most };
    let stops = &arrangement.stops;
    for (index, &stop) in stops.iter().enumerate() {
        if index % PIECES_AT_ONCE == 0 {
            watch.work(PIECES_AT_ONCE)?;
        }
        let end = stops.get(index + 1).map_or(arrangement.edges.len() as u32, |next| next.first);
        sweep.visit(stop, stop.first..end);
    }
    Ok(Covered { triangles: sweep.triangles, winds_once: sweep.most - sweep.least <= 1 })
}

/// An end of an edge: the edge, and which end.
type End = (u32, usize);

impl RegionSweep<'_> {
    /// Sweeps over a point at which the edges in `starting` begin.
    fn visit(&mut self, stop: Stop, starting: Range<u32>) {
        // The point lies above `below`: either in the region between it and the next edge, or at
        // the end of that edge and of others above.
        let lowest = self.next(stop.below);
        let region = self.take(stop.below);
        if self.ends_at(lowest, stop.point) {
            let (regions, above) = self.end_all(stop, &starting, region, lowest);
            self.begin_all(stop, starting, regions, above);
        } else {
            // No edge ends here, so the region is divided: a diagonal leads back to its last point.
            let [first, last] = [starting.start, starting.end.saturating_sub(1)];
            let vertices = [first, last].map(|edge| self.vertex(stop.point, [(edge, 0); 2]));
            let regions = region.split(vertices, &mut self.triangles);
            self.begin_all(stop, starting, regions, lowest);
        }
    }

    /// Takes the edges that end at a point off the line. Returns the regions left below and above
    /// them, and the edge next above.
    fn end_all(
        &mut self,
        stop: Stop,
        starting: &Range<u32>,
        region: Region,
        lowest: u32,
    ) -> ([Region; 2], u32) {
        let point = stop.point;
        let begins = |edge: u32| if starting.is_empty() { (NONE, 0) } else { (edge, 0) };
        // Several corners may lie at this point. Which of them belongs to a region depends on the
        // direction of its outline: with a winding number above 0, the upper boundary runs from
        // right to left, and leaves the point along the edge on the left.
        let mut ends = [(lowest, 1), begins(starting.start)];
        if self.winding(stop.below) < 0 {
            ends.reverse();
        }
        let low = region.add(self.vertex(point, ends), ChainSide::Upper, &mut self.triangles);
        let mut edge = lowest;
        loop {
            let (winding, region, next) = (self.winding(edge), self.take(edge), self.next(edge));
            if !self.ends_at(next, point) {
                let mut ends = [begins(starting.end.saturating_sub(1)), (edge, 1)];
                if winding < 0 {
                    ends.reverse();
                }
                let vertex = self.vertex(point, ends);
                let high = region.add(vertex, ChainSide::Lower, &mut self.triangles);
                return ([low, high], next);
            }
            let ends = if winding < 0 { [edge, next] } else { [next, edge] };
            let vertex = self.vertex(point, ends.map(|edge| (edge, 1)));
            region.close(vertex, &mut self.triangles);
            edge = next;
        }
    }

    /// Puts the edges that begin at a point on the line, between two regions. If there are none,
    /// the two regions become one.
    fn begin_all(
        &mut self,
        stop: Stop,
        starting: Range<u32>,
        [low, high]: [Region; 2],
        above: u32,
    ) {
        if starting.is_empty() {
            self.set(stop.below, above, low.join(high));
            return;
        }
        let mut winding = self.winding(stop.below);
        self.set(stop.below, starting.start, low);
        let mut high = Some(high);
        for edge in starting.clone() {
            winding += self.arrangement.edges[edge as usize].weight;
            let next = edge + 1;
            let region = if next == starting.end {
                high.take().unwrap_or_default()
            } else if self.is_inside(winding) {
                let ends = if winding < 0 { [next, edge] } else { [edge, next] };
                Region::One(Chain::new(self.vertex(stop.point, ends.map(|edge| (edge, 0)))))
            } else {
                Region::Outside
            };
            let next = if next == starting.end { above } else { next };
            self.least = self.least.min(winding);
            self.most = self.most.max(winding);
            self.above.push(Above { edge: next, winding, region });
        }
    }

    fn is_inside(&self, winding: i32) -> bool {
        match self.rule {
            Rule::Signed => winding != 0,
            Rule::Parity => winding & 1 != 0,
        }
    }

    /// A point, with the corner of the first of two edge ends that has one.
    fn vertex(&self, point: u32, ends: [End; 2]) -> Vertex {
        let corner = |&(edge, end): &End| match self.arrangement.edges.get(edge as usize) {
            Some(edge) if edge.corners[end] != NONE => Some(edge.corners[end]),
            _ => None,
        };
        let corner = ends.iter().find_map(corner).unwrap_or(self.corners[point as usize]);
        Vertex { point: self.points[point as usize], corner }
    }

    fn ends_at(&self, edge: u32, point: u32) -> bool {
        edge != NONE && self.arrangement.edges[edge as usize].ends[1] == point
    }

    /// The edge next above another, or the lowest one above [`NONE`].
    fn next(&self, edge: u32) -> u32 {
        if edge == NONE { self.lowest } else { self.above[edge as usize].edge }
    }

    fn winding(&self, edge: u32) -> i32 {
        if edge == NONE { 0 } else { self.above[edge as usize].winding }
    }

    fn take(&mut self, edge: u32) -> Region {
        let above = self.above.get_mut(edge as usize);
        above.map_or(Region::Outside, |above| std::mem::take(&mut above.region))
    }

    /// Sets the edge and the region above an edge.
    fn set(&mut self, edge: u32, next: u32, region: Region) {
        match self.above.get_mut(edge as usize) {
            Some(above) => (above.edge, above.region) = (next, region),
            None => self.lowest = next,
        }
    }
}

impl Region {
    /// Adds a point of a boundary.
    fn add(self, vertex: Vertex, side: ChainSide, triangles: &mut Triangles) -> Self {
        let (done, mut left) = match (self, side) {
            (Self::Outside, _) => return Self::Outside,
            (Self::One(chain), _) => (None, chain),
            (Self::Two(chains), ChainSide::Lower) => {
                let [low, high] = *chains;
                (Some(low), high)
            }
            (Self::Two(chains), ChainSide::Upper) => {
                let [low, high] = *chains;
                (Some(high), low)
            }
        };
        if let Some(done) = done {
            done.close(vertex, triangles);
        }
        left.add(vertex, side, triangles);
        Self::One(left)
    }

    /// Adds the last point.
    fn close(self, vertex: Vertex, triangles: &mut Triangles) {
        match self {
            Self::Outside => {}
            Self::One(chain) => chain.close(vertex, triangles),
            Self::Two(chains) => {
                let [low, high] = *chains;
                low.close(vertex, triangles);
                high.close(vertex, triangles);
            }
        }
    }

    /// Divides the region at a point where edges begin within it. The point's corner may differ
    /// between the part below and the part above.
    fn split(self, [upper, lower]: [Vertex; 2], triangles: &mut Triangles) -> [Self; 2] {
        let [mut low, mut high] = match self {
            Self::Outside => return [Self::Outside, Self::Outside],
            Self::Two(chains) => *chains,
            // The last point sees this one, as the sweep met nothing of the region in between.
            Self::One(chain) => match chain.last() {
                (last, ChainSide::Lower) => [Chain::new(last), chain],
                (last, ChainSide::Upper) => [chain, Chain::new(last)],
            },
        };
        low.add(upper, ChainSide::Upper, triangles);
        high.add(lower, ChainSide::Lower, triangles);
        [Self::One(low), Self::One(high)]
    }

    /// Makes one region of two, when the edges between them have ended.
    fn join(self, high: Self) -> Self {
        match (self, high) {
            (Self::One(low), Self::One(high)) => Self::Two(Box::new([low, high])),
            // The winding number is the same on both sides, so both are outside.
            (low, _) => low,
        }
    }
}

/// A point of the sweep, and the corner of the polygon that lies there.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    point: Point,
    corner: u32,
}

/// One of the two boundaries of a monotone polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ChainSide {
    Lower,
    Upper,
}

/// The part of a monotone polygon that the sweep has passed and no triangle covers yet: a chain of
/// points on one side that turn inwards. The first of them lies on the other side as well.
#[derive(Debug)]
struct Chain {
    stack: Vec<Vertex>,
    side: ChainSide,
}

/// A list of triangles, each counter-clockwise.
type Triangles = Vec<[u32; 3]>;

impl Chain {
    fn new(first: Vertex) -> Self {
        Self { stack: vec![first], side: ChainSide::Lower }
    }

    /// The point that the sweep met last, and its side.
    fn last(&self) -> (Vertex, ChainSide) {
        (self.stack[self.stack.len() - 1], self.side)
    }

    /// Adds the next point of one side.
    fn add(&mut self, vertex: Vertex, side: ChainSide, triangles: &mut Triangles) {
        if self.stack.len() > 1 && side == self.side {
            self.cut_corners(vertex, triangles);
        } else {
            self.fan(vertex, triangles);
            let last = self.stack.len() - 1;
            self.stack.swap(0, last);
            self.stack.truncate(1);
            self.side = side;
        }
        self.stack.push(vertex);
    }

    /// Adds the last point, in which both sides end.
    fn close(self, vertex: Vertex, triangles: &mut Triangles) {
        self.fan(vertex, triangles);
    }

    /// Cuts triangles off between a new point and the points of the same side that it sees.
    fn cut_corners(&mut self, vertex: Vertex, triangles: &mut Triangles) {
        let outwards = match self.side {
            ChainSide::Lower => Ordering::Greater,
            ChainSide::Upper => Ordering::Less,
        };
        while let [.., a, b] = self.stack[..]
            && turn(a.point, b.point, vertex.point) == outwards
        {
            self.triangle(a, b, vertex, triangles);
            self.stack.pop();
        }
    }

    /// Cuts triangles off between the whole chain and a point of the other side, which sees all of
    /// it.
    fn fan(&self, vertex: Vertex, triangles: &mut Triangles) {
        for pair in self.stack.windows(2) {
            self.triangle(pair[0], pair[1], vertex, triangles);
        }
    }

    /// Adds the triangle of an edge of the chain, from left to right, and a point further right.
    fn triangle(&self, a: Vertex, b: Vertex, c: Vertex, triangles: &mut Triangles) {
        triangles.push(match self.side {
            ChainSide::Lower => [a.corner, b.corner, c.corner],
            ChainSide::Upper => [a.corner, c.corner, b.corner],
        });
    }
}
