//! One picture of a depth buffer, and its faces drawn with exact coverage.

use super::super::clip::{Clipper, Range};
use super::super::space::{CameraSpace, Vertex};
use super::format::Scale;
use super::frame::Frame;
use super::gradient::{Gradient, Sample};
use crate::Precision;
use binspace::internals::Faces;
use binspace::raster::{Outline, Piece, Rays, for_each_run};

/// One picture in the making.
pub(super) struct Pass<'a, P> {
    pub(super) space: CameraSpace,
    pub(super) range: Range,
    pub(super) scale: Scale<P>,
    pub(super) faces: &'a Faces,
    pub(super) rays: &'a Rays,
    pub(super) frame: Frame,
}

impl<P: Precision> Pass<'_, P> {
    /// Draws all faces with exact coverage, and gives back how many there are to see.
    pub(super) fn by_edge_functions(&mut self) -> usize {
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
