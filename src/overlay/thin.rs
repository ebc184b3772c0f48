//! Planes between lines and points that meet in one cell.

use std::collections::HashMap;

use smallvec::SmallVec;

use crate::build::piece::Piece;
use crate::error::Error;
use crate::exact::faces::Thin;
use crate::exact::{Faces, PlaneId, PreparedPlane, Side, Vertex, VertexKind};
use crate::progress::Watch;

/// The number of pieces on which a plane is tried. The pieces are spread evenly over the set. Too small:
/// worse planes for large sets. Too large: more time.
const SAMPLE: usize = 64;
/// The number of segments whose planes are tried. Too small: more cuts in a tangle of crossing lines. Too
/// large: more time.
const OWN: usize = 6;
/// A cut costs as much as this many additional pieces on one side. Too small: more pieces. Too large: trees
/// degenerate to lists, which take quadratic time.
const CUT: usize = 4;

type Sample<'a> = SmallVec<[&'a Piece; SAMPLE]>;

/// Chooses the plane that divides a non-empty set of lines and points. Each side has fewer pieces than the
/// set.
pub(super) fn between(
    faces: &Faces,
    anchors: &Anchors,
    pieces: &[Piece],
    arena: &[Vertex],
) -> PlaneId {
    let sample: Sample<'_> = spread(pieces, SAMPLE).collect();
    let first = own_plane(faces, sample[0].face);
    let own = spread(pieces, OWN).skip(1).map(|piece| own_plane(faces, piece.face));
    let own = medians(faces, &sample, arena).chain(own);
    let plain = cheapest(faces, &sample, arena, [first].into_iter().chain(own));
    // The whole sample lies in one plane.
    if let Some((0, plane)) = plain {
        return plane;
    }
    let anchored = anchored(anchors, pieces, arena).map(PlaneId::face);
    let best = cheapest(faces, &sample, arena, anchored).or(plain);
    best.map_or(first, |(_, plane)| plane)
}

/// The cheapest of some planes, with its cost.
fn cheapest(
    faces: &Faces,
    sample: &Sample<'_>,
    arena: &[Vertex],
    planes: impl Iterator<Item = PlaneId>,
) -> Option<(usize, PlaneId)> {
    let mut best: Option<(usize, PlaneId)> = None;
    for plane in planes {
        let cost = cost(faces, sample, arena, plane).unwrap_or(usize::MAX);
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, plane));
        }
        // Cheap enough: each side has few pieces of the sample.
        if cost <= sample.len() / 2 {
            break;
        }
    }
    best
}

/// At most `most` pieces of a set, spread evenly.
fn spread(pieces: &[Piece], most: usize) -> impl Iterator<Item = &Piece> {
    let count = pieces.len().min(most);
    (0..count).map(move |i| &pieces[i * pieces.len() / count])
}

/// Some segments that end at points of the set, if any.
fn anchored(anchors: &Anchors, pieces: &[Piece], arena: &[Vertex]) -> impl Iterator<Item = u32> {
    let points = anchors.points(pieces);
    let parts = points.chunks(points.len().div_ceil(OWN).max(1));
    parts
        .filter_map(move |part| part.iter().find_map(|point| anchors.segment(point, pieces, arena)))
}

/// A plane that a segment or a point lies in.
fn own_plane(faces: &Faces, face: u32) -> PlaneId {
    if faces.reach(face) > 1 {
        PlaneId::face(face)
    } else {
        PlaneId::axis(2, faces.corner_range(face).start as u32)
    }
}

/// The planes perpendicular to the axes through the median of the corners in the cell.
fn medians<'a>(
    faces: &'a Faces,
    sample: &Sample<'_>,
    arena: &'a [Vertex],
) -> impl Iterator<Item = PlaneId> + 'a {
    let mut corners: SmallVec<[u32; 2 * SAMPLE]> = SmallVec::new();
    for piece in sample {
        let start = faces.corner_range(piece.face).start as u32;
        for vertex in piece.cut_vertices(arena).unwrap_or_default() {
            if let VertexKind::Corner(k) = vertex.vertex_id().kind() {
                corners.push(start + k);
            }
        }
    }
    let axes = if corners.is_empty() { 0..0 } else { 0..3 };
    axes.map(move |axis| {
        let middle = corners.len() / 2;
        let at = |corner: &u32| faces.corner(*corner)[axis];
        corners.select_nth_unstable_by(middle, |a, b| at(a).total_cmp(&at(b)));
        PlaneId::axis(axis, corners[middle])
    })
}

/// The cost of dividing a set by a plane; `None` if one side keeps all pieces.
fn cost(faces: &Faces, sample: &Sample<'_>, arena: &[Vertex], plane: PlaneId) -> Option<usize> {
    let prepared = PreparedPlane::new(faces, plane);
    let (mut front, mut back, mut cuts) = (0, 0, 0);
    for piece in sample {
        match piece.side(faces, &prepared, arena) {
            Side::Front => front += 1,
            Side::Back => back += 1,
            Side::Spanning => cuts += 1,
            Side::Coplanar => {}
        }
    }
    let divides = front.max(back) + cuts < sample.len();
    divides.then_some(front.max(back) + CUT * cuts)
}

/// For each point, a segment that ends or begins at the point, if any.
///
/// A mark on a curve is to be painted over the curve. If a plane separated the two segments that meet at the
/// mark, one segment would be painted after the mark. The plane of the segment that ends at the mark also
/// contains the next segment (see `third_corner`) and the point.
#[derive(Debug, Default)]
pub(super) struct Anchors {
    /// The first point's face.
    first: u32,
    /// A segment for each point. The key is the bits of the point's coordinates. (The lattice has no −0.)
    segments: HashMap<[u64; 3], Option<u32>>,
}

impl Anchors {
    /// Finds the segments of all points.
    pub(super) fn fill(&mut self, faces: &Faces, watch: &Watch<'_>) -> Result<(), Error> {
        let Thin { segments, points, .. } = faces.thin;
        self.first = (faces.len() - points) as u32;
        self.segments.clear();
        if points == 0 {
            return Ok(());
        }
        let place = |face: u32, end: usize| faces.corners(face)[end].map(f64::to_bits);
        self.segments.extend((self.first..faces.len() as u32).map(|point| (place(point, 0), None)));
        // Beginnings first, so that a segment that ends at a point is preferred.
        for end in [0, 1] {
            for face in self.first - segments as u32..self.first {
                watch.work(1)?;
                if let Some(segment) = self.segments.get_mut(&place(face, end)) {
                    *segment = Some(face);
                }
            }
        }
        Ok(())
    }

    /// The points of a set of pieces; the set is in the order of faces.
    fn points<'p>(&self, pieces: &'p [Piece]) -> &'p [Piece] {
        &pieces[pieces.partition_point(|piece| piece.face < self.first)..]
    }

    /// The segment of a point, if the segment's piece that ends at the point is in the same set.
    fn segment(&self, point: &Piece, pieces: &[Piece], arena: &[Vertex]) -> Option<u32> {
        let face = (*self.segments.get(&point.min.map(f64::to_bits))?)?;
        let start = pieces.partition_point(|piece| piece.face < face);
        let mut parts = pieces[start..].iter().take_while(|piece| piece.face == face);
        let ends = |piece: &Piece| piece.cut_vertices(arena).unwrap_or_default();
        let touches = |piece: &Piece| ends(piece).iter().any(|end| end.position() == point.min);
        parts.any(touches).then_some(face)
    }
}
