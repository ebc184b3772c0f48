//! The painter: later pieces cover earlier pieces. Also pictures in colour: RGB, 8 bits each, row by row from
//! the top left.

use std::ops::Range;

use glam::DVec3;

use super::coverage::{Coverage, Piece};
use super::judge::{Comparison, DepthImage, Verdict};
use super::rays::Rays;
use crate::exact::Faces;

/// Draws pieces one by one, each piece over the earlier pieces.
#[derive(Debug)]
pub struct Painter<'a> {
    rays: &'a Rays,
    faces: &'a Faces,
    is_front_to_back: bool,
    image: Image,
}

impl<'a> Painter<'a> {
    /// Creates a painter with an empty picture.
    ///
    /// # Panics
    ///
    /// If the rays were made for another grid.
    pub fn new(rays: &'a Rays, faces: &'a Faces) -> Self {
        rays.expect(faces);
        Self { rays, faces, is_front_to_back: false, image: Image::new(rays.size()) }
    }

    /// Expects pieces in front-to-back order: a later piece is visible only where no earlier piece is.
    #[must_use]
    pub fn front_to_back(self) -> Self {
        Self { is_front_to_back: true, ..self }
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
        let (image, is_front_to_back) = (&mut self.image, self.is_front_to_back);
        coverage.for_each_run(&mut |y, columns| {
            image.drawn += columns.len() as u64;
            also(y, columns.clone());
            let pixels = &mut image.row(y)[columns.start as usize..columns.end as usize];
            if is_front_to_back {
                pixels.iter_mut().filter(|p| **p == NONE).for_each(|p| *p = piece.face);
            } else {
                pixels.fill(piece.face);
            }
        });
    }

    /// Returns the picture.
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

/// The number that [`Image::faces`] contains for a pixel without a face.
pub const NONE: u32 = u32::MAX;

/// The number of the visible [face](super) in each pixel, row by row from the top left.
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

    /// Creates a picture with the given face in each pixel, and the result of [`drawn`](Self::drawn).
    pub fn from_faces(size: [u32; 2], faces: Vec<u32>, drawn: u64) -> Self {
        debug_assert_eq!(faces.len(), size[0] as usize * size[1] as usize);
        Self { size, faces, drawn }
    }

    /// Returns the width and height of the picture in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the number of the face in each pixel, row by row from the top left; [`NONE`] for a pixel
    /// without a face.
    pub fn faces(&self) -> &[u32] {
        &self.faces
    }

    /// Returns the number of pixels that show a face.
    pub fn covered(&self) -> usize {
        self.faces.iter().filter(|&&face| face != NONE).count()
    }

    /// Returns the number of pixels drawn, summed over all faces and pieces of faces. A pixel counts each
    /// time that it is drawn.
    pub fn drawn(&self) -> u64 {
        self.drawn
    }

    pub(super) fn row(&mut self, y: u32) -> &mut [u32] {
        let width = self.size[0] as usize;
        &mut self.faces[y as usize * width..][..width]
    }
}

/// Returns a colour for a polygon by its number: polygons with neighbouring numbers differ clearly.
pub fn colour_of(polygon: usize) -> [u8; 3] {
    // Steps of the golden ratio spread any number of hues evenly.
    let hue = (polygon as f64 * 0.618_033_988_749_894_9).fract() * 6.0;
    let (saturation, value) = match polygon % 3 {
        0 => (0.55, 0.95),
        1 => (0.75, 0.85),
        _ => (0.40, 0.90),
    };
    [5.0, 3.0, 1.0].map(|offset| {
        let k = (offset + hue) % 6.0;
        let share = k.min(4.0 - k).clamp(0.0, 1.0);
        (255.0 * value * (1.0 - saturation * share)).round() as u8
    })
}

/// Returns the brightness of a surface: 0.55 + 0.45 · |n · d|, where n is `normal`, d is the `direction` of
/// view, and both have length 1. A surface that faces the viewer has brightness 1, its full colour. A surface
/// seen edge-on has brightness 0.55. Both sides are equally bright.
pub fn brightness(normal: DVec3, direction: DVec3) -> f64 {
    0.55 + 0.45 * normal.dot(direction).abs()
}

/// Returns a picture in colours, as RGB. `colour` returns the colour of a polygon, given the polygon's
/// number. A polygon is darker the more obliquely it is seen; see [`brightness`]. Pixels without a polygon
/// have the colour `background`.
///
/// # Panics
///
/// If the rays were made for another [grid](crate::BspTree::grid) than the grid of the faces.
pub fn picture(
    rays: &Rays,
    faces: &Faces,
    image: &Image,
    colour: impl Fn(usize) -> [u8; 3],
    background: [u8; 3],
) -> Vec<u8> {
    rays.expect(faces);
    let width = rays.size()[0] as usize;
    let pixels = image.faces().iter().enumerate().map(|(i, &face)| {
        if face == NONE {
            return background;
        }
        let direction = rays.direction((i % width) as u32, (i / width) as u32);
        shaded(colour(faces.polygon(face)), flat_normal(faces, face), direction)
    });
    pixels.flatten().collect()
}

/// The normal of a face, of length 1.
pub(super) fn flat_normal(faces: &Faces, face: u32) -> DVec3 {
    faces.normal(face).normalize()
}

/// The shaded colour of a surface.
pub(super) fn shaded(colour: [u8; 3], normal: DVec3, direction: DVec3) -> [u8; 3] {
    let share = brightness(normal, direction);
    colour.map(|c| (f64::from(c) * share).round() as u8)
}

/// Returns the depths as a picture in greys. `greys` are the grey of the nearest pixels and the grey of the
/// furthest pixels, such as `[255, 40]` or `[40, 255]`. Pixels without a face are black. Grey is linear in
/// depth. The nearest 1 % of the pixels have the first grey, and the furthest 1 % have the second grey.
pub fn depth_map(depth: &DepthImage, greys: [u8; 2]) -> Vec<u8> {
    let depths: Vec<f64> = depth.depths().collect();
    let mut sorted: Vec<f64> = depths.iter().copied().filter(|d| d.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| sorted.get((sorted.len() as f64 * share) as usize).copied();
    let (Some(near), Some(far)) = (at(0.01), at(0.99)) else {
        return vec![0; depths.len() * 3];
    };
    let [nearest, furthest] = greys.map(f64::from);
    let grey = |depth: f64| {
        if depth.is_infinite() {
            return 0;
        }
        let share = if far > near { ((depth - near) / (far - near)).clamp(0.0, 1.0) } else { 0.0 };
        (nearest + (furthest - nearest) * share) as u8
    };
    depths.into_iter().flat_map(|depth| [grey(depth); 3]).collect()
}

/// Returns a picture of the differences, as RGB. The background is `picture` at a quarter of its brightness.
/// Contested pixels are blue, pixels in wrong order are red, holes are yellow, and spills are magenta; see
/// [`Verdict`](super::Verdict).
pub fn difference(comparison: &Comparison, picture: &[u8]) -> Vec<u8> {
    let pixels = comparison.verdicts.iter().zip(picture.chunks_exact(3));
    let colours = pixels.map(|(verdict, pixel)| match verdict {
        Verdict::Empty | Verdict::Right => [pixel[0] / 4, pixel[1] / 4, pixel[2] / 4],
        Verdict::Contested => [70, 130, 255],
        Verdict::WrongOrder => [255, 40, 40],
        Verdict::Hole => [255, 230, 0],
        Verdict::Spill => [255, 0, 255],
    });
    colours.flatten().collect()
}

/// Blends a colour over a pixel's colour, as in every colour picture of this library. Red, green and blue are
/// from 0 to 255. With opacity 1, the colour replaces the pixel's colour; with opacity 0, the pixel does not
/// change.
///
/// The result is rounded. So two pixels are guaranteed to be equal bit for bit only if the same colours are
/// blended over the same background, in the same order.
pub fn blend(pixel: &mut [f32; 3], colour: [u8; 3], opacity: f32) {
    for (old, new) in pixel.iter_mut().zip(colour) {
        *old = *old * (1.0 - opacity) + f32::from(new) * opacity;
    }
}

/// Calls `paint` with the number of each pixel that a piece covers, row by row from the top left, and with
/// the piece's colour in that pixel: shaded like [`picture`], darker the more obliquely the piece is seen.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// In floats, the vector product of the sliver's edges is 0.
    #[test]
    fn a_sliver_has_the_normal_of_its_plane() {
        let sliver = [
            [-281_474_976_710_656, -140_737_488_355_328, -140_737_488_355_328],
            [121_780_518_933_211, -326_184_141_481_648, -44_014_312_109_210],
            [-450_158_144_636_571, -63_164_512_243_349, -181_197_127_361_614],
        ]
        .map(|corner: [i64; 3]| corner.map(|c| c as f64));
        let (faces, _) = Faces::new([sliver], Some(0.0)).unwrap();
        let off = flat_normal(&faces, 0) - DVec3::new(-2.0, -8.0, -7.0).normalize();
        assert!(off.length() < 1e-9, "{off}");
    }
}
