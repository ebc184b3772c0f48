//! Scan conversion by sums: an edge table, and increments from scanline to scanline and from pixel
//! to pixel.

use super::gradient::{Gradient, Sample};
use super::pass::Pass;
use super::walk::{FaceWalk, index};
use crate::Precision;

/// An edge on the scanlines whose centres it crosses, with its x and value on the current one.
#[derive(Clone, Copy, Debug)]
struct Edge {
    first: u32,
    end: u32,
    x: f64,
    value: f64,
    /// The increments of x and of the value from one scanline to the next.
    step: [f64; 2],
}

impl Edge {
    /// An edge in a picture of some height; `None` if it crosses no scanline's centre.
    fn new<P: Precision>(a: Sample, b: Sample, height: u32) -> Option<Self> {
        let (top, bottom) = if a.y <= b.y { (a, b) } else { (b, a) };
        let (first, end) = (index(top.y, height), index(bottom.y, height));
        if first >= end {
            return None;
        }
        let rise = P::round(bottom.y - top.y);
        let step = [bottom.x - top.x, bottom.value - top.value]
            .map(|difference| P::round(P::round(difference) / rise));
        let skip = P::round(f64::from(first) + 0.5 - top.y);
        let x = P::round(top.x + P::round(skip * step[0]));
        let value = P::round(top.value + P::round(skip * step[1]));
        Some(Self { first, end, x, value, step })
    }
}

/// The lists of a walk, which the next face reuses.
#[derive(Debug, Default)]
pub(super) struct Walk {
    edges: Vec<Edge>,
    active: Vec<Edge>,
}

impl<P: Precision> FaceWalk<P> for Walk {
    /// Fills the area between the edges of a face. Edges become active in the order of their first scanlines.
    fn fill(&mut self, pass: &mut Pass<'_, P>, face: u32, samples: &[Sample]) {
        let Self { edges, active } = self;
        let next = samples.iter().cycle().skip(1);
        let (width, height) = (pass.frame.width(), pass.frame.rows().end);
        let slope = Gradient::<P>::new(samples).along_x;
        edges.clear();
        edges.extend(samples.iter().zip(next).filter_map(|(&a, &b)| Edge::new::<P>(a, b, height)));
        edges.sort_unstable_by_key(|edge| edge.first);
        let mut waiting = edges.iter().peekable();
        active.clear();
        let mut y = edges.first().map_or(0, |edge| edge.first);
        loop {
            while let Some(edge) = waiting.next_if(|edge| edge.first <= y) {
                active.push(*edge);
            }
            active.retain(|edge| edge.end > y);
            if active.is_empty() && waiting.peek().is_none() {
                return;
            }
            active.sort_unstable_by(|a, b| a.x.total_cmp(&b.x));
            for pair in active.chunks_exact(2) {
                let (left, right) = (&pair[0], &pair[1]);
                let (first, end) = (index(left.x, width), index(right.x, width));
                let skip = P::round(f64::from(first) + 0.5 - left.x);
                let value = P::round(left.value + P::round(skip * slope));
                pass.put_run(y, first..end, face, value, slope);
            }
            for edge in active.iter_mut() {
                edge.x = P::round(edge.x + edge.step[0]);
                edge.value = P::round(edge.value + edge.step[1]);
            }
            y += 1;
        }
    }
}
