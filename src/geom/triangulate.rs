//! Triangles in place of faces that are not convex or not planar.

#[cfg(feature = "triangulate")]
use std::cmp::Ordering;

use glam::DVec3;

#[cfg(feature = "triangulate")]
use super::Int;
use super::exact::Plane;
#[cfg(feature = "triangulate")]
use super::exact::cross;

/// Ear clipping was needed and is compiled out.
#[derive(Debug)]
pub(super) struct Unavailable;

/// Triangles, as corner numbers, of a polygon that is convex seen along some axis: a quad is cut
/// along its shorter diagonal, others fan out from their first corner.
pub(super) fn convex(corners: &[[f64; 3]]) -> Vec<[usize; 3]> {
    let diagonal = |a: usize, b: usize| DVec3::from(corners[a]).distance_squared(corners[b].into());
    if corners.len() == 4 && diagonal(1, 3) < diagonal(0, 2) {
        return vec![[1, 2, 3], [1, 3, 0]];
    }
    (1..corners.len() - 1).map(|k| [0, k, k + 1]).collect()
}

/// Triangles, as corner numbers, of any polygon, facing as it does: by ear clipping in the
/// projection along the main axis of its vector area (Newell's normal), exact. A polygon that
/// crosses itself is covered as far as ear clipping goes, and told: its triangles have more or less
/// area than it has. If its parts face both ways and cancel, `plane`, which must be one of some of
/// its corners, stands for the vector area.
#[cfg(feature = "triangulate")]
pub(super) fn any(
    corners: &[[f64; 3]],
    plane: &Plane,
) -> Result<(Vec<[usize; 3]>, bool), Unavailable> {
    let area = vector_area(corners);
    let (drop, facing) = facing(&area, plane);
    let (x, y) = ((drop + 1) % 3, (drop + 2) % 3);
    let flat: Vec<[f64; 2]> = corners.iter().map(|corner| [corner[x], corner[y]]).collect();
    let mut indices: Vec<u32> = Vec::new();
    earcut::Earcut::new().earcut_slice(&flat, &[], &mut indices);
    let mut covered = 0.0;
    let mut oriented = |triple: &[u32]| {
        let [a, b, c] = [triple[0] as usize, triple[1] as usize, triple[2] as usize];
        let twice = cross(corners[a], corners[b], corners[c])[drop];
        covered += twice.unsigned_abs() as f64;
        if twice.cmp(&0) == facing { [a, b, c] } else { [a, c, b] }
    };
    let triangles = indices.chunks_exact(3).map(&mut oriented).collect();
    let crosses_itself = (covered - area[drop].to_f64().abs()).abs() > covered * UNEVEN;
    Ok((triangles, crosses_itself))
}

/// The share of a polygon's area by which the sum of its triangles' may differ: ear clipping leaves
/// out corners that are on a line but for rounding. Larger, and loops of that size go unsaid.
#[cfg(feature = "triangulate")]
const UNEVEN: f64 = 1e-12;

/// Twice the vector area of a polygon (Newell's normal).
#[cfg(feature = "triangulate")]
fn vector_area(corners: &[[f64; 3]]) -> [Int<3>; 3] {
    let mut area = [Int::<3>::ZERO; 3];
    for pair in corners.windows(2) {
        let part = cross(corners[0], pair[0], pair[1]);
        area = std::array::from_fn(|axis| area[axis] + Int::from(part[axis]));
    }
    area
}

/// The axis to look along, and the sign of a triangle seen along it that faces as the polygon.
#[cfg(feature = "triangulate")]
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

/// Areas that cancel to this share of a triangle's leave no direction but that of rounding.
///
/// Larger, and a thin polygon that is far from planar may be looked at edge-on; smaller, and one
/// that is planar but for rounding may.
#[cfg(feature = "triangulate")]
const CANCELLED: f64 = 1e-6;

/// Ear clipping is compiled out.
#[cfg(not(feature = "triangulate"))]
pub(super) fn any(_: &[[f64; 3]], _: &Plane) -> Result<(Vec<[usize; 3]>, bool), Unavailable> {
    Err(Unavailable)
}
