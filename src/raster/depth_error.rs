//! How far wrongly painted faces lie behind the ones that should show.

use super::compare_pictures::{Comparison, LastPair, Verdict};
use super::coverage::{Coverage, Outline};
use super::exact::PlanePair;
use super::image::Image;
use super::rays::Rays;
use crate::exact::Faces;

/// How far behind the nearest polygon the painted ones are; see [`depth_error`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DepthError {
    /// Wrong pixels in which the painted face is met at all.
    pub pixels: usize,
    /// The largest difference of depths, in world units along the direction of view.
    pub max: f64,
    /// The sum of the differences of all these pixels.
    pub sum: f64,
}

/// The difference in depth between the painted face and the nearest, over the pixels with the
/// verdict [wrong order](Verdict::WrongOrder). Pixels whose ray does not meet the painted face at
/// all are left out.
///
/// # Panics
///
/// If the rays were made for another grid.
pub fn depth_error(
    rays: &Rays,
    faces: &Faces,
    painted: &Image,
    truth: &Image,
    comparison: &Comparison,
) -> DepthError {
    rays.expect(faces);
    let width = rays.size()[0] as usize;
    let mut result = DepthError::default();
    let mut pairs = LastPair::new(rays, faces);
    let mut last = None;
    let pixels = painted.faces().iter().zip(truth.faces()).zip(&comparison.verdicts).enumerate();
    for (i, ((&shown, &nearest), &verdict)) in pixels {
        if verdict != Verdict::WrongOrder {
            continue;
        }
        let (x, y) = ((i % width) as u32, (i / width) as u32);
        // The same face mostly shows in the next wrong pixel, too.
        let (_, coverage) = last
            .take()
            .filter(|&(face, _)| face == shown)
            .unwrap_or_else(|| (shown, Coverage::new(rays, faces, shown, Outline::Whole)));
        let is_met = coverage.as_ref().is_some_and(|coverage| coverage.covers(x, y));
        last = Some((shown, coverage));
        if is_met {
            let pair = pairs.of([shown, nearest]);
            let depth = difference(rays, pair, x, y);
            result.pixels += 1;
            result.max = result.max.max(depth);
            result.sum += depth;
        }
    }
    result
}

/// The distance along the ray of a pixel between its points on two planes. The points are at −κ/φ
/// for a perspective, at −φ/κ for parallel rays; they are subtracted exactly before anything is
/// rounded.
fn difference(rays: &Rays, pair: &PlanePair, x: u32, y: u32) -> f64 {
    let at = pair.at(rays.pixel(x, y));
    let [p, q] = pair.divisors(rays, &at);
    (at.determinant.to_f64() / p / q * rays.depth_unit).abs()
}
