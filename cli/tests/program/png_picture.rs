//! Reads PNG files.

use std::fs;
use std::io::Cursor;
use std::path::Path;

/// A picture of RGB pixels.
#[derive(Debug, PartialEq)]
pub(crate) struct Picture {
    pub(crate) size: [u32; 2],
    pub(crate) rgb: Vec<u8>,
}

impl Picture {
    pub(crate) fn read(path: &Path) -> Self {
        Self::parse(&fs::read(path).unwrap())
    }

    pub(crate) fn parse(bytes: &[u8]) -> Self {
        let decoder = png::Decoder::new(Cursor::new(bytes));
        let mut reader = decoder.read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        assert_eq!(info.color_type, png::ColorType::Rgb);
        Self { size: [info.width, info.height], rgb }
    }

    /// The number of pixels that have a colour.
    pub(crate) fn count(&self, colour: [u8; 3]) -> usize {
        self.rgb.chunks_exact(3).filter(|pixel| *pixel == colour).count()
    }

    /// The number of colours.
    pub(crate) fn colours(&self) -> usize {
        let all: std::collections::HashSet<&[u8]> = self.rgb.chunks_exact(3).collect();
        all.len()
    }
}
