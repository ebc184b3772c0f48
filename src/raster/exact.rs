//! Planes in integers, evaluated at exact rays.
//!
//! Planes are computed here from the lattice points that define them, by other formulas and in
//! other integers than those that trees are built with. With coordinates below 2⁵¹, a normal has
//! 106 bits and an offset 158; φ and κ (see [`line`](super::line)) stay below 2²⁰⁷, and a
//! determinant of both below 2³⁶⁰.

use std::cmp::Ordering;

use super::digits::{self, Long, Short, dot};
use super::rays::{Given, RayOrigin, Rays};
use crate::exact::{Faces, PlaneId, PlaneKind};

/// A plane: the points x with normal · x = offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    normal: [i128; 3],
    offset: Short,
}

impl Plane {
    /// A plane of the scene.
    pub(super) fn new(faces: &Faces, plane: PlaneId) -> Self {
        match plane.kind() {
            PlaneKind::Face(face) => Self::of(faces, face),
            PlaneKind::Axis(axis, corner) => {
                let mut normal = [0; 3];
                normal[axis] = 1;
                Self::with(normal, integer(faces.corner(corner)))
            }
        }
    }

    /// The plane of a face, through its reference triangle p, q, r: as the normal the sum of
    /// p × q, q × r and r × p, which is (q − p) × (r − p).
    pub(super) fn of(faces: &Faces, face: u32) -> Self {
        let [p, q, r] = faces.reference_triangle(face).map(|corner| integer(faces.corner(corner)));
        let (pq, qr, rp) = (cross(p, q), cross(q, r), cross(r, p));
        let normal = std::array::from_fn(|i| pq[i] + qr[i] + rp[i]);
        Self { normal, offset: dot(qr, p) }
    }

    /// The plane through two lattice points and along an axis; seen against the axis, its front is
    /// on the right of the way from `a` to `b`.
    pub(super) fn upright(a: [f64; 3], b: [f64; 3], axis: usize) -> Self {
        let (a, b) = (integer(a), integer(b));
        let mut along = [0; 3];
        along[axis] = 1;
        Self::with(cross(std::array::from_fn(|i| b[i] - a[i]), along), a)
    }

    fn with(normal: [i128; 3], point: [i128; 3]) -> Self {
        Self { normal, offset: dot(normal, point) }
    }

    /// The normal, rounded.
    pub(super) fn normal(&self) -> glam::DVec3 {
        glam::DVec3::from_array(self.normal.map(|c| c as f64))
    }

    /// κ: for a perspective the plane at the eye, for parallel rays its slope along them.
    pub(super) fn kappa(&self, rays: &Rays) -> Short {
        match rays.pencil {
            RayOrigin::From { eye, shift } => {
                dot(self.normal, eye.map(|c| i128::from(c) << shift)) - self.offset
            }
            RayOrigin::Along { direction } => dot(self.normal, direction.map(i128::from)),
        }
    }

    /// φ at a ray's parameter.
    pub(super) fn phi(&self, given: Given) -> Short {
        match given {
            Given::Step(v) => dot(self.normal, v.map(i128::from)),
            Given::Point(v) => dot(self.normal, v.map(i128::from)) - self.offset,
        }
    }
}

/// κ_f φ_h − κ_h φ_f at a ray's parameter.
pub(super) fn determinant(rays: &Rays, f: &Plane, h: &Plane, given: Given) -> Long {
    PlanePair::new(rays, [*f, *h]).at(given).determinant
}

/// Two planes f and h with their κ, which are the same for all rays of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanePair {
    pub(super) planes: [Plane; 2],
    pub(super) kappas: [Short; 2],
}

/// Two planes at a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanePairAt {
    pub(super) phis: [Short; 2],
    /// κ_f φ_h − κ_h φ_f.
    pub(super) determinant: Long,
}

impl PlanePair {
    pub(super) fn new(rays: &Rays, planes: [Plane; 2]) -> Self {
        Self { planes, kappas: planes.each_ref().map(|plane| plane.kappa(rays)) }
    }

    pub(super) fn at(&self, given: Given) -> PlanePairAt {
        let phis = self.planes.each_ref().map(|plane| plane.phi(given));
        let [above, below] = [0, 1].map(|i| [&self.kappas[i], &phis[i]]);
        PlanePairAt { phis, determinant: digits::determinant([above, below]) }
    }

    /// On which side of the first plane a ray meets the second, ahead of the eye: the sign of
    /// sgn κ_h · (κ_h φ_f − κ_f φ_h).
    pub(super) fn side_of_first(&self, given: Given) -> Ordering {
        let across = self.at(given).determinant.sign();
        if self.kappas[1].sign().is_lt() { across } else { across.reverse() }
    }

    /// What lengths along rays are divided by: φ for a perspective, κ for parallel rays. Rounded.
    pub(super) fn divisors(&self, rays: &Rays, at: &PlanePairAt) -> [f64; 2] {
        let values = if rays.is_perspective() { at.phis } else { self.kappas };
        values.map(|value| value.to_f64())
    }
}

/// The volume that a ray spans with the edge from `a` to `b`: direction · (a × b − eye × (b − a)),
/// or, with m the edge × direction, (a − point) · m; 190 bits.
pub(super) fn volume(rays: &Rays, [a, b]: [[f64; 3]; 2], given: Given) -> Short {
    let (a, b) = (integer(a), integer(b));
    let arm = std::array::from_fn(|i| b[i] - a[i]);
    match (rays.pencil, given) {
        (RayOrigin::From { eye, shift }, Given::Step(v) | Given::Point(v)) => {
            let v = v.map(i128::from);
            dot(cross(a, b), v) - dot(cross(arm, v), eye.map(|c| i128::from(c) << shift))
        }
        (RayOrigin::Along { direction }, Given::Step(v)) => {
            dot(cross(direction.map(i128::from), arm), v.map(i128::from))
        }
        (RayOrigin::Along { direction }, Given::Point(v)) => {
            let to = std::array::from_fn(|i| i128::from(v[i]) - a[i]);
            dot(cross(direction.map(i128::from), arm), to)
        }
    }
}

fn integer(point: [f64; 3]) -> [i128; 3] {
    point.map(|c| c as i128)
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
