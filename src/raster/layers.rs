//! Which faces cover each pixel, seen or hidden.

use std::ops::Range;

use super::rays::Rays;
use crate::random::mix;

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
