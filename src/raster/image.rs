//! Pictures of which face shows where, and of all faces that cover a pixel.

use std::ops::Range;

use super::rays::Rays;
use crate::random::mix;

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
