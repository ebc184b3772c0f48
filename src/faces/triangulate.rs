//! Triangulates polygons that are not convex or not planar.

mod arrange;
mod arrangement;
mod chain;
mod edge;
mod outline;
mod regions;
mod sweep_line;
#[cfg(test)]
mod tests;
mod uncross;

use std::cmp::Ordering;

use glam::DVec3;

use crate::Error;
use crate::exact::{Int, Plane, cross};
use crate::progress::Watch;
use edge::Point;
use outline::Triangulation;

/// Triangulates a polygon that is convex as seen along some axis: a quad along its shorter
/// diagonal, any other as a fan from its first corner.
pub(super) fn convex(corners: &[[f64; 3]]) -> Triangulation {
    let diagonal = |a: usize, b: usize| DVec3::from(corners[a]).distance_squared(corners[b].into());
    let triangles = if corners.len() == 4 && diagonal(1, 3) < diagonal(0, 2) {
        vec![[1, 2, 3], [1, 3, 0]]
    } else {
        (1..corners.len() as u32 - 1).map(|k| [0, k, k + 1]).collect()
    };
    Triangulation { triangles, crosses_itself: false }
}

/// Triangulates any polygon, in the projection along the main axis of its vector area (Newell's
/// normal); exact, in O(n log n). The triangles face the way the polygon does.
///
/// They cover everything that the outline winds around, once. A polygon that crosses itself is
/// reported, and covered as [`uncross`] describes. If parts of the polygon face both ways and their
/// areas cancel, `plane`, which must go through three of its corners, replaces the vector area. A
/// polygon that has area, but shows none along that axis, fans out from its first corner.
pub(super) fn any(
    corners: &[[f64; 3]],
    plane: &Plane,
    watch: &Watch<'_>,
) -> Result<Triangulation, Error> {
    let area = vector_area(corners);
    let (drop, facing) = facing(&area, plane);
    let (x, y) = ((drop + 1) % 3, (drop + 2) % 3);
    let flat: Vec<Point> =
        corners.iter().map(|corner| [corner[x] as i64, corner[y] as i64]).collect();
    let mut found = outline::triangulate(&flat, watch)?;
    let has_area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|k| corners[k as usize]);
        cross(a, b, c) != [0; 3]
    };
    if area.iter().any(|component| component.sign().is_ne())
        && !found.triangles.iter().any(has_area)
    {
        return Ok(Triangulation { triangles: convex(corners).triangles, ..found });
    }
    if facing.is_lt() {
        found.triangles.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
    }
    Ok(found)
}

/// Twice the vector area of a polygon (Newell's normal).
fn vector_area(corners: &[[f64; 3]]) -> [Int<3>; 3] {
    let mut area = [Int::<3>::ZERO; 3];
    for pair in corners.windows(2) {
        let part = cross(corners[0], pair[0], pair[1]);
        area = std::array::from_fn(|axis| area[axis] + Int::from(part[axis]));
    }
    area
}

/// The axis to project along, and the sign that the area of a triangle has in this projection if it
/// faces the way the polygon does.
fn facing(area: &[Int<3>; 3], plane: &Plane) -> (usize, Ordering) {
    let normal = plane.normal();
    let size = DVec3::from_array(area.map(|component| component.to_f64())).abs();
    let drop = if size.max_element() > CANCELLED * plane.normal_f64().abs().max_element() {
        size.max_position()
    } else {
        plane.main_axis()
    };
    let facing = area[drop].sign();
    (drop, if facing.is_eq() { normal[drop].cmp(&0) } else { facing })
}

/// A vector area counts as cancelled if it is no more than this share of a triangle of the polygon:
/// its direction then comes from rounding alone.
///
/// Larger: a thin polygon that is far from planar may be projected edge-on. Smaller: a polygon that
/// is planar except for rounding may be.
const CANCELLED: f64 = 1e-6;
