//! The weights of a vertex over the corners of its face, rounded.

use glam::DVec3;
use smallvec::SmallVec;

use super::Int;
use super::faces::Faces;
use super::label::{Symbol, SymbolKind};
use super::vertex::Weights;

impl Faces {
    /// The weights of a vertex over its face's corners: pairs of a corner's number within the face
    /// and its weight. The weights sum to 1.
    pub(crate) fn barycentric(&self, face: u32, vertex: Symbol) -> SmallVec<[(u32, f64); 3]> {
        let len = self.corners(face).len() as u32;
        let edge = |k: u32| [k, (k + 1) % len];
        if let SymbolKind::Corner(k) = vertex.kind() {
            return SmallVec::from_slice(&[(k, 1.0)]);
        }
        match (vertex.kind(), self.weights(face, vertex)) {
            (SymbolKind::OnEdge(k, _), Weights::Edge(_, weights)) => shares(edge(k), weights),
            (SymbolKind::OnEdge(k, _), _) => {
                // The edge of a face that is planar only by definition: the exact weights are over
                // the reference triangle, so take the rounded position's share of the edge.
                let [a, b] = edge(k).map(|k| DVec3::from(self.corners(face)[k as usize]));
                let arm = b - a;
                let point = DVec3::from(self.position(face, vertex));
                let t = ((point - a).dot(arm) / arm.length_squared()).clamp(0.0, 1.0);
                let [a, b] = edge(k);
                SmallVec::from_slice(&[(a, 1.0 - t), (b, t)])
            }
            (_, Weights::Inside(_, weights)) if self.has_own_plane(face) => {
                shares(self.faces[face as usize].frame.triangle(), weights)
            }
            // The exact weights are over corners of other faces.
            _ => self.rounded_shares(face, self.position(face, vertex)),
        }
    }

    /// The weights of a point of a face's plane over the face's own corners, by its rounded position.
    fn rounded_shares(&self, face: u32, position: [f64; 3]) -> SmallVec<[(u32, f64); 3]> {
        let triangle = self.faces[face as usize].frame.triangle();
        let [a, b, c] = triangle.map(|k| DVec3::from(self.corners(face)[k as usize]));
        let normal = (b - a).cross(c - a);
        let point = DVec3::from(position);
        let area = |p: DVec3, q: DVec3| (p - point).cross(q - point).dot(normal);
        let areas = [area(b, c), area(c, a), area(a, b)];
        let total: f64 = areas.iter().sum();
        triangle.into_iter().zip(areas).map(|(k, area)| (k, area / total)).collect()
    }
}

/// Each corner's share of the sum of weights.
fn shares<const K: usize, const N: usize>(
    corners: [u32; K],
    weights: [Int<N>; K],
) -> SmallVec<[(u32, f64); 3]> {
    let total = weights.iter().fold(Int::<N>::ZERO, |sum, &w| sum + w).to_f64();
    corners.into_iter().zip(weights).map(|(k, weight)| (k, weight.to_f64() / total)).collect()
}
