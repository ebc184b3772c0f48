//! Traps: what keeps the background out of the seams between neighbours.
//!
//! Viewers blend each path with what is below it, so that along an edge of two polygons that both cover
//! half of a pixel a quarter of the background shows. Printers solve the same by trapping: the lower of
//! the two reaches a little way under the upper one. What is added lies inside of the upper one, which
//! is opaque and painted later, so that it is not seen but where they meet.

mod grid;
mod part;
mod strip;

use binspace::drawing::Path;

use grid::{Grid, Side};
use part::parts_of;
use strip::{Frame, strip};

/// A closed outline, in pixels.
pub(crate) type Outline = Vec<[f64; 2]>;

/// The outlines of paths that are painted one after another: opaque ones are extended under later opaque
/// neighbours, others are as they are.
///
/// What is an edge of just one polygon in the picture stays as it is.
pub(crate) fn trapped(
    paths: &[Path<'_>],
    size: [u32; 2],
    is_opaque: impl Fn(usize) -> bool,
) -> Vec<Vec<Outline>> {
    let corners = paths.iter().flat_map(|path| path.outlines()).map(<[_]>::len).sum();
    let mut grid = Grid::new(size, corners);
    let mut parts: Vec<Outline> = Vec::new();
    for (number, path) in paths.iter().enumerate().filter(|&(number, _)| is_opaque(number)) {
        for (part, sides) in parts_of(path) {
            for ends in sides {
                grid.add(Side { path: number, part: parts.len(), ends });
            }
            parts.push(part);
        }
    }
    let mut near = Vec::new();
    let mut extended = |(number, path): (usize, &Path<'_>)| {
        if !is_opaque(number) {
            return path.outlines().map(<[_]>::to_vec).collect();
        }
        let turn = path.outlines().map(double_area).sum::<f64>().signum();
        let outlines = path.outlines().map(|outline| {
            let mut ring = Outline::new();
            for ends in sides(outline) {
                ring.push(ends[0]);
                let Some(frame) = Frame::outside_of(ends, turn) else { continue };
                grid.near(ends, number, &mut near);
                extend(&mut ring, &frame, &near, &parts);
            }
            ring
        });
        outlines.collect()
    };
    paths.iter().enumerate().map(&mut extended).collect()
}

/// Adds to a ring what a side of it is extended by, under the neighbours whose sides are near.
fn extend(ring: &mut Outline, frame: &Frame, near: &[Side], parts: &[Outline]) {
    let mut strips: Vec<Outline> = Vec::new();
    for sides in near.chunk_by(|a, b| a.part == b.part) {
        strips.extend(strip(frame, &parts[sides[0].part]));
    }
    // In local coordinates, each from its lower to its upper end along the side.
    strips.sort_by(|a, b| a[0][0].total_cmp(&b[0][0]));
    ring.extend(strips.iter().flatten().map(|&point| frame.world(point)));
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
