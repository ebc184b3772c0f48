//! Triangulates polygons that are not convex or not planar, in a projection along an axis. If edges of a
//! planar polygon cross, they are replaced first. A polygon that is not planar always keeps its edges.

mod region;
mod sweep;
#[cfg(test)]
mod tests;

use std::cmp::Ordering;

use glam::DVec3;

use crate::Error;
use crate::exact::{Int, Plane, chain, cross, integers};
use crate::progress::Watch;
use region::Triangles;
use sweep::{Edge, NONE, Point, Rule, Sweep, area};

/// Triangles, as corner numbers, in place of a polygon.
#[derive(Debug)]
pub(super) struct Triangulation {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Whether the polygon crosses itself, or does not wind exactly once around every triangle.
    pub(super) crosses_itself: bool,
    /// Whether, in addition, no corner is on another corner or on an edge.
    is_simple: bool,
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
    Triangulation { triangles, crosses_itself: false, is_simple: true }
}

/// Triangulates any polygon that is planar except for rounding, in the projection along the main axis of its
/// vector area (Newell's normal). The result is exact, and takes O(n log n) comparisons. The triangles have
/// the orientation of the polygon.
///
/// The triangles cover every point with a winding number other than 0, once. A polygon that crosses itself is
/// reported, and covered as [`uncross`] describes. `plane` must contain three of the polygon's corners. It
/// replaces the vector area if parts of the polygon face both ways and the areas of these parts cancel. A
/// polygon that has area, but no area in the projection, becomes a fan from its first corner. If corners
/// coincide only in the projection, the polygon is triangulated like a [`bent`] polygon.
pub(super) fn planar(
    corners: &[[f64; 3]],
    plane: &Plane,
    watch: &Watch<'_>,
) -> Result<Triangulation, Error> {
    let area = vector_area(corners);
    let (axis, facing) = facing(&area, plane);
    let mut found = in_plane(&along(axis, corners), watch)?;
    let has_area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|k| corners[k as usize]);
        cross(a, b, c) != [0; 3]
    };
    if area.iter().any(|component| component.sign().is_ne())
        && !found.triangles.iter().any(has_area)
    {
        return Ok(Triangulation { triangles: convex(corners).triangles, ..found });
    }
    turn_over(&mut found.triangles, facing);
    let keeps_outline = || found.is_simple || sum_to_outline(corners, &found.triangles);
    if found.crosses_itself || keeps_outline() { Ok(found) } else { bent(corners, plane, watch) }
}

/// Triangulates a polygon that is not planar. The sum of the triangles' directed edges is the polygon's
/// outline: so a body that the polygon closes stays closed, and the sum of the triangles' vector areas is the
/// polygon's.
///
/// If the outline crosses itself in the projection along the main axis, or corners coincide there, then the
/// projections along the other axes are tried. If all fail, the polygon is divided, and the parts are
/// triangulated in the same way. Parts become fans from their first corners if this takes too long.
pub(super) fn bent(
    corners: &[[f64; 3]],
    plane: &Plane,
    watch: &Watch<'_>,
) -> Result<Triangulation, Error> {
    let mut triangles = vec![];
    let mut budget = PATIENCE.max(SWEEPS * corners.len());
    let mut parts: Vec<Vec<u32>> = vec![(0..corners.len() as u32).collect()];
    while let Some(part) = parts.pop() {
        let of_part = |some: Triangles| some.into_iter().map(|t| t.map(|k| part[k as usize]));
        let points: Vec<[f64; 3]> = part.iter().map(|&corner| corners[corner as usize]).collect();
        let left = budget.checked_sub(part.len());
        let (Some(left), 4..) = (left, part.len()) else {
            triangles.extend(of_part((2..part.len() as u32).map(|k| [0, k - 1, k]).collect()));
            continue;
        };
        budget = left;
        match along_any_axis(&points, plane, watch)? {
            Ok(found) => triangles.extend(of_part(found)),
            Err(crossing) => {
                let cut = Cut::new(&points, crossing);
                triangles.extend(of_part(cut.triangles));
                let of_part = |loops: Vec<u32>| loops.iter().map(|&k| part[k as usize]).collect();
                parts.extend(cut.parts.map(of_part));
            }
        }
    }
    Ok(Triangulation { triangles, crosses_itself: false, is_simple: false })
}

/// Triangles whose directed edges sum to the outline, in the projection along some axis. Otherwise two edges
/// that cross, if there are any in the first projection that was tried.
fn along_any_axis(
    corners: &[[f64; 3]],
    plane: &Plane,
    watch: &Watch<'_>,
) -> Result<Result<Triangles, Option<[Edge; 2]>>, Error> {
    let area = vector_area(corners);
    let (main, facing) = facing(&area, plane);
    let size = area.map(|component| component.to_f64().abs());
    let others = (0..3).filter(|&axis| axis != main && size[axis] > CANCELLED * size[main]);
    let axes = std::iter::once((main, facing)).chain(others.map(|axis| (axis, area[axis].sign())));
    let mut crossing = None;
    for (axis, facing) in axes {
        let outline = Outline::new(&along(axis, corners));
        let Some(mut sweep) = outline.sweep(watch)? else { continue };
        if let Some(&pair) = sweep.crossings.first() {
            crossing = crossing.or(Some(pair));
            continue;
        }
        turn_over(&mut sweep.triangles, facing);
        if sweep.is_simple(corners.len()) || sum_to_outline(corners, &sweep.triangles) {
            return Ok(Ok(sweep.triangles));
        }
    }
    Ok(Err(crossing))
}

/// Turns triangles to the other side if their polygon's projection is clockwise.
fn turn_over(triangles: &mut Triangles, facing: Ordering) {
    if facing.is_lt() {
        triangles.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
    }
}

/// Whether the triangles' directed edges sum to the outline.
fn sum_to_outline(corners: &[[f64; 3]], triangles: &Triangles) -> bool {
    let at = |corner: u32| integers(corners[corner as usize]);
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let n = corners.len() as u32;
    let outline_back = (0..n).map(|k| [if k + 1 == n { 0 } else { k + 1 }, k]);
    let edges = sides.chain(outline_back).map(|ends| (at(ends[0]), at(ends[1]), ends));
    chain::open_edges(edges.collect()).is_empty()
}

/// A closed outline, divided. The outlines of the parts and the edges of the triangles sum to the outline.
struct Cut {
    parts: [Vec<u32>; 2],
    triangles: Triangles,
}

impl Cut {
    /// Divides an outline where two of its edges cross in a projection: the edges are replaced by two edges
    /// between the same four ends, which separate the outline into two. Two triangles between the four ends
    /// fill the gap. Otherwise divides the outline by a diagonal.
    fn new(corners: &[[f64; 3]], crossing: Option<[Edge; 2]>) -> Self {
        let n = corners.len();
        let next = |k: usize| if k + 1 == n { 0 } else { k + 1 };
        let ends = |edge: Edge| {
            let [from, to] = edge.corners.map(|corner| corner as usize);
            let [from, to] = if edge.weight > 0 { [from, to] } else { [to, from] };
            (from < n && next(from) == to).then_some([from, to])
        };
        let between = |from: usize, to: usize| -> Vec<u32> {
            let end = if from <= to { to } else { to + n };
            (from..=end).map(|k| (k % n) as u32).collect()
        };
        if let Some([first, second]) = crossing
            && let (Some([a, b]), Some([c, d])) = (ends(first), ends(second))
        {
            let triangles = two_triangles(corners, [a, b, c, d]);
            return Self { parts: [between(b, c), between(d, a)], triangles };
        }
        if n == 4 {
            let triangles = two_triangles(corners, [0, 1, 2, 3]);
            return Self { parts: Default::default(), triangles };
        }
        let [a, b] = diagonal(corners);
        Self { parts: [between(a, b), between(b, a)], triangles: vec![] }
    }
}

/// Two triangles between four corners, with as little area as possible.
fn two_triangles(corners: &[[f64; 3]], [a, b, c, d]: [usize; 4]) -> Triangles {
    let ways = [[[a, b, c], [a, c, d]], [[b, c, d], [b, d, a]]];
    let area = |triangle: [usize; 3]| {
        let [p, q, r] = triangle.map(|k| DVec3::from(corners[k]));
        (q - p).cross(r - p).length()
    };
    let [one, other] = ways.map(|way| way.map(area).iter().sum::<f64>());
    ways[usize::from(other < one)].map(|triangle| triangle.map(|k| k as u32)).to_vec()
}

/// The shortest diagonal; in large outlines, of the diagonals that divide the outline in half.
fn diagonal(corners: &[[f64; 3]]) -> [usize; 2] {
    /// Too small: short diagonals are missed. Too large: a large outline takes longer.
    const CANDIDATES: usize = 1 << 12;
    let n = corners.len();
    let half = n / 2;
    let steps = half.saturating_sub(CANDIDATES / n).max(2)..=half;
    let all = steps.flat_map(|step| (0..n).map(move |k| [k, (k + step) % n]));
    let length =
        |[a, b]: &[usize; 2]| DVec3::from(corners[*a]).distance_squared(DVec3::from(corners[*b]));
    all.min_by(|one, other| length(one).total_cmp(&length(other))).unwrap_or([0, half])
}

/// The projection of corners along an axis.
fn along(axis: usize, corners: &[[f64; 3]]) -> Vec<Point> {
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    corners.iter().map(|corner| [corner[x] as i64, corner[y] as i64]).collect()
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
    if let Some(sweep) = outline.sweep(watch)?
        && sweep.crossings.is_empty()
    {
        let (crosses_itself, is_simple) = (!sweep.winds_once(), sweep.is_simple(corners.len()));
        return Ok(Triangulation { triangles: sweep.triangles, crosses_itself, is_simple });
    }
    let mut triangles = uncross(&outline, watch)?;
    if triangles.is_empty() {
        triangles = fan(corners);
    }
    Ok(Triangulation { triangles, crosses_itself: true, is_simple: false })
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

    /// Sweeps over the outline up to the first crossing; `None` if there are too many parts.
    fn sweep(&self, watch: &Watch<'_>) -> Result<Option<Sweep<'_>>, Error> {
        Sweep::new(self, &self.edges, Rule::Signed).run(watch)
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
