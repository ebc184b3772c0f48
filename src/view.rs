//! Cameras: from where a picture is taken, and where in it a point of the world appears.
//!
//! A picture is `width` × `height` pixels; x runs right, y runs down, pixel (0, 0) is the top left
//! one and covers the square from (0, 0) to (1, 1), so that its centre is at (0.5, 0.5).

use glam::{DMat4, DVec3, DVec4};

use crate::error::Kind;
use crate::random::SplitMix64;
use crate::viewpoint::{Frustum, Viewpoint};

/// Polygons are clipped at this distance from the eye's plane, as a share of the distance of their
/// furthest vertex. Larger: parts near the eye are missing. Smaller: coordinates lose digits.
const NEAR: f64 = 1e-9;

const NON_FINITE: &str = "a camera parameter is NaN or infinite";
const FIELD_OF_VIEW: &str = "the field of view must be more than 0 and less than π radians";

/// A camera: a viewpoint, an orientation, and a picture's size in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    projection: Projection,
    /// Unit vectors, each perpendicular to the others.
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    size: [u32; 2],
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
            return refused(NON_FINITE);
        }
        if !(field_of_view > 0.0 && field_of_view < std::f64::consts::PI) {
            return refused(FIELD_OF_VIEW);
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
        Self::oriented(Projection::Parallel { direction, centre, height }, direction, up, size)
    }

    fn oriented(
        projection: Projection,
        view: DVec3,
        up: DVec3,
        [width, height]: [u32; 2],
    ) -> Result<Self, CameraError> {
        let (origin, span, too_small) = match projection {
            Projection::Perspective { eye, half_height } => (eye, half_height, FIELD_OF_VIEW),
            Projection::Parallel { centre, height, .. } => {
                (centre, height, "the height that a parallel camera shows must be positive")
            }
        };
        if !(origin.is_finite() && view.is_finite() && up.is_finite() && span.is_finite()) {
            return refused(NON_FINITE);
        }
        if span <= 0.0 {
            return refused(too_small);
        }
        let sides = 1..=Self::MAX_SIDE;
        let pixels = u64::from(width) * u64::from(height);
        if !sides.contains(&width) || !sides.contains(&height) || pixels > Self::MAX_PIXELS {
            return refused(format!(
                "a picture must have 1 to {} pixels each way and at most {} in all, not {width}x{height}",
                Self::MAX_SIDE,
                Self::MAX_PIXELS
            ));
        }
        let Some(forward) = unit(view) else {
            return refused(
                "the camera looks nowhere: its eye and target are the same, or its direction is zero",
            );
        };
        let side = forward.cross(unit(up).unwrap_or(forward));
        // Smaller: rounding would decide the picture's orientation.
        if side.length() < 1e-9 {
            return refused("the camera's up vector is zero or along its direction of view");
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

    /// The eye; `None` for a parallel camera.
    pub fn eye(&self) -> Option<DVec3> {
        match self.projection {
            Projection::Perspective { eye, .. } => Some(eye),
            Projection::Parallel { .. } => None,
        }
    }

    /// The view-projection matrix: from the world to clip coordinates, with x to the right, y upwards, and
    /// depths from 0 at the distance `near` to 1 at `far`, as WebGPU, Vulkan (y aside), Metal and Direct3D
    /// have them. Distances are along the direction of view, from the eye, or from the centre of a
    /// parallel camera, where they may be negative. They must be finite and different.
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
    /// # Ok::<(), binspace::view::CameraError>(())
    /// ```
    pub fn matrix(&self, near: f64, far: f64) -> DMat4 {
        let [half_width, half_height] =
            self.size.map(|side| 0.5 * f64::from(side) * self.pixel_size());
        let row = |axis: DVec3, origin: DVec3, scale: f64, offset: f64| -> DVec4 {
            (axis * scale).extend(offset - axis.dot(origin) * scale)
        };
        let depth = 1.0 / (far - near);
        let rows = match self.projection {
            Projection::Perspective { eye, .. } => [
                row(self.right, eye, 1.0 / half_width, 0.0),
                row(self.up, eye, 1.0 / half_height, 0.0),
                row(self.forward, eye, far * depth, -near * far * depth),
                row(self.forward, eye, 1.0, 0.0),
            ],
            Projection::Parallel { centre, .. } => [
                row(self.right, centre, 1.0 / half_width, 0.0),
                row(self.up, centre, 1.0 / half_height, 0.0),
                row(self.forward, centre, depth, -near * depth),
                DVec4::W,
            ],
        };
        DMat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose()
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

    /// A point in homogeneous picture coordinates: (x·w, y·w, w) for the pixel position (x, y),
    /// with w the distance in front of the eye's plane, or 1 for a parallel camera.
    pub fn homogeneous(&self, point: DVec3) -> DVec3 {
        let (origin, parallel) = match self.projection {
            Projection::Perspective { eye, .. } => (eye, false),
            Projection::Parallel { centre, .. } => (centre, true),
        };
        let arm = point - origin;
        let w = if parallel { 1.0 } else { arm.dot(self.forward) };
        let pixel = self.pixel_size();
        let [width, height] = self.size.map(f64::from);
        DVec3::new(
            arm.dot(self.right) / pixel + 0.5 * width * w,
            0.5 * height * w - arm.dot(self.up) / pixel,
            w,
        )
    }

    /// Where in the picture a point appears, in pixels; it may be outside the picture. `None` for a
    /// point that is not in front of the eye.
    pub fn project(&self, point: DVec3) -> Option<[f64; 2]> {
        let [x, y, w] = self.homogeneous(point).to_array();
        let position = [x / w, y / w];
        let seen = w > 0.0 && position[0].is_finite() && position[1].is_finite();
        seen.then_some(position)
    }

    /// The region that the picture shows, to its borders: half a pixel more on each side than the
    /// rays through the centres of its pixels. That is more than the rounding of the camera, unless
    /// it is so narrow that a pixel is finer than 2⁻³⁰ of its distance, or of a parallel camera's
    /// scene.
    ///
    /// There is no near and no far plane; a perspective camera sees what is ahead of its eye.
    pub fn frustum(&self) -> Frustum {
        let [half_width, half_height] =
            self.size.map(|side| 0.5 * f64::from(side) * self.pixel_size());
        let (right, up, ahead) = (self.right, self.up, self.forward);
        let planes = |origin: DVec3, normals: [DVec3; 4], half: [f64; 4]| {
            let sides = normals.into_iter().zip(half);
            sides.map(move |(normal, half)| (normal, normal.dot(origin) - half))
        };
        match self.projection {
            Projection::Perspective { eye, .. } => {
                let (side, rise) = (ahead * half_width, ahead * half_height);
                let sides =
                    planes(eye, [side + right, side - right, rise + up, rise - up], [0.0; 4]);
                Frustum::new(sides.chain([(ahead, ahead.dot(eye))]))
            }
            Projection::Parallel { centre, .. } => {
                let half = [half_width, half_width, half_height, half_height];
                Frustum::new(planes(centre, [right, -right, up, -up], half))
            }
        }
    }

    /// The part of a convex polygon that the picture shows, in pixels; empty if it shows none.
    ///
    /// Polygons that share an edge also share the ends of the clipped edge, up to rounding.
    pub fn clip(&self, polygon: &[DVec3]) -> Vec<[f64; 2]> {
        let mut here: Vec<DVec3> = polygon.iter().map(|&point| self.homogeneous(point)).collect();
        let furthest = here.iter().fold(0.0f64, |max, vertex| max.max(vertex.z));
        if !(furthest > 0.0 && furthest.is_finite()) {
            return Vec::new();
        }
        let [width, height] = self.size.map(f64::from);
        let near = furthest * NEAR;
        let planes: [&dyn Fn(DVec3) -> f64; 5] =
            [&|v| v.z - near, &|v| v.x, &|v| width * v.z - v.x, &|v| v.y, &|v| height * v.z - v.y];
        for plane in planes {
            here = keep_inside(&here, plane);
        }
        here.iter()
            .map(|v| [(v.x / v.z).clamp(0.0, width), (v.y / v.z).clamp(0.0, height)])
            .collect()
    }
}

/// The unit vector along a vector of any length that `f64` can express; `None` for zero.
fn unit(v: DVec3) -> Option<DVec3> {
    let size = v.abs().max_element();
    (size > 0.0 && size.is_finite()).then(|| (v / size).normalize())
}

/// The part of a convex polygon where `plane` is not negative (Sutherland & Hodgman 1974).
fn keep_inside(polygon: &[DVec3], plane: &dyn Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &here) in polygon.iter().enumerate() {
        let next = polygon[(i + 1) % polygon.len()];
        let (a, b) = (plane(here), plane(next));
        if a >= 0.0 {
            kept.push(here);
        }
        if (a >= 0.0) != (b >= 0.0) {
            // Always from the inner end, so that both polygons at the edge compute the same.
            let (inner, outer, a, b) =
                if a >= 0.0 { (here, next, a, b) } else { (next, here, b, a) };
            kept.push(inner + (outer - inner) * (a / (a - b)));
        }
    }
    if kept.len() < 3 { Vec::new() } else { kept }
}

pub use crate::Error as CameraError;

/// The error of a problem.
pub(crate) fn refused<T>(problem: impl Into<String>) -> Result<T, CameraError> {
    Err(Kind::Camera(problem.into()).error())
}

/// The field of view of cameras that stand around a scene, in radians.
const AROUND: f64 = 0.7;
/// The share of the picture left free around a scene that is shown whole.
const BORDER: f64 = 0.05;
/// The field of view of cameras inside: wide, as a room has to be seen from within.
const INSIDE: f64 = 1.4;

impl Camera {
    /// A perspective camera that shows all of a bounding box, from the front, the right and above.
    ///
    /// # Errors
    ///
    /// If a number is not finite, `up` is zero, or the size is zero or beyond the limits.
    pub fn looking_at_all(
        bounds: [DVec3; 2],
        up: DVec3,
        size: [u32; 2],
    ) -> Result<Self, CameraError> {
        let [up, side, ahead] = axes(up);
        let from = ahead * 0.8 + side * 0.45 + up * 0.4;
        around(bounds, up, from, 1.0, size)
    }
}

/// `count` cameras, alternately around a bounding box and inside it; the same for the same seed.
///
/// # Errors
///
/// If a number is not finite, `up` is zero, or the size is zero or beyond the limits.
pub fn views(
    bounds: [DVec3; 2],
    up: DVec3,
    count: usize,
    size: [u32; 2],
    seed: u64,
) -> Result<Vec<Camera>, CameraError> {
    let mut random = SplitMix64::new(seed);
    let [up, side, ahead] = axes(up);
    (0..count)
        .map(|i| {
            if i % 2 == 0 {
                let (angle, height) =
                    (random.range(0.0, std::f64::consts::TAU), random.range(-0.6, 0.9));
                let from = side * angle.cos() + ahead * angle.sin() + up * height;
                around(bounds, up, from, random.range(0.7, 1.6), size)
            } else {
                // At a point in the middle four fifths of the box, looking at another one there.
                let [eye, target] = [(); 2].map(|()| {
                    let share = random.point(0.1, 0.9);
                    bounds[0] * (1.0 - share) + bounds[1] * share
                });
                // In a box without extent the two points coincide, or one is straight above the other.
                Camera::perspective(eye, target, up, INSIDE, size)
                    .or_else(|_| around(bounds, up, ahead + side, 0.1, size))
            }
        })
        .collect()
}

/// A camera that looks at the middle of a box from the direction `from`. At distance 1 the box just
/// fits the picture.
fn around(
    [min, max]: [DVec3; 2],
    up: DVec3,
    from: DVec3,
    distance: f64,
    size: [u32; 2],
) -> Result<Camera, CameraError> {
    let centre = min * 0.5 + max * 0.5;
    let half = max * 0.5 - min * 0.5;
    // A scene that is a single point still has a direction to be seen from.
    let points = [half.abs().max_element(), centre.abs().max_element(), 1.0];
    let largest = points.into_iter().find(|&size| size > 0.0).unwrap_or(1.0);
    let from = unit(from).unwrap_or(DVec3::ZERO);
    let orientation = Camera::perspective(from, DVec3::ZERO, up, AROUND, size)?;
    let [width, height] = size.map(f64::from);
    let rise = (AROUND * 0.5).tan() * (1.0 - BORDER);
    let run = rise * width / height;
    // A corner at c from the centre has depth d − c·from, and must lie within the picture's slopes
    // there.
    let needs = |corner: usize| {
        let sign = |axis: usize| if corner >> axis & 1 == 0 { 1.0 } else { -1.0 };
        let c = half / largest * DVec3::new(sign(0), sign(1), sign(2));
        let (x, y) = (c.dot(orientation.right()).abs(), c.dot(orientation.up()).abs());
        c.dot(from) + (x / run).max(y / rise)
    };
    let step = (0..8).map(needs).fold(1e-3, f64::max) * distance;
    Camera::perspective(centre + from * (step * largest), centre, up, AROUND, size)
}

/// The unit vector along `up`, and two perpendicular to it and to each other: for up = z, x and −y; for
/// up = y, x and z. The last is the front, and the second to its right.
fn axes(up: DVec3) -> [DVec3; 3] {
    let up = unit(up).unwrap_or(DVec3::ZERO);
    let reference = if up.z.abs() > 0.9 { DVec3::NEG_Y } else { DVec3::Z };
    let side = unit(up.cross(reference)).unwrap_or(DVec3::X);
    [up, side, side.cross(up)]
}

#[cfg(test)]
mod camera_tests {
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

    fn camera() -> Camera {
        // A right angle high: at distance 1 the picture shows y from −1 to 1.
        let fov = std::f64::consts::FRAC_PI_2;
        Camera::perspective(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, fov, [40, 20]).unwrap()
    }

    fn near(a: [f64; 2], b: [f64; 2]) -> bool {
        (a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9
    }

    #[test]
    fn x_runs_right_and_y_down() {
        let at = |x, y, z| camera().project(DVec3::new(x, y, z));
        assert!(near(at(0.0, 0.0, -3.0).unwrap(), [20.0, 10.0]));
        assert!(near(at(-2.0, 1.0, -1.0).unwrap(), [0.0, 0.0]));
        assert!(near(at(4.0, -2.0, -2.0).unwrap(), [40.0, 20.0]));
        assert_eq!(at(0.0, 0.0, 1.0), None);
    }

    #[test]
    fn a_parallel_camera_shows_its_height() {
        let up = DVec3::Y;
        let camera = Camera::parallel(DVec3::NEG_Z, up, DVec3::ONE, 4.0, [10, 20]).unwrap();
        assert!(near(camera.project(DVec3::new(1.0, 3.0, 9.0)).unwrap(), [5.0, 0.0]));
        assert!(near(camera.project(DVec3::new(2.0, 1.0, -9.0)).unwrap(), [10.0, 10.0]));
    }

    /// The matrix puts points where the camera does, and depths between those of the two planes.
    #[test]
    fn the_matrix_projects_as_the_camera_does() {
        let eye = DVec3::new(3.0, -7.0, 2.0);
        let size = [640, 360];
        for camera in [
            Camera::perspective(eye, DVec3::ONE, DVec3::Z, 0.9, size).unwrap(),
            Camera::parallel(-eye, DVec3::Z, DVec3::ONE, 12.0, size).unwrap(),
        ] {
            let matrix = camera.matrix(0.5, 40.0);
            let from = camera.eye().unwrap_or(DVec3::ONE);
            let mut random = SplitMix64::new(5);
            for _ in 0..100 {
                let point = from + camera.forward() * 20.0 + random.point(-6.0, 6.0);
                let clip = matrix.project_point3(point);
                let [x, y] = camera.project(point).unwrap();
                assert!(near([(0.5 + 0.5 * clip.x) * 640.0, (0.5 - 0.5 * clip.y) * 360.0], [x, y]));
            }
            for (distance, depth) in [(0.5, 0.0), (40.0, 1.0)] {
                let at = from + camera.forward() * distance + camera.right();
                assert!((matrix.project_point3(at).z - depth).abs() < 1e-12, "{camera:?}");
            }
        }
    }

    #[test]
    fn a_floor_that_reaches_behind_the_eye_fills_the_lower_half() {
        let floor = [[-1e3, -1.0, 1e3], [1e3, -1.0, 1e3], [1e3, -1.0, -1e3], [-1e3, -1.0, -1e3]];
        let clipped = camera().clip(&floor.map(DVec3::from));
        let (low, high) =
            clipped.iter().fold((99f64, 0f64), |(l, h), p| (l.min(p[1]), h.max(p[1])));
        assert!((low - 10.01).abs() < 1e-6 && (high - 20.0).abs() < 1e-6, "{clipped:?}");
        assert!(clipped.iter().any(|&p| near(p, [0.0, 20.0])));
        assert!(clipped.iter().any(|&p| near(p, [40.0, 20.0])));
    }

    #[test]
    fn what_is_behind_or_beside_is_gone() {
        let behind =
            [DVec3::new(0.0, 0.0, 1.0), DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.0, 1.0, 2.0)];
        assert!(camera().clip(&behind).is_empty());
        let beside = behind.map(|p| DVec3::new(p.x + 50.0, p.y, -p.z));
        assert!(camera().clip(&beside).is_empty());
        assert!(camera().clip(&[]).is_empty());
    }
}

#[cfg(test)]
mod vantage_tests {
    use super::*;

    const SIZE: [u32; 2] = [320, 240];

    #[test]
    fn shows_all_corners_of_the_box() {
        for (up, size) in [(DVec3::Y, SIZE), (DVec3::Z, [240, 320]), (DVec3::X, SIZE)] {
            for scale in [1e-300, 1.0, 1e300] {
                let (min, max) =
                    (DVec3::new(-1.0, 2.0, 0.0) * scale, DVec3::new(5.0, 3.0, 7.0) * scale);
                let camera = Camera::looking_at_all([min, max], up, size).unwrap();
                for i in 0..8 {
                    let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
                    let [x, y] = camera.project(DVec3::new(pick(0), pick(1), pick(2))).unwrap();
                    let [width, height] = size.map(f64::from);
                    assert!(
                        x > 0.0 && x < width && y > 0.0 && y < height,
                        "{up} {scale:e} {x} {y}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_front_of_y_up_is_z_and_right_is_x() {
        let camera = Camera::looking_at_all([-DVec3::ONE, DVec3::ONE], DVec3::Y, SIZE).unwrap();
        assert!(camera.forward().z < -0.5 && camera.right().x > 0.5, "{camera:?}");
        let camera = Camera::looking_at_all([-DVec3::ONE, DVec3::ONE], DVec3::Z, SIZE).unwrap();
        assert!(camera.forward().y > 0.5 && camera.right().x > 0.5, "{camera:?}");
    }

    #[test]
    fn views_are_reproducible_and_exist_for_degenerate_boxes() {
        let boxes =
            [[DVec3::ZERO, DVec3::ZERO], [DVec3::ZERO, DVec3::Y], [DVec3::ZERO, DVec3::ONE]];
        for bounds in boxes {
            for up in [DVec3::Y, DVec3::Z, DVec3::ONE] {
                let cameras = views(bounds, up, 9, SIZE, 7).unwrap();
                assert_eq!(cameras, views(bounds, up, 9, SIZE, 7).unwrap());
                assert_ne!(cameras, views(bounds, up, 9, SIZE, 8).unwrap());
            }
        }
        assert!(views(boxes[0], DVec3::ZERO, 1, SIZE, 0).is_err());
    }
}
