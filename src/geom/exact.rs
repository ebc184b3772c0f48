//! Exact predicates: where a vertex of a piece lies against a plane, decided in integers.
//!
//! Lattice coordinates are below 2⁵¹ in magnitude, so the components of a face's normal are below
//! 2¹⁰⁵, and its plane at a lattice point is a determinant of differences, below 2¹⁵⁹ (160 bits
//! with the sign). A vertex is a combination of one, two or three lattice points of its face:
//!
//! | vertex | weights over | weights are | plane at the vertex, times the sum of weights |
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

use super::faces::Faces;
use super::label::{PlaneId, PlaneKind, Symbol, SymbolKind};
use super::{Eye, Int};

/// The integer vector product (q − p) × (r − p) of three lattice points.
pub(super) fn cross(p: [f64; 3], q: [f64; 3], r: [f64; 3]) -> [i128; 3] {
    let u: [i128; 3] = std::array::from_fn(|i| i128::from((q[i] - p[i]) as i64));
    let w: [i128; 3] = std::array::from_fn(|i| i128::from((r[i] - p[i]) as i64));
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        u[j] * w[k] - u[k] * w[j]
    })
}

/// A plane in integers: a normal and a lattice point on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    normal: [i128; 3],
    point: [i64; 3],
}

impl Plane {
    /// The plane through three lattice points; its front is the side from which they run
    /// counter-clockwise.
    pub(crate) fn through([p, q, r]: [[f64; 3]; 3]) -> Self {
        Self { normal: cross(p, q, r), point: p.map(|c| c as i64) }
    }

    /// The plane through two lattice points and along an axis.
    pub(crate) fn upright(p: [f64; 3], q: [f64; 3], axis: usize) -> Self {
        let mut normal = [0; 3];
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        normal[j] = i128::from((q[k] - p[k]) as i64);
        normal[k] = -i128::from((q[j] - p[j]) as i64);
        Self { normal, point: p.map(|c| c as i64) }
    }

    fn axis(axis: usize, point: [f64; 3]) -> Self {
        let mut normal = [0; 3];
        normal[axis] = 1;
        Self { normal, point: point.map(|c| c as i64) }
    }

    /// The normal, each component rounded.
    pub(crate) fn normal_f64(&self) -> DVec3 {
        DVec3::from_array(self.normal.map(|c| c as f64))
    }

    /// The scalar product of the normal and a point of the plane, rounded.
    pub(crate) fn offset_f64(&self) -> f64 {
        self.along(self.point).to_f64()
    }

    /// The normal.
    #[cfg(feature = "triangulate")]
    pub(crate) fn normal(&self) -> [i128; 3] {
        self.normal
    }

    /// The axis along which the normal is longest, the first of several: the one in which the
    /// plane is least steep.
    pub(crate) fn main_axis(&self) -> usize {
        let size = |axis: usize| self.normal[axis].unsigned_abs();
        (1..3).fold(0, |best, axis| if size(axis) > size(best) { axis } else { best })
    }

    /// The signed distance of a lattice point times the length of the normal.
    #[inline]
    pub(crate) fn at(&self, x: &[f64; 3]) -> Int<3> {
        self.along(std::array::from_fn(|i| x[i] as i64 - self.point[i]))
    }

    /// The scalar product of the normal and a direction of components below 2⁶³.
    #[inline]
    pub(crate) fn along(&self, direction: [i64; 3]) -> Int<3> {
        let term =
            |i: usize| Int::<2>::from(self.normal[i]).times::<1, 3>(&Int::<1>::from(direction[i]));
        term(0) + term(1) + term(2)
    }

    /// Where an eye lies against the plane perpendicular to an axis through a lattice point: as
    /// [`at_eye`](Self::at_eye), without products.
    pub(crate) fn axis_at_eye(axis: usize, point: [f64; 3], eye: &Eye) -> Ordering {
        let (e, p) = (i128::from(eye.integer()[axis]), i128::from(point[axis] as i64));
        match eye.shift() {
            // A whole number that is not zero is then further out than any lattice point.
            Some(shift) if e == 0 || shift <= 52 => (e << shift.min(52)).cmp(&p),
            None if e == 0 => 0.cmp(&p),
            _ => e.cmp(&0),
        }
    }

    /// The plane at an eye, times a positive number where the eye is infinitely far.
    pub(crate) fn at_eye(&self, eye: &Eye) -> Ordering {
        let p = self.point;
        match eye.shift() {
            // Near: e − p is itself a lattice difference.
            Some(0) => {
                let e = eye.integer();
                let side = self.along(e) - self.along(p);
                side.sign()
            }
            Some(shift) => {
                let far = self.along(eye.integer()).shifted::<9>(shift);
                (far - self.along(p).resize()).sign()
            }
            None => {
                let side = self.along(eye.integer()).sign();
                if side.is_ne() { side } else { self.along(p).sign().reverse() }
            }
        }
    }
}

/// A vertex as a combination of lattice points: weights and their sum, not zero, of either sign.
pub(super) enum Weights {
    Corner([f64; 3]),
    Edge([[f64; 3]; 2], [Int<3>; 2]),
    Inside([[f64; 3]; 3], [Int<5>; 3]),
}

impl Faces {
    /// Moves the corners of the last face along `axis` to the lattice points nearest to its plane.
    pub(super) fn flatten_last(&mut self, axis: usize) {
        let face = self.faces.len() as u32 - 1;
        for (k, corner) in self.corner_range(face).enumerate() {
            if let Weights::Inside(points, weights) = self.weights(face, Symbol::corner(k as u32)) {
                self.corners[corner][axis] = ratio(&points, &weights)[axis].round();
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

    /// How `threshold` (an integer, at most 2⁵¹ times the length of the plane's normal) compares
    /// with the plane at a vertex: exact.
    pub(crate) fn compare(
        &self,
        plane: &Plane,
        face: u32,
        vertex: Symbol,
        threshold: f64,
    ) -> Ordering {
        let threshold: Int<3> = if threshold == 0.0 { Int::ZERO } else { Int::from_f64(threshold) };
        let value = |x: &[f64; 3]| plane.at(x) - threshold;
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

    /// The position of a vertex in lattice units: each coordinate within three roundings of the
    /// exact one, and exactly on the axis-aligned planes among those that define it. The same
    /// for every piece, of any face, that defines the vertex by the same points and planes.
    pub(crate) fn position(&self, face: u32, vertex: Symbol) -> [f64; 3] {
        if let SymbolKind::Corner(k) = vertex.kind() {
            return self.corners(face)[k as usize];
        }
        let mut position = match self.weights(face, vertex) {
            Weights::Corner(point) => point,
            Weights::Edge(points, weights) => ratio(&points, &weights.map(|w| w.resize())),
            Weights::Inside(points, weights) => ratio(&points, &weights),
        };
        let mut pin = |plane: PlaneId| {
            if let PlaneKind::Axis(axis, corner) = plane.kind() {
                position[axis] = self.corner(corner)[axis];
            }
        };
        match vertex.kind() {
            SymbolKind::Corner(_) => {}
            SymbolKind::OnEdge(_, plane) => pin(plane),
            SymbolKind::Inside(g, h) => {
                pin(g);
                pin(h);
            }
        }
        position
    }

    /// The weights of a vertex over its face's corners, as pairs of a corner's number within the
    /// face and its weight; they sum to 1.
    pub(crate) fn barycentric(&self, face: u32, vertex: Symbol) -> SmallVec<[(u32, f64); 3]> {
        let len = self.corners(face).len() as u32;
        let edge = |k: u32| [k, (k + 1) % len];
        match (vertex.kind(), self.weights(face, vertex)) {
            (SymbolKind::Corner(k), _) => SmallVec::from_slice(&[(k, 1.0)]),
            (SymbolKind::OnEdge(k, _), Weights::Edge(_, weights)) => shares(edge(k), weights),
            (SymbolKind::OnEdge(k, _), _) => {
                // On the edge of a face that is planar only by definition.
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

    pub(super) fn weights(&self, face: u32, vertex: Symbol) -> Weights {
        let record = &self.faces[face as usize];
        let corners = self.corners(face);
        let triangle = record.frame.triangle().map(|k| corners[k as usize]);
        let edge = |k: u32| {
            let k = k as usize;
            [corners[k], corners[if k + 1 == corners.len() { 0 } else { k + 1 }]]
        };
        // Corners that lie on the plane as they are need no moving, and edges between them give
        // the same bits as the edges of neighbours that have moved no corner.
        let stays = |k: u32| {
            let corner = &corners[if k as usize == corners.len() { 0 } else { k as usize }];
            triangle.contains(corner) || Plane::through(triangle).at(corner).sign().is_eq()
        };
        match (vertex.kind(), record.frame.drop_axis()) {
            (SymbolKind::Corner(k), Some(axis)) if !stays(k) => {
                let point = corners[k as usize];
                let area = |p, q| Int::from(cross(point, p, q)[axis]);
                let [a, b, c] = triangle;
                Weights::Inside(triangle, [area(b, c), area(c, a), area(a, b)])
            }
            (SymbolKind::Corner(k), _) => Weights::Corner(corners[k as usize]),
            (SymbolKind::OnEdge(k, plane), Some(axis)) if !(stays(k) && stays(k + 1)) => {
                let [a, b] = edge(k);
                meeting(triangle, &Plane::upright(a, b, axis), &self.plane(plane))
            }
            (SymbolKind::OnEdge(k, plane), _) => {
                let plane = self.plane(plane);
                let [a, b] = edge(k);
                Weights::Edge([a, b], [-plane.at(&b), plane.at(&a)])
            }
            (SymbolKind::Inside(g, h), _) => meeting(triangle, &self.plane(g), &self.plane(h)),
        }
    }
}

/// The point of the plane of a triangle where two other planes meet it.
fn meeting(triangle: [[f64; 3]; 3], g: &Plane, h: &Plane) -> Weights {
    let (g, h) = (triangle.map(|x| g.at(&x)), triangle.map(|x| h.at(&x)));
    let weights = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        g[j].times::<3, 5>(&h[k]) - g[k].times::<3, 5>(&h[j])
    });
    Weights::Inside(triangle, weights)
}

/// The weighted mean of lattice points, rounded.
fn ratio<const K: usize>(points: &[[f64; 3]; K], weights: &[Int<5>; K]) -> [f64; 3] {
    let total = weights.iter().fold(Int::<5>::ZERO, |sum, &w| sum + w).to_f64();
    std::array::from_fn(|axis| {
        let terms = points.iter().zip(weights);
        let sum = terms.fold(Int::<6>::ZERO, |sum, (point, weight)| {
            sum + weight.times::<1, 6>(&Int::from(point[axis] as i64))
        });
        sum.to_f64() / total
    })
}

/// Each corner's share of the sum of weights.
fn shares<const K: usize, const N: usize>(
    corners: [u32; K],
    weights: [Int<N>; K],
) -> SmallVec<[(u32, f64); 3]> {
    let total = weights.iter().fold(Int::<N>::ZERO, |sum, &w| sum + w).to_f64();
    corners.into_iter().zip(weights).map(|(k, weight)| (k, weight.to_f64() / total)).collect()
}

/// The sign of a quotient.
#[inline]
pub(crate) fn relative_to(numerator: Ordering, denominator: Ordering) -> Ordering {
    if denominator.is_lt() { numerator.reverse() } else { numerator }
}
