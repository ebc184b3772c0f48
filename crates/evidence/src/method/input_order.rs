//! No removal of hidden surfaces at all.

use std::time::{Duration, Instant};

use super::{Method, MethodError, Painted, Prepared};
use binspace::internals::Faces;
use binspace::raster::{Order, Outline, Painter, Piece, Rays};
use binspace::view::Camera;

/// Paints faces in the order of the input: what all other methods are measured against.
#[derive(Clone, Copy, Debug, Default)]
pub struct InputOrder;

impl Method for InputOrder {
    fn name(&self) -> String {
        "input order".into()
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
        let mut painter = Painter::new(rays, self.faces, Order::BackToFront);
        for face in 0..self.faces.len() as u32 {
            painter.draw(Piece { face, outline: Outline::Whole });
        }
        let (image, pieces) = (painter.finish(), self.faces.len());
        Ok(Painted { image, order: Duration::ZERO, draw: begin.elapsed(), pieces })
    }

    fn bytes(&self) -> usize {
        0
    }
}
