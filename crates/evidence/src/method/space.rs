//! The camera's own coordinates, in `f64`.

use glam::DVec3;

use binspace::internals::{LATTICE_LIMIT, Lattice};
use binspace::view::{Camera, Projection};

/// Converts lattice points to coordinates along the camera's axes: x to the right, y down, and z for the
/// depth along the direction of view. Depths start at the eye, or at the centre of a parallel camera's
/// picture.
///
/// Supports only cameras with square pixels that look at the middle of their picture.
///
/// The unit is 2⁵¹ lattice units, which is one to four times half the scene's extent, so the magnitude of
/// numbers suits `f32`.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraSpace {
    origin: DVec3,
    /// Right, down and forward, divided by the unit.
    axes: [DVec3; 3],
    /// The side of a pixel in units. For a perspective camera, it is the side at depth 1.
    pub(super) pixel: f64,
    pub(super) size: [u32; 2],
    pub(super) perspective: bool,
    lattice: Lattice,
}

impl CameraSpace {
    pub(super) fn new(camera: &Camera, lattice: &Lattice) -> Self {
        let to_units = 1.0 / LATTICE_LIMIT;
        let (origin, pixel, perspective) = match *camera.projection() {
            Projection::Perspective { eye, .. } => (eye, camera.pixel_size()[1], true),
            Projection::Parallel { centre, .. } => {
                (centre, lattice.length_to_lattice(camera.pixel_size()[1]) * to_units, false)
            }
        };
        let axes = [camera.right(), -camera.up(), camera.forward()].map(|axis| axis * to_units);
        let origin = DVec3::from_array(lattice.to_lattice(origin));
        let (size, lattice) = (camera.size(), *lattice);
        Self { origin, axes, pixel, size, perspective, lattice }
    }

    /// A world length in these units.
    pub(super) fn length(&self, world: f64) -> f64 {
        self.lattice.length_to_lattice(world) / LATTICE_LIMIT
    }

    /// A lattice point in these coordinates.
    #[inline]
    pub(super) fn place(&self, point: [f64; 3]) -> DVec3 {
        self.turn(DVec3::from_array(point) - self.origin)
    }

    /// A vector of lattice units along the camera's axes.
    #[inline]
    pub(super) fn turn(&self, vector: DVec3) -> DVec3 {
        let [right, down, forward] = self.axes;
        DVec3::new(vector.dot(right), vector.dot(down), vector.dot(forward))
    }

    /// A lattice point with its place.
    #[inline]
    pub(super) fn vertex(&self, lattice: [f64; 3]) -> Vertex {
        Vertex { at: self.place(lattice), lattice: DVec3::from_array(lattice) }
    }

    /// The position of a place on the picture, in pixels from the upper left corner.
    #[inline]
    pub(super) fn project(&self, at: DVec3) -> [f64; 2] {
        let unit = if self.perspective { at.z * self.pixel } else { self.pixel };
        let [width, height] = self.size.map(f64::from);
        [at.x / unit + 0.5 * width, at.y / unit + 0.5 * height]
    }
}

/// A vertex of a polygon seen by a camera.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Vertex {
    /// In the camera's coordinates.
    pub(super) at: DVec3,
    /// In lattice units.
    pub(super) lattice: DVec3,
}

impl Vertex {
    /// The point at a share `t` of the way from `a` to `b`.
    pub(super) fn between(a: &Self, b: &Self, t: f64) -> Self {
        Self { at: a.at + (b.at - a.at) * t, lattice: a.lattice + (b.lattice - a.lattice) * t }
    }
}
