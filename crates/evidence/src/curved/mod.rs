//! Curved surfaces in a depth buffer, each by its own routine, and triangulated for the tree.

mod cast;
mod mesh;
mod nearest;
mod patch;
mod sphere;
#[cfg(test)]
mod tests;

pub use cast::Cast;
pub use mesh::{Triangle, mesh};
pub use nearest::{Surfaces, nearest};
pub use patch::Patch;
pub use sphere::Sphere;

use binspace::internals::Faces;
use binspace::raster::{NONE, Rays, zbuffer};

use crate::plain::PlainView;

/// A depth buffer that polygons and curved surfaces share.
#[derive(Clone, Debug)]
pub struct Shared {
    pub(crate) width: u32,
    /// The depth in each pixel, in world units; infinite in empty pixels.
    pub(crate) depths: Vec<f64>,
    /// The surface in each pixel, [`NONE`] in empty pixels.
    pub(crate) shown: Vec<u32>,
}

impl Shared {
    /// Draws polygons by the library's routine. They keep their numbers.
    pub fn new(rays: &Rays, faces: &Faces) -> Self {
        let depth = zbuffer(rays, faces);
        let number = |&face: &u32| if face == NONE { NONE } else { faces.polygon(face) as u32 };
        let shown = depth.image().faces().iter().map(number).collect();
        Self { width: rays.size()[0], depths: depth.depths().collect(), shown }
    }

    /// Shows a surface in a pixel if it is nearer.
    pub(crate) fn put(&mut self, [x, y]: [u32; 2], depth: f64, number: u32) {
        let i = (y * self.width + x) as usize;
        if depth < self.depths[i] {
            (self.depths[i], self.shown[i]) = (depth, number);
        }
    }

    /// Returns the surface in each pixel, row by row from the top left; [`NONE`] in empty pixels.
    pub fn shown(&self) -> &[u32] {
        &self.shown
    }

    /// Returns the depth in each pixel; infinite in empty pixels.
    pub fn depths(&self) -> &[f64] {
        &self.depths
    }
}

/// The slopes of a pixel's ray.
fn slopes(view: &PlainView, pixel: [u32; 2]) -> [f64; 2] {
    let [x, y, z] = view.ray(pixel);
    [x, y].map(|c| c as f64 / -z as f64)
}
