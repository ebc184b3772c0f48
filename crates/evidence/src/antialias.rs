//! Antialiasing: compares the visible areas in each pixel with samples, and with coverages blended in paint
//! order.

use binspace::drawing::VisibilityMap;
use binspace::glam::DVec3;
use binspace::internals::Faces;
use binspace::raster::{NONE, Rays, zbuffer};
use binspace::view::Camera;
use binspace::{BspTree, Error};

use crate::translucent::Colour;

/// The visible polygons of each pixel, each with the share of the pixel that it covers.
///
/// The cells of a visibility map are clipped to the pixels (E. Catmull, "A hidden-surface algorithm with
/// anti-aliasing", 1978). The set of cells and their lines are exact; areas are rounded.
#[derive(Clone, Debug)]
pub struct Areas {
    pixels: Vec<Vec<(usize, f64)>>,
}

impl Areas {
    /// Creates the areas of a map.
    pub fn of(map: &VisibilityMap<'_>) -> Self {
        let [width, height] = map.size();
        let mut pixels = vec![Vec::new(); width as usize * height as usize];
        for cell in map.cells() {
            let corners: Vec<_> = cell.corners().collect();
            for_each_share(&corners, map.size(), |pixel, area| {
                let shares: &mut Vec<(usize, f64)> = &mut pixels[pixel];
                match shares.iter_mut().find(|(polygon, _)| *polygon == cell.polygon()) {
                    Some((_, sum)) => *sum += area,
                    None => shares.push((cell.polygon(), area)),
                }
            });
        }
        Self { pixels }
    }

    /// Returns the visible polygons of each pixel and their shares of the pixel, row by row.
    pub fn pixels(&self) -> impl ExactSizeIterator<Item = &[(usize, f64)]> {
        self.pixels.iter().map(Vec::as_slice)
    }

    /// Returns the picture: each pixel is the mean of its visible polygons.
    pub fn picture(&self, colour: impl Fn(usize) -> Colour, background: Colour) -> Vec<Colour> {
        let pixel = |shares: &[(usize, f64)]| {
            let rest = 1.0 - shares.iter().map(|(_, area)| area).sum::<f64>();
            let parts = shares.iter().map(|&(polygon, area)| (colour(polygon), area));
            mean(parts.chain([(background, rest)]))
        };
        self.pixels().map(pixel).collect()
    }
}

/// Returns the picture by `side` × `side` evenly spaced rays in each pixel.
///
/// # Errors
///
/// As for [`Rays::sampled`].
pub fn supersampled(
    camera: &Camera,
    faces: &Faces,
    side: u32,
    colour: impl Fn(usize) -> Colour,
    background: Colour,
) -> Result<Vec<Colour>, Error> {
    let rays = Rays::sampled(camera, faces, side)?;
    let depth = zbuffer(&rays, faces);
    let [width, height] = camera.size();
    let row = (width * side) as usize;
    let pixel = |x: u32, y: u32| {
        let samples = (0..side * side).map(|k| {
            let at = (y * side + k / side) as usize * row + (x * side + k % side) as usize;
            let face = depth.image().faces()[at];
            if face == NONE { background } else { colour(faces.polygon(face)) }
        });
        mean(samples.map(|colour| (colour, 1.0 / f64::from(side * side))))
    };
    Ok((0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| pixel(x, y))
        .collect())
}

/// Paints the fragments of a tree back to front. The opacity of a fragment in a pixel is the share of the
/// pixel that it covers.
///
/// Painting programs do this. The result is wrong along common edges of fragments: the opacity says how much
/// of a pixel is covered, but not which part (T. Porter and T. Duff, "Compositing digital images", 1984,
/// assume that the parts are independent).
pub fn blended(
    tree: &BspTree,
    camera: &Camera,
    colour: impl Fn(usize) -> Colour,
    background: Colour,
) -> Vec<Colour> {
    let [width, height] = camera.size();
    let mut picture = vec![background; width as usize * height as usize];
    for fragment in tree.back_to_front(camera.viewpoint()) {
        let corners: Vec<DVec3> = fragment.vertices().collect();
        let colour = colour(fragment.polygon());
        for_each_share(&camera.clip(&corners), camera.size(), |pixel, area| {
            let old = picture[pixel];
            picture[pixel] = mean([(old, 1.0 - area), (colour, area)]);
        });
    }
    picture
}

/// Returns the largest difference of two pictures in a channel, and the root mean square of all differences.
pub fn distance(a: &[Colour], b: &[Colour]) -> (f64, f64) {
    let both = a.iter().flatten().zip(b.iter().flatten());
    let off = both.map(|(a, b)| f64::from(a - b).abs());
    let (largest, squares) =
        off.fold((0.0f64, 0.0), |(most, sum), off| (most.max(off), sum + off * off));
    (largest, (squares / (3 * a.len().max(1)) as f64).sqrt())
}

/// A sum of colours with weights.
fn mean(parts: impl IntoIterator<Item = (Colour, f64)>) -> Colour {
    let mut sum = [0.0f64; 3];
    for (colour, weight) in parts {
        sum.iter_mut().zip(colour).for_each(|(sum, c)| *sum += weight * f64::from(c));
    }
    sum.map(|c| c as f32)
}

/// Clips a convex polygon to each pixel, and calls `f` with the number of each pixel that it overlaps and the
/// area of the overlap. Pixel (x, y) is the square from (x, y) to (x + 1, y + 1).
fn for_each_share(corners: &[[f64; 2]], [width, height]: [u32; 2], mut f: impl FnMut(usize, f64)) {
    let span = |corners: &[[f64; 2]], axis: usize, end: u32| {
        let ends = corners.iter().map(|p| p[axis]);
        let (low, high) =
            ends.fold((f64::MAX, f64::MIN), |(low, high), c| (low.min(c), high.max(c)));
        // `as u32` turns numbers below 0 into 0.
        low.floor() as u32..(high.ceil() as u32).min(end)
    };
    for y in span(corners, 1, height) {
        let row = between(corners, 1, y);
        for x in span(&row, 0, width) {
            let area = area(&between(&row, 0, x));
            if area > 0.0 {
                f((y * width + x) as usize, area.min(1.0));
            }
        }
    }
}

/// The part of a convex polygon whose coordinate is between `low` and `low + 1`.
fn between(corners: &[[f64; 2]], axis: usize, low: u32) -> Vec<[f64; 2]> {
    let low = f64::from(low);
    let right = part(corners, |p| p[axis] - low);
    part(&right, |p| low + 1.0 - p[axis])
}

/// The part of a convex polygon where a linear function is not negative (I. Sutherland and G. Hodgman,
/// "Reentrant polygon clipping", 1974).
fn part(corners: &[[f64; 2]], value: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut left = Vec::with_capacity(corners.len() + 1);
    for (i, &p) in corners.iter().enumerate() {
        let q = corners[(i + 1) % corners.len()];
        let (at_p, at_q) = (value(p), value(q));
        if at_p >= 0.0 {
            left.push(p);
        }
        if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
            let t = at_p / (at_p - at_q);
            left.push([0, 1].map(|k| p[k] + t * (q[k] - p[k])));
        }
    }
    left
}

/// The area of a polygon of either orientation.
fn area(corners: &[[f64; 2]]) -> f64 {
    let Some(&[ox, oy]) = corners.first() else { return 0.0 };
    let cross = |pair: &[[f64; 2]]| {
        (pair[0][0] - ox) * (pair[1][1] - oy) - (pair[0][1] - oy) * (pair[1][0] - ox)
    };
    0.5 * corners.windows(2).map(cross).sum::<f64>().abs()
}
