//! Scan conversion with edges in integers.

use std::ops::Range;

use super::gradient::{Gradient, Sample};
use super::pass::Pass;
use super::walk::FaceWalk;
use crate::Precision;

/// The number of parts of a pixel to which vertices are rounded. Too large: coordinates of wide pictures need
/// more than 32 bits in hardware. Too small: edges move, and neighbours of different slopes show gaps.
const PARTS: i64 = 256;

/// Nothing is kept from one face to the next.
#[derive(Debug)]
pub(super) struct Walk;

impl<P: Precision> FaceWalk<P> for Walk {
    fn fill(&mut self, pass: &mut Pass<'_, P>, face: u32, samples: &[Sample]) {
        let part = |c: f64| (c * PARTS as f64).round() as i64;
        let points: Vec<[i64; 2]> = samples.iter().map(|s| [part(s.x), part(s.y)]).collect();
        let plane = Gradient::<P>::new(samples);
        let size = [pass.frame.width(), pass.frame.rows().end];
        for_each_run(&points, size, |y, columns| {
            let value = plane.at(plane.row(y), columns.start);
            pass.put_run(y, columns, face, value, plane.along_x);
        });
    }
}

/// An edge on the scanlines whose centres it crosses. On the current scanline, `column` is the first pixel
/// whose centre is on the edge or to the right of it. `rest / unit` is the distance of this centre from the
/// edge in pixels, from 0 up to but not including 1.
#[derive(Clone, Copy, Debug)]
struct Edge {
    first: i64,
    end: i64,
    column: i64,
    rest: i64,
    /// The step of the edge from one scanline to the next: pixels, and parts of 1 / rise.
    step: [i64; 2],
    unit: i64,
}

impl Edge {
    fn new(a: [i64; 2], b: [i64; 2]) -> Option<Self> {
        let ([x, y], [end_x, end_y]) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        let [first, end] = [y, end_y].map(|y| ceil(y - PARTS / 2, PARTS));
        if first >= end {
            return None;
        }
        let (run, rise) = (end_x - x, end_y - y);
        // The place on the first scanline, in rise × PARTS parts of a pixel from the first centre.
        let place = (x - PARTS / 2) * rise + (first * PARTS + PARTS / 2 - y) * run;
        let unit = rise * PARTS;
        let column = ceil(place, unit);
        let whole = run.div_euclid(rise);
        let step = [whole, run - whole * rise];
        Some(Self { first, end, column, rest: column * unit - place, step, unit })
    }

    /// Advances to the next scanline.
    fn advance(&mut self) {
        self.column += self.step[0];
        self.rest -= self.step[1] * PARTS;
        if self.rest < 0 {
            self.column += 1;
            self.rest += self.unit;
        }
    }
}

/// Calls `visit` with the row and the columns of all pixels whose centres are within a convex polygon, on its
/// left boundary, or on its upper boundary.
fn for_each_run(points: &[[i64; 2]], size: [u32; 2], mut visit: impl FnMut(u32, Range<u32>)) {
    let [width, height] = size.map(i64::from);
    let next = points.iter().cycle().skip(1);
    let mut edges: Vec<Edge> =
        points.iter().zip(next).filter_map(|(&a, &b)| Edge::new(a, b)).collect();
    let first = edges.iter().map(|edge| edge.first).min().unwrap_or(0);
    let end = edges.iter().map(|edge| edge.end).max().unwrap_or(0).min(height);
    for y in first..end {
        let (mut low, mut high) = (i64::MAX, i64::MIN);
        for edge in edges.iter_mut().filter(|edge| (edge.first..edge.end).contains(&y)) {
            (low, high) = (low.min(edge.column), high.max(edge.column));
            edge.advance();
        }
        let (low, high) = (low.max(0), high.min(width));
        if y >= 0 && low < high {
            visit(y as u32, low as u32..high as u32);
        }
    }
}

/// The quotient, rounded up; `b` is above 0.
fn ceil(a: i64, b: i64) -> i64 {
    -(-a).div_euclid(b)
}

#[cfg(test)]
mod tests {
    use super::{PARTS, for_each_run};
    use binspace::internals::SplitMix64;

    /// Whether the centre of a pixel is in a triangle, by the signs of three products.
    fn is_inside(points: &[[i64; 2]; 3], [x, y]: [i64; 2]) -> bool {
        let centre = [x, y].map(|c| c * PARTS + PARTS / 2);
        let area = |[a, b, c]: [[i64; 2]; 3]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let turn = area(*points).signum();
        turn != 0
            && (0..3).all(|k| {
                let (a, b) = (points[k], points[(k + 1) % 3]);
                let [run, rise] = [b[0] - a[0], b[1] - a[1]].map(|d| d * turn);
                // With y down and this orientation, the inside is to the right of a rising edge.
                let on_left_or_top = rise < 0 || rise == 0 && run > 0;
                let side = area([a, b, centre]) * turn;
                side > 0 || side == 0 && on_left_or_top
            })
    }

    #[test]
    fn runs_are_all_pixels_whose_centres_are_inside() {
        let mut random = SplitMix64::new(4);
        let mut covered = 0;
        for round in 0..3000 {
            // Every second triangle is on a coarse grid, so that centres of pixels are on edges.
            let grid = if round % 2 == 0 { 1 } else { PARTS / 2 };
            let mut point = || {
                let p = random.point(-1.0, 1.0) * 12.0 * PARTS as f64;
                [p.x, p.y].map(|c| (c as i64 + 8 * PARTS) / grid * grid)
            };
            let points = [point(), point(), point()];
            let mut shown = vec![false; 16 * 16];
            for_each_run(&points, [16, 16], |y, columns| {
                columns.for_each(|x| shown[(y * 16 + x) as usize] = true);
            });
            for (i, &shown) in (0..).zip(&shown) {
                let pixel = [i % 16, i / 16];
                assert_eq!(shown, is_inside(&points, pixel), "{points:?} {pixel:?}");
                covered += usize::from(shown);
            }
        }
        assert!(covered > 50_000, "{covered}");
    }
}
