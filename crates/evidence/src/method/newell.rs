//! The algorithm of Newell, Newell & Sancha.

mod compare;
mod decisions;
mod options;
mod pieces;
mod sort;
mod split;

use std::time::Instant;

use self::pieces::Pieces;
use self::sort::Sorter;
use super::front_faces::shown;
use super::space::CameraSpace;
use super::{Method, MethodError, Painted, Prepared, Space};
use binspace::internals::Faces;
use binspace::raster::{Outline, Painter, Piece, Rays};
use binspace::view::Camera;

pub use self::decisions::Decisions;
pub use self::options::Newell;

impl Method for Newell {
    fn name(&self) -> String {
        if self.epsilon == Self::DEFAULT.epsilon {
            "newell".into()
        } else {
            format!("newell {:e}", self.epsilon)
        }
    }

    fn space(&self) -> Space {
        Space::Both
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        Ok(Box::new(Ready { method: self, faces, pieces: Pieces::default() }))
    }
}

impl Newell {
    /// Sorts the faces that a camera sees, and counts the deciding tests.
    ///
    /// # Errors
    ///
    /// If a budget runs out.
    pub fn decisions(&self, faces: &Faces, camera: &Camera) -> Result<Decisions, MethodError> {
        let space = CameraSpace::new(camera, faces.lattice());
        let mut pieces = Pieces::default();
        pieces.take(&space, faces, |_| true);
        let (_, decisions) = Sorter::new(self, &space, &mut pieces)?.sort()?;
        Ok(decisions)
    }
}

struct Ready<'a> {
    method: &'a Newell,
    faces: &'a Faces,
    /// The pieces of the last picture, kept to reuse their memory.
    pieces: Pieces,
}

impl Prepared for Ready<'_> {
    fn paint(&mut self, camera: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        let space = CameraSpace::new(camera, self.faces.lattice());
        let is_shown = shown(rays, self.faces);
        self.pieces.take(&space, self.faces, is_shown);
        let (sorted, _) = Sorter::new(self.method, &space, &mut self.pieces)?.sort()?;
        let order = begin.elapsed();
        let mut painter = Painter::new(rays, self.faces);
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
        Ok(Painted { image, order, draw: begin.elapsed() - order, pieces, removed: 0 })
    }

    fn bytes(&self) -> usize {
        self.pieces.bytes()
    }
}
