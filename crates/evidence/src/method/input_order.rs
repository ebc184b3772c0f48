//! No removal of hidden surfaces at all.

use std::time::{Duration, Instant};

use super::front_faces::shown;
use super::{Method, MethodError, Painted, Prepared, Space};
use binspace::internals::Faces;
use binspace::raster::{Outline, Painter, Piece, Rays};
use binspace::view::Camera;

/// Paints faces in the order of the input: the baseline of all other methods.
#[derive(Clone, Copy, Debug, Default)]
pub struct InputOrder;

impl Method for InputOrder {
    fn name(&self) -> String {
        "input order".into()
    }

    fn space(&self) -> Space {
        Space::Neither
    }

    fn prepare<'a>(&'a self, faces: &'a Faces) -> Result<Box<dyn Prepared + 'a>, MethodError> {
        Ok(Box::new(Ready { faces }))
    }
}

struct Ready<'a> {
    faces: &'a Faces,
}

impl Prepared for Ready<'_> {
    fn paint(&mut self, _: &Camera, rays: &Rays) -> Result<Painted, MethodError> {
        let begin = Instant::now();
        let mut painter = Painter::new(rays, self.faces);
        let (is_shown, mut pieces) = (shown(rays, self.faces), 0);
        for face in (0..self.faces.len() as u32).filter(|&face| is_shown(face)) {
            painter.draw(Piece { face, outline: Outline::Whole });
            pieces += 1;
        }
        let image = painter.finish();
        Ok(Painted { image, order: Duration::ZERO, draw: begin.elapsed(), pieces, removed: 0 })
    }

    fn bytes(&self) -> usize {
        0
    }
}
