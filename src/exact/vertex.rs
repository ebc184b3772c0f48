//! Vertices of pieces: on which side of a plane each lies, decided in integers.
//!
//! Lattice coordinates are below 2⁵¹ in magnitude, so the components of a face's normal are below
//! 2¹⁰⁵, and its plane at a lattice point is a determinant of differences, below 2¹⁵⁹ (160 bits
//! with the sign). A vertex is a combination of one, two or three lattice points of its face:
//!
//! | vertex | combination of | with weights | plane at the vertex, times the sum of weights |
//! |---|---|---|---|
//! | a corner | itself | 1 | 160 bits |
//! | edge `ab` cut by h | a, b | −h(b), h(a): 160 bits | h(a)·g(b) − h(b)·g(a): 320 bits |
//! | h₁ and h₂ in the face's plane | its reference triangle | h₁ × h₂ over A, B, C: 320 bits | 482 bits |
//!
//! A corner that only the tolerance puts on its face's plane is defined to lie on it, along the
//! axis `e` in which the plane is least steep. Its edges then lie in the planes through their two
//! lattice points and along `e`, which stand for h above; its own weights over A, B, C are the
//! areas of triangles seen along `e`.

use std::cmp::Ordering;

use glam::DVec3;
use smallvec::SmallVec;

use super::Int;
use super::faces::Faces;
use super::label::{PlaneId, PlaneKind, Symbol, SymbolKind};
use super::plane::{Plane, cross, relative_to};

/// A vertex as a combination of lattice points. The sum of the weights is not zero; it and the
/// weights may have either sign.
pub(crate) enum Weights {
    /// A corner.
    Corner([f64; 3]),
    /// A point between two corners.
    Edge([[f64; 3]; 2], [Int<3>; 2]),
    /// A point of the plane of three corners.
    Inside([[f64; 3]; 3], [Int<5>; 3]),
}

/// What defines a vertex.
pub(super) enum Definition {
    /// A corner.
    Corner([f64; 3]),
    /// A corner moved along an axis onto the plane of a triangle.
    Moved { corner: [f64; 3], triangle: [[f64; 3]; 3], axis: usize },
    /// Where a plane meets the line through two lattice points.
    Edge([[f64; 3]; 2], Plane),
    /// Where two planes meet that of a triangle.
    Meeting([[f64; 3]; 3], [Plane; 2]),
}

impl Faces {
    /// Moves the corners of the last face along `axis` to the lattice points nearest to its plane.
    pub(crate) fn flatten_last(&mut self, axis: usize, plane: &Plane) {
        let face = self.faces.len() as u32 - 1;
        let triangle = self.faces[face as usize].frame.triangle();
        let slope = plane.normal()[axis];
        for (k, corner) in self.corner_range(face).enumerate() {
            if triangle.contains(&(k as u32)) {
                continue;
            }
            let off = plane.at(&self.corners[corner]);
            if off.sign().is_eq() {
                continue;
            }
            // The plane is off / slope steps away. Both are rounded here, and the quotient, but it is
            // below 2⁴⁵, so the nearest integer is this or the next.
            let steps = (off.to_f64() / slope as f64).round();
            let rest = off - Int::<2>::from(slope).times::<1, 3>(&Int::from(steps as i64));
            let slope: Int<3> = slope.into();
            let (rest, up) = if rest.sign() == slope.sign() { (rest, 1.0) } else { (-rest, -1.0) };
            // Now of one sign, or no rest.
            let excess = rest + rest - slope;
            let is_next = excess.sign() == slope.sign() && rest.sign().is_ne();
            let steps = if is_next { steps + up } else { steps };
            if steps != 0.0 {
                self.moved.push((corner as u32, self.corners[corner]));
                self.corners[corner][axis] -= steps;
            }
        }
    }

    /// A partition plane in integers.
    pub(crate) fn plane(&self, plane: PlaneId) -> Plane {
        match plane.kind() {
            PlaneKind::Face(face) => {
                Plane::through(self.reference_triangle(face).map(|c| self.corner(c)))
            }
            PlaneKind::Axis(axis, corner) => Plane::axis(axis, self.corner(corner)),
        }
    }

    /// How the distance of a vertex from a plane, times the length of the plane's normal, compares
    /// with `threshold`: exact. `threshold` is an integer of at most 2⁵¹ times that length.
    pub(crate) fn compare(
        &self,
        id: PlaneId,
        plane: &Plane,
        face: u32,
        vertex: Symbol,
        threshold: f64,
    ) -> Ordering {
        if threshold == 0.0 && vertex.is_on(id) {
            return Ordering::Equal;
        }
        let threshold: Int<3> = if threshold == 0.0 { Int::ZERO } else { Int::from_f64(threshold) };
        let value = |x: &[f64; 3]| plane.at(x) - threshold;
        // The plane at the vertex is Σ wᵢ · value(pᵢ) / Σ wᵢ. There is no division: only the sign
        // of the quotient is needed, and the numerator and the denominator are exact.
        match self.weights(face, vertex) {
            Weights::Corner(point) => value(&point).sign(),
            Weights::Edge([a, b], [wa, wb]) => {
                let sum = wa.times::<3, 6>(&value(&a)) + wb.times::<3, 6>(&value(&b));
                relative_to(sum.sign(), (wa + wb).sign())
            }
            Weights::Inside(points, weights) => {
                let term = |i: usize| weights[i].times::<3, 8>(&value(&points[i]));
                let total = weights[0] + weights[1] + weights[2];
                relative_to((term(0) + term(1) + term(2)).sign(), total.sign())
            }
        }
    }

    /// The ends of the edge that a vertex was cut into, if they lie on the face's plane as they are.
    pub(super) fn edge_ends(&self, face: u32, vertex: Symbol) -> Option<[[f64; 3]; 2]> {
        let SymbolKind::OnEdge(k, _) = vertex.kind() else { return None };
        if self.upright_axis(face).is_some() {
            return None;
        }
        let corners = self.corners(face);
        Some([corners[k as usize], corners[(k as usize + 1) % corners.len()]])
    }

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

    /// A vertex as a combination of corners of its face.
    pub(crate) fn weights(&self, face: u32, vertex: Symbol) -> Weights {
        match self.definition(face, vertex, None) {
            Definition::Corner(point) => Weights::Corner(point),
            Definition::Moved { corner, triangle, axis } => {
                let area = |p, q| Int::from(cross(corner, p, q)[axis]);
                let [a, b, c] = triangle;
                Weights::Inside(triangle, [area(b, c), area(c, a), area(a, b)])
            }
            Definition::Edge([a, b], plane) => Weights::Edge([a, b], [-plane.at(&b), plane.at(&a)]),
            Definition::Meeting(triangle, [g, h]) => meeting(triangle, &g, &h),
        }
    }

    /// What defines a vertex: lattice points and planes, one of which may be at hand.
    pub(super) fn definition(
        &self,
        face: u32,
        vertex: Symbol,
        at_hand: Option<(PlaneId, Plane)>,
    ) -> Definition {
        let plane_of = |id| match at_hand {
            Some((known, plane)) if known == id => plane,
            _ => self.plane(id),
        };
        let record = &self.faces[face as usize];
        let corners = self.corners(face);
        let triangle = record.frame.triangle().map(|k| corners[k as usize]);
        let edge = |k: u32| {
            let k = k as usize;
            [corners[k], corners[if k + 1 == corners.len() { 0 } else { k + 1 }]]
        };
        // A corner that lies on the plane is not moved. An edge between two such corners must be
        // treated as an edge, not as a cut by an upright plane: the neighbour across it may have
        // moved no corner, and both must get the same bits.
        let stays = |k: u32| {
            let corner = &corners[if k as usize == corners.len() { 0 } else { k as usize }];
            triangle.contains(corner) || Plane::through(triangle).at(corner).sign().is_eq()
        };
        match (vertex.kind(), record.frame.drop_axis()) {
            (SymbolKind::Corner(k), Some(axis)) if !stays(k) => {
                Definition::Moved { corner: corners[k as usize], triangle, axis }
            }
            (SymbolKind::Corner(k), _) => Definition::Corner(corners[k as usize]),
            (SymbolKind::OnEdge(k, plane), Some(axis)) if !(stays(k) && stays(k + 1)) => {
                let [a, b] = edge(k);
                Definition::Meeting(triangle, [Plane::upright(a, b, axis), plane_of(plane)])
            }
            (SymbolKind::OnEdge(k, plane), _) => Definition::Edge(edge(k), plane_of(plane)),
            (SymbolKind::Inside(g, h), _) => {
                Definition::Meeting(triangle, [plane_of(g), plane_of(h)])
            }
        }
    }
}

/// The point where the plane of a triangle and two other planes meet.
fn meeting(triangle: [[f64; 3]; 3], g: &Plane, h: &Plane) -> Weights {
    let (g, h) = (triangle.map(|x| g.at(&x)), triangle.map(|x| h.at(&x)));
    // Barycentric weights w with Σ wᵢ gᵢ = Σ wᵢ hᵢ = 0 are perpendicular to both triples of values:
    // their vector product.
    let weights = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        g[j].times::<3, 5>(&h[k]) - g[k].times::<3, 5>(&h[j])
    });
    Weights::Inside(triangle, weights)
}

/// Each corner's share of the sum of weights.
fn shares<const K: usize, const N: usize>(
    corners: [u32; K],
    weights: [Int<N>; K],
) -> SmallVec<[(u32, f64); 3]> {
    let total = weights.iter().fold(Int::<N>::ZERO, |sum, &w| sum + w).to_f64();
    corners.into_iter().zip(weights).map(|(k, weight)| (k, weight.to_f64() / total)).collect()
}
