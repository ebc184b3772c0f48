//! How far wrongly painted faces lie behind the ones that should show.

use super::compare_pictures::{Comparison, Verdict};
use super::coverage::Coverage;
use super::exact::{Plane, determinant};
use super::image::Image;
use super::piece::Outline;
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
pub fn depth_error(
    rays: &Rays,
    faces: &Faces,
    painted: &Image,
    truth: &Image,
    comparison: &Comparison,
) -> DepthError {
    let width = rays.size()[0] as usize;
    let mut result = DepthError::default();
    let pixels = painted.faces().iter().zip(truth.faces()).zip(&comparison.verdicts).enumerate();
    for (i, ((&shown, &nearest), &verdict)) in pixels {
        let (x, y) = ((i % width) as u32, (i / width) as u32);
        let is_met = || {
            let coverage = Coverage::new(rays, faces, shown, Outline::Whole);
            coverage.is_some_and(|coverage| coverage.covers(x, y))
        };
        if verdict == Verdict::WrongOrder && is_met() {
            let depth = difference(rays, faces, shown, nearest, x, y);
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
fn difference(rays: &Rays, faces: &Faces, p: u32, q: u32, x: u32, y: u32) -> f64 {
    let [p, q] = [p, q].map(|face| Plane::of(faces, face));
    let pixel = rays.pixel(x, y);
    let divisor = |plane: &Plane| {
        let value = if rays.is_perspective() { plane.phi(pixel) } else { plane.kappa(rays) };
        value.to_f64()
    };
    let steps = determinant(rays, &p, &q, pixel).to_f64() / divisor(&p) / divisor(&q);
    (steps * rays.depth_unit).abs()
}
