//! Rays from an eye through segments and faces, in rationals.

use num_traits::One;
use testkit::prelude::*;

use testkit::model::Face;
use testkit::rational::{Plane, Point};

/// Half the grid's side, in its steps.
pub(crate) const GRID: f64 = (1u64 << 51) as f64;

pub(crate) fn to_f64(point: &Point) -> DVec3 {
    DVec3::from_array(point.each_ref().map(|c| c.to_f64().value()))
}

pub(crate) fn between([p, q]: &[Point; 2], share: &Rational) -> Point {
    std::array::from_fn(|i| &p[i] + (&q[i] - &p[i]) * share)
}

/// The position of `b` along the ray from `eye` to `a`: 1 at `a`.
pub(crate) fn ratio(eye: &Point, a: &Point, b: &Point) -> Rational {
    let arm = rational::difference(a, eye);
    let axis = (0..3).find(|&i| !arm[i].is_zero()).expect("another point than the eye");
    (&b[axis] - &eye[axis]) / &arm[axis]
}

/// The points where a ray from the eye meets two segments, as shares of the segments, and the distance
/// between them; `None` if no ray meets the inside of both.
pub(crate) fn crossing(
    eye: &Point,
    a: &[Point; 2],
    b: &[Point; 2],
) -> Option<([Rational; 2], Rational)> {
    let share = |of: &[Point; 2], by: &[Point; 2]| {
        let plane = Plane::through([eye, &by[0], &by[1]]);
        let [from, to] = of.each_ref().map(|end| plane.at(end));
        let is_crossed =
            rational::sign(&from).is_ne() && rational::sign(&from) == rational::sign(&to).reverse();
        is_crossed.then(|| &from / (&from - &to))
    };
    let (of_a, of_b) = (share(a, b)?, share(b, a)?);
    let ratio = ratio(eye, &between(a, &of_a), &between(b, &of_b));
    ratio.is_positive().then_some(([of_a, of_b], ratio))
}

/// Whether the ends of a segment may be on different sides of the plane through the eye and another segment.
/// Floats decide, to save time.
pub(crate) fn may_cross(eye: DVec3, of: [DVec3; 2], by: [DVec3; 2]) -> bool {
    let normal = (by[0] - eye).cross(by[1] - eye);
    let [from, to] = of.map(|end| normal.dot((end - eye).normalize_or_zero()) / GRID / GRID);
    (from < 1e-6 || to < 1e-6) && (from > -1e-6 || to > -1e-6)
}

/// Whether the ray from an eye through a point may meet the inside of a face. Floats decide, to save time.
pub(crate) fn may_hit(eye: DVec3, through: DVec3, corners: &[DVec3]) -> bool {
    let ray = (through - eye).normalize_or_zero();
    let n = corners.len();
    let turns =
        (0..n).map(|k| (corners[k] - eye).cross(corners[(k + 1) % n] - eye).dot(ray) / GRID / GRID);
    let turns: Vec<f64> = turns.collect();
    turns.iter().all(|&turn| turn > -1e-6) || turns.iter().all(|&turn| turn < 1e-6)
}

/// The position where the ray from the eye through a point meets the inside of a face: 1 at the point.
pub(crate) fn hit(eye: &Point, through: &Point, face: &Face) -> Option<Rational> {
    let (from, to) = (face.plane.at(eye), face.plane.at(through));
    if from.is_zero() || from == to {
        return None;
    }
    let ratio = &from / (&from - &to);
    if !ratio.is_positive() {
        return None;
    }
    let at = between(&[eye.clone(), through.clone()], &ratio);
    face.place(&at).is_gt().then_some(ratio)
}

/// The place where the line through the eye and a point meets a segment, as a share of the segment. The
/// segment may be a point.
pub(crate) fn share_in_line(eye: &Point, x: &Point, [p, q]: &[Point; 2]) -> Option<Rational> {
    let arm = rational::difference(x, eye);
    let off = |at: &Point| rational::product(&arm, &rational::difference(at, eye));
    let is_zero = |v: &Point| v.iter().all(Zero::is_zero);
    let (from, to) = (off(p), off(q));
    if p == q {
        return is_zero(&from).then(Rational::zero);
    }
    let axis = (0..3).find(|&i| from[i] != to[i])?;
    let share = &from[axis] / (&from[axis] - &to[axis]);
    let is_within = !share.is_negative() && share <= Rational::one();
    (is_within && is_zero(&off(&between(&[p.clone(), q.clone()], &share)))).then_some(share)
}
