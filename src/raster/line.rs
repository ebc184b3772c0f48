//! The lines that bound a piece of a face, as functions of the pixel.
//!
//! Planes are functions of the pixel, too. Two numbers determine where the ray of pixel (x, y) meets a plane
//! with normal n through p. For a perspective, κ = n·(eye − p) is constant and φ(x, y) = n·direction(x, y) is
//! linear in the pixel; for a parallel projection κ = n·direction is constant and φ(x, y) = n·(point(x, y) −
//! p) is linear. The ray meets the plane after −κ/φ of its direction (perspective) or −φ/κ (parallel). If the
//! divisor is 0, the ray is in the plane or never meets it. The point where the ray meets a plane f lies in
//! front of another plane h if sgn κ_f · (κ_f φ_h − κ_h φ_f) is positive, provided that f is met ahead of the
//! eye.

use std::cmp::Ordering;

use super::exact::{Plane, PlanePair, volume};
use super::rays::{Given, RayOrigin, Rays, float};
use crate::exact::{EdgeLine, Faces, PlaneId, PlaneKind};

/// The source of a boundary line.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// The straight edge from one lattice point to another.
    Edge([[f64; 3]; 2]),
    /// The edge of a face in which the plane through two lattice points and along an axis cuts the face's
    /// plane.
    Upright([[f64; 3]; 2], usize),
    /// A plane that cut the face.
    Cut(EdgeLine),
    /// The plane through the eye parallel to the picture. The inside is ahead of this plane.
    Ahead,
}

/// A line of a face: a rounded linear function of the pixel that is positive inside, a bound on the
/// error of its values, and the source from which the exact values are computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boundary {
    pub(super) k: [f64; 3],
    pub(super) bound: f64,
    pub(super) source: Source,
}

/// A face with the sign of its κ: positive if parallel rays come from behind the face, or an eye is in front
/// of the face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<'a> {
    pub(super) rays: &'a Rays,
    pub(super) faces: &'a Faces,
    pub(super) face: u32,
    pub(super) sheet: Sheet,
    pub(super) positive: bool,
}

impl Seen<'_> {
    /// A line of the face, prepared for evaluation.
    pub(super) fn boundary(&self, source: Source) -> Boundary {
        let (mut k, bound) = match source {
            Source::Edge(ends) => edge(self.rays, ends),
            Source::Upright([a, b], axis) => self.sheet.cut(&Sheet::upright(self.rays, a, b, axis)),
            Source::Cut(line) => match line.as_cut() {
                Some(plane) => self.sheet.cut(&Sheet::new(self.rays, self.faces, plane)),
                None => ([0.0; 3], f64::INFINITY),
            },
            Source::Ahead => self.sheet.horizon(),
        };
        if self.is_flipped(source) {
            k = k.map(|c| -c);
        }
        Boundary { k, bound, source }
    }

    /// Whether the line's function, as in [`exact`](Self::exact), is negative inside.
    fn is_flipped(&self, source: Source) -> bool {
        match source {
            // Seen from the front, counter-clockwise edges have the inside on their left: for a ray on the
            // left, the eye, the edge and the ray span a negative volume.
            Source::Edge(_) => self.positive == self.rays.is_perspective(),
            // The upright plane faces outwards if the face's normal has a positive component along the axis.
            Source::Upright(_, axis) => {
                let normal = Plane::of(self.faces, self.face).normal();
                self.positive == (normal[axis] > 0.0)
            }
            Source::Cut(line) => self.positive == line.is_behind(),
            Source::Ahead => self.positive,
        }
    }

    /// The side of a line on which the ray of a pixel passes: inside is `Greater`; exactly on the line is
    /// `Equal`.
    pub(super) fn exact(&self, source: Source, x: u32, y: u32) -> Ordering {
        self.oriented(source, self.rays.pixel(x, y))
    }

    /// The side of a line for a ray that meets the line exactly. The ray is treated as moved slightly to the
    /// right, and much less downwards, which matters only for a horizontal line.
    pub(super) fn tie(&self, source: Source) -> Ordering {
        let right = self.oriented(source, Given::Step(self.rays.right));
        if right.is_ne() { right } else { self.oriented(source, Given::Step(self.rays.down)) }
    }

    fn oriented(&self, source: Source, given: Given) -> Ordering {
        let (rays, faces) = (self.rays, self.faces);
        let own = || Plane::of(faces, self.face);
        let across = |other| PlanePair::new(rays, [own(), other]).at(given).determinant.sign();
        let sign = match source {
            Source::Edge(ends) => volume(rays, ends, given).sign(),
            Source::Upright([a, b], axis) => across(Plane::upright(a, b, axis)),
            Source::Cut(line) => {
                line.as_cut().map_or(Ordering::Equal, |cut| across(Plane::new(faces, cut)))
            }
            Source::Ahead => own().phi(given).sign(),
        };
        if self.is_flipped(source) { sign.reverse() } else { sign }
    }
}

/// The volume that a ray spans with the edge from `a` to `b`, as a rounded linear function of the pixel, and
/// a bound on the error of its values. The volume is direction · ((a − eye) × (b − a)) for a perspective, and
/// (point − a) · ((a − b) × direction) for parallel rays. Each component of the vector product is off by 4.4
/// roundings of the sum of the component's two products. The other factor of the scalar product is off by 1
/// rounding. The scalar product adds 3 roundings, and the evaluation adds 4.
pub(crate) fn edge(rays: &Rays, [a, b]: [[f64; 3]; 2]) -> ([f64; 3], f64) {
    let origin = rays.origin_from(a);
    let arm: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
    let (u, w, first) = match rays.pencil {
        // (a − eye) × arm = arm × (eye − a)
        RayOrigin::From { .. } => (arm, origin, float(rays.base).to_array()),
        // (a − b) × direction = direction × arm
        RayOrigin::Along { direction } => (float(direction).to_array(), arm, origin),
    };
    let (right, down) = (float(rays.right).to_array(), float(rays.down).to_array());
    let [width, height] = rays.size.map(f64::from);
    let (mut k, mut size) = ([0.0; 3], 0.0);
    for i in 0..3 {
        let (j, l) = ((i + 1) % 3, (i + 2) % 3);
        let (p, q) = (u[j] * w[l], u[l] * w[j]);
        let c = p - q;
        k[0] += c * first[i];
        k[1] += c * right[i];
        k[2] += c * down[i];
        let reach = first[i].abs() + width * right[i].abs() + height * down[i].abs();
        size += (p.abs() + q.abs()) * reach;
    }
    (k, 24.0 * ROUNDING * size)
}

/// Half an ulp of 1: the largest relative error of one rounding.
pub(super) const ROUNDING: f64 = f64::EPSILON / 2.0;

/// κ and φ of a plane, rounded; φ(x, y) = φ₀ + x·φ₁ + y·φ₂.
///
/// Errors, with π the sizes of the normal's components (see [`normal_of`]): κ is off by at most 8 roundings
/// of `kappa_size` = Σ π|eye − p|. A value of φ, including its evaluation, is off by at most 12 roundings of
/// `phi_size`, which is the same sum over the largest terms that occur in φ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheet {
    pub(super) kappa: f64,
    pub(super) phi: [f64; 3],
    pub(super) kappa_size: f64,
    pub(super) phi_size: f64,
}

impl Sheet {
    /// A plane of the scene.
    pub(crate) fn new(rays: &Rays, faces: &Faces, plane: PlaneId) -> Self {
        match plane.kind() {
            PlaneKind::Face(face) => {
                let triangle = faces.triangle(face);
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

    /// The plane through two lattice points and along an axis, as in
    /// [`Plane::upright`](crate::raster::exact::Plane::upright).
    pub(crate) fn upright(rays: &Rays, a: [f64; 3], b: [f64; 3], axis: usize) -> Self {
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
        // φ₀ and κ are scalar products of the normal. One of the two uses the eye, or the first
        // pixel's point, relative to the plane.
        let (first, common) = match rays.pencil {
            RayOrigin::From { .. } => (float(rays.base).to_array(), from),
            RayOrigin::Along { direction } => (from, float(direction).to_array()),
        };
        Self {
            kappa: sum(normal, common),
            phi: [sum(normal, first), sum(normal, right), sum(normal, down)],
            kappa_size: sum(size, common.map(f64::abs)),
            phi_size: sum(size, reach(first)),
        }
    }

    /// The function κ_f φ_h − κ_h φ_f, which is 0 for the rays that meet this plane, f, and another plane, h,
    /// in one point; and a bound on the error of its values.
    ///
    /// Each product is off by at most 21 roundings of the product of the sizes: 8 for κ, 7 for a coefficient
    /// of φ, 2 for the product and the difference, 4 for the evaluation.
    pub(crate) fn cut(&self, h: &Self) -> ([f64; 3], f64) {
        let k = std::array::from_fn(|i| self.kappa * h.phi[i] - h.kappa * self.phi[i]);
        let size = self.kappa_size * h.phi_size + h.kappa_size * self.phi_size;
        (k, 40.0 * ROUNDING * size)
    }

    /// The function φ, which is 0 for the rays that are parallel to the plane, and a bound on the error of
    /// its values.
    pub(crate) fn horizon(&self) -> ([f64; 3], f64) {
        (self.phi, 24.0 * ROUNDING * self.phi_size)
    }

    /// The sign of κ, if the rounded value is certain.
    pub(crate) fn certain_side(&self) -> Option<Ordering> {
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
pub(crate) fn normal_of([p, q, r]: [[f64; 3]; 3]) -> ([f64; 3], [f64; 3]) {
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
