//! The lines that bound a piece of a face, as the rays see them.

use std::cmp::Ordering;

use super::exact::{Plane, determinant, volume};
use super::rays::{Given, Pencil, Rays, float};
use super::sheet::{ROUNDING, Sheet};
use crate::exact::{Faces, Line};

/// Where a boundary line comes from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// The edge from one lattice point to another, straight through both.
    Edge([[f64; 3]; 2]),
    /// The edge of a face where the plane through two lattice points and along an axis meets it.
    Upright([[f64; 3]; 2], usize),
    /// A plane that cut the face.
    Cut(Line),
    /// The plane through the eye across the direction of view: inside is ahead of it.
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

/// A face with the sign of its κ: positive where parallel rays come from behind it, or an eye is in
/// front of it.
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

    /// Whether inside is where the line's function, as [`exact`](Self::exact) has it, is negative.
    fn is_flipped(&self, source: Source) -> bool {
        match source {
            // Seen from the front, counter-clockwise edges have the inside on their left: there
            // the eye, the edge and the ray span a negative volume.
            Source::Edge(_) => self.positive == self.rays.is_perspective(),
            // The upright plane faces outwards where the face's normal runs with the axis.
            Source::Upright(_, axis) => {
                let normal = Plane::of(self.faces, self.face).normal();
                self.positive == (normal[axis] > 0.0)
            }
            Source::Cut(line) => self.positive == line.is_behind(),
            Source::Ahead => self.positive,
        }
    }

    /// On which side of a line the ray of a pixel passes: inside is `Greater`; exactly on the line
    /// is `Equal`.
    pub(super) fn exact(&self, source: Source, x: u32, y: u32) -> Ordering {
        self.oriented(source, self.rays.pixel(x, y))
    }

    /// The side of a line for a ray that meets it exactly. The ray is treated as moved a little to the
    /// right, and by much less downwards, which matters if the line runs to the right.
    pub(super) fn tie(&self, source: Source) -> Ordering {
        let right = self.oriented(source, Given::Step(self.rays.right));
        if right.is_ne() { right } else { self.oriented(source, Given::Step(self.rays.down)) }
    }

    fn oriented(&self, source: Source, given: Given) -> Ordering {
        let (rays, faces) = (self.rays, self.faces);
        let own = || Plane::of(faces, self.face);
        let sign = match source {
            Source::Edge(ends) => volume(rays, ends, given).sign(),
            Source::Upright([a, b], axis) => {
                determinant(rays, &own(), &Plane::upright(a, b, axis), given).sign()
            }
            Source::Cut(line) => line.as_cut().map_or(Ordering::Equal, |cut| {
                determinant(rays, &own(), &Plane::new(faces, cut), given).sign()
            }),
            Source::Ahead => own().phi(given).sign(),
        };
        if self.is_flipped(source) { sign.reverse() } else { sign }
    }
}

/// The volume that a ray spans with the edge from `a` to `b`: direction · ((a − eye) × (b −
/// a)), or (point − a) · ((a − b) × direction). The factor's components are off by 4.4
/// roundings of the sum of their two products, the vectors that they are multiplied by 1, their scalar
/// products by 3 more, the evaluation by 4.
pub(crate) fn edge(rays: &Rays, [a, b]: [[f64; 3]; 2]) -> ([f64; 3], f64) {
    let origin = rays.origin_from(a);
    let arm: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
    let (u, w, first) = match rays.pencil {
        // (a − eye) × arm = arm × (eye − a)
        Pencil::From { .. } => (arm, origin, float(rays.base).to_array()),
        // (a − b) × direction = direction × arm
        Pencil::Along { direction } => (float(direction).to_array(), arm, origin),
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
