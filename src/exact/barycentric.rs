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
        match (vertex.kind(), self.weights(face, vertex)) {
            (SymbolKind::Corner(k), _) => SmallVec::from_slice(&[(k, 1.0)]),
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
            (SymbolKind::Inside(..), weights) => {
                let triangle = self.faces[face as usize].frame.triangle();
                match weights {
                    Weights::Inside(_, weights) => shares(triangle, weights),
                    _ => SmallVec::new(),
                }
            }
        }
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
