//! The camera.

use glam::DVec3;

use super::error::{CameraError, Kind};
use crate::viewpoint::Viewpoint;

/// A camera: a viewpoint, an orientation, and a picture's size in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub(super) projection: Projection,
    /// Unit vectors, each perpendicular to the others.
    pub(super) right: DVec3,
    pub(super) up: DVec3,
    pub(super) forward: DVec3,
    pub(super) size: [u32; 2],
}

/// How a camera projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// From an eye point.
    Perspective {
        /// The eye.
        eye: DVec3,
        /// The tangent of half the vertical field of view.
        half_height: f64,
    },
    /// Along a direction, from infinitely far away.
    Parallel {
        /// The direction in which the camera looks, not normalised.
        direction: DVec3,
        /// The point in the middle of the picture.
        centre: DVec3,
        /// The picture's height, a length in the world.
        height: f64,
    },
}

impl Camera {
    /// The most pixels of a picture in each direction.
    pub const MAX_SIDE: u32 = 1 << 16;
    /// The most pixels of a picture.
    pub const MAX_PIXELS: u64 = 1 << 26;

    /// A perspective camera at `eye` that looks at `target`, with a vertical field of view in
    /// radians, for a picture of `[width, height]` pixels. Pixels are square.
    ///
    /// # Errors
    ///
    /// If a number is not finite, the eye is at the target, `up` is along the view, the field of
    /// view is not between 0 and π, or the size is zero or beyond the limits.
    pub fn perspective(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        field_of_view: f64,
        size: [u32; 2],
    ) -> Result<Self, CameraError> {
        if !field_of_view.is_finite() {
            return Err(Kind::NonFinite.into());
        }
        if !(field_of_view > 0.0 && field_of_view < std::f64::consts::PI) {
            return Err(Kind::FieldOfView.into());
        }
        let half_height = (field_of_view * 0.5).tan();
        Self::perspective_by_slope(eye, target, up, half_height, size)
    }

    /// A perspective camera with a given tangent of half the vertical field of view. Unlike an
    /// angle, which must be converted, it gives the same bits on every machine.
    ///
    /// # Errors
    ///
    /// As for [`perspective`](Self::perspective); the tangent must be positive.
    pub fn perspective_by_slope(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        half_height: f64,
        size: [u32; 2],
    ) -> Result<Self, CameraError> {
        if !(eye.is_finite() && target.is_finite() && half_height.is_finite()) {
            return Err(Kind::NonFinite.into());
        }
        if half_height <= 0.0 {
            return Err(Kind::FieldOfView.into());
        }
        // Halved first, so that the difference of two finite points is finite.
        let view = target * 0.5 - eye * 0.5;
        Self::oriented(Projection::Perspective { eye, half_height }, view, up, size)
    }

    /// A parallel camera that looks along `direction`, with `centre` in the middle of a picture
    /// that is `height` world units high and `[width, height]` pixels large. Pixels are square.
    ///
    /// # Errors
    ///
    /// If a number is not finite, `direction` is zero, `up` is along it, `height` is not positive,
    /// or the size is zero or beyond the limits.
    pub fn parallel(
        direction: DVec3,
        up: DVec3,
        centre: DVec3,
        height: f64,
        size: [u32; 2],
    ) -> Result<Self, CameraError> {
        if !(direction.is_finite() && centre.is_finite() && height.is_finite()) {
            return Err(Kind::NonFinite.into());
        }
        if height <= 0.0 {
            return Err(Kind::Height.into());
        }
        Self::oriented(Projection::Parallel { direction, centre, height }, direction, up, size)
    }

    fn oriented(
        projection: Projection,
        view: DVec3,
        up: DVec3,
        [width, height]: [u32; 2],
    ) -> Result<Self, CameraError> {
        if !up.is_finite() {
            return Err(Kind::NonFinite.into());
        }
        let sides = 1..=Self::MAX_SIDE;
        let pixels = u64::from(width) * u64::from(height);
        if !sides.contains(&width) || !sides.contains(&height) || pixels > Self::MAX_PIXELS {
            let (max_side, max_pixels) = (Self::MAX_SIDE, Self::MAX_PIXELS);
            return Err(Kind::Size { size: [width, height], max_side, max_pixels }.into());
        }
        let forward = unit(view).ok_or(Kind::NoDirection)?;
        let side = forward.cross(unit(up).ok_or(Kind::UpAlongView)?);
        // Smaller: rounding would decide the picture's orientation.
        if side.length() < 1e-9 {
            return Err(Kind::UpAlongView.into());
        }
        let right = side.normalize();
        let up = right.cross(forward).normalize();
        Ok(Self { projection, right, up, forward, size: [width, height] })
    }

    /// How the camera projects.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// The viewpoint to order fragments for.
    pub fn viewpoint(&self) -> Viewpoint {
        match self.projection {
            Projection::Perspective { eye, .. } => Viewpoint::Eye(eye),
            Projection::Parallel { direction, .. } => Viewpoint::Direction(direction),
        }
    }

    /// The picture's width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The unit vector to the right.
    pub fn right(&self) -> DVec3 {
        self.right
    }

    /// The unit vector upwards in the picture.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// The unit vector in the direction in which the camera looks.
    pub fn forward(&self) -> DVec3 {
        self.forward
    }

    /// The side of a pixel: at distance 1 from the eye, or, for a parallel camera, at any distance.
    pub fn pixel_size(&self) -> f64 {
        let span = match self.projection {
            Projection::Perspective { half_height, .. } => 2.0 * half_height,
            Projection::Parallel { height, .. } => height,
        };
        span / f64::from(self.size[1])
    }

    /// The same view with a picture of another size; the vertical field of view stays.
    ///
    /// # Errors
    ///
    /// If the size is zero or beyond the limits.
    pub fn with_size(&self, size: [u32; 2]) -> Result<Self, CameraError> {
        Self::oriented(self.projection, self.forward, self.up, size)
    }
}

/// The unit vector along a vector of any length that `f64` can express; `None` for zero.
pub(super) fn unit(v: DVec3) -> Option<DVec3> {
    let size = v.abs().max_element();
    if size > 0.0 && size.is_finite() { Some((v / size).normalize()) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [64, 48];

    #[test]
    fn looks_from_eye_to_target_with_up_upwards() {
        let eye = DVec3::new(0.0, 0.0, 5.0);
        let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 1.0, SIZE).unwrap();
        assert_eq!(camera.forward(), DVec3::NEG_Z);
        assert_eq!(camera.right(), DVec3::X);
        assert_eq!(camera.up(), DVec3::Y);
        assert_eq!(camera.viewpoint(), Viewpoint::Eye(eye));
    }

    #[test]
    fn extremes_of_the_range_have_a_direction() {
        for size in [1e-310, 1e-300, 1e300, f64::MAX] {
            let eye = DVec3::new(size, 0.0, 0.0);
            let camera = Camera::perspective(eye, -eye, DVec3::Z * size, 1.0, SIZE).unwrap();
            assert_eq!(camera.forward(), DVec3::NEG_X, "{size:e}");
        }
    }

    #[test]
    fn degenerate_cameras_are_errors() {
        let (o, x, z) = (DVec3::ZERO, DVec3::X, DVec3::Z);
        let perspective = |eye, up, fov, size| Camera::perspective(eye, o, up, fov, size);
        let message = |camera: Result<Camera, CameraError>| camera.unwrap_err().to_string();
        assert!(message(perspective(o, z, 1.0, SIZE)).contains("looks nowhere"));
        assert!(message(perspective(x, x, 1.0, SIZE)).contains("up vector"));
        assert!(message(perspective(x, o, 1.0, SIZE)).contains("up vector"));
        assert!(message(perspective(x, z, 0.0, SIZE)).contains("field of view"));
        assert!(message(perspective(x, z, 3.2, SIZE)).contains("field of view"));
        assert!(message(perspective(x / 0.0, z, 1.0, SIZE)).contains("infinite"));
        assert!(message(perspective(x, z, f64::NAN, SIZE)).contains("infinite"));
        assert!(message(perspective(x, z, 1.0, [0, 5])).contains("0x5"));
        assert!(message(perspective(x, z, 1.0, [1 << 14, 1 << 14])).contains("16384x16384"));
        assert!(message(Camera::parallel(o, z, o, 1.0, SIZE)).contains("looks nowhere"));
        assert!(message(Camera::parallel(x, z, o, 0.0, SIZE)).contains("height"));
    }
}
