//! The depth buffer as hardware and textbooks have it.

mod format;
mod frame;
mod gradient;
mod range;
mod scanline;

use std::time::{Duration, Instant};

use self::format::Scale;
use self::frame::Frame;
use self::gradient::{Gradient, Sample};
use super::clip::{Clipper, Range};
use super::space::{CameraSpace, Vertex};
use super::{Method, MethodError, Painted, Prepared};
use crate::geom::{Faces, Precision};
use crate::raster::{Outline, Piece, Rays, for_each_run};
use crate::view::Camera;

pub use self::format::{DepthFormat, Interpolation};

/// The depth buffer (Catmull 1974) with depths of limited precision.
///
/// A pixel shows the face of the least stored depth. Of equal stored depths the *earlier* face's
/// counts (the test `LESS` of graphics libraries); a pixel without a face is beyond any depth.
///
/// # What is rounded
///
/// Corners are placed in the camera's coordinates and clipped to the picture and to the range of
/// depths in `f64`. From there on, with R the rounding of each single operation, which is to `f32`
/// for the floating-point formats and to `f64` for the integer ones:
///
/// 1. the place, to x, y and the depth w: one R each;
/// 2. the position on the picture: x / (w · pixel) + half the width, y likewise;
/// 3. what is interpolated. Perspective: (a · w + b) / w with a and b from near and far as graphics
///    libraries have them, and for w-buffers 1 / w. Parallel: (w − near) / (far − near);
/// 4. the slopes −A/C and −B/C of the plane Ax + By + Cz + D = 0 through three of these points: of a
///    face of more corners, the first and two neighbours that span the most;
/// 5. the value in a pixel, by the way of [`Interpolation`];
/// 6. what is stored: see [`DepthFormat`].
///
/// So an integer format errs by its steps alone, as with interpolators that are wide enough, while
/// the floating-point formats err as a pipeline of `f32` does. (Such a pipeline errs more in 1, as
/// it multiplies matrices in `f32` as well, and has positions of fewer bits in 2.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthBuffer {
    /// What is stored.
    pub format: DepthFormat,
    /// How it comes from the corners to the pixels.
    pub interpolation: Interpolation,
    /// The least depth that is shown, in world units along the direction of view, from the eye, or
    /// from the centre of a parallel camera's picture. Default: `None`, the least that the picture
    /// shows, though no less than 2⁻⁴⁴ of the furthest.
    pub near: Option<f64>,
    /// The largest depth that is shown. Default: `None`, the largest that the picture shows.
    pub far: Option<f64>,
}

impl DepthBuffer {
    /// A buffer of this format with edge functions and the scene's own range.
    pub const fn new(format: DepthFormat) -> Self {
        Self { format, interpolation: Interpolation::EdgeFunctions, near: None, far: None }
    }

    /// With another way to interpolate.
    #[must_use]
    pub const fn with_interpolation(self, interpolation: Interpolation) -> Self {
        Self { interpolation, ..self }
    }

    /// With given near and far planes, in world units.
    #[must_use]
    pub const fn with_range(self, near: f64, far: f64) -> Self {
        Self { near: Some(near), far: Some(far), ..self }
    }
}

impl Method for DepthBuffer {
    fn name(&self) -> String {
        let mut name = self.format.to_string();
        if self.interpolation == Interpolation::Incremental {
            name += " incremental";
        }
        for (label, value) in [("near", self.near), ("far", self.far)] {
            if let Some(value) = value {
                name += &format!(" {label} {value:e}");
            }
        }
        name
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        Ok(Box::new(Ready { method: self, faces, keys: Vec::new() }))
    }
}

struct Ready<'a> {
    method: &'a DepthBuffer,
    faces: &'a Faces,
    /// The stored depths, kept to be used again.
    keys: Vec<u32>,
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
        // A depth and a face.
        self.keys.len() * 2 * size_of::<u32>()
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
        let mut frame = Frame::new(space.size, std::mem::take(&mut self.keys));
        let mut pieces = 0;
        if let Some(range) = range::of(self.method, &space, self.faces)? {
            let scale = Scale::<P>::new(self.method.format, range, space.perspective);
            let mut pass = Pass { space, range, scale, faces: self.faces, rays, frame };
            pieces = match self.method.interpolation {
                Interpolation::EdgeFunctions => pass.by_edge_functions(),
                Interpolation::Incremental => scanline::draw(&mut pass),
            };
            frame = pass.frame;
        }
        let (image, keys) = frame.finish();
        self.keys = keys;
        Ok(Painted { image, order: Duration::ZERO, draw: begin.elapsed(), pieces })
    }
}

/// One picture in the making.
struct Pass<'a, P> {
    space: CameraSpace,
    range: Range,
    scale: Scale<P>,
    faces: &'a Faces,
    rays: &'a Rays,
    frame: Frame,
}

impl<P: Precision> Pass<'_, P> {
    /// Draws all faces with exact coverage, and gives back how many there are to see.
    fn by_edge_functions(&mut self) -> usize {
        let mut clipper = Clipper::new(&self.space, self.range);
        let mut samples: Vec<Sample> = Vec::new();
        let mut drawn = 0;
        for face in 0..self.faces.len() as u32 {
            let outline = clipper.clip_face(&self.space, self.faces, face);
            if outline.is_empty() {
                continue;
            }
            drawn += 1;
            samples.clear();
            samples.extend(outline.iter().map(|v| self.scale.sample(&self.space, v.at)));
            let gradient = Gradient::<P>::new(&samples);
            let limits = self.limits(face, outline);
            let (scale, frame) = (&self.scale, &mut self.frame);
            let piece = Piece { face, outline: Outline::Whole };
            for_each_run(self.rays, self.faces, piece, |y, columns| {
                let row = gradient.row(y);
                let key = |x| scale.key(gradient.at(row, x));
                match limits {
                    None => frame.put(y, columns, face, |x| Some(key(x))),
                    Some(limits) => {
                        frame.put(y, columns, face, |x| limits.allow(x, y).then(|| key(x)));
                    }
                }
            });
        }
        drawn
    }

    /// What cuts a face off in each pixel, if it reaches out of the range of depths.
    fn limits(&self, face: u32, outline: &[Vertex]) -> Option<Limits> {
        let Self { space, range, .. } = self;
        let beyond = |corner: &[f64; 3]| {
            let depth = space.place(*corner).z;
            depth < range.near || depth > range.far
        };
        if !self.faces.corners(face).iter().any(beyond) {
            return None;
        }
        let sample = |vertex: &Vertex| {
            let [x, y] = space.project(vertex.at);
            let depth = vertex.at.z;
            Sample { x, y, value: if space.perspective { 1.0 / depth } else { depth } }
        };
        let samples: Vec<Sample> = outline.iter().map(sample).collect();
        let slack = LIMIT_ROUNDING * (range.far - range.near);
        let allowed = if space.perspective {
            [(1.0 - LIMIT_ROUNDING) / range.far, (1.0 + LIMIT_ROUNDING) / range.near]
        } else {
            [range.near - slack, range.far + slack]
        };
        Some(Limits { linear: Gradient::new(&samples), allowed })
    }
}

/// What is let through beyond the near and the far plane, for the rounding of depths.
const LIMIT_ROUNDING: f64 = 1e-9;

/// The depth of a face, or its reciprocal for a perspective, and the values of it that are in range.
#[derive(Clone, Copy, Debug)]
struct Limits {
    linear: Gradient<f64>,
    allowed: [f64; 2],
}

impl Limits {
    fn allow(&self, x: u32, y: u32) -> bool {
        let value = self.linear.at(self.linear.row(y), x);
        value >= self.allowed[0] && value <= self.allowed[1]
    }
}
