//! Ray casting in rational numbers, written from the definitions alone.

use std::cmp::Ordering;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::ray;
use crate::geom::{Faces, Line, PlaneKind};
use crate::raster::rays::{Pencil, Rays};

type Vector = [BigRational; 3];

fn dot(a: &Vector, b: &Vector) -> BigRational {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn rational(point: [f64; 3]) -> Vector {
    point.map(|c| BigRational::from_float(c).unwrap())
}

fn normal(p: &Vector, q: &Vector, r: &Vector) -> Vector {
    let (u, w) = (minus(q, p), minus(r, p));
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &u[j] * &w[k] - &u[k] * &w[j]
    })
}

/// A ray, moved by `delta` to the right and `delta`² downwards.
fn moved(rays: &Rays, x: u32, y: u32, delta: &BigRational) -> [Vector; 2] {
    let mut ray = ray(rays, x, y).map(|v| v.map(BigRational::from));
    let given = if matches!(rays.pencil, Pencil::From { .. }) { 1 } else { 0 };
    for i in 0..3 {
        let [right, down] =
            [rays.right[i], rays.down[i]].map(|c| BigRational::from(BigInt::from(c)));
        ray[given][i] += delta * (right + delta * down);
    }
    ray
}

/// Where a ray meets the plane of a face, and which multiple of its direction that is from its
/// start; `None` if it does not, or only behind the eye.
fn hit(rays: &Rays, faces: &Faces, face: u32, ray: &[Vector; 2]) -> Option<(Vector, BigRational)> {
    let [p, q, r] = faces.reference_triangle(face).map(|c| rational(faces.corner(c)));
    let n = normal(&p, &q, &r);
    let along = dot(&n, &ray[1]);
    let from = dot(&n, &minus(&ray[0], &p));
    if along.is_zero() || rays.is_perspective() && from.is_zero() {
        return None;
    }
    if rays.front_only && along.is_positive() {
        return None;
    }
    let t = -from / along;
    if rays.is_perspective() && !t.is_positive() {
        return None;
    }
    Some((std::array::from_fn(|i| &ray[0][i] + &t * &ray[1][i]), t))
}

/// Whether a point of a face's plane is inside all its edges, seen along the axis that the plane is
/// least steep in; `None` if it is on one of them, and not outside of another.
fn within(faces: &Faces, face: u32, point: &Vector) -> Option<bool> {
    let [p, q, r] = faces.reference_triangle(face).map(|c| rational(faces.corner(c)));
    let n = normal(&p, &q, &r);
    let steepest = (0..3).max_by_key(|&i| n[i].abs()).unwrap();
    let axis = faces.upright_axis(face).unwrap_or(steepest);
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let corners: Vec<Vector> = faces.corners(face).iter().map(|&c| rational(c)).collect();
    let mut on_edge = false;
    for (i, a) in corners.iter().enumerate() {
        let b = &corners[(i + 1) % corners.len()];
        let (arm, to) = (minus(b, a), minus(point, a));
        let side = (&arm[j] * &to[k] - &arm[k] * &to[j]) * n[axis].signum();
        match side.cmp(&BigRational::zero()) {
            Ordering::Less => return Some(false),
            Ordering::Equal => on_edge = true,
            Ordering::Greater => {}
        }
    }
    if on_edge { None } else { Some(true) }
}

/// Whether the ray of a pixel meets a face, and after which multiple of its direction.
pub(super) fn meets(rays: &Rays, faces: &Faces, face: u32, x: u32, y: u32) -> Option<BigRational> {
    let straight = moved(rays, x, y, &BigRational::zero());
    let (point, t) = hit(rays, faces, face, &straight)?;
    let inside = within(faces, face, &point).unwrap_or_else(|| {
        // Less than any ratio of the numbers involved, so as good as infinitely little.
        let delta = BigRational::new(BigInt::from(1), BigInt::from(1) << 3000);
        let (point, _) = hit(rays, faces, face, &moved(rays, x, y, &delta)).unwrap();
        within(faces, face, &point).unwrap()
    });
    inside.then_some(t)
}

/// Whether the ray of a pixel meets a piece of a face.
pub(super) fn meets_piece(
    rays: &Rays,
    faces: &Faces,
    face: u32,
    lines: &[Line],
    x: u32,
    y: u32,
) -> bool {
    if meets(rays, faces, face, x, y).is_none() {
        return false;
    }
    let straight = moved(rays, x, y, &BigRational::zero());
    let Some((point, _)) = hit(rays, faces, face, &straight) else { return false };
    lines.iter().filter_map(|line| Some((line.as_cut()?, line.is_behind()))).all(
        |(plane, behind)| {
            let side = match plane.kind() {
                PlaneKind::Axis(axis, corner) => {
                    &point[axis] - &rational(faces.corner(corner))[axis]
                }
                PlaneKind::Face(face) => {
                    let [p, q, r] =
                        faces.reference_triangle(face).map(|c| rational(faces.corner(c)));
                    dot(&normal(&p, &q, &r), &minus(&point, &p))
                }
            };
            side.is_negative() == behind
        },
    )
}

/// The nearest face on the ray of a pixel, the later of two at the same distance.
pub(super) fn nearest(rays: &Rays, faces: &Faces, x: u32, y: u32) -> Option<u32> {
    let mut best: Option<(u32, BigRational)> = None;
    for face in 0..faces.len() as u32 {
        if let Some(t) = meets(rays, faces, face, x, y)
            && best.as_ref().is_none_or(|(_, nearest)| t <= *nearest)
        {
            best = Some((face, t));
        }
    }
    best.map(|(face, _)| face)
}
