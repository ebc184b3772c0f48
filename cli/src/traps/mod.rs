//! Traps: what keeps the background out of the seams between neighbours.
//!
//! Viewers blend each path with what is below it, so that along an edge of two polygons that both cover
//! half of a pixel a quarter of the background shows. Printers solve the same by trapping: the lower of
//! the two reaches a little way under the upper one. What is added lies inside of the upper one, which
//! is opaque and painted later, so that it is not seen but where they meet.

mod grid;
mod strip;

use binspace::drawing::Path;

use grid::{Grid, Side};
use strip::{Frame, strip};

/// A closed outline, in pixels.
pub(crate) type Outline = Vec<[f64; 2]>;

/// The outlines of paths that are painted one after another, each extended under later neighbours.
///
/// Only under convex ones; and what is an edge of just one polygon in the picture stays as it is.
pub(crate) fn trapped(paths: &[Path<'_>], size: [u32; 2]) -> Vec<Vec<Outline>> {
    let convex: Vec<Option<&[[f64; 2]]>> = paths.iter().map(convex).collect();
    let mut grid = Grid::new(size, convex.iter().flatten().map(|outline| outline.len()).sum());
    for (path, outline) in convex.iter().enumerate() {
        let Some(outline) = outline else { continue };
        sides(outline).for_each(|ends| grid.add(Side { path, ends }));
    }
    let mut near = Vec::new();
    let mut extended = |(number, path): (usize, &Path<'_>)| {
        let turn = path.outlines().map(double_area).sum::<f64>().signum();
        let outlines = path.outlines().map(|outline| {
            let mut ring = Outline::new();
            for ends in sides(outline) {
                ring.push(ends[0]);
                let Some(frame) = Frame::outside_of(ends, turn) else { continue };
                grid.near(ends, number, &mut near);
                extend(&mut ring, &frame, &near, &convex);
            }
            ring
        });
        outlines.collect()
    };
    paths.iter().enumerate().map(&mut extended).collect()
}

/// Adds to a ring what a side of it is extended by, under the neighbours whose sides are near.
fn extend(ring: &mut Outline, frame: &Frame, near: &[Side], convex: &[Option<&[[f64; 2]]>]) {
    let mut strips: Vec<Outline> = Vec::new();
    for sides in near.chunk_by(|a, b| a.path == b.path) {
        let along = sides.iter().filter_map(|side| frame.along(side.ends));
        let hull = along.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        if let (Some(hull), Some(outline)) = (hull, convex[sides[0].path]) {
            strips.extend(strip(frame, hull, outline));
        }
    }
    // In local coordinates, each from its lower to its upper end along the side.
    strips.sort_by(|a, b| a[0][0].total_cmp(&b[0][0]));
    ring.extend(strips.iter().flatten().map(|&point| frame.world(point)));
}

/// The outline of a path, if it is the only one, and convex.
fn convex<'d>(path: &Path<'d>) -> Option<&'d [[f64; 2]]> {
    let mut outlines = path.outlines();
    let (first, None) = (outlines.next()?, outlines.next()) else { return None };
    let turn = double_area(first).signum();
    let n = first.len();
    let is_convex = (0..n).all(|i| {
        let [a, b, c] = [0, 1, 2].map(|k| first[(i + k) % n]);
        turn * cross([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]) >= 0.0
    });
    is_convex.then_some(first)
}

fn sides(outline: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> {
    (0..outline.len()).map(|i| [outline[i], outline[(i + 1) % outline.len()]])
}

fn double_area(outline: &[[f64; 2]]) -> f64 {
    sides(outline).map(|[a, b]| cross(a, b)).sum()
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
