//! Cutting a piece in two.

use glam::DVec3;

use super::super::space::{CameraSpace, Vertex};
use super::compare::TOUCH;
use super::pieces::Pieces;

/// The parts of a polygon in front of a plane and behind it.
pub(super) type Halves = [Vec<Vertex>; 2];

/// Cuts a piece by the plane of another piece; `None` unless the piece reaches beyond the epsilon on both
/// sides.
pub(super) fn by_plane(pieces: &Pieces, piece: u32, by: u32, epsilon: f64) -> Option<Halves> {
    let plane = pieces.plane(by);
    cut(pieces.vertices(piece), |vertex| plane.distance(vertex.at), |_| epsilon)
}

/// Cuts a piece along an edge of another piece, as both are seen: along the first edge that cuts it.
pub(super) fn by_outline(
    space: &CameraSpace,
    pieces: &Pieces,
    piece: u32,
    by: u32,
) -> Option<Halves> {
    let outline = pieces.vertices(by);
    (0..outline.len()).find_map(|i| {
        let (a, b) = (outline[i].at, outline[if i + 1 == outline.len() { 0 } else { i + 1 }].at);
        // The plane through the edge and the eye.
        let cross = if space.perspective { a.cross(b) } else { (b - a).cross(DVec3::Z) };
        let normal = cross.try_normalize()?;
        let offset = if space.perspective { 0.0 } else { normal.dot(a) };
        let pixel = |vertex: &Vertex| {
            if space.perspective { vertex.at.z * space.pixel } else { space.pixel }
        };
        let distance = |vertex: &Vertex| normal.dot(vertex.at) - offset;
        cut(pieces.vertices(piece), distance, |vertex| TOUCH * pixel(vertex))
    })
}

/// Cuts a convex polygon where the distance changes its sign; vertices within the slack belong to both parts.
fn cut(
    polygon: &[Vertex],
    distance: impl Fn(&Vertex) -> f64,
    slack: impl Fn(&Vertex) -> f64,
) -> Option<Halves> {
    let signed = |vertex: &Vertex| {
        let d = distance(vertex);
        if d.abs() <= slack(vertex) { 0.0 } else { d }
    };
    let distances: Vec<f64> = polygon.iter().map(signed).collect();
    if !(distances.iter().any(|&d| d > 0.0) && distances.iter().any(|&d| d < 0.0)) {
        return None;
    }
    let (mut front, mut back) = (Vec::new(), Vec::new());
    for (i, here) in polygon.iter().enumerate() {
        let k = if i + 1 == polygon.len() { 0 } else { i + 1 };
        let (next, a, b) = (&polygon[k], distances[i], distances[k]);
        if a >= 0.0 {
            front.push(*here);
        }
        if a <= 0.0 {
            back.push(*here);
        }
        if a < 0.0 && b > 0.0 || a > 0.0 && b < 0.0 {
            // Computed from the front, whatever the direction of the edge: so neighbours get the same vertex.
            let vertex = if a > 0.0 {
                Vertex::between(here, next, a / (a - b))
            } else {
                Vertex::between(next, here, b / (b - a))
            };
            front.push(vertex);
            back.push(vertex);
        }
    }
    (front.len() >= 3 && back.len() >= 3).then_some([front, back])
}
