//! Triangulates a polygon in the plane: as it stands if it does not cross itself, else uncrossed.

use super::arrange::ArrangementSweep;
use super::arrangement::Rule;
use super::edge::{Edge, Point};
use super::sweep_line::NONE;
use super::{edge, regions, uncross};
use crate::Error;
use crate::progress::Watch;

/// Triangles, as corner numbers, in place of a polygon.
#[derive(Debug)]
pub(in crate::faces) struct Triangulation {
    pub(in crate::faces) triangles: Vec<[u32; 3]>,
    /// Whether the polygon crosses itself, or winds other than once round what the triangles cover.
    pub(in crate::faces) crosses_itself: bool,
}

/// Triangles of a polygon in the plane, counter-clockwise, as numbers of its corners.
pub(super) fn triangulate(corners: &[Point], watch: &Watch<'_>) -> Result<Triangulation, Error> {
    let outline = Outline::new(corners);
    let (points, names) = (&outline.points, &outline.corners);
    let simple = ArrangementSweep::new(points, &outline.edges, Rule::Signed).run(true, watch)?;
    if let Some(sweep) = simple {
        let arrangement = sweep.finish();
        let covered = regions::triangulate(points, names, &arrangement, Rule::Signed, watch)?;
        let crosses_itself = !covered.winds_once;
        return Ok(Triangulation { triangles: covered.triangles, crosses_itself });
    }
    let mut triangles = match uncross::uncross(points, outline.edges, watch)? {
        Some(arrangement) => {
            regions::triangulate(points, names, &arrangement, Rule::Parity, watch)?.triangles
        }
        None => vec![],
    };
    if triangles.is_empty() {
        triangles = fan(corners);
    }
    Ok(Triangulation { triangles, crosses_itself: true })
}

/// A polygon's distinct points and its edges.
struct Outline {
    points: Vec<Point>,
    /// For each point, a corner of the polygon there.
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

/// Triangles that fan out from the first corner: the last resort, for polygons of which nothing
/// else is left.
fn fan(corners: &[Point]) -> Vec<[u32; 3]> {
    let triangle = |k: usize| {
        let [a, b, c] = [0, k as u32, k as u32 + 1];
        match edge::area(corners[0], corners[k], corners[k + 1]).signum() {
            0 => None,
            1 => Some([a, b, c]),
            _ => Some([a, c, b]),
        }
    };
    (1..corners.len().saturating_sub(1)).filter_map(triangle).collect()
}
