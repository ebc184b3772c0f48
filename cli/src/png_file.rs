//! PNG files.

use std::io::{self, Write};

/// Writes RGB pixels, row by row from the top left.
pub fn write(out: &mut dyn Write, size: [u32; 2], rgb: &[u8]) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()?;
    Ok(())
}
