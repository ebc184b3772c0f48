//! The camera's own coordinates, in `f64`.

use glam::DVec3;

use crate::geom::{LATTICE_LIMIT, Lattice};
use crate::view::{Camera, Projection};

/// Takes lattice points to coordinates along the camera's axes: x to the right, y down, z the depth
/// in its direction of view, from the eye, or from the centre of a parallel camera's picture.
///
/// The unit is half the scene's extent, or up to four times that (2⁵¹ lattice units), so that
/// numbers are of a size that suits `f32`.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraSpace {
    origin: DVec3,
    /// Right, down and forward, divided by the unit.
    axes: [DVec3; 3],
    /// The side of a pixel: at depth 1, or, for a parallel camera, in units.
    pub(super) pixel: f64,
    pub(super) size: [u32; 2],
    pub(super) perspective: bool,
}

impl CameraSpace {
    pub(super) fn new(camera: &Camera, lattice: &Lattice) -> Self {
        let to_units = 1.0 / LATTICE_LIMIT;
        let (origin, pixel, perspective) = match *camera.projection() {
            Projection::Perspective { eye, .. } => (eye, camera.pixel_size(), true),
            Projection::Parallel { centre, .. } => {
                (centre, lattice.length_to_lattice(camera.pixel_size()) * to_units, false)
            }
        };
        let axes = [camera.right(), -camera.up(), camera.forward()].map(|axis| axis * to_units);
        let origin = DVec3::from_array(lattice.to_lattice(origin));
        Self { origin, axes, pixel, size: camera.size(), perspective }
    }

    /// A lattice point in these coordinates.
    #[inline]
    pub(super) fn place(&self, point: [f64; 3]) -> DVec3 {
        let arm = DVec3::from_array(point) - self.origin;
        let [right, down, forward] = self.axes;
        DVec3::new(arm.dot(right), arm.dot(down), arm.dot(forward))
    }
}
