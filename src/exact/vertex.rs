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

use super::Int;
use super::edge::{ExactEdge, Moved};
use super::faces::Faces;
use super::flatten::{Flattener, Off};
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

impl Faces {
    /// Moves the corners of the last face along `axis` to the lattice points nearest to its plane.
    /// Gives how far the furthest was off it, in lattice units, rounded; 0 only if all were exactly on
    /// it.
    pub(crate) fn flatten_last(&mut self, axis: usize) -> f64 {
        let face = self.faces.len() as u32 - 1;
        let triangle = self.reference_triangle(face);
        let flattener = Flattener::new(triangle.map(|corner| self.corner(corner)), axis);
        let mut furthest = 0.0f64;
        for corner in self.corner_range(face) {
            if triangle.contains(&(corner as u32)) {
                continue;
            }
            let point = self.corners[corner];
            let Off { distance, steps } = flattener.off(&point);
            furthest = furthest.max(distance);
            if steps != 0.0 {
                self.moved.push((corner as u32, point));
                self.corners[corner][axis] -= steps;
            }
        }
        furthest
    }

    /// A partition plane in integers.
    pub(crate) fn plane(&self, plane: PlaneId) -> Plane {
        match plane.kind() {
            PlaneKind::Face(face) => Plane::through(self.triangle(face)),
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

    /// A vertex as a combination of corners of its face.
    pub(crate) fn weights(&self, face: u32, vertex: Symbol) -> Weights {
        match vertex.kind() {
            SymbolKind::Corner(k) => {
                let corner = self.corners(face)[k as usize];
                let Some(axis) = self.axis_of_move(face, k) else {
                    return Weights::Corner(corner);
                };
                let area = |p, q| Int::from(cross(corner, p, q)[axis]);
                let [a, b, c] = self.triangle(face);
                Weights::Inside([a, b, c], [area(b, c), area(c, a), area(a, b)])
            }
            SymbolKind::OnEdge(k, plane) => {
                let ExactEdge { ends: [a, b], moved } = self.edge(face, k);
                let plane = self.plane(plane);
                match moved {
                    None => Weights::Edge([a, b], [-plane.at(&b), plane.at(&a)]),
                    Some(Moved { axis, .. }) => {
                        meeting(self.triangle(face), &Plane::upright(a, b, axis), &plane)
                    }
                }
            }
            SymbolKind::Inside(g, h) => {
                meeting(self.triangle(face), &self.plane(g), &self.plane(h))
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
