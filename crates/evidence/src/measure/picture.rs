//! Wrong pixels, over one picture or many.

use std::ops::AddAssign;

use binspace::internals::Faces;
use binspace::raster::{Image, Rays, compare, depth_error};

/// What is wrong with painted pictures, counted over all that were added.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PictureError {
    /// Pixels in which there is a polygon.
    pub covered: usize,
    /// Pixels that show another polygon than the nearest, where the tolerance allows for both.
    pub contested: usize,
    /// Pixels that show a polygon which another one hides.
    pub wrong_order: usize,
    /// Pixels that show nothing where there is a polygon.
    pub holes: usize,
    /// Pixels that show a polygon where there is none.
    pub spills: usize,
    /// How far behind the nearest polygon a painted one is at most, as a share of the extent.
    pub depth_max: f64,
    /// How far on average, over the wrong pixels in which the painted polygon is met at all.
    pub depth_mean: f64,
    /// How many these are.
    pub depth_pixels: usize,
}

impl PictureError {
    /// What is wrong with one picture; `truth` is the [exact depth
    /// buffer](binspace::raster::zbuffer)'s, made with the same rays.
    pub fn of(rays: &Rays, faces: &Faces, painted: &Image, truth: &Image) -> Self {
        let found = compare(rays, faces, painted, truth);
        let depth = depth_error(rays, faces, painted, truth, &found);
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

    /// How many pixels are wrong: all that differ but the contested ones.
    pub fn wrong(&self) -> usize {
        self.wrong_order + self.holes + self.spills
    }

    /// The wrong pixels as a share of the covered ones.
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

/// The longest side of the box around all faces, in world units.
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
