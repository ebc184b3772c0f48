//! The common part of all walks along edges.

use super::super::clip::Clipper;
use super::gradient::Sample;
use super::pass::Pass;
use crate::Precision;

/// A way to fill a face given by its vertices on the picture.
pub(super) trait FaceWalk<P> {
    fn fill(&mut self, pass: &mut Pass<'_, P>, face: u32, samples: &[Sample]);
}

/// Draws all faces, and returns the number of visible ones.
pub(super) fn draw<P: Precision>(pass: &mut Pass<'_, P>, walk: &mut impl FaceWalk<P>) -> usize {
    let mut clipper = Clipper::new(&pass.space, pass.range);
    let (mut samples, mut drawn) = (Vec::<Sample>::new(), 0);
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
        walk.fill(pass, face, &samples);
    }
    drawn
}

/// The first pixel whose centre is at this coordinate or beyond, no more than `limit`.
pub(super) fn index(coordinate: f64, limit: u32) -> u32 {
    (coordinate - 0.5).ceil().clamp(0.0, f64::from(limit)) as u32
}

/// Twice the area of a polygon of samples. It is negative if the samples run counter-clockwise on the
/// picture.
fn area(samples: &[Sample]) -> f64 {
    let next = samples.iter().cycle().skip(1);
    samples.iter().zip(next).map(|(a, b)| a.x * b.y - b.x * a.y).sum()
}
