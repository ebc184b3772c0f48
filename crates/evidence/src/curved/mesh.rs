//! Divides patches into triangles without cracks.

use std::collections::BTreeMap;

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

/// Divides patches into triangles whose error is at most `tolerance` pixels; returns a list for each patch.
///
/// Each patch has its own grid. An edge has as many points as the finer of its two patches needs. These
/// points depend only on the curve of the edge, and not on its direction, so patches fit together. A strip
/// joins a patch's grid to its edges.
pub fn mesh(patches: &[Patch], view: &PlainView, tolerance: f64) -> Vec<Vec<Triangle>> {
    let mut counts = Counts::new();
    for patch in patches {
        let count = grid_count(&patch.0, view, tolerance);
        let across = turned(&patch.0);
        for line in [patch.0[0], patch.0[3], across[0], across[3]] {
            let most = counts.entry(directed(line).0).or_default();
            *most = count.max(*most);
        }
    }
    let cut = |patch| triangles_of(patch, grid_count(&patch.0, view, tolerance), &counts);
    patches.iter().map(cut).collect()
}

/// The number of chords of each edge, by its control points.
type Counts = BTreeMap<[Corner; 4], u32>;

/// The triangles of a patch with a grid of `count` rows and columns.
fn triangles_of(patch: &Patch, count: u32, counts: &Counts) -> Vec<Triangle> {
    let net = &patch.0;
    let turned = turned(net);
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
        edge_points(line, counts).into_iter().map(|(t, p)| (place(t), p)).collect()
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
        // Advances the side whose next point comes first.
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

/// An edge in its canonical direction, and whether it was reversed for this.
fn directed(mut line: [Corner; 4]) -> ([Corner; 4], bool) {
    let flips = line[3] < line[0];
    if flips {
        line.reverse();
    }
    (line, flips)
}

/// Points along an edge of a patch, with their parameters. They are the same for both directions of the edge.
fn edge_points(line: [Corner; 4], counts: &Counts) -> Vec<(f64, DVec3)> {
    let (line, flips) = directed(line);
    let count = counts[&line];
    let points = (0..=count).map(|k| {
        let t = f64::from(k) / f64::from(count);
        (t, DVec3::from_array(on_curve(&line, t)))
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

fn turned(net: &[[Corner; 4]; 4]) -> [[Corner; 4]; 4] {
    std::array::from_fn(|i| std::array::from_fn(|j| net[j][i]))
}

/// The numbers of rows and columns that a patch needs. If the parameters of a triangle differ by 1 / n, its
/// error is at most the sum of the largest second derivatives, the mixed one taken twice, divided by 8 n²
/// (Filip, Magedson & Markot 1986).
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

/// The number n for which bend / (8 n²) equals the tolerance. The tolerance is in pixels at the depth of the
/// control point nearest to the eye.
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
