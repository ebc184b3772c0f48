//! Triangulates a monotone polygon while a sweep passes over it.
//!
//! Garey, Johnson, Preparata and Tarjan, “Triangulating a simple polygon”, 1978.

use std::cmp::Ordering;

use super::edge::{Point, turn};

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

/// The part of a monotone polygon that the sweep has passed and no triangle covers yet: a chain of
/// points on one side that turn inwards. The first of them lies on the other side as well.
#[derive(Debug)]
pub(super) struct Chain {
    stack: Vec<Vertex>,
    side: ChainSide,
}

/// A list of triangles, each counter-clockwise.
pub(super) type Triangles = Vec<[u32; 3]>;

impl Chain {
    pub(super) fn new(first: Vertex) -> Self {
        Self { stack: vec![first], side: ChainSide::Lower }
    }

    /// The point that the sweep met last, and its side.
    pub(super) fn last(&self) -> (Vertex, ChainSide) {
        (self.stack[self.stack.len() - 1], self.side)
    }

    /// Adds the next point of one side.
    pub(super) fn add(&mut self, vertex: Vertex, side: ChainSide, triangles: &mut Triangles) {
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
    pub(super) fn close(self, vertex: Vertex, triangles: &mut Triangles) {
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
