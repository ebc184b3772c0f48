//! Ray casting in unlimited integers, written from the definitions alone.

use std::cmp::Ordering;

use dashu_int::IBig;
use dashu_ratio::RBig;
use num_traits::{FromPrimitive, Signed, Zero};

use super::ray;
use crate::exact::{EdgeLine, Faces, PlaneId, PlaneKind};
use crate::raster::rays::{RayOrigin, Rays};

type Vector = [IBig; 3];

fn dot(a: &Vector, b: &Vector) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn times(a: &Vector, factor: &IBig) -> Vector {
    std::array::from_fn(|i| &a[i] * factor)
}

fn integer(point: [f64; 3]) -> Vector {
    point.map(|c| IBig::from_f64(c).unwrap())
}

/// The normal of a face's plane, and a point on the plane.
fn plane(faces: &Faces, face: u32) -> (Vector, Vector) {
    let [p, q, r] = faces.reference_triangle(face).map(|c| integer(faces.corner(c)));
    let (u, w) = (minus(&q, &p), minus(&r, &p));
    let normal = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &u[j] * &w[k] - &u[k] * &w[j]
    });
    (normal, p)
}

/// A point as a vector over a positive divisor.
struct Point(Vector, IBig);

/// A ray's start and direction.
struct Ray(Point, Vector);

/// The ray of a pixel; on request, moved by δ to the right and δ² downwards, where δ is less than any ratio
/// of the numbers involved, so practically infinitesimal.
fn ray_of(rays: &Rays, x: u32, y: u32, moved: bool) -> Ray {
    const SHIFT: usize = 3000;
    let [start, direction] = ray(rays, x, y);
    if !moved {
        return Ray(Point(start, IBig::from(1)), direction);
    }
    let perspective = matches!(rays.pencil, RayOrigin::From { .. });
    let given = if perspective { &direction } else { &start };
    let given: Vector = std::array::from_fn(|i| {
        let [right, down] = [rays.right[i], rays.down[i]].map(IBig::from);
        (&given[i] << (2 * SHIFT)) + (right << SHIFT) + down
    });
    if perspective {
        Ray(Point(start, IBig::from(1)), given)
    } else {
        Ray(Point(given, IBig::from(1) << (2 * SHIFT)), direction)
    }
}

/// A face in unlimited integers, for many rays.
pub(crate) struct Target {
    normal: Vector,
    /// A point of the plane.
    point: Vector,
    corners: Vec<Vector>,
    /// The axis along which the outline is looked at: the one in which the plane is least steep.
    axis: usize,
}

impl Target {
    pub(crate) fn new(faces: &Faces, face: u32) -> Self {
        let (normal, point) = plane(faces, face);
        let corners = faces.corners(face).iter().map(|&c| integer(c)).collect();
        let steepest = (0..3).max_by_key(|&i| normal[i].abs()).unwrap();
        let axis = faces.moved_axis(face).unwrap_or(steepest);
        Self { normal, point, corners, axis }
    }

    /// All faces, in order.
    pub(crate) fn all(faces: &Faces) -> Vec<Self> {
        (0..faces.len() as u32).map(|face| Self::new(faces, face)).collect()
    }

    /// The point where a ray meets the plane, and the multiple of its direction, as a quotient; `None` if the
    /// ray does not meet the plane, or only behind the eye.
    fn hit(&self, rays: &Rays, ray: &Ray) -> Option<(Point, [IBig; 2])> {
        let Ray(Point(start, divisor), direction) = ray;
        let along = dot(&self.normal, direction);
        let from = dot(&self.normal, &minus(start, &times(&self.point, divisor)));
        if along.is_zero() || rays.is_perspective() && from.is_zero() {
            return None;
        }
        if rays.front_only && along.is_positive() {
            return None;
        }
        if rays.is_perspective() && along.is_positive() == from.is_positive() {
            return None;
        }
        let sign = along.signum();
        let point = minus(&times(start, &along), &times(direction, &from));
        let divisor = divisor * &along * &sign;
        Some((Point(times(&point, &sign), divisor.clone()), [-from * sign, divisor]))
    }

    /// Whether a point of the plane is inside all edges; `None` if it is on an edge, and not outside another
    /// edge.
    fn within(&self, Point(point, divisor): &Point) -> Option<bool> {
        let (j, k) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let faces_back = self.normal[self.axis].is_negative();
        let mut on_edge = false;
        for (i, a) in self.corners.iter().enumerate() {
            let b = &self.corners[(i + 1) % self.corners.len()];
            let arm = |axis: usize| &b[axis] - &a[axis];
            let to = |axis: usize| &point[axis] - &a[axis] * divisor;
            let side = arm(j) * to(k) - arm(k) * to(j);
            match side.cmp(&IBig::zero()) {
                Ordering::Equal => on_edge = true,
                side if side.is_lt() != faces_back => return Some(false),
                _ => {}
            }
        }
        if on_edge { None } else { Some(true) }
    }

    /// The multiple of its direction at which the ray of a pixel meets the face, if it does.
    pub(crate) fn meets(&self, rays: &Rays, x: u32, y: u32) -> Option<RBig> {
        let (point, [numerator, denominator]) = self.hit(rays, &ray_of(rays, x, y, false))?;
        let inside = self.within(&point).unwrap_or_else(|| {
            let (point, _) = self.hit(rays, &ray_of(rays, x, y, true)).unwrap();
            self.within(&point).unwrap()
        });
        inside.then(|| RBig::from_parts_signed(numerator, denominator))
    }
}

/// The multiple of its direction at which the ray of a pixel meets a face, if it does.
pub(crate) fn meets(rays: &Rays, faces: &Faces, face: u32, x: u32, y: u32) -> Option<RBig> {
    Target::new(faces, face).meets(rays, x, y)
}

/// Whether the ray of a pixel meets a piece of a face.
pub(crate) fn meets_piece(
    rays: &Rays,
    faces: &Faces,
    face: u32,
    lines: &[EdgeLine],
    [x, y]: [u32; 2],
) -> bool {
    let target = Target::new(faces, face);
    let side = |moved, cut| {
        let (Point(point, divisor), _) = target.hit(rays, &ray_of(rays, x, y, moved))?;
        let (n, p) = named(faces, cut);
        Some(dot(&n, &minus(&point, &times(&p, &divisor))))
    };
    let is_inside = |line: &EdgeLine| {
        let Some(cut) = line.as_cut() else { return true };
        let Some(value) = side(false, cut) else { return false };
        let value = if value.is_zero() { side(true, cut).expect("a face met") } else { value };
        value.is_negative() == line.is_behind()
    };
    target.meets(rays, x, y).is_some() && lines.iter().all(is_inside)
}

/// The normal of a named plane, and a point on the plane.
fn named(faces: &Faces, plane_id: PlaneId) -> (Vector, Vector) {
    match plane_id.kind() {
        PlaneKind::Face(face) => plane(faces, face),
        PlaneKind::Axis(axis, corner) => {
            let mut normal = [0; 3].map(IBig::from);
            normal[axis] = 1.into();
            (normal, integer(faces.corner(corner)))
        }
    }
}

/// The height above a plane at which the ray of a pixel meets the plane of a face, or, without a face,
/// starts; `None` if the ray does neither.
pub(crate) fn height(
    rays: &Rays,
    faces: &Faces,
    (face, [x, y]): (Option<u32>, [u32; 2]),
    plane: PlaneId,
) -> Option<Height> {
    let ray = ray_of(rays, x, y, false);
    let Point(point, divisor) = match face {
        Some(face) => Target::new(faces, face).hit(rays, &ray).map(|(point, _)| point),
        None => rays.is_perspective().then_some(ray.0),
    }?;
    let (n, p) = named(faces, plane);
    let value = dot(&n, &minus(&point, &times(&p, &divisor)));
    let squared = RBig::from_parts_signed(&value * &value, dot(&n, &n) * &divisor * &divisor);
    Some(Height { sign: value.cmp(&IBig::zero()), squared })
}

/// A height above a plane: its sign, and its square in lattice units.
pub(crate) struct Height {
    pub(crate) sign: Ordering,
    squared: RBig,
}

impl Height {
    /// Whether the height is at most `reach`.
    pub(crate) fn is_within(&self, reach: f64) -> bool {
        let reach = RBig::from_f64(reach).unwrap();
        self.squared <= &reach * &reach
    }
}

/// The nearest of all faces on the ray of a pixel, the later of two at the same distance.
pub(super) fn nearest(rays: &Rays, all: &[Target], x: u32, y: u32) -> Option<u32> {
    let mut best: Option<(u32, RBig)> = None;
    for (target, face) in all.iter().zip(0..) {
        if let Some(t) = target.meets(rays, x, y)
            && best.as_ref().is_none_or(|(_, nearest)| t <= *nearest)
        {
            best = Some((face, t));
        }
    }
    best.map(|(face, _)| face)
}
