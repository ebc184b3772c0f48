//! The two buffers: a depth and a face a pixel.

use crate::raster::{Image, NONE};

#[derive(Debug)]
pub(super) struct Frame {
    size: [u32; 2],
    keys: Vec<u32>,
    faces: Vec<u32>,
    drawn: u64,
}

impl Frame {
    /// An empty picture; the memory of another one's depths is used again.
    pub(super) fn new(size: [u32; 2], mut keys: Vec<u32>) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        keys.clear();
        keys.resize(pixels, u32::MAX);
        Self { size, keys, faces: vec![NONE; pixels], drawn: 0 }
    }

    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Shows a face in a pixel if it is nearer than what is there. What is as far loses.
    #[inline]
    pub(super) fn put(&mut self, x: u32, y: u32, key: u32, face: u32) {
        let i = y as usize * self.size[0] as usize + x as usize;
        self.drawn += 1;
        if key < self.keys[i] || self.faces[i] == NONE {
            self.keys[i] = key;
            self.faces[i] = face;
        }
    }

    /// The picture, and the memory of the depths.
    pub(super) fn finish(self) -> (Image, Vec<u32>) {
        (Image::from_faces(self.size, self.faces, self.drawn), self.keys)
    }
}
