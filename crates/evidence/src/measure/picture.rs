//! Wrong pixels, over one picture or many.

use std::collections::BTreeMap;
use std::ops::AddAssign;

use binspace::internals::Faces;
use binspace::raster::{Comparison, Image, Outline, Piece, Rays, Verdict, compare, for_each_run};
use dashu_int::IBig;

/// The errors of painted pictures, counted over all added pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PictureError {
    /// Pixels in which there is a polygon.
    pub covered: usize,
    /// Pixels that show another polygon than the nearest, if the tolerance allows both.
    pub contested: usize,
    /// Pixels that show a polygon that another polygon hides.
    pub wrong_order: usize,
    /// Empty pixels that a polygon should cover.
    pub holes: usize,
    /// Pixels that show a polygon but should be empty.
    pub spills: usize,
    /// The largest distance of a painted polygon behind the nearest one, as a share of the extent.
    pub depth_max: f64,
    /// The mean of this distance over the wrong pixels whose rays meet the painted polygon.
    pub depth_mean: f64,
    /// The number of pixels in `depth_mean`.
    pub depth_pixels: usize,
}

impl PictureError {
    /// Counts the errors of one picture. `truth` is the picture of the [exact depth
    /// buffer](binspace::raster::zbuffer), made with the same rays.
    pub fn of(rays: &Rays, faces: &Faces, painted: &Image, truth: &Image) -> Self {
        let found = compare(rays, faces, painted, truth);
        let depth = DepthError::of(rays, faces, painted, truth, &found);
        let extent = extent(faces);
        let share = |length: f64| if extent > 0.0 { length / extent } else { 0.0 };
        Self {
            covered: found.covered,
            contested: found.contested,
            wrong_order: found.wrong_order,
            holes: found.holes,
            spills: found.spills,
            depth_max: share(depth.max),
            depth_mean: share(depth.sum / depth.pixels.max(1) as f64),
            depth_pixels: depth.pixels,
        }
    }

    /// Returns the number of wrong pixels. Contested pixels do not count.
    pub fn wrong(&self) -> usize {
        self.wrong_order + self.holes + self.spills
    }

    /// Returns the wrong pixels as a share of the covered ones.
    pub fn wrong_share(&self) -> f64 {
        self.wrong() as f64 / self.covered.max(1) as f64
    }
}

impl AddAssign for PictureError {
    fn add_assign(&mut self, other: Self) {
        let pixels = self.depth_pixels + other.depth_pixels;
        let sum = |error: &Self| error.depth_mean * error.depth_pixels as f64;
        self.depth_mean = (sum(self) + sum(&other)) / pixels.max(1) as f64;
        self.depth_pixels = pixels;
        self.depth_max = self.depth_max.max(other.depth_max);
        self.covered += other.covered;
        self.contested += other.contested;
        self.wrong_order += other.wrong_order;
        self.holes += other.holes;
        self.spills += other.spills;
    }
}

/// The distances of the painted faces behind the nearest ones, in world units along the direction of view.
/// Only pixels with a wrong order whose rays meet the painted face are counted.
#[derive(Clone, Copy, Debug, Default)]
struct DepthError {
    pixels: usize,
    max: f64,
    sum: f64,
}

impl DepthError {
    fn of(rays: &Rays, faces: &Faces, painted: &Image, truth: &Image, found: &Comparison) -> Self {
        let [width, height] = rays.size();
        let mut wrong: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (pixel, (&face, verdict)) in painted.faces().iter().zip(&found.verdicts).enumerate() {
            if *verdict == Verdict::WrongOrder {
                wrong.entry(face).or_default().push(pixel);
            }
        }
        // The direction through the middle of the picture.
        let ends =
            [rays.ray(0, 0), rays.ray(width - 1, height - 1)].map(|[_, direction]| direction);
        let middle = [0, 1, 2].map(|i| 0.5 * (ends[0][i] + ends[1][i]) as f64);
        let step =
            faces.lattice().length_to_world(middle.iter().map(|c| c * c).sum::<f64>().sqrt());
        let mut error = Self::default();
        for (face, pixels) in wrong {
            let piece = Piece { face, outline: Outline::Whole };
            for_each_run(rays, faces, piece, |y, columns| {
                let run = columns.map(|x| (x, (y * width + x) as usize));
                for (x, pixel) in run.filter(|(_, pixel)| pixels.binary_search(pixel).is_ok()) {
                    let met =
                        [face, truth.faces()[pixel]].map(|face| met(faces, face, rays.ray(x, y)));
                    let [[above, below], [other_above, other_below]] = &met;
                    // The distances are subtracted exactly, and the difference is rounded.
                    let apart = above * other_below - other_above * below;
                    let [apart, below, other_below] =
                        [&apart, below, other_below].map(|number| number.to_f64().value());
                    let depth = (apart / below / other_below * step).abs();
                    error.pixels += 1;
                    error.max = error.max.max(depth);
                    error.sum += depth;
                }
            });
        }
        error
    }
}

/// The distance along a ray to the plane of a face: a numerator and a denominator.
fn met(faces: &Faces, face: u32, [start, direction]: [[i128; 3]; 2]) -> [IBig; 2] {
    let [p, q, r] =
        faces.reference_triangle(face).map(|corner| faces.corner(corner).map(|c| c as i128));
    let less = |a: [i128; 3], b: [i128; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
    let (u, w) = (less(q, p), less(r, p));
    let normal = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| IBig::from(u[j] * w[k] - u[k] * w[j]));
    [less(p, start), direction].map(|v| normal.iter().zip(v).map(|(n, c)| n * IBig::from(c)).sum())
}

/// Returns the longest side of the box around all faces, in world units.
pub fn extent(faces: &Faces) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for corner in (0..faces.corner_count() as u32).map(|corner| faces.corner(corner)) {
        for axis in 0..3 {
            low[axis] = low[axis].min(corner[axis]);
            high[axis] = high[axis].max(corner[axis]);
        }
    }
    let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    faces.lattice().length_to_world(longest)
}

#[cfg(test)]
mod tests {
    use binspace::glam::DVec3;
    use binspace::raster::zbuffer;
    use binspace::view::Camera;

    use super::*;

    const SIZE: [u32; 2] = [6, 6];

    /// Squares from (0, 0) to (right, 6) at a height, and rays down the z axis: a unit is a pixel.
    fn scene(squares: &[(f64, f64)], tolerance: Option<f64>) -> (Faces, Rays) {
        let square =
            |&(x, z): &(f64, f64)| [[0.0, 0.0, z], [x, 0.0, z], [x, 6.0, z], [0.0, 6.0, z]];
        let (faces, _) = Faces::new(squares.iter().map(square), tolerance).unwrap();
        let centre = DVec3::new(3.0, 3.0, 0.0);
        let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, centre, 6.0, SIZE).unwrap();
        let rays = Rays::new(&camera, &faces).unwrap();
        (faces, rays)
    }

    /// If a pixel shows a face that its ray misses, the face has no depth there.
    #[test]
    fn faces_that_are_not_met_have_no_depth_error() {
        let (faces, rays) = scene(&[(3.0, 0.0), (6.0, -3.0)], None);
        let truth = zbuffer(&rays, &faces).into_image();
        for (painted, expected) in [(0, 0), (1, 18)] {
            let painted = Image::from_faces(SIZE, vec![painted; 36], 0);
            let found = compare(&rays, &faces, &painted, &truth);
            let error = DepthError::of(&rays, &faces, &painted, &truth, &found);
            assert_eq!((found.wrong_order, error.pixels), (18, expected));
        }
    }

    /// Two faces behind a third are painted in alternation. Each pixel is judged by its own faces. Rays meet
    /// one of the two faces only in the left half.
    #[test]
    fn each_pixel_is_judged_by_its_own_faces() {
        let tolerance = 0.01;
        let all = [(6.0, 0.0), (3.0, -1.5 * tolerance), (6.0, -5.0)];
        for (tolerance, wrong, met, sum) in
            [(0.0, 36, 30, 18.0 * 5.0 + 12.0 * 0.015), (tolerance, 18, 18, 18.0 * 5.0)]
        {
            let (faces, rays) = scene(&all, Some(tolerance));
            let truth = zbuffer(&rays, &faces).into_image();
            let alternating = (0..36).map(|i| if i % 2 == 0 { 1 } else { 2 }).collect();
            let painted = Image::from_faces(SIZE, alternating, 0);
            let found = compare(&rays, &faces, &painted, &truth);
            assert_eq!((found.wrong_order, found.contested), (wrong, 36 - wrong));
            let error = DepthError::of(&rays, &faces, &painted, &truth, &found);
            assert_eq!(error.pixels, met);
            assert!((error.max - 5.0).abs() < 1e-12 && (error.sum - sum).abs() < 1e-9, "{error:?}");
        }
    }

    /// For an eye as well, depth is measured along the direction of view, not along rays.
    #[test]
    fn depth_is_along_the_direction_of_view() {
        let (faces, _) = scene(&[(6.0, 0.0), (6.0, -2.0)], Some(0.0));
        let (eye, target) = (DVec3::new(3.0, 3.0, 4.0), DVec3::new(3.0, 3.0, 0.0));
        let camera = Camera::perspective(eye, target, DVec3::Y, 0.9, SIZE).unwrap();
        let rays = Rays::new(&camera, &faces).unwrap();
        let truth = zbuffer(&rays, &faces).into_image();
        let painted = Image::from_faces(SIZE, vec![1; 36], 0);
        let found = compare(&rays, &faces, &painted, &truth);
        let error = DepthError::of(&rays, &faces, &painted, &truth, &found);
        assert!(error.pixels == 36 && (error.max - 2.0).abs() < 1e-12, "{error:?}");
        assert!((error.sum - 72.0).abs() < 1e-9, "{error:?}");
    }
}
