//! The painter: a later piece covers earlier ones.

use std::ops::Range;

use super::coverage::{Coverage, Piece};
use super::image::{Image, NONE};
use super::rays::Rays;
use crate::exact::Faces;

/// The order in which pieces are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// A later piece is drawn over earlier ones.
    BackToFront,
    /// A later piece shows only where no earlier one does.
    FrontToBack,
}

/// Draws pieces one by one.
#[derive(Debug)]
pub struct Painter<'a> {
    rays: &'a Rays,
    faces: &'a Faces,
    order: Order,
    image: Image,
}

impl<'a> Painter<'a> {
    /// A painter with an empty picture.
    ///
    /// # Panics
    ///
    /// If the rays were made for another grid.
    pub fn new(rays: &'a Rays, faces: &'a Faces, order: Order) -> Self {
        rays.expect(faces);
        Self { rays, faces, order, image: Image::new(rays.size()) }
    }

    /// Draws a piece.
    pub fn draw(&mut self, piece: Piece<'_>) {
        self.draw_and(piece, |_, _| {});
    }

    /// Draws a piece, and calls `also` with the row and the columns of all pixels that it covers.
    pub(crate) fn draw_and(&mut self, piece: Piece<'_>, mut also: impl FnMut(u32, Range<u32>)) {
        let Some(coverage) = Coverage::new(self.rays, self.faces, piece.face, piece.outline) else {
            return;
        };
        let (image, order) = (&mut self.image, self.order);
        coverage.for_each_run(&mut |y, columns| {
            image.drawn += columns.len() as u64;
            also(y, columns.clone());
            let pixels = &mut image.row(y)[columns.start as usize..columns.end as usize];
            match order {
                Order::BackToFront => pixels.fill(piece.face),
                Order::FrontToBack => {
                    pixels.iter_mut().filter(|p| **p == NONE).for_each(|p| *p = piece.face);
                }
            }
        });
    }

    /// The picture.
    pub fn finish(self) -> Image {
        self.image
    }
}

/// Calls `run` with the row and the columns of all pixels that a piece covers, row by row from the
/// top: the pixels that a [`Painter`] would draw.
///
/// # Panics
///
/// If the rays were made for another grid.
pub fn for_each_run(
    rays: &Rays,
    faces: &Faces,
    piece: Piece<'_>,
    mut run: impl FnMut(u32, Range<u32>),
) {
    rays.expect(faces);
    if let Some(coverage) = Coverage::new(rays, faces, piece.face, piece.outline) {
        coverage.for_each_run(&mut run);
    }
}

/// Whether a piece covers a pixel.
pub(crate) fn covers(rays: &Rays, faces: &Faces, piece: Piece<'_>, [x, y]: [u32; 2]) -> bool {
    Coverage::new(rays, faces, piece.face, piece.outline).is_some_and(|piece| piece.covers(x, y))
}
