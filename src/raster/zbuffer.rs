//! The depth buffer (Catmull 1974): in each pixel the nearest face, whatever the order.

use std::cmp::Ordering;
use std::ops::Range;

use super::coverage::{Coverage, Outline};
use super::digits;
use super::exact::Plane;
use super::line::{ROUNDING, Seen};
use super::painter::{Image, Layers, NONE};
use super::rays::Rays;
use crate::exact::Faces;

/// Which face is nearest in each pixel, and how near it is.
#[derive(Clone, Debug)]
pub struct DepthImage {
    image: Image,
    /// 1/t for a perspective and −t for a parallel projection, where the ray meets the face after t
    /// times its direction: larger is nearer.
    nearness: Vec<f64>,
    unit: f64,
    perspective: bool,
}

impl DepthImage {
    /// The faces.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// The faces alone.
    pub fn into_image(self) -> Image {
        self.image
    }

    /// The depth of the face in each pixel, rounded, in world units, row by row from the top left;
    /// infinite where there is no face.
    ///
    /// Depth is measured along the direction in which the camera looks: from the eye, or, for
    /// parallel rays, from the plane through the middle of the scene; then it may have either sign.
    pub fn depths(&self) -> impl Iterator<Item = f64> {
        self.image.faces.iter().zip(&self.nearness).map(|(&face, &nearness)| {
            if face == NONE {
                f64::INFINITY
            } else if self.perspective {
                self.unit / nearness
            } else {
                -nearness * self.unit
            }
        })
    }
}

/// How near a face is, as a rounded linear function of the pixel, with a bound on its error.
#[derive(Clone, Copy)]
struct Nearness {
    k: [f64; 3],
    error: f64,
}

impl Nearness {
    fn new(seen: &Seen<'_>) -> Self {
        let sheet = &seen.sheet;
        let factor = if seen.rays.is_perspective() { -1.0 } else { 1.0 } / sheet.kappa;
        // φ is off by 12 roundings of its size, κ by 8 of its size; the quotient and the evaluation
        // add a few more. If κ is uncertain by a quarter, nothing is known.
        let uncertainty = 9.0 * ROUNDING * sheet.kappa_size / sheet.kappa.abs();
        let error = if uncertainty < 0.25 {
            sheet.phi_size * factor.abs() * (20.0 * ROUNDING + 2.0 * uncertainty)
        } else {
            f64::INFINITY
        };
        Self { k: sheet.phi.map(|c| c * factor), error }
    }

    fn at(&self, x: u32, y: u32) -> f64 {
        self.k[0] + f64::from(y) * self.k[2] + f64::from(x) * self.k[1]
    }
}

/// The nearest face in each pixel. Of faces at exactly the same distance, the later polygon's wins,
/// as if it had been painted over the earlier one.
///
/// # Panics
///
/// If the rays were made for another grid.
pub fn zbuffer(rays: &Rays, faces: &Faces) -> DepthImage {
    zbuffer_and(rays, faces, |_, _, _| {})
}

/// The nearest face in each pixel, and all that cover it.
pub(crate) fn zbuffer_layers(rays: &Rays, faces: &Faces) -> (DepthImage, Layers) {
    let mut layers = Layers::new(rays);
    let depth = zbuffer_and(rays, faces, |face, y, columns| layers.add(face, y, columns));
    (depth, layers)
}

/// Like [`zbuffer`]; calls `also` with each face, and a row and columns that it covers.
fn zbuffer_and(
    rays: &Rays,
    faces: &Faces,
    mut also: impl FnMut(u32, u32, Range<u32>),
) -> DepthImage {
    rays.expect(faces);
    let mut image = Image::new(rays.size());
    let mut nearness = vec![f64::NEG_INFINITY; image.faces.len()];
    let mut errors = vec![0.0f64; image.faces.len()];
    let width = rays.size()[0] as usize;
    for face in 0..faces.len() as u32 {
        let Some(coverage) = Coverage::new(rays, faces, face, Outline::Whole) else { continue };
        let near = Nearness::new(&coverage.seen);
        coverage.for_each_run(&mut |y, columns| {
            image.drawn += columns.len() as u64;
            also(face, y, columns.clone());
            for x in columns {
                let i = y as usize * width + x as usize;
                let value = near.at(x, y);
                // Rounded values decide if they differ by more than their errors; otherwise
                // integers.
                let doubt = errors[i] + near.error;
                let wins = if image.faces[i] == NONE || value - nearness[i] > doubt {
                    true
                } else if nearness[i] - value > doubt {
                    false
                } else {
                    is_drawn_over(rays, faces, face, image.faces[i], x, y)
                };
                if wins {
                    image.faces[i] = face;
                    nearness[i] = value;
                    errors[i] = near.error;
                }
            }
        });
    }
    DepthImage { image, nearness, unit: rays.depth_unit, perspective: rays.is_perspective() }
}

/// Whether a face hides another in a pixel: it is nearer, or as near and of the later polygon.
#[cold]
fn is_drawn_over(rays: &Rays, faces: &Faces, face: u32, other: u32, x: u32, y: u32) -> bool {
    let rank = |face| (faces.polygon(face), face);
    compare_nearness(rays, faces, face, other, x, y).then(rank(face).cmp(&rank(other))).is_gt()
}

/// Which of two faces the ray of a pixel meets first, exactly: `Greater` if it is the first.
///
/// Nearness is ∓φ/κ, so this is the sign of ∓(φ_a κ_b − φ_b κ_a), times the signs of both κ.
pub(super) fn compare_nearness(
    rays: &Rays,
    faces: &Faces,
    a: u32,
    b: u32,
    x: u32,
    y: u32,
) -> Ordering {
    let pixel = rays.pixel(x, y);
    let [a, b] = [a, b].map(|face| {
        let plane = Plane::of(faces, face);
        [plane.phi(pixel), plane.kappa(rays)]
    });
    let difference = digits::determinant([a.each_ref(), b.each_ref()]).sign();
    let flips = [a[1].sign().is_lt(), b[1].sign().is_lt(), rays.is_perspective()];
    let flipped = flips.into_iter().fold(false, |odd, flip| odd != flip);
    if flipped { difference.reverse() } else { difference }
}
