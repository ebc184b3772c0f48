//! Triangulates polygons that are not convex or not planar, in a projection along an axis. Edges that cross
//! are replaced first.

mod region;
mod sweep;
#[cfg(test)]
mod tests;

use std::cmp::Ordering;

use glam::DVec3;

use crate::Error;
use crate::exact::{Int, Plane, cross};
use crate::progress::Watch;
use region::Triangles;
use sweep::{Edge, NONE, Point, Rule, Sweep, area};

/// Triangles, as corner numbers, in place of a polygon.
#[derive(Debug)]
pub(super) struct Triangulation {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Whether the polygon crosses itself, or does not wind exactly once around every triangle.
    pub(super) crosses_itself: bool,
}

/// Triangulates a polygon that is convex as seen along some axis: a quad along the shorter diagonal, any
/// other polygon as a fan from the first corner.
pub(super) fn convex(corners: &[[f64; 3]]) -> Triangulation {
    let diagonal = |a: usize, b: usize| DVec3::from(corners[a]).distance_squared(corners[b].into());
    let triangles = if corners.len() == 4 && diagonal(1, 3) < diagonal(0, 2) {
        vec![[1, 2, 3], [1, 3, 0]]
    } else {
        (1..corners.len() as u32 - 1).map(|k| [0, k, k + 1]).collect()
    };
    Triangulation { triangles, crosses_itself: false }
}

/// Triangulates any polygon, in the projection along the main axis of its vector area (Newell's normal). The
/// result is exact, and takes O(n log n) comparisons. The triangles have the orientation of the polygon. A
/// polygon that is far from planar may cross or touch itself in that projection, and lose corners. If the
/// projection along another axis has no such fault, that axis is used.
///
/// The triangles cover every point with a winding number other than 0, once. A polygon that crosses itself is
/// reported, and covered as [`uncross`] describes. `plane` must contain three of the polygon's corners. It
/// replaces the vector area if parts of the polygon face both ways and the areas of these parts cancel. A
/// polygon that has area, but no area in the projection, becomes a fan from its first corner.
pub(super) fn any(
    corners: &[[f64; 3]],
    plane: &Plane,
    watch: &Watch<'_>,
) -> Result<Triangulation, Error> {
    let area = vector_area(corners);
    let (main, mut facing) = facing(&area, plane);
    let mut found = along(main, corners, watch)?;
    for axis in (0..3).filter(|&axis| axis != main && area[axis].sign().is_ne()) {
        if found.triangles.len() + 2 < corners.len() {
            let other = along(axis, corners, watch)?;
            if !other.crosses_itself && other.triangles.len() > found.triangles.len() {
                (found, facing) = (other, area[axis].sign());
            }
        }
    }
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

/// Triangles of a polygon in the projection along an axis.
fn along(axis: usize, corners: &[[f64; 3]], watch: &Watch<'_>) -> Result<Triangulation, Error> {
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let flat: Vec<Point> =
        corners.iter().map(|corner| [corner[x] as i64, corner[y] as i64]).collect();
    in_plane(&flat, watch)
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

/// The axis of the projection, and the sign that the projected area of a triangle has if the triangle has the
/// polygon's orientation.
fn facing(area: &[Int<3>; 3], plane: &Plane) -> (usize, Ordering) {
    let normal = plane.normal();
    let size = DVec3::from_array(area.map(|component| component.to_f64())).abs();
    let axis = if size.max_element() > CANCELLED * plane.normal_f64().abs().max_element() {
        size.max_position()
    } else {
        plane.dominant_axis()
    };
    let facing = area[axis].sign();
    (axis, if facing.is_eq() { normal[axis].cmp(&0) } else { facing })
}

/// A vector area counts as cancelled if it is no more than this share of the area of a triangle of the
/// polygon. Only rounding determines the direction of a cancelled vector area.
///
/// Too large: a thin polygon that is far from planar may be projected edge-on. Too small: a polygon that is
/// planar except for rounding may be projected edge-on.
const CANCELLED: f64 = 1e-6;

/// Triangles of a polygon in the plane, counter-clockwise, as numbers of its corners.
fn in_plane(corners: &[Point], watch: &Watch<'_>) -> Result<Triangulation, Error> {
    let outline = Outline::new(corners);
    if let Some(sweep) = Sweep::new(&outline, &outline.edges, Rule::Signed).run(watch)? {
        let crosses_itself = !sweep.winds_once();
        return Ok(Triangulation { triangles: sweep.triangles, crosses_itself });
    }
    let mut triangles = uncross(&outline, watch)?;
    if triangles.is_empty() {
        triangles = fan(corners);
    }
    Ok(Triangulation { triangles, crosses_itself: true })
}

/// A polygon's distinct points and its edges.
struct Outline {
    points: Vec<Point>,
    /// For each point, a corner of the polygon at that point.
    corners: Vec<u32>,
    edges: Vec<Edge>,
}

impl Outline {
    fn new(corners: &[Point]) -> Self {
        let mut order: Vec<u32> = (0..corners.len() as u32).collect();
        order.sort_unstable_by_key(|&corner| (corners[corner as usize], corner));
        let (mut points, mut names) = (vec![], vec![]);
        let mut point_of = vec![NONE; corners.len()];
        for &corner in &order {
            let point = corners[corner as usize];
            if points.last() != Some(&point) {
                points.push(point);
                names.push(corner);
            }
            point_of[corner as usize] = points.len() as u32 - 1;
        }
        let mut edges = vec![];
        for k in 0..corners.len() {
            let next = if k + 1 == corners.len() { 0 } else { k + 1 };
            let [from, to] = [k, next].map(|k| (k as u32, point_of[k]));
            if from.1 != to.1 {
                edges.push(Edge::between(from, to));
            }
        }
        Self { points, corners: names, edges }
    }
}

/// Triangles that fan out from the first corner: the last resort.
fn fan(corners: &[Point]) -> Vec<[u32; 3]> {
    let triangle = |k: usize| {
        let [a, b, c] = [0, k as u32, k as u32 + 1];
        match area(corners[0], corners[k], corners[k + 1]).signum() {
            0 => None,
            1 => Some([a, b, c]),
            _ => Some([a, c, b]),
        }
    };
    (1..corners.len().saturating_sub(1)).filter_map(triangle).collect()
}

/// Search budget of small polygons, in edges swept. Too small: tangles of some hundred corners become fans.
/// Too large: each tangle takes longer.
const PATIENCE: usize = 1 << 17;
/// Search budget of large polygons, in sweeps. Too small: outlines with several crossings in sequence
/// become fans. Too large: tangles take longer.
const SWEEPS: usize = 16;

/// Replaces edges that cross until no edges cross, and triangulates the inside by [`Rule::Parity`]. Returns
/// no triangles if the budget runs out.
///
/// Two edges that cross are replaced by two edges between the same four ends that do not cross (a 2-opt
/// move). The move that changes less of the inside by the even-odd rule is used. So the result covers
/// somewhat more or less than the outline near a crossing, and exactly the inside everywhere else. The new
/// edges are shorter than the old edges, so the process ends, but it may take long (van Leeuwen and Schoone,
/// “Untangling a travelling salesman tour in the plane”, 1981).
fn uncross(outline: &Outline, watch: &Watch<'_>) -> Result<Triangles, Error> {
    let mut edges = outline.edges.clone();
    let mut budget = PATIENCE.max(SWEEPS * edges.len());
    while let Some(left) = budget.checked_sub(edges.len()) {
        budget = left;
        let Some(sweep) = Sweep::new(outline, &edges, Rule::Parity).run(watch)? else { break };
        if sweep.crossings.is_empty() {
            return Ok(sweep.triangles);
        }
        edges.clear();
        edges.extend(sweep.uncrossed());
        edges.extend(sweep.crossings.iter().flat_map(|&pair| rejoined(&outline.points, pair)));
    }
    Ok(vec![])
}

/// Two edges that do not cross, between the ends of two edges that cross.
fn rejoined(points: &[Point], [first, second]: [Edge; 2]) -> [Edge; 2] {
    let nearer_to_low = |edge: &Edge, other: &Edge| {
        let [c, d] = other.ends.map(|end| points[end as usize]);
        let [low, high] = edge.ends.map(|end| area(c, d, points[end as usize]).abs());
        low < high
    };
    let end = |edge: &Edge, end: usize| (edge.corners[end], edge.ends[end]);
    let [a, b] = [0, 1].map(|k| end(&first, k));
    let [c, d] = [0, 1].map(|k| end(&second, k));
    // The crossing and the four ends form four triangles, and each move changes the inside of two of these
    // triangles. The crossing is at t between a and b, and at u between c and d. As shares of all four
    // triangles, the changed areas are t·u + (1 − t)(1 − u) and t(1 − u) + u(1 − t). The first area is
    // smaller if exactly one of t and u is below 1/2.
    if nearer_to_low(&first, &second) == nearer_to_low(&second, &first) {
        [Edge::between(a, d), Edge::between(c, b)]
    } else {
        [Edge::between(a, c), Edge::between(b, d)]
    }
}
