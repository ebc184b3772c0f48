//! The two buffers: a depth and a face a pixel.

use std::ops::Range;

use binspace::raster::{Image, NONE};

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

    /// Shows a face in those pixels of a run where it is nearer than what is there. What is as far
    /// loses. Of a pixel that is to be left alone the key is `None`.
    #[inline]
    pub(super) fn put(
        &mut self,
        y: u32,
        columns: Range<u32>,
        face: u32,
        mut key_at: impl FnMut(u32) -> Option<u32>,
    ) {
        let start = y as usize * self.size[0] as usize;
        let pixels = start + columns.start as usize..start + columns.end as usize;
        let keys = self.keys[pixels.clone()].iter_mut();
        for ((x, stored), shown) in columns.zip(keys).zip(&mut self.faces[pixels]) {
            let Some(key) = key_at(x) else { continue };
            self.drawn += 1;
            if key < *stored || *shown == NONE {
                (*stored, *shown) = (key, face);
            }
        }
    }

    /// The picture, and the memory of the depths.
    pub(super) fn finish(self) -> (Image, Vec<u32>) {
        (Image::from_faces(self.size, self.faces, self.drawn), self.keys)
    }
}
