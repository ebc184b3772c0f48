//! One picture of a depth buffer, and its faces drawn with exact coverage.

use std::ops::Range;

use super::super::clip::{Clipper, Range as DepthRange};
use super::super::space::{CameraSpace, Vertex};
use super::format::Scale;
use super::frame::Frame;
use super::gradient::{Gradient, Sample};
use crate::Precision;
use binspace::internals::Faces;
use binspace::raster::{Outline, Piece, Rays, for_each_run};

/// The state of one picture while it is drawn.
pub(super) struct Pass<'a, P> {
    pub(super) space: CameraSpace,
    pub(super) range: DepthRange,
    pub(super) scale: Scale<P>,
    pub(super) faces: &'a Faces,
    /// The rays of the section that is drawn.
    pub(super) rays: &'a Rays,
    pub(super) frame: Frame,
}

impl<P: Precision> Pass<'_, P> {
    /// Draws faces with exact coverage, and returns the number of visible ones.
    pub(super) fn by_edge_functions(&mut self, faces: impl IntoIterator<Item = u32>) -> usize {
        let mut clipper = Clipper::new(&self.space, self.range);
        let mut drawn = 0;
        for face in faces {
            let Some(depths) = self.depths(&mut clipper, face) else { continue };
            drawn += 1;
            let (scale, frame) = (&self.scale, &mut self.frame);
            let piece = Piece { face, outline: Outline::Whole };
            let above = frame.rows().start;
            for_each_run(self.rays, self.faces, piece, |y, columns| {
                let y = above + y;
                let row = depths.gradient.row(y);
                let key = |x| scale.key(depths.gradient.at(row, x));
                match depths.limits {
                    None => frame.put(y, columns, face, |x| Some(key(x))),
                    Some(limits) => {
                        frame.put(y, columns, face, |x| limits.allow(x, y).then(|| key(x)));
                    }
                }
            });
        }
        drawn
    }

    /// Calls `visit` with the pixels of a piece that pass the depth test; their depths are kept if
    /// `writes`.
    pub(super) fn test(
        &mut self,
        clipper: &mut Clipper,
        piece: Piece<'_>,
        writes: bool,
        mut visit: impl FnMut(u32, u32),
    ) {
        let Some(depths) = self.depths(clipper, piece.face) else { return };
        let (scale, frame) = (&self.scale, &mut self.frame);
        let above = frame.rows().start;
        for_each_run(self.rays, self.faces, piece, |y, columns| {
            let y = above + y;
            let row = depths.gradient.row(y);
            let allows = |x| depths.limits.is_none_or(|limits| limits.allow(x, y));
            let key = |x| allows(x).then(|| scale.key(depths.gradient.at(row, x)));
            frame.test(y, columns, writes, key, |x| visit(x, y));
        });
    }

    /// Shows a face in a run, with a value that grows by a constant from pixel to pixel.
    pub(super) fn put_run(
        &mut self,
        y: u32,
        columns: Range<u32>,
        face: u32,
        mut value: f64,
        slope: f64,
    ) {
        let columns = columns.start..columns.end.max(columns.start);
        let scale = &self.scale;
        self.frame.put(y, columns, face, |_| {
            let key = scale.key(value);
            value = P::round(value + slope);
            Some(key)
        });
    }

    /// The value interpolated over a face, if any of the face is visible.
    fn depths(&self, clipper: &mut Clipper, face: u32) -> Option<Depths<P>> {
        let outline = clipper.clip_face(&self.space, self.faces, face);
        if outline.is_empty() {
            return None;
        }
        let sample = |vertex: &Vertex| self.scale.sample(&self.space, vertex.at);
        let samples: Vec<Sample> = outline.iter().map(sample).collect();
        Some(Depths { gradient: Gradient::new(&samples), limits: self.limits(face, outline) })
    }

    /// The limits that cut a face off in each pixel, if it leaves the range of depths.
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

/// The depths of a face on the picture, and its limits.
#[derive(Clone, Copy, Debug)]
struct Depths<P> {
    gradient: Gradient<P>,
    limits: Option<Limits>,
}

/// The margin beyond the near and the far plane, for the rounding of depths.
const LIMIT_ROUNDING: f64 = 1e-9;

/// The depth of a face, or the reciprocal of the depth for a perspective, and the range of allowed values.
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
