//! Vertices of fragments, nearly: for boxes around them, which may be a little larger than they need be.

#[cfg(test)]
mod tests;

use smallvec::SmallVec;

use super::frame::Frame;
use crate::exact::{Faces, PlaneId, PlaneKind, Symbol, SymbolKind};
use crate::raster::normal_of;
use crate::tree::Fragment;

/// Vertices are at most so far off along each axis, in lattice units: 2⁻³³ of the lattice. Smaller: more are
/// computed by integers; larger: boxes are larger than they need be.
pub(super) const NEAR_VERTEX: f64 = (1u64 << 20) as f64;
/// What is rounded at the end, and the error of vertices from integers.
const ROUNDING: f64 = 8.0;

impl Frame<'_> {
    /// The vertices of a fragment, each to within [`NEAR_VERTEX`]: by floats where they can tell, else by integers.
    pub(super) fn near_vertices(&self, fragment: &Fragment<'_>) -> SmallVec<[[f64; 3]; 8]> {
        let (faces, face) = (self.faces, fragment.face());
        let near: Option<_> =
            fragment.symbols().map(|symbol| near_vertex(faces, face, symbol)).collect();
        near.unwrap_or_else(|| fragment.lattice_vertices().collect())
    }
}

/// A vertex of a face to within [`NEAR_VERTEX`]; `None` if floats cannot tell.
fn near_vertex(faces: &Faces, face: u32, vertex: Symbol) -> Option<[f64; 3]> {
    match vertex.kind() {
        SymbolKind::Corner(k) => Some(faces.corners(face)[k as usize]),
        // Edges of faces of which corners were moved are not straight through these.
        SymbolKind::OnEdge(..) if faces.upright_axis(face).is_some() => None,
        SymbolKind::OnEdge(k, plane) => on_edge(faces, faces.ends(face, k), plane),
        SymbolKind::Inside(g, h) => meeting(faces, faces.triangle(face), [g, h]),
    }
}

/// Where a plane meets the edge between two points.
fn on_edge(faces: &Faces, [a, b]: [[f64; 3]; 2], plane: PlaneId) -> Option<[f64; 3]> {
    let ([at_a, at_b], off) = values(faces, plane, [a, b]);
    let fall = at_a - at_b;
    // The fall is off by both values, and by a rounding of its own.
    let least = fall.abs() * (1.0 - f64::EPSILON) - 2.0 * off;
    if least.is_nan() || least <= 0.0 {
        return None;
    }
    let share = at_a / fall;
    let arm = difference(b, a);
    // Where s is the exact share, this one is wrong by off · (|s| + |1 − s|) / least at most, and by the roundings:
    // between the ends, where vertices are, by off / least. A forged tree may have others.
    let spread = (off + 2.0 * off * share.abs()) / least + 4.0 * f64::EPSILON * share.abs();
    near(a, arm.map(|c| share * c), arm.map(|c| spread * c.abs()))
}

/// Where two planes meet that of a triangle. The weights of its corners there are the vector product of the
/// values of the one plane at the three corners and those of the other.
fn meeting(faces: &Faces, triangle: [[f64; 3]; 3], planes: [PlaneId; 2]) -> Option<[f64; 3]> {
    let [(g, g_off), (h, h_off)] = planes.map(|plane| values(faces, plane, triangle));
    let [g_most, h_most] = [g, h].map(|v| v.iter().fold(0.0f64, |most, c| most.max(c.abs())));
    let weights: [f64; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        g[j] * h[k] - g[k] * h[j]
    });
    let total = weights[0] + weights[1] + weights[2];
    // A weight g h − g′ h′ is off by 2 (|g| δh + |h| δg + δg δh), and by the roundings of the two products, of their
    // difference and, in part, of the sum.
    let off = 2.0 * (g_most * h_off + h_most * g_off + g_off * h_off)
        + 16.0 * f64::EPSILON * g_most * h_most;
    let least = total.abs() - 3.0 * off;
    if least.is_nan() || least <= 0.0 {
        return None;
    }
    let arms = [difference(triangle[1], triangle[0]), difference(triangle[2], triangle[0])];
    let from = std::array::from_fn(|i| (weights[1] * arms[0][i] + weights[2] * arms[1][i]) / total);
    let spread = std::array::from_fn(|i| {
        let sizes = arms.map(|arm: [f64; 3]| arm[i].abs());
        let terms = weights[1].abs() * sizes[0] + weights[2].abs() * sizes[1];
        let from: [f64; 3] = from;
        (off * (sizes[0] + sizes[1] + 3.0 * from[i].abs()) + 2.0 * f64::EPSILON * terms) / least
    });
    near(triangle[0], from, spread)
}

/// `point` + `from`, where `from` is off by up to `spread`, if that is near enough.
fn near(point: [f64; 3], from: [f64; 3], spread: [f64; 3]) -> Option<[f64; 3]> {
    let is_near = spread.iter().all(|off| *off <= NEAR_VERTEX - ROUNDING);
    is_near.then(|| std::array::from_fn(|i| point[i] + from[i]))
}

/// The values of a plane at points, and a bound on what each is off by.
///
/// Differences of lattice points are exact. The normal is off by 2.01 roundings of its size, each product by one,
/// and the sum by two.
fn values<const K: usize>(faces: &Faces, plane: PlaneId, points: [[f64; 3]; K]) -> ([f64; K], f64) {
    match plane.kind() {
        PlaneKind::Axis(axis, corner) => {
            let at = faces.corner(corner)[axis];
            (points.map(|point| point[axis] - at), 0.0)
        }
        PlaneKind::Face(face) => {
            let triangle = faces.triangle(face);
            let (normal, size) = normal_of(triangle);
            let arms = points.map(|point| difference(point, triangle[0]));
            let sizes = arms.map(|arm| sum(size, arm.map(f64::abs)));
            let most = sizes.iter().fold(0.0f64, |most, size| most.max(*size));
            (arms.map(|arm| sum(normal, arm)), 8.0 * f64::EPSILON * most)
        }
    }
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn sum(factors: [f64; 3], numbers: [f64; 3]) -> f64 {
    factors[0] * numbers[0] + factors[1] * numbers[1] + factors[2] * numbers[2]
}
