//! The five tests.

use super::pieces::Pieces;

/// Projections that overlap by no more than this, in pixels, only touch. Too large: the overlaps of slivers
/// are overlooked. Too small: neighbours in a mesh are compared without effect.
pub(super) const TOUCH: f64 = 1e-6;

/// The test that proves that P does not hide Q.
#[derive(Clone, Copy, Debug)]
pub(super) enum Reason {
    /// P and Q are pieces of one face.
    OneFace,
    /// One of the five tests, numbered from 0.
    Test(usize),
}

/// The first reason why P does not hide Q; `None` if P may hide a part of Q.
#[inline]
pub(super) fn why_not_hidden(pieces: &Pieces, p: u32, q: u32, epsilon: f64) -> Option<Reason> {
    let (a, b) = (pieces.get(p), pieces.get(q));
    let apart =
        |axis: usize| a.high[axis] <= b.low[axis] + TOUCH || b.high[axis] <= a.low[axis] + TOUCH;
    if apart(0) {
        Some(Reason::Test(0))
    } else if apart(1) {
        Some(Reason::Test(1))
    } else if a.face == b.face {
        Some(Reason::OneFace)
    } else if is_behind(pieces, p, q, epsilon) {
        Some(Reason::Test(2))
    } else if is_in_front(pieces, q, p, epsilon) {
        Some(Reason::Test(3))
    } else if are_apart(pieces.flat(p), pieces.flat(q)) {
        Some(Reason::Test(4))
    } else {
        None
    }
}

/// Whether no part of P is in front of Q's plane.
pub(super) fn is_behind(pieces: &Pieces, p: u32, q: u32, epsilon: f64) -> bool {
    let plane = pieces.plane(q);
    pieces.vertices(p).iter().all(|vertex| plane.distance(vertex.at) <= epsilon)
}

/// Whether no part of P is behind Q's plane.
pub(super) fn is_in_front(pieces: &Pieces, p: u32, q: u32, epsilon: f64) -> bool {
    let plane = pieces.plane(q);
    pieces.vertices(p).iter().all(|vertex| plane.distance(vertex.at) >= -epsilon)
}

/// Whether an edge of one of two convex polygons separates them.
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
