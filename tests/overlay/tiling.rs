//! The contents of an overlay, and whether its pieces tile them.

use binspace::overlay::{Overlay, Shape};
use testkit::prelude::*;

use crate::overlay::oracle::Counts;
use crate::overlay::sight::{between, to_f64};
use testkit::model::Face;
use testkit::rational::Point;

/// The contents of an overlay, on its grid.
pub(crate) struct Given {
    /// Each segment with its line, its number in the line, and its ends.
    pub(crate) segments: Vec<(usize, usize, [Point; 2])>,
    pub(crate) points: Vec<Point>,
    pub(crate) faces: Vec<Face>,
    /// The ends of the segments, rounded.
    pub(crate) rounded: Vec<[DVec3; 2]>,
    /// The positions of the faces, rounded.
    pub(crate) corners: Vec<Vec<DVec3>>,
}

impl Given {
    pub(crate) fn new(overlay: &Overlay, lines: &[Vec<DVec3>], points: &[DVec3]) -> Self {
        let lattice = *overlay.faces().lattice();
        let snap = |point: &DVec3| rational::point(lattice.snap(*point));
        let ends = |(line, corners): (usize, &Vec<DVec3>)| {
            let pairs: Vec<[Point; 2]> =
                corners.windows(2).map(|pair| [snap(&pair[0]), snap(&pair[1])]).collect();
            pairs.into_iter().enumerate().map(move |(k, pair)| (line, k, pair))
        };
        let segments = lines.iter().enumerate().flat_map(ends).filter(|(_, _, [p, q])| p != q);
        // Segments have faces too, which are not painted.
        let segments: Vec<_> = segments.collect();
        let count = overlay.faces().len() - segments.len() - points.len();
        let faces: Vec<Face> =
            (0..count as u32).map(|face| Face::new(overlay.faces(), face)).collect();
        let corners = faces.iter().map(|face| face.corners.iter().map(to_f64).collect()).collect();
        let rounded = segments.iter().map(|(_, _, ends)| ends.each_ref().map(to_f64)).collect();
        Self { segments, points: points.iter().map(snap).collect(), faces, rounded, corners }
    }
}

/// For both ends of a piece: their shares of the segment, their positions, and whether they are cuts.
type SegmentEnds = ([f64; 2], [DVec3; 2], [bool; 2]);

/// Whether the pieces of each segment tile it, and share the bits of their ends.
pub(crate) fn tiles(
    tree: &BspTree,
    overlay: &Overlay,
    given: &Given,
    counts: &mut Counts,
) -> Result<(), String> {
    let lattice = overlay.faces().lattice();
    let mut pieces: Vec<Vec<SegmentEnds>> = vec![vec![]; given.segments.len()];
    let mut markers = vec![0; given.points.len()];
    for number in tree.len()..tree.len() + overlay.len() {
        match overlay.shape(number as u32).expect("a shape") {
            Shape::Segment(piece) => {
                let name = (piece.line(), piece.number());
                let at = given.segments.binary_search_by_key(&name, |s| (s.0, s.1));
                let at = at.map_err(|_| format!("no segment {name:?}"))?;
                pieces[at].push((piece.shares(), piece.ends(), piece.cuts()));
            }
            Shape::Marker(marker) => {
                markers[marker.point()] += 1;
                let off = rational::distance_to_rounded(
                    &given.points[marker.point()],
                    lattice.to_lattice(marker.position()),
                );
                if off > 1.0 {
                    return Err(format!("{marker:?} is {off} off"));
                }
            }
            _ => {}
        }
    }
    if markers.iter().any(|&count| count != 1) {
        return Err("a point that does not come once".into());
    }
    for (pieces, (_, _, segment)) in pieces.iter_mut().zip(&given.segments) {
        counts.pieces += pieces.len();
        // Pieces are followed from end to end. If they were sorted by their shares, pieces shorter than a
        // rounding error might be out of order.
        let mut end = (0.0, None);
        while !pieces.is_empty() {
            let joins = |piece: &SegmentEnds| {
                piece.0[0] == end.0 && end.1.is_none_or(|point| point == piece.1[0])
            };
            let is_nothing =
                |piece: &SegmentEnds| piece.0[0] == piece.0[1] && piece.1[0] == piece.1[1];
            let next = pieces.iter().position(|piece| joins(piece) && is_nothing(piece));
            let next = next.or_else(|| pieces.iter().position(joins));
            let Some(next) = next else {
                return Err(format!("pieces do not tile: {end:?}, {pieces:?}"));
            };
            let (shares, ends, cuts) = pieces.swap_remove(next);
            if cuts != [shares[0] != 0.0, shares[1] != 1.0] {
                return Err(format!("cut or not: {shares:?}, {cuts:?}"));
            }
            for (share, point) in shares.into_iter().zip(ends) {
                let exact = between(segment, &rational::exact(share));
                let off = rational::distance_to_rounded(&exact, lattice.to_lattice(point));
                if off > 8.0 {
                    return Err(format!("an end is {off} off"));
                }
            }
            end = (shares[1], Some(ends[1]));
        }
        if end.0 != 1.0 {
            return Err(format!("the end of a segment is missing: {end:?}"));
        }
    }
    counts.segments += given.segments.len();
    Ok(())
}
