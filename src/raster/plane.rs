//! Planes as the rays see them.
//!
//! The ray of pixel (x, y) meets a plane with normal n through p where κ and φ say: of a
//! perspective, κ = n·(eye − p) is one number, and φ(x, y) = n·direction(x, y) is linear in the
//! pixel; of a parallel projection κ = n·direction, and φ(x, y) = n·(point(x, y) − p). The ray
//! from its start takes −κ/φ, or −φ/κ, of its direction to get there. Either way the ray is
//! within the plane, or never meets it, where the divisor is 0; and the point where it meets a
//! plane f lies in front of another plane h where sgn κ_f · (κ_f φ_h − κ_h φ_f) is positive, given
//! that f is met at all, and ahead of the eye.

use std::cmp::Ordering;

use super::rays::{Given, Pencil, Rays, float};
use crate::geom::{Faces, Int, Plane, PlaneId, PlaneKind};

/// Half an ulp of 1: the largest relative error of one rounding.
pub(super) const ROUNDING: f64 = f64::EPSILON / 2.0;

/// κ and φ of a plane, rounded; φ(x, y) = φ₀ + x·φ₁ + y·φ₂.
///
/// With π the plane's component sizes (see [`normal_of`]), an error of at most 8 roundings of
/// `kappa_size` = Σ π|eye − p| in κ, and of 12 roundings of `phi_size`, the same sum with the
/// largest terms that occur in φ, in a value of φ, its evaluation included.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet {
    pub(super) kappa: f64,
    pub(super) phi: [f64; 3],
    pub(super) kappa_size: f64,
    pub(super) phi_size: f64,
}

impl Sheet {
    /// A plane of the scene.
    pub(super) fn new(rays: &Rays, faces: &Faces, plane: PlaneId) -> Self {
        match plane.kind() {
            PlaneKind::Face(face) => {
                let triangle = faces.reference_triangle(face).map(|c| faces.corner(c));
                let (normal, size) = normal_of(triangle);
                Self::with(rays, normal, size, triangle[0])
            }
            PlaneKind::Axis(axis, corner) => {
                let mut normal = [0.0; 3];
                normal[axis] = 1.0;
                Self::with(rays, normal, normal, faces.corner(corner))
            }
        }
    }

    /// The plane through two lattice points and along an axis, as [`Plane::upright`] has it.
    pub(super) fn upright(rays: &Rays, a: [f64; 3], b: [f64; 3], axis: usize) -> Self {
        let (mut normal, (j, k)) = ([0.0; 3], ((axis + 1) % 3, (axis + 2) % 3));
        normal[j] = b[k] - a[k];
        normal[k] = a[j] - b[j];
        Self::with(rays, normal, normal.map(f64::abs), a)
    }

    fn with(rays: &Rays, normal: [f64; 3], size: [f64; 3], point: [f64; 3]) -> Self {
        let sum = |m: [f64; 3], v: [f64; 3]| m[0] * v[0] + m[1] * v[1] + m[2] * v[2];
        let (right, down) = (float(rays.right).to_array(), float(rays.down).to_array());
        let from = rays.origin_from(point);
        let [width, height] = rays.size.map(f64::from);
        let reach = |start: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|i| {
                start[i].abs() + width * right[i].abs() + height * down[i].abs()
            })
        };
        // One of the two that φ₀ and κ are scalar products with is the eye's or first point's.
        let (first, common) = match rays.pencil {
            Pencil::From { .. } => (float(rays.base).to_array(), from),
            Pencil::Along { direction } => (from, float(direction).to_array()),
        };
        Self {
            kappa: sum(normal, common),
            phi: [sum(normal, first), sum(normal, right), sum(normal, down)],
            kappa_size: sum(size, common.map(f64::abs)),
            phi_size: sum(size, reach(first)),
        }
    }

    /// The sign of κ, if the rounded one is certain.
    pub(super) fn certain_side(&self) -> Option<Ordering> {
        let bound = 9.0 * ROUNDING * self.kappa_size;
        if self.kappa > bound {
            Some(Ordering::Greater)
        } else if self.kappa < -bound {
            Some(Ordering::Less)
        } else {
            None
        }
    }
}

/// The normal of a triangle of lattice points, and its components' sizes |u_j w_k| + |u_k w_j|:
/// each component is off by at most 2.01 roundings of its size.
pub(super) fn normal_of([p, q, r]: [[f64; 3]; 3]) -> ([f64; 3], [f64; 3]) {
    let (mut normal, mut size) = ([0.0; 3], [0.0; 3]);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let a = (q[j] - p[j]) * (r[k] - p[k]);
        let b = (q[k] - p[k]) * (r[j] - p[j]);
        normal[i] = a - b;
        size[i] = a.abs() + b.abs();
    }
    (normal, size)
}

/// κ: 105 bits of a normal by 82 of an eye, or 53 of a direction, and three terms: 189 bits.
pub(super) fn kappa(rays: &Rays, plane: &Plane) -> Int<3> {
    match rays.pencil {
        // A plane at the origin is −n·p.
        Pencil::From { eye, shift } => plane.along(eye).shifted(shift) + plane.at(&[0.0; 3]),
        Pencil::Along { direction } => plane.along(direction),
    }
}

/// φ at what a ray is given by: 105 bits by 61, and three terms and a difference: 169 bits of a
/// point, 158 of a direction of 51.
pub(super) fn phi(plane: &Plane, given: Given) -> Int<3> {
    match given {
        Given::Step(v) => plane.along(v),
        Given::Point(v) => plane.along(v) + plane.at(&[0.0; 3]),
    }
}

/// κ_f φ_h − κ_h φ_f at what a ray is given by: 189 bits by 158 of a perspective, 160 by 169 of a
/// parallel projection, and a difference: 348 bits.
pub(super) fn determinant(rays: &Rays, f: &Plane, h: &Plane, given: Given) -> Int<6> {
    kappa(rays, f).times::<3, 6>(&phi(h, given)) - kappa(rays, h).times::<3, 6>(&phi(f, given))
}
