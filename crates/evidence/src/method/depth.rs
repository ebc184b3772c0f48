//! The depth buffer of hardware and textbooks, with limited precision.

mod format;
mod frame;
pub(super) mod gradient;
mod integer_edges;
mod layered;
mod options;
mod pass;
mod precision;
mod range;
mod rules;
mod scanline;
mod trapezoids;
mod unstored;
mod walk;
mod whole;

use std::time::{Duration, Instant};

use self::whole::Whole;
use super::space::CameraSpace;
use super::{Method, MethodError, Painted, Prepared, Space};
use crate::Precision;
use binspace::internals::Faces;
use binspace::raster::{Image, NONE, Rays};
use binspace::view::Camera;

pub use self::format::{DepthFormat, Interpolation};
pub use self::layered::{Layered, Layers};
pub use self::options::{DepthBuffer, Sections};
pub use self::precision::Stored;
pub use self::rules::{Clear, DepthRules, DepthTest, Nearer};
pub use self::unstored::{SetUp, Unstored};

impl Method for DepthBuffer {
    fn name(&self) -> String {
        let mut name = self.format.to_string();
        name += match self.interpolation {
            Interpolation::EdgeFunctions => "",
            Interpolation::Incremental => " incremental",
            Interpolation::Trapezoids => " trapezoids",
            Interpolation::IntegerEdges => " integer edges",
        };
        let rules = self.rules;
        if rules.nearer == Nearer::Larger {
            name += " larger nearer";
        }
        if matches!(rules.test, DepthTest::LessOrEqual | DepthTest::GreaterOrEqual) {
            name += " or equal";
        }
        if rules.clear != Clear::Nothing {
            name += " cleared";
        }
        for (label, value) in [("near", self.near), ("far", self.far)] {
            if let Some(value) = value {
                name += &format!(" {label} {value:e}");
            }
        }
        name
    }

    fn space(&self) -> Space {
        Space::Image
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        Ok(Box::new(Ready { method: self, faces, keys: Vec::new(), bytes: 0 }))
    }
}

struct Ready<'a> {
    method: &'a DepthBuffer,
    faces: &'a Faces,
    /// The stored depths of each thread; the next picture reuses their memory.
    keys: Vec<Vec<u32>>,
    bytes: usize,
}

impl Prepared for Ready<'_> {
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        if self.method.format.is_float() {
            self.paint_in::<f32>(camera, rays)
        } else {
            self.paint_in::<f64>(camera, rays)
        }
    }

    fn bytes(&self) -> usize {
        self.bytes
    }
}

impl Ready<'_> {
    fn paint_in<P: Precision>(
        &mut self,
        camera: &Camera,
        rays: &Rays,
    ) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        let space = CameraSpace::new(camera, self.faces.lattice());
        let [width, height] = space.size;
        let mut faces = vec![NONE; width as usize * height as usize];
        let (mut pieces, mut drawn) = (0, 0);
        if let Some(range) = range::of([self.method.near, self.method.far], &space, self.faces)? {
            let picture = Whole { method: self.method, space, range, faces: self.faces, rays };
            (pieces, drawn) = picture.draw::<P>(&mut faces, &mut self.keys);
            // A depth and a face for each pixel of the largest section, for each thread.
            let rows = self.method.sections.map_or(height, |s| s.rows.clamp(1, height));
            self.bytes = self.keys.len() * (width * rows) as usize * 2 * size_of::<u32>();
        }
        let image = Image::from_faces(space.size, faces, drawn);
        Ok(Painted { image, order: Duration::ZERO, draw: begin.elapsed(), pieces, removed: 0 })
    }
}
