//! Areas and windings in integers.

use super::super::super::dice::Dice;
use super::super::super::judge::{Verdict, ensure};
use super::Given;
use binspace::glam::DVec3;
use binspace::internals::Faces;
use std::ops::Range;

/// Twice a vector area.
pub(super) type Area = [i128; 3];

/// The number of tested points of a polygon.
const POINTS: usize = 24;

fn minus(a: [f64; 3], b: [f64; 3]) -> [i128; 3] {
    std::array::from_fn(|i| a[i] as i128 - b[i] as i128)
}

/// Twice the vector area of a triangle: lattice coordinates have 52 bits.
pub(super) fn cross(p: [f64; 3], q: [f64; 3], r: [f64; 3]) -> Area {
    let (a, b) = (minus(q, p), minus(r, p));
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// Twice the vector area of a polygon.
pub(super) fn area_of(corners: &[[f64; 3]]) -> Area {
    let parts = corners.windows(2).map(|pair| cross(corners[0], pair[0], pair[1]));
    parts.fold([0; 3], |sum, part| std::array::from_fn(|i| sum[i] + part[i]))
}

/// The axis along which an area is largest, or several axes with areas that are equal up to rounding.
pub(super) fn main_axes(area: Area) -> Vec<usize> {
    let size = area.map(|component| component.unsigned_abs());
    let largest = size.into_iter().max().unwrap_or(0);
    (0..3).filter(|&axis| largest - size[axis] <= largest >> 40).collect()
}

/// Checks that each point inside a simple polygon lies in one of its faces, and that no other point does.
/// Tests points in the middle of a face and points anywhere near, in a projection along an axis.
pub(super) fn winds_once(
    faces: &Faces,
    range: Range<u32>,
    given: &Given,
    dice: &mut Dice,
) -> Verdict {
    let outline: Vec<[f64; 3]> = given.corners.iter().map(|&c| faces.lattice().snap(c)).collect();
    let drop = main_axes(area_of(&outline))[0];
    for _ in 0..POINTS {
        let face = range.start + dice.below(range.len()) as u32;
        let corner = |dice: &mut Dice| {
            let own = faces.corners(face);
            match dice.below(4) {
                0 => outline[dice.below(outline.len())],
                _ => own[dice.below(own.len())],
            }
        };
        let (mut point, mut total) = (DVec3::ZERO, 0.0);
        for _ in 0..4 {
            let share = 0.05 + dice.share();
            point += DVec3::from(corner(dice)) * share;
            total += share;
        }
        let point = (point / total).round().to_array();
        let mut inside = Some(0);
        for face in range.clone() {
            let around = winding(faces.corners(face), point, drop);
            inside = inside.zip(around).map(|(sum, one)| sum + one.abs());
        }
        // Points on an edge of a face are on neither side.
        let (Some(inside), Some(around)) = (inside, winding(&outline, point, drop)) else {
            continue;
        };
        ensure(inside == around.abs(), || {
            format!("{inside} faces at {point:?}, which the polygon goes around {around} times")
        })?;
    }
    Ok(())
}

/// Whether a polygon winds around one of some points between its corners, in a projection along some axis.
pub(super) fn goes_around_something(corners: &[[f64; 3]], dice: &mut Dice) -> bool {
    (0..POINTS).any(|_| {
        let mut some = || DVec3::from(corners[dice.below(corners.len())]);
        let point = ((some() + some() + some()) / 3.0).round().to_array();
        (0..3).any(|drop| winding(corners, point, drop).is_some_and(|times| times != 0))
    })
}

/// The winding number of a polygon around a point, in a projection along an axis; `None` on its outline.
fn winding(corners: &[[f64; 3]], point: [f64; 3], drop: usize) -> Option<i32> {
    let y = (drop + 2) % 3;
    let mut times = 0;
    for (k, &a) in corners.iter().enumerate() {
        let b = corners[(k + 1) % corners.len()];
        let side = cross(point, a, b)[drop];
        let x = (drop + 1) % 3;
        let between = |i: usize| (point[i] - a[i]) * (point[i] - b[i]) <= 0.0;
        if side == 0 && between(x) && between(y) {
            return None;
        }
        match (a[y] <= point[y], b[y] <= point[y]) {
            (true, false) if side > 0 => times += 1,
            (false, true) if side < 0 => times -= 1,
            _ => {}
        }
    }
    Some(times)
}
