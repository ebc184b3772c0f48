//! Compares the raster with exact rationals and with hand-made pictures, and tests that pieces tile their
//! faces.

mod camera;
mod hand;
mod mesh;
pub(crate) mod oracle;
mod parts;
mod signs;
mod tiling;

use dashu_int::IBig;
use glam::{DMat4, DVec3, DVec4};

use super::rays::{RayOrigin, Rays};
use crate::exact::Faces;
use crate::random::SplitMix64;
use crate::view::Camera;

/// The source of random scenes, planes and cameras.
pub(super) struct Random(SplitMix64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    pub(super) fn below(&mut self, limit: u64) -> u64 {
        self.0.next() % limit
    }

    /// A number from −1 to 1.
    pub(super) fn unit(&mut self) -> f64 {
        self.0.range(-1.0, 1.0)
    }

    pub(super) fn point(&mut self) -> DVec3 {
        self.0.point(-1.0, 1.0)
    }

    /// A point with integer coordinates from −`limit` to `limit`.
    pub(super) fn grid(&mut self, limit: i32) -> DVec3 {
        let span = 2 * limit as u64 + 1;
        DVec3::from_array(std::array::from_fn(|_| f64::from(self.below(span) as i32 - limit)))
    }
}

pub(super) fn faces(polygons: &[Vec<DVec3>], tolerance: Option<f64>) -> Faces {
    Faces::new(polygons, tolerance).unwrap().0
}

/// Views of a scene of extent about `size` around the origin: general, along the axes with rays through
/// lattice points, close, grazing and far views, and parallel views of all these kinds. Also the same views
/// off-axis, with oblong and skewed pixels.
pub(super) fn cameras(random: &mut Random, size: f64, pixels: [u32; 2]) -> Vec<Camera> {
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut cameras = Vec::new();
    for kind in 0..6 {
        let (axis, up) = [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z), (DVec3::NEG_Z, DVec3::X)]
            [random.below(3) as usize];
        let (eye, target) = match kind {
            0 => (random.point() * 3.0, random.point() * 0.2),
            1 => (axis * 4.0, DVec3::ZERO),
            2 => (axis + up, up),
            3 => (random.point(), random.point() * 0.2),
            4 => (random.point() + axis * 1e5, random.point() * 0.2),
            _ => (random.grid(2) / 4.0, random.grid(2) / 4.0 + axis * 8.0),
        };
        let up = if up.cross(target - eye).length() < 1e-6 { DVec3::ONE } else { up };
        let fov = if kind == 4 { 3e-5 } else { quarter };
        cameras.push(Camera::perspective(eye * size, target * size, up, fov, pixels));
        let direction = (target - eye) * size;
        cameras.push(Camera::parallel(direction, up, random.point() * size, 2.0 * size, pixels));
        cameras.push(Camera::parallel(axis, up, DVec3::ZERO, 4.0 * size, pixels));
    }
    let mut cameras: Vec<Camera> = cameras
        .into_iter()
        .map(|camera| {
            camera.or(Camera::looking_at_all([-DVec3::ONE, DVec3::ONE], DVec3::Z, pixels)).unwrap()
        })
        .collect();
    for k in (0..cameras.len()).step_by(2) {
        let matrix = skew(random) * cameras[k].matrix(size, 2.0 * size);
        cameras.push(Camera::from_matrix(matrix, pixels).unwrap());
    }
    cameras
}

/// A matrix of clip coordinates that scales, shears and shifts the picture.
fn skew(random: &mut Random) -> DMat4 {
    let [width, height] = [0; 2].map(|_| 1.5 + random.unit());
    let [across, rise] = [0; 2].map(|_| 0.4 * random.unit());
    let columns = [DVec3::new(width, rise, 0.0), DVec3::new(across, height, 0.0), DVec3::Z];
    let [x, y, z] = columns.map(|column| column.extend(0.0));
    DMat4::from_cols(x, y, z, DVec4::new(random.unit(), random.unit(), 0.0, 1.0))
}

/// The ray of a pixel: its start, or any point of it, and its direction.
pub(super) fn ray(rays: &Rays, x: u32, y: u32) -> [[IBig; 3]; 2] {
    let given: [IBig; 3] = std::array::from_fn(|i| {
        IBig::from(rays.base[i]) + IBig::from(rays.right[i]) * x + IBig::from(rays.down[i]) * y
    });
    match rays.pencil {
        RayOrigin::From { eye, shift } => [eye.map(|c| IBig::from(c) << shift as usize), given],
        RayOrigin::Along { direction } => [given, direction.map(IBig::from)],
    }
}
