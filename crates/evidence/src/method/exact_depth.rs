//! The exact depth buffer, which judges all methods, as one of the methods.

use std::time::{Duration, Instant};

use super::{Method, MethodError, Painted, Prepared, Space};
use binspace::internals::Faces;
use binspace::raster::{Rays, zbuffer};
use binspace::view::Camera;

/// The depth buffer of [`zbuffer`]: depths in `f64`, and exact arithmetic in pixels where two depths differ
/// by less than their rounding.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExactDepth;

impl Method for ExactDepth {
    fn name(&self) -> String {
        "z f64".into()
    }

    fn space(&self) -> Space {
        Space::Image
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        Ok(Box::new(Ready { faces, bytes: 0 }))
    }
}

struct Ready<'a> {
    faces: &'a Faces,
    bytes: usize,
}

impl Prepared for Ready<'_> {
    fn paint(&mut self, _: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        let depth = zbuffer(rays, self.faces);
        let image = depth.into_image();
        // A face, a depth and its error.
        self.bytes = image.faces().len() * (size_of::<u32>() + 2 * size_of::<f64>());
        let (order, draw) = (Duration::ZERO, begin.elapsed());
        Ok(Painted { image, order, draw, pieces: self.faces.len(), removed: 0 })
    }

    fn bytes(&self) -> usize {
        self.bytes
    }
}
