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
use super::edge::{ExactEdge, Flattener, Moved, Off};
use super::faces::Faces;
use super::names::{PlaneId, PlaneKind, VertexId, VertexKind};
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
        vertex: VertexId,
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
    pub(super) fn edge_ends(&self, face: u32, vertex: VertexId) -> Option<[[f64; 3]; 2]> {
        let VertexKind::OnEdge(k, _) = vertex.kind() else { return None };
        if self.upright_axis(face).is_some() {
            return None;
        }
        let corners = self.corners(face);
        Some([corners[k as usize], corners[(k as usize + 1) % corners.len()]])
    }

    /// A vertex as a combination of corners of its face.
    pub(crate) fn weights(&self, face: u32, vertex: VertexId) -> Weights {
        match vertex.kind() {
            VertexKind::Corner(k) => {
                let corner = self.corners(face)[k as usize];
                let Some(axis) = self.axis_of_move(face, k) else {
                    return Weights::Corner(corner);
                };
                let area = |p, q| Int::from(cross(corner, p, q)[axis]);
                let [a, b, c] = self.triangle(face);
                Weights::Inside([a, b, c], [area(b, c), area(c, a), area(a, b)])
            }
            VertexKind::OnEdge(k, plane) => {
                let ExactEdge { ends: [a, b], moved } = self.edge(face, k);
                let plane = self.plane(plane);
                match moved {
                    None => Weights::Edge([a, b], [-plane.at(&b), plane.at(&a)]),
                    Some(Moved { axis, .. }) => {
                        meeting(self.triangle(face), &Plane::upright(a, b, axis), &plane)
                    }
                }
            }
            VertexKind::Inside(g, h) => {
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

impl Faces {
    /// The weights of a vertex over its face's corners: pairs of a corner's number within the face
    /// and its weight. The weights sum to 1.
    pub(crate) fn barycentric(&self, face: u32, vertex: VertexId) -> SmallVec<[(u32, f64); 3]> {
        let len = self.corners(face).len() as u32;
        let edge = |k: u32| [k, (k + 1) % len];
        if let VertexKind::Corner(k) = vertex.kind() {
            return SmallVec::from_slice(&[(k, 1.0)]);
        }
        match (vertex.kind(), self.weights(face, vertex)) {
            (VertexKind::OnEdge(k, _), Weights::Edge(_, weights)) => shares(edge(k), weights),
            (VertexKind::OnEdge(k, _), _) => {
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

/// A coordinate of a point, in lattice units. The denominator is not zero, and of either sign.
///
/// Both are sums over the weights of [`Weights`]: 374 and 320 bits at most.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fraction {
    numerator: Int<6>,
    denominator: Int<5>,
}

impl Fraction {
    /// The coordinate of a lattice point.
    pub(crate) fn whole(value: f64) -> Self {
        Self { numerator: Int::from(value as i64), denominator: Int::from(1_i64) }
    }

    fn mean<const K: usize>(coordinates: [f64; K], weights: [Int<5>; K]) -> Self {
        let denominator = weights.iter().fold(Int::ZERO, |sum, &weight| sum + weight);
        let terms = coordinates.iter().zip(weights);
        let numerator = terms.fold(Int::ZERO, |sum, (&coordinate, weight)| {
            sum + weight.times::<1, 6>(&Int::from(coordinate as i64))
        });
        Self { numerator, denominator }
    }

    /// How two coordinates compare: exact.
    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        let left = self.numerator.times::<5, 12>(&other.denominator);
        let right = other.numerator.times::<5, 12>(&self.denominator);
        let flipped = self.denominator.is_negative() != other.denominator.is_negative();
        let denominators = if flipped { Ordering::Less } else { Ordering::Greater };
        relative_to((left - right).sign(), denominators)
    }

    /// Which share of the way from one lattice coordinate to another has been gone here, rounded.
    pub(crate) fn share(&self, from: f64, to: f64) -> f64 {
        let before = self.denominator.times::<1, 6>(&Int::from(from as i64));
        (self.numerator - before).to_f64() / (self.denominator.to_f64() * (to - from))
    }
}

/// Where a plane cuts the segment between two lattice points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    ends: [[f64; 3]; 2],
    weights: [Int<5>; 2],
}

impl Cut {
    /// The coordinate along an axis.
    pub(crate) fn along(&self, axis: usize) -> Fraction {
        Fraction::mean(self.ends.map(|end| end[axis]), self.weights)
    }

    /// The place in lattice units, each coordinate within three roundings of the exact one.
    pub(crate) fn position(&self) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let Fraction { numerator, denominator } = self.along(axis);
            numerator.to_f64() / denominator.to_f64()
        })
    }
}

impl Faces {
    /// Where a plane cuts the segment between two lattice points; `None` unless they are strictly on
    /// its two sides.
    pub(crate) fn cut_of_segment(&self, ends: [[f64; 3]; 2], plane: PlaneId) -> Option<Cut> {
        let plane = self.plane(plane);
        let [a, b] = ends.map(|end| plane.at(&end));
        let crosses = a.sign() == b.sign().reverse() && a.sign().is_ne();
        crosses.then(|| Cut { ends, weights: [(-b).resize(), a.resize()] })
    }

    /// A coordinate of a vertex.
    pub(crate) fn along(&self, face: u32, vertex: VertexId, axis: usize) -> Fraction {
        match self.weights(face, vertex) {
            Weights::Corner(point) => Fraction::whole(point[axis]),
            Weights::Edge(ends, weights) => {
                Fraction::mean(ends.map(|end| end[axis]), weights.map(|weight| weight.resize()))
            }
            Weights::Inside(points, weights) => {
                Fraction::mean(points.map(|point| point[axis]), weights)
            }
        }
    }

    /// The axis in which the line where a plane cuts a face is longest.
    pub(crate) fn axis_of_cut(&self, face: u32, plane: PlaneId) -> usize {
        let own = Plane::through(self.triangle(face)).normal();
        let other = self.plane(plane).normal();
        let product = |j: usize, k: usize| Int::<2>::from(own[j]).times::<2, 4>(&other[k].into());
        let length = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            (product(j, k) - product(k, j)).to_f64().abs()
        };
        (1..3).fold(0, |best, axis| if length(axis) > length(best) { axis } else { best })
    }
}

#[cfg(test)]
mod along_tests {
    use super::*;

    #[test]
    fn fractions_compare_exactly_whatever_the_signs_of_their_denominators() {
        let fraction = |n: i64, d: i64| Fraction { numerator: n.into(), denominator: d.into() };
        let third = fraction(1, 3);
        for (other, expected) in [
            (fraction(-1, -3), Ordering::Equal),
            (fraction(333_333_333_333_333, 1_000_000_000_000_000), Ordering::Greater),
            (fraction(-333_333_333_333_334, -1_000_000_000_000_000), Ordering::Less),
            (fraction(1, -3), Ordering::Greater),
            (Fraction::whole(0.0), Ordering::Greater),
            (Fraction::whole(1.0), Ordering::Less),
        ] {
            assert_eq!(third.compare(&other), expected, "{other:?}");
            assert_eq!(other.compare(&third), expected.reverse(), "{other:?}");
        }
        assert_eq!(fraction(-7, -2).share(3.0, 5.0), 0.25);
        assert_eq!(fraction(7, 2).share(5.0, 3.0), 0.75);
    }
}
