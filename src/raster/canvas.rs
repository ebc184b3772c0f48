//! A painter in colours, for pictures with transparent polygons.

use glam::DVec3;

use super::coverage::Coverage;
use super::picture::{flat_normal, shaded};
use super::piece::Piece;
use super::rays::Rays;
use crate::exact::Faces;

/// Paints a colour over that of a pixel, as every picture in colours of this library does. Amounts of
/// red, green and blue are from 0 to 255. An opacity of 1 hides what is behind; 0 is invisible.
///
/// Rounded, so that the order counts: pixels painted elsewhere come out the same, bit for bit, only if
/// the same colours are painted over the same ground one by one.
pub fn blend(pixel: &mut [f32; 3], colour: [u8; 3], opacity: f32) {
    for (old, new) in pixel.iter_mut().zip(colour) {
        *old = *old * (1.0 - opacity) + f32::from(new) * opacity;
    }
}

/// Calls `paint` with each pixel that a piece covers, by its number, row by row from the top left, and
/// with the colour there: shaded as by [`picture`](super::picture), darker the more obliquely the piece is
/// seen.
pub(crate) fn for_each_shaded(
    rays: &Rays,
    faces: &Faces,
    piece: Piece<'_>,
    colour: [u8; 3],
    mut paint: impl FnMut(usize, [u8; 3]),
) {
    let Some(coverage) = Coverage::new(rays, faces, piece.face, piece.outline) else { return };
    let normal: DVec3 = flat_normal(faces, piece.face);
    let width = rays.size()[0] as usize;
    coverage.for_each_run(&mut |y, columns| {
        for x in columns {
            paint(y as usize * width + x as usize, shaded(colour, normal, rays.direction(x, y)));
        }
    });
}
