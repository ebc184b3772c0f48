//! The coplanar tolerance: where a piece lies against a plane.

use std::cmp::Ordering;

use super::Faces;
use super::filter::{ExactSplitter, ExactVertex, compare};
use super::kernel::{Piece, Side};
use super::label::{PlaneId, Symbol};

/// Where a piece lies against a plane, by the rules of [`Exact`](super::Exact).
#[inline]
pub(super) fn classify(
    faces: &Faces,
    splitter: &ExactSplitter,
    piece: Piece<'_, ExactVertex>,
) -> Side {
    if splitter.plane == PlaneId::face(piece.face) {
        return Side::Coplanar;
    }
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut see = |position| {
        // Not `min` and `max`, which take more instructions because of NaN.
        let s = splitter.distance(position);
        low = if s < low { s } else { low };
        high = if s > high { s } else { high };
    };
    match piece.cut {
        None => faces.corners(piece.face).iter().for_each(|&corner| see(corner)),
        Some(vertices) => vertices.iter().for_each(|vertex| see(vertex.position)),
    }
    // Certainly off the plane, and certainly further than the tolerance from it.
    let (near, far) = (splitter.bound, splitter.band + splitter.bound);
    // The tolerance applies to the corners of the whole face. So a whole face may reach behind by
    // the tolerance and still be in front. For a piece, its face's corners would have to be tested:
    // `classify_exactly` does.
    let allowed = if piece.cut.is_none() { near - splitter.band } else { near };
    if high > far && low >= allowed {
        Side::Front
    } else if low < -far && high <= -allowed {
        Side::Back
    } else if high > far && low < -far {
        Side::Spanning
    } else if piece.cut.is_none() && high.max(-low) <= splitter.band - near {
        Side::Coplanar
    } else {
        classify_exactly(faces, splitter, piece)
    }
}

/// The rules of [`Exact`](super::Exact), with every comparison certified.
#[cold]
fn classify_exactly(
    faces: &Faces,
    splitter: &ExactSplitter,
    piece: Piece<'_, ExactVertex>,
) -> Side {
    let face = piece.face;
    let corners = faces.corners(face);
    let corner = |k: usize, threshold| {
        compare(faces, splitter, face, Symbol::corner(k as u32), corners[k], threshold)
    };
    // The third corner of a segment is no part of it.
    let count = faces.reach(face);
    let band = splitter.band;
    // First the whole face decides, so that all of its pieces are treated alike: pieces that are
    // tested one by one would be coplanar here and spanning there.
    let in_front = (0..count).any(|k| corner(k, band).is_gt());
    let behind = (0..count).any(|k| corner(k, -band).is_lt());
    match (in_front, behind) {
        (false, false) => return Side::Coplanar,
        (true, false) => return Side::Front,
        (false, true) => return Side::Back,
        (true, true) => {}
    }
    let Some(vertices) = piece.cut else { return Side::Spanning };
    // The face spans the plane by more than the tolerance, so its pieces are decided exactly.
    let (mut in_front, mut behind) = (false, false);
    for vertex in vertices {
        match compare(faces, splitter, face, vertex.symbol, vertex.position, 0.0) {
            Ordering::Greater => in_front = true,
            Ordering::Less => behind = true,
            Ordering::Equal => {}
        }
    }
    match (in_front, behind) {
        (true, true) => Side::Spanning,
        (true, false) => Side::Front,
        (false, true) => Side::Back,
        // Not reached: a convex piece with an area lies in the plane only if its face does.
        (false, false) => Side::Coplanar,
    }
}
