//! The regions between edges, triangulated while a sweep passes over them. The sweep divides each region into
//! monotone polygons (Lee and Preparata, “Location of a point in a planar subdivision”, 1977), and these
//! polygons are triangulated as they grow (Garey, Johnson, Preparata and Tarjan, “Triangulating a simple
//! polygon”, 1978).

use std::cmp::Ordering;

use smallvec::{SmallVec, smallvec};

use super::sweep::{Point, turn};

/// The region between two neighbouring edges on the sweep line: empty outside the polygon; a monotone
/// polygon; or, where two regions became one, two monotone polygons that share their last point, the lower
/// polygon first.
#[derive(Default)]
pub(super) struct Region(SmallVec<[Chain; 1]>);

impl From<Vertex> for Region {
    /// A region that begins at a point.
    fn from(first: Vertex) -> Self {
        Self(smallvec![Chain::new(first)])
    }
}

impl Region {
    /// Adds a point of a boundary.
    pub(super) fn add(
        mut self,
        vertex: Vertex,
        side: ChainSide,
        triangles: &mut Triangles,
    ) -> Self {
        if self.0.len() == 2 {
            let far = if side == ChainSide::Lower { 0 } else { 1 };
            self.0.remove(far).close(vertex, triangles);
        }
        self.0.iter_mut().for_each(|chain| chain.add(vertex, side, triangles));
        self
    }

    /// Adds the last point.
    pub(super) fn close(self, vertex: Vertex, triangles: &mut Triangles) {
        self.0.into_iter().for_each(|chain| chain.close(vertex, triangles));
    }

    /// Divides the region at a point inside the region where edges begin. The point's corner may differ
    /// between the part below and the part above.
    pub(super) fn split(
        mut self,
        [upper, lower]: [Vertex; 2],
        triangles: &mut Triangles,
    ) -> [Self; 2] {
        if let [chain] = &self.0[..] {
            // The last point sees the new point, because the sweep met no point of the region in between.
            let last = Chain::new(chain.stack[chain.stack.len() - 1]);
            self.0.insert(if chain.side == ChainSide::Lower { 0 } else { 1 }, last);
        }
        let high = Self(self.0.drain(self.0.len() / 2..).collect());
        let low = self.add(upper, ChainSide::Upper, triangles);
        [low, high.add(lower, ChainSide::Lower, triangles)]
    }

    /// Joins two regions when the edges between them have ended.
    pub(super) fn join(mut self, high: Self) -> Self {
        self.0.extend(high.0);
        self
    }
}

/// A point of the sweep, and the corner of the polygon that lies there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub(super) point: Point,
    pub(super) corner: u32,
}

/// One of the two boundaries of a monotone polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ChainSide {
    Lower,
    Upper,
}

/// The part of a monotone polygon that the sweep has passed, but that no triangle covers yet: a chain of
/// points on one side that turn inwards. The first point lies on the other side as well.
#[derive(Debug)]
struct Chain {
    stack: Vec<Vertex>,
    side: ChainSide,
}

/// A list of triangles, each counter-clockwise.
pub(super) type Triangles = Vec<[u32; 3]>;

impl Chain {
    fn new(first: Vertex) -> Self {
        Self { stack: vec![first], side: ChainSide::Lower }
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

    /// Cuts triangles off between a new point and the visible points of the same side.
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

    /// Cuts triangles off between the whole chain and a point of the other side, which sees the whole chain.
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
