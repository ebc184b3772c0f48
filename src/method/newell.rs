//! The algorithm of Newell, Newell & Sancha.

mod compare;
mod pieces;
mod sort;
mod split;

use std::time::Instant;

use self::pieces::Pieces;
use self::sort::Sorter;
use super::clip::{Clipper, Range};
use super::space::CameraSpace;
use super::{Method, MethodError, Painted, Prepared};
use crate::geom::Faces;
use crate::raster::{Order, Outline, Painter, Piece, Rays};
use crate::view::Camera;

/// Sorts by depth, and makes sure of it: M. E. Newell, R. G. Newell & T. L. Sancha, "A solution to
/// the hidden surface problem" (1972).
///
/// Faces are clipped to what the picture shows and sorted by their furthest vertex. The furthest, P,
/// may be painted if it hides no Q that reaches further than P's nearest vertex, which is so if one
/// of these holds, each tried in turn:
///
/// 1. their extents on the picture do not overlap from left to right;
/// 2. nor from top to bottom;
/// 3. all of P is behind Q's plane;
/// 4. all of Q is in front of P's plane;
/// 5. their projections do not overlap.
///
/// If none does, Q takes P's place, marked, if it is behind P's plane or P is in front of Q's. If
/// that is not so (they penetrate), or Q is marked already (a cycle), one is cut by the plane of the
/// other. Where no plane of a cycle cuts another face of it, one is cut along an edge of another as
/// it is seen. Where that is in vain too, all is nearer than the epsilon, and P is painted.
///
/// When Q is painted, its predecessor goes on where it was stopped, rather than beginning again: the
/// order is the same, the comparisons are fewer.
///
/// Everything is `f64`. The time is quadratic in the faces that overlap in depth, and so are the
/// pieces at worst: both have a budget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newell {
    /// The most pieces, faces that were not cut included; more is an error. Default: 2²¹, about
    /// 1 GB.
    pub max_pieces: usize,
    /// The most pairs that are compared for one picture; more is an error. Default: 2²⁸, seconds.
    pub max_comparisons: u64,
    /// Vertices no further than this from a plane count as on it, in units of 2⁵¹ lattice steps,
    /// half the scene's extent or up to four times that. Default: 1e-10. Smaller, and faces with
    /// a common edge cut each other; larger, and near layers are painted as they come.
    pub epsilon: f64,
}

impl Newell {
    /// The defaults.
    pub const DEFAULT: Self =
        Self { max_pieces: 1 << 21, max_comparisons: 1 << 28, epsilon: 1e-10 };
}

impl Default for Newell {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Method for Newell {
    fn name(&self) -> String {
        if self.epsilon == Self::DEFAULT.epsilon {
            "newell".into()
        } else {
            format!("newell {:e}", self.epsilon)
        }
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        Ok(Box::new(Ready { method: self, faces, pieces: Pieces::default() }))
    }
}

struct Ready<'a> {
    method: &'a Newell,
    faces: &'a Faces,
    /// Those of the last picture, for their memory.
    pieces: Pieces,
}

impl Prepared for Ready<'_> {
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        let space = CameraSpace::new(camera, self.faces.lattice());
        self.pieces.clear();
        if let Some(range) = Range::ahead(&space, self.faces) {
            let mut clipper = Clipper::new(&space, range);
            for face in 0..self.faces.len() as u32 {
                let outline = clipper.clip_face(&space, self.faces, face);
                self.pieces.add_face(&space, self.faces, face, outline);
            }
        }
        let sorted = Sorter::new(self.method, &space, &mut self.pieces)?.sort()?;
        let order = begin.elapsed();
        let mut painter = Painter::new(rays, self.faces, Order::BackToFront);
        let mut vertices = Vec::new();
        for &piece in &sorted {
            let (face, whole) = self.pieces.source(piece);
            let outline = if whole {
                Outline::Whole
            } else {
                vertices.clear();
                vertices.extend(self.pieces.vertices(piece).iter().map(|v| v.lattice.to_array()));
                Outline::Vertices(&vertices)
            };
            painter.draw(Piece { face, outline });
        }
        let (image, pieces) = (painter.finish(), sorted.len());
        Ok(Painted { image, order, draw: begin.elapsed() - order, pieces })
    }

    fn bytes(&self) -> usize {
        self.pieces.bytes()
    }
}
