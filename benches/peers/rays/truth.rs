//! The nearest hit of a ray among all triangles, in rationals.

use binspace::glam::DVec3;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use std::cmp::Ordering;
use testkit::vector::{difference, product, scalar};

type Point = [BigRational; 3];

pub(crate) struct Truth<'a> {
    triangles: &'a [[DVec3; 3]],
}

impl<'a> Truth<'a> {
    pub(crate) fn new(triangles: &'a [[DVec3; 3]]) -> Self {
        Self { triangles }
    }

    /// The parameter of the nearest hit; edges, corners and the ray's beginning count.
    pub(crate) fn nearest(&self, [from, direction]: [DVec3; 2]) -> Option<f64> {
        let near = self.triangles.iter().filter(|triangle| is_near(triangle, from, direction));
        let ray = [point(from), point(direction)];
        near.filter_map(|triangle| meets(&triangle.map(point), &ray)).min()?.to_f64()
    }
}

/// Whether rounding leaves any chance that a ray meets a triangle: a thousand times what it loses.
fn is_near(triangle: &[DVec3; 3], from: DVec3, direction: DVec3) -> bool {
    let arms = triangle.map(|corner| corner - from);
    let sides = [0, 1, 2].map(|k| direction.dot(arms[k].cross(arms[(k + 1) % 3])));
    let size = arms.iter().map(|arm| arm.length()).fold(from.length(), f64::max);
    let slack = 1e-12 * direction.length() * size * size;
    !(sides.iter().any(|&s| s > slack) && sides.iter().any(|&s| s < -slack))
}

fn meets([a, b, c]: &[Point; 3], [from, direction]: &[Point; 2]) -> Option<BigRational> {
    let arms = [a, b, c].map(|corner| difference(corner, from));
    let normal = product(&difference(b, a), &difference(c, a));
    let slope = scalar(&normal, direction);
    if slope.is_zero() {
        return in_plane(&arms, &normal, direction);
    }
    let mut sides =
        [0, 1, 2].map(|k| scalar(direction, &product(&arms[k], &arms[(k + 1) % 3])).cmp(&zero()));
    sides.sort();
    if sides[0].is_lt() && sides[2].is_gt() {
        return None;
    }
    let t = scalar(&normal, &arms[0]) / slope;
    (!t.is_negative()).then_some(t)
}

/// Where a ray that is parallel to a triangle enters it.
fn in_plane(arms: &[Point; 3], normal: &Point, direction: &Point) -> Option<BigRational> {
    if !scalar(normal, &arms[0]).is_zero() {
        return None;
    }
    // Which side of the ray each corner is on, seen along the normal.
    let across = product(normal, direction);
    let sides = [0, 1, 2].map(|k| scalar(&across, &arms[k]));
    let length = scalar(direction, direction);
    let along = [0, 1, 2].map(|k| scalar(direction, &arms[k]) / &length);
    let mut met = Vec::new();
    for k in 0..3 {
        let j = (k + 1) % 3;
        if sides[k].is_zero() {
            met.push(along[k].clone());
        } else if sides[k].cmp(&zero()) == sides[j].cmp(&zero()).reverse() {
            let share = &sides[k] / (&sides[k] - &sides[j]);
            met.push(&along[k] + (&along[j] - &along[k]) * share);
        }
    }
    let (first, last) = (met.iter().min()?, met.iter().max()?);
    (last.cmp(&zero()) != Ordering::Less).then(|| first.clone().max(zero()))
}

fn zero() -> BigRational {
    BigRational::zero()
}

fn point(p: DVec3) -> Point {
    p.to_array().map(|c| BigRational::from_float(c).expect("finite"))
}
