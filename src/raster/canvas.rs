//! A painter in colours, for pictures in which things show through others.

use glam::DVec3;

use super::coverage::Coverage;
use super::painter::Piece;
use super::picture::{flat_normal, shaded};
use super::rays::Rays;
use crate::geom::Faces;

/// A picture on which pieces are painted one over the other, from back to front.
#[derive(Debug)]
pub struct Canvas<'a> {
    rays: &'a Rays,
    faces: &'a Faces,
    pixels: Vec<[f32; 3]>,
}

impl<'a> Canvas<'a> {
    /// An empty picture.
    pub fn new(rays: &'a Rays, faces: &'a Faces, background: [u8; 3]) -> Self {
        let [width, height] = rays.size().map(|side| side as usize);
        Self { rays, faces, pixels: vec![background.map(f32::from); width * height] }
    }

    /// Paints a piece over what is there, darker the more slantingly it is seen, as
    /// [`picture`](super::picture) does. With an opacity of 1 it covers all behind it, with 0
    /// nothing.
    pub fn draw(&mut self, piece: Piece<'_>, colour: [u8; 3], opacity: f32) {
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
    pub fn finish(self) -> Vec<u8> {
        self.pixels.into_iter().flatten().map(|channel| channel.round() as u8).collect()
    }
}
