//! Scan conversion by trapezoids, with the sums of textbooks.

use super::gradient::{Gradient, Sample};
use super::pass::Pass;
use super::walk::{FaceWalk, index};
use crate::Precision;

/// An edge between two scanlines, the second excluded.
#[derive(Clone, Copy, Debug)]
struct Edge {
    first: u32,
    end: u32,
    top: Sample,
    /// 1/m: the increment of x from one scanline to the next; 0 if the edge is vertical.
    step: f64,
}

impl Edge {
    /// `None` if no scanline's centre is crossed.
    fn new<P: Precision>(a: Sample, b: Sample, height: u32) -> Option<Self> {
        let (top, bottom) = if a.y <= b.y { (a, b) } else { (b, a) };
        let (first, end) = (index(top.y, height), index(bottom.y, height));
        let [run, rise] = [bottom.x - top.x, bottom.y - top.y].map(P::round);
        (first < end).then(|| Self { first, end, top, step: P::round(run / rise) })
    }

    /// The x of the edge on a scanline.
    fn x<P: Precision>(&self, y: u32) -> f64 {
        let skip = P::round(f64::from(y) + 0.5 - self.top.y);
        P::round(self.top.x + P::round(skip * self.step))
    }
}

/// Nothing is kept from one face to the next.
#[derive(Debug)]
pub(super) struct Walk;

impl<P: Precision> FaceWalk<P> for Walk {
    fn fill(&mut self, pass: &mut Pass<'_, P>, face: u32, samples: &[Sample]) {
        let height = pass.frame.rows().end;
        let next = samples.iter().cycle().skip(1);
        let edges: Vec<Edge> =
            samples.iter().zip(next).filter_map(|(&a, &b)| Edge::new::<P>(a, b, height)).collect();
        let mut heights: Vec<u32> = edges.iter().flat_map(|edge| [edge.first, edge.end]).collect();
        heights.sort_unstable();
        heights.dedup();
        let plane = Gradient::<P>::new(samples);
        for pair in heights.windows(2) {
            let (first, end) = (pair[0], pair[1]);
            let mut sides = edges.iter().filter(|edge| edge.first <= first && edge.end >= end);
            // The picture of a convex face has two edges there. If rounding leaves only one, the face is a
            // line.
            let (Some(a), Some(b)) = (sides.next(), sides.next()) else { continue };
            let middle = |edge: &Edge| edge.x::<P>(first) + edge.x::<P>(end - 1);
            let [left, right] = if middle(a) <= middle(b) { [a, b] } else { [b, a] };
            fill_trapezoid(pass, face, &plane, [left, right], first..end);
        }
    }
}

/// Fills the rows between two edges.
fn fill_trapezoid<P: Precision>(
    pass: &mut Pass<'_, P>,
    face: u32,
    plane: &Gradient<P>,
    [left, right]: [&Edge; 2],
    rows: std::ops::Range<u32>,
) {
    let width = pass.frame.width();
    let [mut from, mut to] = [left, right].map(|edge| edge.x::<P>(rows.start));
    let mut value = plane.at_x(plane.row(rows.start), from);
    // −(A/m + B)/C; a vertical edge has 1/m = 0.
    let down = P::round(P::round(plane.along_x * left.step) + plane.along_y);
    for y in rows {
        let (first, end) = (index(from, width), index(to, width));
        let skip = P::round(f64::from(first) + 0.5 - from);
        let start = P::round(value + P::round(skip * plane.along_x));
        pass.put_run(y, first..end, face, start, plane.along_x);
        from = P::round(from + left.step);
        to = P::round(to + right.step);
        value = P::round(value + down);
    }
}
