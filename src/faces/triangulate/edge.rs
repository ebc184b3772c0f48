//! Points and edges of a polygon projected along an axis.

use std::cmp::Ordering;

use super::sweep_line::NONE;

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
    pub(super) const fn cut(self, point: u32) -> [Self; 2] {
        [
            Self { ends: [self.ends[0], point], corners: [self.corners[0], NONE], ..self },
            Self { ends: [point, self.ends[1]], corners: [NONE, self.corners[1]], ..self },
        ]
    }
}

/// The corner at an end that edges share: preferably of an edge with the direction of their sum.
pub(super) fn shared_corner(edges: &[Edge], end: usize, weight: i32) -> u32 {
    let at = |edge: &&Edge| edge.corners[end] != NONE;
    let along = |edge: &&Edge| at(edge) && edge.weight.signum() == weight.signum();
    let best = edges.iter().find(along).or_else(|| edges.iter().find(at));
    best.map_or(NONE, |edge| edge.corners[end])
}
