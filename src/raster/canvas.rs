//! A painter in colours, for pictures with transparent polygons.

use glam::DVec3;

use super::coverage::Coverage;
use super::picture::{flat_normal, shaded};
use super::piece::Piece;
use super::rays::Rays;
use crate::exact::Faces;

/// A picture on which pieces are painted one over the other, from back to front.
#[derive(Debug)]
pub(crate) struct Canvas<'a> {
    rays: &'a Rays,
    faces: &'a Faces,
    pixels: Vec<[f32; 3]>,
}

impl<'a> Canvas<'a> {
    /// An empty picture.
    pub(crate) fn new(rays: &'a Rays, faces: &'a Faces, background: [u8; 3]) -> Self {
        let [width, height] = rays.size().map(|side| side as usize);
        Self { rays, faces, pixels: vec![background.map(f32::from); width * height] }
    }

    /// Paints a piece over the picture so far, shaded as by [`picture`](super::picture): darker the
    /// more obliquely it is seen. An opacity of 1 hides everything behind it; with 0 it is
    /// invisible.
    pub(crate) fn draw(&mut self, piece: Piece<'_>, colour: [u8; 3], opacity: f32) {
        let Some(coverage) = Coverage::new(self.rays, self.faces, piece.face, piece.outline) else {
            return;
        };
        let normal: DVec3 = flat_normal(self.faces, piece.face);
        let width = self.rays.size()[0] as usize;
        coverage.for_each_run(&mut |y, columns| {
            for x in columns {
                let new = shaded(colour, normal, self.rays.direction(x, y));
                let pixel = &mut self.pixels[y as usize * width + x as usize];
                for (old, new) in pixel.iter_mut().zip(new) {
                    *old = *old * (1.0 - opacity) + f32::from(new) * opacity;
                }
            }
        });
    }

    /// The picture: RGB, 8 bits each, row by row from the top left.
    pub(crate) fn finish(self) -> Vec<u8> {
        self.pixels.into_iter().flatten().map(|channel| channel.round() as u8).collect()
    }
}
