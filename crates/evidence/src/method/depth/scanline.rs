//! Scan conversion by sums: an edge table, and increments from scanline to scanline and from pixel
//! to pixel.

use super::super::clip::Clipper;
use super::gradient::{Gradient, Sample};
use super::pass::Pass;
use crate::Precision;

/// An edge on the scanlines whose centres it crosses, with its x and value on the one at hand.
#[derive(Clone, Copy, Debug)]
struct Edge {
    first: u32,
    end: u32,
    x: f64,
    value: f64,
    /// What x and the value grow by from one scanline to the next.
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

/// The first pixel whose centre is at this coordinate or beyond, no more than `limit`.
fn index(coordinate: f64, limit: u32) -> u32 {
    (coordinate - 0.5).ceil().clamp(0.0, f64::from(limit)) as u32
}

/// Draws all faces, and returns the number of visible ones.
pub(super) fn draw<P: Precision>(pass: &mut Pass<'_, P>) -> usize {
    let mut clipper = Clipper::new(&pass.space, pass.range);
    let (mut samples, mut edges): (Vec<Sample>, Vec<Edge>) = (Vec::new(), Vec::new());
    let (mut active, mut drawn) = (Vec::new(), 0);
    for face in 0..pass.faces.len() as u32 {
        let outline = clipper.clip_face(&pass.space, pass.faces, face);
        if outline.is_empty() {
            continue;
        }
        samples.clear();
        samples.extend(outline.iter().map(|v| pass.scale.sample(&pass.space, v.at)));
        if pass.rays.is_front_only() && area(&samples) >= 0.0 {
            continue;
        }
        drawn += 1;
        let next = samples.iter().cycle().skip(1);
        let height = pass.frame.size()[1];
        edges.clear();
        edges.extend(samples.iter().zip(next).filter_map(|(&a, &b)| Edge::new::<P>(a, b, height)));
        edges.sort_unstable_by_key(|edge| edge.first);
        let slope = Gradient::<P>::new(&samples).along_x;
        fill(pass, face, slope, &edges, &mut active);
    }
    drawn
}

/// Twice the area that samples span: negative where they run counter-clockwise as one sees them.
fn area(samples: &[Sample]) -> f64 {
    let next = samples.iter().cycle().skip(1);
    samples.iter().zip(next).map(|(a, b)| a.x * b.y - b.x * a.y).sum()
}

/// Fills what lies between the edges of a face, given by their first scanlines.
fn fill<P: Precision>(
    pass: &mut Pass<'_, P>,
    face: u32,
    slope: f64,
    edges: &[Edge],
    active: &mut Vec<Edge>,
) {
    let [width, _] = pass.frame.size();
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
            let mut value = P::round(left.value + P::round(skip * slope));
            let scale = &pass.scale;
            pass.frame.put(y, first..end.max(first), face, |_| {
                let key = scale.key(value);
                value = P::round(value + slope);
                Some(key)
            });
        }
        for edge in active.iter_mut() {
            edge.x = P::round(edge.x + edge.step[0]);
            edge.value = P::round(edge.value + edge.step[1]);
        }
        y += 1;
    }
}
