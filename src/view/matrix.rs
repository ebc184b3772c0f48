//! Cameras from view-projection matrices, and the matrices of cameras.

use crate::Error;
use glam::{DMat4, DVec3, DVec4};

use super::{Camera, NON_FINITE, Projection, checked, refused, unit};

/// A field of view with a smaller tangent counts as parallel. Too small: a parallel matrix whose last row was
/// rounded has an eye, very far away. Too large: eyes of narrow views are lost.
/// ([`Rays`](crate::raster::Rays) reject views as narrow as this.)
const PARALLEL: f64 = 1.0 / (1u64 << 45) as f64;
/// Three rows of a matrix, each scaled to length 1, count as dependent if they span less than this volume.
/// Too small: rounding decides where the eye is. Too large: skewed pictures are rejected as singular.
const SINGULAR: f64 = 1e-10;
/// The sine of the least angle between the sides of a pixel, and between the picture and the line of sight to
/// the picture's middle. Too small: rounding decides where points appear. Too large: steep off-axis views are
/// rejected.
const LEAST_ANGLE: f64 = 1e-3;
/// The direction of a parallel matrix is the direction of increasing depth. If depth changes along the rays
/// by less than this share of the largest change along any direction, depth does not determine the direction.
/// Too small: rounding decides. Too large: mirrored pictures are shown from behind.
const FLAT: f64 = 1e-9;

impl Camera {
    /// Creates the camera of a view-projection matrix. The matrix maps world coordinates to clip coordinates,
    /// in which x points right and y points up. A point with the clip coordinates (x, y, z, w) appears in the
    /// picture at ((½ + ½ x/w) · width, (½ − ½ y/w) · height).
    ///
    /// Every matrix of a perspective or parallel projection has a camera: off-axis frusta, pixels that are
    /// not square, axes of different scales, sheared axes. The rows of x, y and w determine the camera:
    ///
    /// | w | the camera |
    /// |---|---|
    /// | changes from point to point | is a perspective camera: x, y and w are 0 at the eye, and w is positive ahead of the eye |
    /// | is the same positive number at all points | is a parallel camera: it looks along the direction in which x and y do not change |
    ///
    /// The row of z, the depth, may have any finite numbers. There is no near and no far plane. For a
    /// perspective matrix, the depth is ignored. For a parallel matrix, the depth decides in which direction
    /// the camera looks: the depth must increase away from the viewer, as in OpenGL, Vulkan, Direct3D, Metal
    /// and WebGPU, or be constant along the direction of view. If depths are reversed ("reversed z"), negate
    /// the row of z: `DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0)) * matrix`.
    ///
    /// Mirrored pictures are an error. In a mirrored picture, the directions right, up and towards the viewer
    /// are left-handed. Mirrored pictures have two common causes:
    ///
    /// - y points down, as in Vulkan: negate the second row of the matrix.
    /// - One axis is inverted, as in some plots: negate the first row, and mirror the drawing (x becomes
    ///   width − x).
    ///
    /// ```
    /// use binspace::glam::{DVec3, dcamera::rh};
    /// use binspace::view::Camera;
    ///
    /// // A window from (-2, 0) to (1, 1); the eye is 1.5 in front of it, but not in front of its middle.
    /// let eye = DVec3::new(0.0, 0.0, 1.5);
    /// let view = rh::view::look_to_mat4(eye, DVec3::NEG_Z, DVec3::Y);
    /// let window = rh::proj::directx::frustum(-2.0, 1.0, 0.0, 1.0, 1.5, 100.0);
    /// let camera = Camera::from_matrix(window * view, [600, 100])?;
    ///
    /// assert!(camera.eye().is_some_and(|found| found.distance(eye) < 1e-12));
    /// // Pixels are twice as high as wide.
    /// let [width, height] = camera.pixel_size();
    /// assert!((height / width - 2.0).abs() < 1e-12);
    /// // The window's corners are the picture's corners.
    /// let [x, y] = camera.project(DVec3::new(1.0, 0.0, 0.0)).expect("ahead");
    /// assert!((x - 600.0).abs() < 1e-9 && (y - 100.0).abs() < 1e-9);
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// - A number is not finite.
    /// - The rows determine neither an eye nor a direction.
    /// - w is positive nowhere, so that nothing is ahead of the camera.
    /// - The picture is mirrored.
    /// - The angle between two sides of a pixel is less than 0.001 radians.
    /// - The angle between the picture's plane and the line of sight to the picture's middle is less than
    ///   0.001 radians.
    /// - A side of the picture is 0 or above [`MAX_SIDE`](Self::MAX_SIDE), or the picture has more than
    ///   [`MAX_PIXELS`](Self::MAX_PIXELS) pixels.
    pub fn from_matrix(matrix: DMat4, size: [u32; 2]) -> Result<Self, Error> {
        let size = checked(size)?;
        if !matrix.is_finite() {
            return refused(NON_FINITE);
        }
        let [x, y, w] = scaled([0, 1, 3].map(|k| matrix.row(k)));
        let (Some(across), Some(rise)) = (unit(x.truncate()), unit(y.truncate())) else {
            return refused(DEPENDENT);
        };
        let lengths = [across.dot(x.truncate()), rise.dot(y.truncate())];
        let ahead = unit(w.truncate()).unwrap_or(DVec3::ZERO);
        let depth = ahead.dot(w.truncate());
        let is_parallel = depth <= PARALLEL * lengths[0].min(lengths[1]);
        // Lengths in the picture are measured at this w.
        let (forward, scale) = if is_parallel {
            if w.w <= 0.0 {
                return refused(NOTHING_AHEAD);
            }
            let Some(direction) = unit(rise.cross(across)) else { return refused(DEPENDENT) };
            // The other direction would look at the mirror image.
            let away = direction.dot(unit(matrix.row(2).truncate()).unwrap_or(DVec3::ZERO));
            if away < -FLAT {
                return refused(MIRRORED_OR_REVERSED);
            }
            (direction, w.w)
        } else {
            (ahead, depth)
        };
        let volume = forward.dot(rise.cross(across));
        if volume.abs() < SINGULAR {
            return refused(DEPENDENT);
        }
        if volume < 0.0 {
            return refused(MIRRORED);
        }
        // The dual basis: each vector is perpendicular to two of the rows.
        let [side, height, middle] =
            [forward.cross(rise), across.cross(forward), rise.cross(across)].map(|v| v / volume);
        let middle = if is_parallel { forward } else { middle };
        let [right, up] = [side, height].map(DVec3::normalize);
        let is_skewed = right.cross(up).length() < LEAST_ANGLE;
        if is_skewed || middle.length() * LEAST_ANGLE > 1.0 {
            return refused(SKEWED);
        }
        let offset = if is_parallel { DVec3::ZERO } else { middle * (w.w / depth) };
        let origin = -(side * (x.w / lengths[0]) + height * (y.w / lengths[1]) + offset);
        let half_width = side.length() * (scale / lengths[0]);
        let half_height = height.length() * (scale / lengths[1]);
        let aspect = half_width / half_height * (f64::from(size[1]) / f64::from(size[0]));
        let lengths = [half_width, half_height, aspect];
        if !(origin.is_finite() && lengths.iter().all(|length| length.is_normal())) {
            return refused(TOO_FAR);
        }
        let projection = if is_parallel {
            Projection::Parallel { direction: forward, centre: origin, height: 2.0 * half_height }
        } else {
            Projection::Perspective { eye: origin, half_height }
        };
        Ok(Self { projection, right, up, forward, middle, aspect, size })
    }

    /// Returns the view-projection matrix, which maps world coordinates to clip coordinates. In clip
    /// coordinates, x points right, and y points up. The depth is 0 at the distance `near` and 1 at the
    /// distance `far`. These are the conventions of WebGPU, Metal and Direct3D; Vulkan differs only in y.
    ///
    /// Distances are measured along [`forward`](Self::forward): from the eye of a perspective camera, or from
    /// the centre of a parallel camera. Distances of a parallel camera may be negative. The two distances
    /// must be finite and different.
    ///
    /// ```
    /// use binspace::glam::DVec3;
    /// use binspace::view::Camera;
    ///
    /// let eye = DVec3::new(0.0, -5.0, 2.0);
    /// let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 1.0, [640, 480])?;
    /// let point = DVec3::new(0.4, 0.3, 0.7);
    /// let clip = camera.matrix(0.1, 100.0).project_point3(point);
    /// let [x, y] = camera.project(point).expect("in front of the eye");
    /// assert!(((0.5 + 0.5 * clip.x) * 640.0 - x).abs() < 1e-9);
    /// assert!(((0.5 - 0.5 * clip.y) * 480.0 - y).abs() < 1e-9);
    /// assert!(clip.z > 0.0 && clip.z < 1.0);
    /// # Ok::<(), binspace::Error>(())
    /// ```
    pub fn matrix(&self, near: f64, far: f64) -> DMat4 {
        let ([half_width, half_height], [x, y]) = (self.half_size(), self.rows());
        let origin = self.origin();
        let row = |axis: DVec3, scale: f64, offset: f64| -> DVec4 {
            (axis * scale).extend(offset - axis.dot(origin) * scale)
        };
        let depth = 1.0 / (far - near);
        let [across, rise] = [row(x, 1.0 / half_width, 0.0), row(y, 1.0 / half_height, 0.0)];
        let [depth, w] = match self.projection {
            Projection::Perspective { .. } => {
                let scale = far * depth;
                let depths = row(self.forward, scale, -near * scale);
                [depths, row(self.forward, 1.0, 0.0)]
            }
            Projection::Parallel { .. } => [row(self.forward, depth, -near * depth), DVec4::W],
        };
        let rows = [across, rise, depth, w];
        DMat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose()
    }
}

const DEPENDENT: &str = "the rows of x, y and w of the matrix determine neither an eye nor a direction of view: a \
                         row is zero, or the rows are linearly dependent";
const NOTHING_AHEAD: &str = "w of the matrix is zero or negative for every point: it must be positive ahead of the \
                             camera";
const MIRRORED: &str = "the matrix mirrors the picture: negate its first row and mirror the drawing; or, if its y \
                        points down, negate its second row";
const MIRRORED_OR_REVERSED: &str = "the matrix mirrors the picture, or its depth decreases away from the viewer: if \
                                    depths are reversed, negate its third row; if its y points down, negate its second \
                                    row; or negate its first row and mirror the drawing";
const SKEWED: &str = "the sides of a pixel, or the picture and the line of sight to its middle, form an angle of less \
                      than 0.001 radians";
const TOO_FAR: &str =
    "the eye, the middle or the size of the matrix's picture is beyond the range of f64";

/// The rows multiplied by the power of two that makes the largest number about 1. The scale of clip
/// coordinates does not matter.
fn scaled(rows: [DVec4; 3]) -> [DVec4; 3] {
    let [x, y, w] = rows.map(|row| row.abs().max_element());
    let exponent = x.max(y).max(w).log2().floor().clamp(-1000.0, 1000.0);
    rows.map(|row| row * (-exponent).exp2())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::viewpoint::Viewpoint;

    const SIZE: [u32; 2] = [640, 360];

    /// Cameras of both kinds around the origin.
    fn cameras(random: &mut SplitMix64) -> [Camera; 2] {
        let (eye, up) = (random.point(-1.0, 1.0).normalize() * 9.0, random.point(-1.0, 1.0));
        let target = random.point(-1.0, 1.0);
        let parallel = Camera::parallel(target - eye, up, target, random.range(2.0, 9.0), SIZE);
        [Camera::perspective(eye, target, up, 0.9, SIZE).unwrap(), parallel.unwrap()]
    }

    /// The position of a world point by the matrix, in pixels.
    fn place(matrix: &DMat4, point: DVec3) -> [f64; 2] {
        let clip = *matrix * point.extend(1.0);
        [(0.5 + 0.5 * clip.x / clip.w) * 640.0, (0.5 - 0.5 * clip.y / clip.w) * 360.0]
    }

    fn is_near(a: [f64; 2], b: [f64; 2], most: f64) -> bool {
        (a[0] - b[0]).abs() <= most && (a[1] - b[1]).abs() <= most
    }

    /// A map of pictures with a right-handed frame, and, for perspective cameras, a tilt.
    fn skew(random: &mut SplitMix64, tilt: f64) -> DMat4 {
        let [x, y] = [random.range(0.1, 9.0), random.range(0.1, 9.0)];
        let [a, b] = [random.range(-0.7, 0.7) * y, random.range(-0.7, 0.7) * x];
        let [tilt_x, tilt_y] = [x * random.range(-tilt, tilt), y * random.range(-tilt, tilt)];
        let shift = random.point(-2.0, 2.0);
        DMat4::from_cols(
            DVec4::new(x, b, 0.0, tilt_x),
            DVec4::new(a, y, 0.0, tilt_y),
            DVec4::Z,
            DVec4::new(shift.x, shift.y, shift.z, 1.0),
        )
    }

    /// The matrix puts points where the camera does, and maps the two distances to the depths 0 and 1. The
    /// camera made from the matrix is the same camera.
    #[test]
    fn the_matrix_of_a_camera_has_that_camera() {
        let mut random = SplitMix64::new(5);
        for camera in (0..200).flat_map(|_| cameras(&mut random)).collect::<Vec<_>>() {
            let matrix = camera.matrix(0.5, 40.0);
            let again = Camera::from_matrix(matrix * random.range(1e-9, 1e9), SIZE).unwrap();
            for _ in 0..10 {
                let point = random.point(-2.0, 2.0);
                let at = camera.project(point).unwrap();
                assert!(is_near(place(&matrix, point), at, 1e-9), "{camera:?}");
                assert!(is_near(again.project(point).unwrap(), at, 1e-9), "{camera:?} {again:?}");
            }
            for (distance, depth) in [(0.5, 0.0), (40.0, 1.0)] {
                let at = camera.origin() + camera.forward() * distance + camera.right();
                assert!((matrix.project_point3(at).z - depth).abs() < 1e-12, "{camera:?}");
            }
            let axes = [Camera::right, Camera::up, Camera::forward];
            assert!(axes.iter().all(|axis| axis(&camera).distance(axis(&again)) < 1e-12));
            let [width, height] = again.pixel_size().map(|side| side / camera.pixel_size()[1]);
            assert!((width - 1.0).abs() < 1e-12 && (height - 1.0).abs() < 1e-12);
            assert_eq!(camera.eye().is_some(), again.eye().is_some());
        }
    }

    #[test]
    fn skewed_oblong_and_off_axis_pictures_equal_the_pictures_of_the_matrix() {
        let mut random = SplitMix64::new(6);
        let mut accepted = [0; 2];
        for _ in 0..1000 {
            for (kind, camera) in cameras(&mut random).into_iter().enumerate() {
                let matrix = skew(&mut random, [0.05, 0.0][kind])
                    * camera.matrix(0.5, random.range(1.0, 9.0));
                let skewed = Camera::from_matrix(matrix, SIZE).unwrap();
                let eye = skewed.eye().unwrap_or(DVec3::ZERO);
                assert!(eye.distance(camera.eye().unwrap_or(DVec3::ZERO)) < 1e-9, "{skewed:?}");
                if let Viewpoint::Direction(direction) = skewed.viewpoint() {
                    assert!(direction.distance(camera.forward()) < 1e-9, "{skewed:?}");
                }
                let again = Camera::from_matrix(skewed.matrix(0.5, 2.0), SIZE).unwrap();
                let frustum = skewed.frustum();
                for _ in 0..10 {
                    let point = random.point(-2.0, 2.0);
                    let clip = matrix * point.extend(1.0);
                    if clip.w < 0.1 {
                        assert!(clip.w > 0.0 || skewed.project(point).is_none());
                        continue;
                    }
                    let at = place(&matrix, point);
                    let most = 1e-11 * (640.0 + at[0].abs() + at[1].abs());
                    assert!(is_near(skewed.project(point).unwrap(), at, most), "{skewed:?}");
                    assert!(is_near(again.project(point).unwrap(), at, most), "{skewed:?}");
                    // Visible points are in the frustum, and vice versa.
                    let outside = clip.x.abs().max(clip.y.abs()) / clip.w;
                    if (outside - 1.0).abs() > 1e-6 {
                        assert_eq!(frustum.meets([point; 2]), outside < 1.0, "{skewed:?}");
                        accepted[kind] += 1;
                    }
                }
            }
        }
        assert!(accepted.iter().all(|&count| count > 3000), "{accepted:?}");
    }

    /// An oblique (cabinet) projection as drawn by hand: depths lead up to the right at half their length.
    #[test]
    fn a_cabinet_projection_looks_along_the_direction_in_which_points_coincide() {
        let mut matrix = DMat4::IDENTITY;
        // x and y of a point increase by a quarter of its distance; z points to the viewer.
        (matrix.z_axis.x, matrix.z_axis.y) = (-0.25, -0.25);
        matrix.z_axis.z = -1.0;
        let camera = Camera::from_matrix(matrix, SIZE).unwrap();
        let Viewpoint::Direction(direction) = camera.viewpoint() else { panic!("parallel") };
        assert!(direction.distance(DVec3::new(-1.0, -1.0, -4.0).normalize()) < 1e-12);
        let at = |x, y, z| camera.project(DVec3::new(x, y, z)).unwrap();
        assert!(is_near(at(0.0, 0.0, 0.0), [320.0, 180.0], 1e-9));
        assert!(is_near(at(1.0, 1.0, 0.0), [640.0, 0.0], 1e-9));
        assert!(is_near(at(0.0, 0.0, -2.0), [480.0, 90.0], 1e-9));
    }

    /// Only the direction in which the depth increases matters, and only for a parallel camera.
    #[test]
    fn depths_of_any_convention_will_do() {
        let row = |matrix: &mut DMat4, row: DVec4| {
            (matrix.x_axis.z, matrix.y_axis.z) = (row.x, row.y);
            (matrix.z_axis.z, matrix.w_axis.z) = (row.z, row.w);
        };
        let mut random = SplitMix64::new(7);
        for camera in (0..50).flat_map(|_| cameras(&mut random)).collect::<Vec<_>>() {
            let is_parallel = camera.eye().is_none();
            let matrix = camera.matrix(1.0, 2.0);
            let expected = Camera::from_matrix(matrix, SIZE).unwrap();
            let (depth, x) = (matrix.row(2), matrix.row(0));
            let plane = camera.right().extend(3.0);
            for depth in [DVec4::ZERO, x, plane, depth * 1e300 / depth.abs().max_element()] {
                let mut other = matrix;
                row(&mut other, depth);
                assert_eq!(Camera::from_matrix(other, SIZE), Ok(expected), "{depth}");
            }
            let mut reversed = matrix;
            row(&mut reversed, -depth);
            let found = Camera::from_matrix(reversed, SIZE);
            if is_parallel {
                assert!(found.unwrap_err().to_string().contains("third row"));
                let mended = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0)) * reversed;
                assert_eq!(Camera::from_matrix(mended, SIZE), Ok(expected));
            } else {
                assert_eq!(found, Ok(expected));
            }
        }
    }

    /// A last row that is off by rounding does not put the eye 10¹⁶ units away.
    #[test]
    fn a_parallel_matrix_may_be_rounded() {
        let mut random = SplitMix64::new(8);
        for _ in 0..50 {
            let [_, camera] = cameras(&mut random);
            let mut matrix = camera.matrix(1.0, 2.0);
            (matrix.x_axis.w, matrix.z_axis.w) = (1e-17, -2e-17);
            let found = Camera::from_matrix(matrix, SIZE).unwrap();
            assert_eq!(found, Camera::from_matrix(camera.matrix(1.0, 2.0), SIZE).unwrap());
        }
    }

    #[test]
    fn matrices_without_a_camera_are_errors() {
        let message = |matrix: DMat4| Camera::from_matrix(matrix, SIZE).unwrap_err().to_string();
        let scaled = |x, y, z| DMat4::from_scale(DVec3::new(x, y, z));
        let mut random = SplitMix64::new(9);
        for camera in cameras(&mut random) {
            let matrix = camera.matrix(1.0, 2.0);
            for number in [f64::NAN, f64::INFINITY] {
                let mut broken = matrix;
                broken.z_axis.z = number;
                assert!(message(broken).contains("infinite"));
            }
            assert!(message(scaled(0.0, 1.0, 1.0) * matrix).contains("depend"));
            assert!(message(scaled(1.0, 0.0, 1.0) * matrix).contains("depend"));
            let mut same = DMat4::IDENTITY;
            (same.x_axis.y, same.y_axis.y) = (2.0, 0.0);
            assert!(message(same * matrix).contains("depend"));
            let mirrored = message(scaled(-1.0, 1.0, 1.0) * matrix);
            assert!(mirrored.contains("mirror") && mirrored.contains("first row"), "{mirrored}");
            assert!(message(scaled(1.0, -1.0, 1.0) * matrix).contains("second row"));
            // As in the documentation of `from_matrix`.
            assert!(Camera::from_matrix(scaled(-1.0, -1.0, 1.0) * matrix, SIZE).is_ok());
            let mut sheared = DMat4::IDENTITY;
            sheared.y_axis.x = 1e4;
            assert!(message(sheared * matrix).contains("sides of a pixel"));
            let size = Camera::from_matrix(matrix, [0, 5]);
            assert!(size.unwrap_err().to_string().contains("0x5"));
            let w = |factor: f64| DMat4::from_diagonal(DVec4::new(1.0, 1.0, 1.0, factor));
            match camera.eye() {
                // Then the other half-space is ahead, and its picture is mirrored.
                Some(_) => assert!(message(w(-1.0) * matrix).contains("mirror")),
                None => {
                    assert!(message(w(-1.0) * matrix).contains("zero or negative"));
                    assert!(message(w(0.0) * matrix).contains("zero or negative"));
                }
            }
        }
        let [camera, _] = cameras(&mut random);
        let mut shifted = DMat4::IDENTITY;
        shifted.w_axis.x = 1e4;
        assert!(message(shifted * camera.matrix(1.0, 2.0)).contains("line of sight"));
        assert!(message(DMat4::ZERO).contains("depend"));
    }
}
