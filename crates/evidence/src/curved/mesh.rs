//! Patches cut to triangles without cracks.

use glam::DVec3;

use super::patch::Patch;
use crate::plain::{Corner, PlainView, UNITS};

/// A triangle on a patch: its corners' parameters and places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The parameters of the corners, from 0 to 1.
    pub parameters: [[f64; 2]; 3],
    /// The corners in world units.
    pub corners: [DVec3; 3],
}

/// A corner's parameters and its place.
type Vertex = ([f64; 2], DVec3);

/// Cuts a patch to triangles that are off by no more than about `tolerance` pixels.
///
/// The number of points along an edge of the patch, and these points, depend on the edge's own curve
/// alone, whichever way it runs: patches that share it fit together. Within, points are on a grid of
/// their own, and a strip joins them to the edges.
pub fn mesh(patch: &Patch, view: &PlainView, tolerance: f64) -> Vec<Triangle> {
    let net = &patch.0;
    let turned = turned(net);
    let count = grid_count(net, view, tolerance);
    let (rows, columns) = (count, count);
    let at = |i: u32, j: u32| -> Vertex {
        let [u, v] = [f64::from(i) / f64::from(rows), f64::from(j) / f64::from(columns)];
        ([u, v], DVec3::from_array(patch.at(u, v)))
    };
    let mut triangles = Vec::new();
    for (i, j) in (1..rows - 1).flat_map(|i| (1..columns - 1).map(move |j| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        triangles.extend([triangle([a, b, c]), triangle([a, c, d])]);
    }
    let inner_row = |i: u32| (1..columns).map(|j| at(i, j)).collect::<Vec<_>>();
    let inner_column = |j: u32| (1..rows).map(|i| at(i, j)).collect::<Vec<_>>();
    let edge = |line: [Corner; 4], place: &dyn Fn(f64) -> [f64; 2]| {
        edge_points(&line, view, tolerance).into_iter().map(|(t, p)| (place(t), p)).collect()
    };
    let sides: [(Vec<Vertex>, Vec<Vertex>, usize); 4] = [
        (edge(net[0], &|t| [0.0, t]), inner_row(1), 1),
        (edge(net[3], &|t| [1.0, t]), inner_row(rows - 1), 1),
        (edge(turned[0], &|t| [t, 0.0]), inner_column(1), 0),
        (edge(turned[3], &|t| [t, 1.0]), inner_column(columns - 1), 0),
    ];
    for (outer, inner, axis) in sides {
        join(&outer, &inner, axis, &mut triangles);
    }
    triangles
}

/// Joins two lines of points by triangles, along the parameter of an axis.
fn join(outer: &[Vertex], inner: &[Vertex], axis: usize, triangles: &mut Vec<Triangle>) {
    let (mut i, mut k) = (0, 0);
    while i + 1 < outer.len() || k + 1 < inner.len() {
        // The one goes on whose next point comes first.
        let next =
            |line: &[Vertex], at: usize| line.get(at + 1).map_or(f64::INFINITY, |v| v.0[axis]);
        if next(outer, i) <= next(inner, k) {
            triangles.push(triangle([outer[i], outer[i + 1], inner[k]]));
            i += 1;
        } else {
            triangles.push(triangle([outer[i], inner[k + 1], inner[k]]));
            k += 1;
        }
    }
}

fn triangle(vertices: [Vertex; 3]) -> Triangle {
    Triangle { parameters: vertices.map(|v| v.0), corners: vertices.map(|v| v.1) }
}

/// Points along an edge of a patch, with their parameters: the same whichever way it runs.
fn edge_points(line: &[Corner; 4], view: &PlainView, tolerance: f64) -> Vec<(f64, DVec3)> {
    let mut forward = *line;
    let flips = line[3] < line[0];
    if flips {
        forward.reverse();
    }
    let count = edge_count(&forward, view, tolerance);
    let points = (0..=count).map(|k| {
        let t = f64::from(k) / f64::from(count);
        (t, DVec3::from_array(on_curve(&forward, t)))
    });
    if flips { points.rev().map(|(t, p)| (1.0 - t, p)).collect() } else { points.collect() }
}

fn on_curve(line: &[Corner; 4], t: f64) -> [f64; 3] {
    let s = 1.0 - t;
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    std::array::from_fn(|i| {
        line.iter().zip(weights).map(|(p, w)| w * p[i] as f64 / UNITS).sum::<f64>()
    })
}

/// How many chords an edge needs to be within a quarter of a tolerance, in pixels, as the
/// strip along it errs as well: an eighth of the largest
/// second derivative over the square of their number.
fn edge_count(line: &[Corner; 4], view: &PlainView, tolerance: f64) -> u32 {
    let bend = (0..2).map(|k| 6.0 * second(line[k], line[k + 1], line[k + 2])).fold(0.0, f64::max);
    chords(4.0 * bend, line.iter(), view, tolerance)
}

fn turned(net: &[[Corner; 4]; 4]) -> [[Corner; 4]; 4] {
    std::array::from_fn(|i| std::array::from_fn(|j| net[j][i]))
}

/// How many rows and columns of a grid a patch needs: the largest second derivatives, the mixed one
/// twice, make up for an eighth of the error (Filip, Magedson & Markot 1986).
fn grid_count(net: &[[Corner; 4]; 4], view: &PlainView, tolerance: f64) -> u32 {
    let (mut bends, three) = ([0.0f64; 3], 0..3usize);
    for (bend, lines) in bends.iter_mut().zip([*net, turned(net)]) {
        let along =
            |line: [Corner; 4]| (0..2).map(move |k| second(line[k], line[k + 1], line[k + 2]));
        *bend = lines.into_iter().flat_map(along).fold(0.0, |most, c| most.max(6.0 * c));
    }
    for (i, j) in three.clone().flat_map(|i| three.clone().map(move |j| (i, j))) {
        let twist: [i64; 3] = std::array::from_fn(|n| {
            net[i][j][n] - net[i + 1][j][n] - net[i][j + 1][n] + net[i + 1][j + 1][n]
        });
        bends[2] = bends[2].max(9.0 * length(twist));
    }
    let bend = bends[0] + bends[1] + 2.0 * bends[2];
    chords(bend, net.iter().flatten(), view, tolerance).max(2)
}

/// The number n for which bend / (8 n²) is a tolerance in pixels, for the control points nearest to the
/// eye.
fn chords<'a>(
    bend: f64,
    points: impl Iterator<Item = &'a Corner>,
    view: &PlainView,
    tolerance: f64,
) -> u32 {
    let nearest = points.map(|p| -p[2]).min().unwrap_or(1).max(1) as f64;
    let pixel = 2.0 / view.ray([0, 0])[2].unsigned_abs() as f64;
    (bend / (nearest * pixel * 8.0 * tolerance)).sqrt().ceil().max(1.0) as u32
}

fn second(a: Corner, b: Corner, c: Corner) -> f64 {
    length(std::array::from_fn(|i| a[i] - 2 * b[i] + c[i]))
}

fn length(vector: [i64; 3]) -> f64 {
    vector.map(|c| (c * c) as f64).iter().sum::<f64>().sqrt()
}
