//! Polygons, a sphere and patches together, and the surface that is certainly nearest.

use super::{Cast, Patch, Shared, Sphere};
use crate::plain::{Corner, PlainView};
use binspace::raster::NONE;

/// Surfaces, numbered in this order: the polygons, the sphere, the patches.
#[derive(Clone, Copy, Debug)]
pub struct Surfaces<'a> {
    /// Polygons of integer corners.
    pub polygons: &'a [Vec<Corner>],
    /// A sphere.
    pub sphere: Sphere,
    /// Patches.
    pub patches: &'a [Patch],
}

impl Surfaces<'_> {
    /// Draws the sphere and the patches, each by its own routine, into a picture that already shows the
    /// polygons.
    pub fn draw(&self, view: &PlainView, picture: &mut Shared) {
        let sphere = self.polygons.len() as u32;
        self.sphere.draw(view, sphere, picture);
        for (number, patch) in (sphere + 1..).zip(self.patches) {
            patch.draw(view, number, picture);
        }
    }
}

/// Returns the number of the surface that a pixel's ray certainly meets first. Returns [`NONE`] if the ray
/// certainly meets no surface, and `None` if the result is uncertain. The sphere against polygons is decided
/// exactly; patches are known by intervals of depth.
pub fn nearest(surfaces: &Surfaces<'_>, view: &PlainView, pixel: [u32; 2]) -> Option<u32> {
    let sphere = &surfaces.sphere;
    let layers = view.layers(surfaces.polygons, pixel)?;
    let number = surfaces.polygons.len() as u32;
    let mut first = layers.first().map(|&(number, depth)| (number, [depth.to_f64(); 2]));
    if sphere.is_met(view, pixel) {
        let is_before = |depth| sphere.compare(view, pixel, depth).is_lt();
        if layers.first().is_none_or(|(_, depth)| is_before(depth)) {
            first = Some((number, [sphere.depth(view, pixel); 2]));
        }
    }
    for (number, patch) in (number + 1..).zip(surfaces.patches) {
        let [low, high] = match Cast::new(patch, view, pixel) {
            Cast::Misses => continue,
            Cast::Doubtful => return None,
            Cast::Meets(depths) => depths,
        };
        match first {
            Some((_, [_, last])) if last < low - ROUNDING => {}
            Some((_, [before, _])) if before <= high + ROUNDING => return None,
            _ => first = Some((number, [low, high])),
        }
    }
    Some(first.map_or(NONE, |(number, _)| number))
}

/// Far more than the rounding of depths in `f64`.
const ROUNDING: f64 = 1e-9;
