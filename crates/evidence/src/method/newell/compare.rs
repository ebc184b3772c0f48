//! The five tests.

use super::pieces::Pieces;

/// Projections that overlap by no more than this, in pixels, only touch. Larger, and the overlaps
/// of slivers are overlooked; smaller, and neighbours in a mesh are compared in vain.
pub(super) const TOUCH: f64 = 1e-6;

/// Whether P may hide part of Q: none of the five tests says that it does not.
#[inline]
pub(super) fn may_hide(pieces: &Pieces, p: u32, q: u32, epsilon: f64) -> bool {
    let (a, b) = (pieces.get(p), pieces.get(q));
    let apart =
        |axis: usize| a.high[axis] <= b.low[axis] + TOUCH || b.high[axis] <= a.low[axis] + TOUCH;
    !(apart(0)
        || apart(1)
        || a.face == b.face
        || is_behind(pieces, p, q, epsilon)
        || is_in_front(pieces, q, p, epsilon)
        || are_apart(pieces.flat(p), pieces.flat(q)))
}

/// Whether nothing of P is in front of Q's plane.
pub(super) fn is_behind(pieces: &Pieces, p: u32, q: u32, epsilon: f64) -> bool {
    let plane = pieces.plane(q);
    pieces.vertices(p).iter().all(|vertex| plane.distance(vertex.at) <= epsilon)
}

/// Whether nothing of P is behind Q's plane.
pub(super) fn is_in_front(pieces: &Pieces, p: u32, q: u32, epsilon: f64) -> bool {
    let plane = pieces.plane(q);
    pieces.vertices(p).iter().all(|vertex| plane.distance(vertex.at) >= -epsilon)
}

/// Whether an edge of one of two convex polygons has them on different sides.
fn are_apart(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    has_separating_edge(a, b) || has_separating_edge(b, a)
}

fn has_separating_edge(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    (0..a.len()).any(|i| {
        let (from, to) = (a[i], a[if i + 1 == a.len() { 0 } else { i + 1 }]);
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = (dx * dx + dy * dy).sqrt();
        let across = |polygon: &[[f64; 2]]| {
            let values = polygon.iter().map(|p| (p[1] - from[1]) * dx - (p[0] - from[0]) * dy);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
        };
        let ((low_a, high_a), (low_b, high_b)) = (across(a), across(b));
        let touch = TOUCH * length;
        length > TOUCH && (high_a <= low_b + touch || high_b <= low_a + touch)
    })
}
