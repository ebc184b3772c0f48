//! Pictures by faces, and the painter: a later piece covers earlier ones.

use std::ops::Range;

use super::coverage::{Coverage, Piece};
use super::rays::Rays;
use crate::exact::Faces;
use crate::random::mix;

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

/// Face number for "no face".
pub const NONE: u32 = u32::MAX;

/// Which face shows in each pixel, row by row from the top left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    pub(super) size: [u32; 2],
    pub(super) faces: Vec<u32>,
    pub(super) drawn: u64,
}

impl Image {
    /// An empty picture.
    pub(super) fn new(size: [u32; 2]) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        Self { size, faces: vec![NONE; pixels], drawn: 0 }
    }

    /// A picture with the given face in each pixel, and the number of times pixels were covered.
    pub fn from_faces(size: [u32; 2], faces: Vec<u32>, drawn: u64) -> Self {
        debug_assert_eq!(faces.len(), size[0] as usize * size[1] as usize);
        Self { size, faces, drawn }
    }

    /// Its width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The face in each pixel, [`NONE`] where there is none, row by row from the top left.
    pub fn faces(&self) -> &[u32] {
        &self.faces
    }

    /// How many pixels show a face.
    pub fn covered(&self) -> usize {
        self.faces.iter().filter(|&&face| face != NONE).count()
    }

    /// How many times pixels were covered by a piece, overdrawn ones included.
    pub fn drawn(&self) -> u64 {
        self.drawn
    }

    pub(super) fn row(&mut self, y: u32) -> &mut [u32] {
        let width = self.size[0] as usize;
        &mut self.faces[y as usize * width..][..width]
    }
}

/// For every pixel, the multiset of faces that cover it.
///
/// Stored as a hash, the sum of a pseudo-random number for each face: the hashes of two different
/// multisets are equal with a probability of 2⁻³².
#[derive(Clone, Debug)]
pub(crate) struct Layers {
    width: usize,
    sums: Vec<u32>,
}

impl Layers {
    /// Without any faces.
    pub(crate) fn new(rays: &Rays) -> Self {
        let [width, height] = rays.size().map(|side| side as usize);
        Self { width, sums: vec![0; width * height] }
    }

    /// Adds a face in some columns of a row.
    pub(crate) fn add(&mut self, face: u32, y: u32, columns: Range<u32>) {
        let term = mix(u64::from(face)) as u32;
        let row = &mut self.sums[y as usize * self.width..][..self.width];
        for sum in &mut row[columns.start as usize..columns.end as usize] {
            *sum = sum.wrapping_add(term);
        }
    }

    /// The number of pixels in which the faces differ from those of `other`.
    pub(crate) fn differences(&self, other: &Self) -> usize {
        self.sums.iter().zip(&other.sums).filter(|(a, b)| a != b).count()
    }
}
