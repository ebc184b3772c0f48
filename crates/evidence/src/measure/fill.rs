//! Fills outlines at the centres of pixels, in floats, and compares the result with a picture computed in
//! integers.

use binspace::internals::Faces;
use binspace::raster::{Image, NONE};

/// Centres nearer to an outline than this, in pixels, are not compared. Where parts of polygons were joined,
/// outlines have errors of up to 2⁻¹⁵.
const NEAR: f64 = 4e-5;

/// The polygon at a pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pixel {
    Nothing,
    Polygon(usize),
    /// Undecided: an outline passes too near.
    Unsure,
}

/// A picture into which outlines are filled, one over another.
#[derive(Clone, Debug)]
pub struct Filled {
    size: [usize; 2],
    pixels: Vec<Pixel>,
}

/// The differences between a filled picture and another picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FillError {
    /// Pixels that show a polygon in either picture and could be compared.
    pub compared: usize,
    /// Compared pixels that differ: they show another polygon, a polygon where none should be, or no polygon
    /// where one should be.
    pub wrong: usize,
    /// Undecided pixels: an outline passes too near their centre.
    pub unsure: usize,
}

impl Filled {
    /// Creates an empty picture.
    pub fn new(size: [u32; 2]) -> Self {
        let size = size.map(|side| side as usize);
        Self { size, pixels: vec![Pixel::Nothing; size[0] * size[1]] }
    }

    /// Fills outlines by the nonzero rule. Corners are in pixels from the corner of the first pixel, with x
    /// to the right and y down.
    pub fn fill<'o>(&mut self, polygon: usize, outlines: impl Iterator<Item = &'o [[f64; 2]]>) {
        let [width, height] = self.size;
        let mut crossings: Vec<(usize, f64, i32)> = Vec::new();
        let mut near: Vec<usize> = Vec::new();
        for outline in outlines {
            for (i, a) in outline.iter().enumerate() {
                // Coordinates are from the centre of the first pixel.
                let [a, b] = [a, &outline[(i + 1) % outline.len()]].map(|end| end.map(|c| c - 0.5));
                self.find_near(a, b, &mut near);
                let (low, high, step) = if a[1] < b[1] { (a, b, 1) } else { (b, a, -1) };
                let rows = low[1].ceil().max(0.0) as usize..height;
                for y in rows.take_while(|&y| (y as f64) < high[1]) {
                    let share = (y as f64 - low[1]) / (high[1] - low[1]);
                    crossings.push((y, low[0] + (high[0] - low[0]) * share, step));
                }
            }
        }
        crossings.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for row in crossings.chunk_by(|a, b| a.0 == b.0) {
            let mut winding = 0;
            for pair in row.windows(2) {
                winding += pair[0].2;
                let [from, to] = [pair[0].1, pair[1].1].map(|x| x.ceil().max(0.0) as usize);
                if winding != 0 && from < to.min(width) {
                    let start = pair[0].0 * width;
                    self.pixels[start + from..start + to.min(width)].fill(Pixel::Polygon(polygon));
                }
            }
        }
        near.into_iter().for_each(|pixel| self.pixels[pixel] = Pixel::Unsure);
    }

    /// Finds the pixels whose centres are too near to an edge.
    fn find_near(&self, a: [f64; 2], b: [f64; 2], near: &mut Vec<usize>) {
        let size = self.size.map(|side| side as f64);
        for axis in 0..2 {
            // Along each row, and each column.
            let (low, high) = if a[axis] < b[axis] { (a, b) } else { (b, a) };
            let length = high[axis] - low[axis];
            let first = (low[axis] - NEAR).ceil().max(0.0);
            let last = (high[axis] + NEAR).floor().min(size[axis] - 1.0);
            for at in first as usize..(last + 1.0).max(0.0) as usize {
                let along = at as f64 - low[axis];
                let share = if length > 0.0 { (along / length).clamp(0.0, 1.0) } else { 0.0 };
                let across = low[1 - axis] + (high[1 - axis] - low[1 - axis]) * share;
                let nearest = across.round();
                if (across - nearest).abs() < NEAR && 0.0 <= nearest && nearest < size[1 - axis] {
                    let (at, across) = (at, nearest as usize);
                    let [x, y] = if axis == 0 { [at, across] } else { [across, at] };
                    near.push(y * self.size[0] + x);
                }
            }
        }
    }

    /// Compares with a picture of faces.
    pub fn compare(&self, faces: &Faces, truth: &Image) -> FillError {
        let mut error = FillError::default();
        for (&pixel, &face) in self.pixels.iter().zip(truth.faces()) {
            let expected = match face {
                NONE => Pixel::Nothing,
                face => Pixel::Polygon(faces.polygon(face)),
            };
            match pixel {
                Pixel::Unsure => error.unsure += 1,
                Pixel::Nothing if expected == Pixel::Nothing => {}
                pixel => {
                    error.compared += 1;
                    error.wrong += usize::from(pixel != expected);
                }
            }
        }
        error
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use binspace::BspTree;
    use binspace::drawing::ViewOptions;
    use binspace::paint::paint_tree;
    use binspace::raster::Rays;
    use binspace::scene::Builtin;
    use binspace::view::Camera;

    #[test]
    fn a_square_has_the_pixels_whose_centres_it_covers() {
        let square = [[1.0, 1.0], [4.0, 1.0], [4.0, 3.0], [1.0, 3.0]];
        let mut filled = Filled::new([5, 4]);
        filled.fill(7, std::iter::once(&square[..]));
        let covered = |x: usize, y: usize| (1..=3).contains(&x) && (1..=2).contains(&y);
        for (i, &pixel) in filled.pixels.iter().enumerate() {
            let expected = if covered(i % 5, i / 5) { Pixel::Polygon(7) } else { Pixel::Nothing };
            assert_eq!(pixel, expected, "{i}");
        }
        // Pixels on a side through their centres are undecided; a later outline covers them.
        filled.fill(8, std::iter::once(&[[0.5, 0.0], [2.0, 0.0], [2.0, 4.0], [0.5, 4.0]][..]));
        assert_eq!(filled.pixels[5], Pixel::Unsure);
        assert_eq!(filled.pixels[6], Pixel::Polygon(8));
        assert_eq!(filled.pixels[7], Pixel::Polygon(7));
    }

    #[test]
    fn a_path_that_is_missing_or_too_early_is_noticed() {
        let scene = Builtin::City.build(Some(60), 1);
        let tree = BspTree::build(scene.polygons()).unwrap();
        let (low, high) = scene.bounds().unwrap();
        let camera = Camera::looking_at_all([low, high], scene.up(), [160, 120]).unwrap();
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let truth = paint_tree(&tree, camera.viewpoint(), &rays);
        let drawing = tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap().drawing().unwrap();
        let paths: Vec<_> = drawing.paths().collect();
        let judge = |order: &mut dyn Iterator<Item = usize>| {
            let mut filled = Filled::new([160, 120]);
            order.for_each(|i| filled.fill(paths[i].polygon(), paths[i].outlines()));
            filled.compare(tree.faces(), &truth)
        };
        let right = judge(&mut (0..paths.len()));
        assert!(right.wrong == 0 && right.compared > 1000 && right.unsure < 40, "{right:?}");
        assert!(judge(&mut (0..paths.len()).rev()).wrong > 100);
        assert!(judge(&mut (0..paths.len() - 1)).wrong > 0);
    }
}
