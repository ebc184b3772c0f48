//! Cameras: the viewpoint of a picture, and the place of world points in the picture.
//!
//! A picture is `width` × `height` pixels; x points right, and y points down. Pixel (0, 0) at the top left
//! covers the square from (0, 0) to (1, 1), so its centre is at (0.5, 0.5).

mod around;
mod matrix;

use crate::Error;
use glam::DVec3;

pub use around::views;

use crate::error::Kind;
use crate::viewpoint::{Frustum, Viewpoint};

/// A polygon is clipped at this distance from the eye's plane, as a share of the distance of the polygon's
/// furthest vertex. Too large: parts near the eye are missing. Too small: coordinates lose digits.
const NEAR: f64 = 1e-9;

const NON_FINITE: &str = "a camera parameter is NaN or infinite";
const FIELD_OF_VIEW: &str = "the field of view must be more than 0 and less than π radians";

/// A camera: a viewpoint, an orientation, and a picture's size in pixels.
///
/// [`perspective`](Self::perspective) and [`parallel`](Self::parallel) make cameras with square pixels that
/// look at the middle of the picture. [`from_matrix`](Self::from_matrix) also makes off-axis cameras, whose
/// direction is not towards the middle, and cameras whose pixels are oblong or skewed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    projection: Projection,
    /// Unit vectors along the lower and the left side of a pixel.
    right: DVec3,
    up: DVec3,
    /// The unit normal of the picture's plane.
    forward: DVec3,
    /// The vector from the eye to the middle of the picture at distance 1, measured along `forward`. The
    /// vector equals `forward` unless the camera is off-axis.
    middle: DVec3,
    /// The ratio of a pixel's width to its height.
    aspect: f64,
    size: [u32; 2],
}

/// The projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A perspective projection from an eye.
    Perspective {
        /// The eye.
        eye: DVec3,
        /// Half the picture's height at distance 1 from the eye. Unless the camera is off-axis, this value is
        /// the tangent of half the vertical field of view.
        half_height: f64,
    },
    /// A parallel projection along a direction.
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
    /// The largest width and the largest height of a picture, in pixels.
    pub const MAX_SIDE: u32 = 1 << 16;
    /// The largest number of pixels of a picture.
    pub const MAX_PIXELS: u64 = 1 << 26;

    /// Creates a perspective camera at `eye` that looks at `target`, with a vertical field of view in
    /// radians, for a picture of `[width, height]` pixels. Pixels are square.
    ///
    /// # Errors
    ///
    /// If a number is not finite, the eye is at the target, `up` is parallel to the line from the eye to the
    /// target, the field of view is not between 0 and π, a side of the picture is 0 or above
    /// [`MAX_SIDE`](Self::MAX_SIDE), or the picture has more than [`MAX_PIXELS`](Self::MAX_PIXELS) pixels.
    pub fn perspective(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        field_of_view: f64,
        size: [u32; 2],
    ) -> Result<Self, Error> {
        if !field_of_view.is_finite() {
            return refused(NON_FINITE);
        }
        if !(field_of_view > 0.0 && field_of_view < std::f64::consts::PI) {
            return refused(FIELD_OF_VIEW);
        }
        let half_height = (field_of_view * 0.5).tan();
        Self::perspective_by_slope(eye, target, up, half_height, size)
    }

    /// Creates a perspective camera, like [`perspective`](Self::perspective), but given the tangent of half
    /// the vertical field of view. No trigonometric function is needed, so the camera has the same bits on
    /// every machine.
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
    ) -> Result<Self, Error> {
        // Halved first, so that the difference of two finite points is finite.
        let view = target * 0.5 - eye * 0.5;
        Self::oriented(Projection::Perspective { eye, half_height }, view, up, size)
    }

    /// Creates a parallel camera that looks along `direction`, with `centre` in the middle of a picture that
    /// is `height` world units high and `[width, height]` pixels large. Pixels are square.
    ///
    /// # Errors
    ///
    /// If a number is not finite, `direction` is zero, `up` is parallel to `direction`, `height` is not
    /// positive, a side of the picture is 0 or above [`MAX_SIDE`](Self::MAX_SIDE), or the picture has more
    /// than [`MAX_PIXELS`](Self::MAX_PIXELS) pixels.
    pub fn parallel(
        direction: DVec3,
        up: DVec3,
        centre: DVec3,
        height: f64,
        size: [u32; 2],
    ) -> Result<Self, Error> {
        Self::oriented(Projection::Parallel { direction, centre, height }, direction, up, size)
    }

    fn oriented(
        projection: Projection,
        view: DVec3,
        up: DVec3,
        size: [u32; 2],
    ) -> Result<Self, Error> {
        let (origin, span, too_small) = match projection {
            Projection::Perspective { eye, half_height } => (eye, half_height, FIELD_OF_VIEW),
            Projection::Parallel { centre, height, .. } => {
                (centre, height, "the height of a parallel camera's picture must be positive")
            }
        };
        if !(origin.is_finite() && view.is_finite() && up.is_finite() && span.is_finite()) {
            return refused(NON_FINITE);
        }
        if span <= 0.0 {
            return refused(too_small);
        }
        let size = checked(size)?;
        let Some(forward) = unit(view) else {
            return refused(
                "the camera has no direction of view: its eye and target are equal, or its direction is zero",
            );
        };
        let side = forward.cross(unit(up).unwrap_or(forward));
        // Too small: rounding would decide the picture's orientation.
        if side.length() < 1e-9 {
            return refused("the camera's up vector is zero or along its direction of view");
        }
        let right = side.normalize();
        let up = right.cross(forward).normalize();
        Ok(Self { projection, right, up, forward, middle: forward, aspect: 1.0, size })
    }

    /// Returns the camera's projection.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// Returns the viewpoint for ordering [fragments](crate::Fragment).
    pub fn viewpoint(&self) -> Viewpoint {
        match self.projection {
            Projection::Perspective { eye, .. } => Viewpoint::Eye(eye),
            Projection::Parallel { direction, .. } => Viewpoint::Direction(direction),
        }
    }

    /// Returns the eye; `None` for a parallel camera.
    pub fn eye(&self) -> Option<DVec3> {
        match self.projection {
            Projection::Perspective { eye, .. } => Some(eye),
            Projection::Parallel { .. } => None,
        }
    }

    /// Returns the picture's width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the unit vector to the right: from a pixel to the next pixel of its row.
    pub fn right(&self) -> DVec3 {
        self.right
    }

    /// Returns the unit vector upwards in the picture: from a pixel to the pixel above it. The vector is
    /// perpendicular to [`right`](Self::right), unless the camera was made from a matrix with skewed pixels.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Returns the unit vector in the direction in which the camera looks: the normal of the picture's plane.
    /// For a perspective camera, the vector points at the middle of the picture, unless the camera is
    /// off-axis.
    pub fn forward(&self) -> DVec3 {
        self.forward
    }

    /// Returns the width and the height of a pixel, as lengths in the world. For a perspective camera, these
    /// lengths are measured at distance 1 from the eye. Width and height are equal, unless the camera was
    /// made from a matrix.
    pub fn pixel_size(&self) -> [f64; 2] {
        let span = match self.projection {
            Projection::Perspective { half_height, .. } => 2.0 * half_height,
            Projection::Parallel { height, .. } => height,
        };
        let height = span / f64::from(self.size[1]);
        [height * self.aspect, height]
    }

    /// Half of the picture's width and height, in the unit of [`pixel_size`](Self::pixel_size).
    pub(crate) fn half_size(&self) -> [f64; 2] {
        let [width, height] = self.pixel_size();
        [0.5 * f64::from(self.size[0]) * width, 0.5 * f64::from(self.size[1]) * height]
    }

    /// The vector from the eye to the middle of the picture at distance 1, measured along
    /// [`forward`](Self::forward).
    pub(crate) fn middle(&self) -> DVec3 {
        self.middle
    }

    /// Returns a camera with the same view and a picture of another size. The visible height, the point in
    /// the middle of the picture and the shape of pixels do not change.
    ///
    /// # Errors
    ///
    /// If a side of the picture is 0 or above [`MAX_SIDE`](Self::MAX_SIDE), or the picture has more than
    /// [`MAX_PIXELS`](Self::MAX_PIXELS) pixels.
    pub fn with_size(&self, size: [u32; 2]) -> Result<Self, Error> {
        Ok(Self { size: checked(size)?, ..*self })
    }

    /// The eye, or the centre of a parallel camera.
    fn origin(&self) -> DVec3 {
        match self.projection {
            Projection::Perspective { eye, .. } => eye,
            Projection::Parallel { centre, .. } => centre,
        }
    }

    /// Two vectors, one for [`right`](Self::right) and one for [`up`](Self::up). The scalar product of such a
    /// vector and the vector from the [origin](Self::origin) to a point is the point's distance from the
    /// middle of the picture to the right or upwards. For a perspective camera, the product is that distance
    /// times the point's distance along [`forward`](Self::forward).
    fn rows(&self) -> [DVec3; 2] {
        let Self { right, up, forward, middle, .. } = *self;
        let sine = up.cross(right).dot(forward);
        let duals = [forward.cross(up) / sine, right.cross(forward) / sine];
        duals.map(|dual| dual - forward * dual.dot(middle))
    }

    /// Returns the homogeneous picture coordinates of a point: (x·w, y·w, w), where (x, y) is the point's
    /// position in the picture, in pixels. For a perspective camera, w is the point's distance from the eye
    /// along [`forward`](Self::forward). For a parallel camera, w is 1.
    pub fn homogeneous(&self, point: DVec3) -> DVec3 {
        let arm = point - self.origin();
        let w = if self.eye().is_some() { arm.dot(self.forward) } else { 1.0 };
        let [width, height] = self.size.map(f64::from);
        let ([pixel_width, pixel_height], [x, y]) = (self.pixel_size(), self.rows());
        DVec3::new(
            arm.dot(x) / pixel_width + 0.5 * width * w,
            0.5 * height * w - arm.dot(y) / pixel_height,
            w,
        )
    }

    /// Returns the projection of a point, in pixels. The projection may be outside the picture. `None` for a
    /// point that is not in front of the eye.
    pub fn project(&self, point: DVec3) -> Option<[f64; 2]> {
        let [x, y, w] = self.homogeneous(point).to_array();
        let position = [x / w, y / w];
        let seen = w > 0.0 && position[0].is_finite() && position[1].is_finite();
        seen.then_some(position)
    }

    /// Returns the region that the picture shows, up to the picture's borders. There is no near and no far
    /// plane; a perspective camera sees everything ahead of its eye.
    ///
    /// The borders are half a pixel outside the centres of the outermost pixels. So, although the camera's
    /// numbers are rounded, the region contains the rays through all pixels' centres. (Exception: the width
    /// or the height of a pixel is less than 2⁻³⁰ of the pixel's distance from the eye or, for a parallel
    /// camera, of the scene's size.)
    pub fn frustum(&self) -> Frustum {
        let ([half_width, half_height], [x, y]) = (self.half_size(), self.rows());
        let (origin, ahead) = (self.origin(), self.forward);
        let planes = |normals: [DVec3; 4], half: [f64; 4]| {
            let sides = normals.into_iter().zip(half);
            sides.map(move |(normal, half)| (normal, normal.dot(origin) - half))
        };
        match self.projection {
            Projection::Perspective { .. } => {
                let (side, rise) = (ahead * half_width, ahead * half_height);
                let sides = planes([side + x, side - x, rise + y, rise - y], [0.0; 4]);
                Frustum::new(sides.chain([(ahead, ahead.dot(origin))]))
            }
            Projection::Parallel { .. } => {
                let half = [half_width, half_width, half_height, half_height];
                Frustum::new(planes([x, -x, y, -y], half))
            }
        }
    }

    /// Clips a convex polygon to the picture. Returns the corners of the visible part, in pixels. The list is
    /// empty if no part of the polygon is in the picture.
    ///
    /// If two polygons share an edge, the ends of the clipped edge are the same for both polygons, up to
    /// rounding.
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

/// Returns a picture's size; an error if the size is zero or beyond the limits.
fn checked([width, height]: [u32; 2]) -> Result<[u32; 2], Error> {
    let sides = 1..=Camera::MAX_SIDE;
    let pixels = u64::from(width) * u64::from(height);
    if !sides.contains(&width) || !sides.contains(&height) || pixels > Camera::MAX_PIXELS {
        return refused(format!(
            "a picture must be 1 to {} pixels wide and high, with at most {} pixels in total, not {width}x{height}",
            Camera::MAX_SIDE,
            Camera::MAX_PIXELS
        ));
    }
    Ok([width, height])
}

/// The unit vector in the direction of a vector of any length that `f64` can express; `None` for zero.
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
            // Always from the inner end, so that both polygons at the edge have the same point.
            let (inner, outer, a, b) =
                if a >= 0.0 { (here, next, a, b) } else { (next, here, b, a) };
            kept.push(inner + (outer - inner) * (a / (a - b)));
        }
    }
    if kept.len() < 3 { Vec::new() } else { kept }
}

/// An error with a message.
pub(crate) fn refused<T>(problem: impl Into<String>) -> Result<T, Error> {
    Err(Kind::Argument(problem.into()).error())
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
        let message = |camera: Result<Camera, Error>| camera.unwrap_err().to_string();
        assert!(message(perspective(o, z, 1.0, SIZE)).contains("no direction of view"));
        assert!(message(perspective(x, x, 1.0, SIZE)).contains("up vector"));
        assert!(message(perspective(x, o, 1.0, SIZE)).contains("up vector"));
        assert!(message(perspective(x, z, 0.0, SIZE)).contains("field of view"));
        assert!(message(perspective(x, z, 3.2, SIZE)).contains("field of view"));
        assert!(message(perspective(x / 0.0, z, 1.0, SIZE)).contains("infinite"));
        assert!(message(perspective(x, z, f64::NAN, SIZE)).contains("infinite"));
        assert!(message(perspective(x, z, 1.0, [0, 5])).contains("0x5"));
        assert!(message(perspective(x, z, 1.0, [1 << 14, 1 << 14])).contains("16384x16384"));
        assert!(message(Camera::parallel(o, z, o, 1.0, SIZE)).contains("no direction of view"));
        assert!(message(Camera::parallel(x, z, o, 0.0, SIZE)).contains("height"));
    }

    fn camera() -> Camera {
        // The field of view is a right angle: at distance 1 the picture shows y from −1 to 1.
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
    fn polygons_behind_or_beside_the_view_are_clipped_away() {
        let behind =
            [DVec3::new(0.0, 0.0, 1.0), DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.0, 1.0, 2.0)];
        assert!(camera().clip(&behind).is_empty());
        let beside = behind.map(|p| DVec3::new(p.x + 50.0, p.y, -p.z));
        assert!(camera().clip(&beside).is_empty());
        assert!(camera().clip(&[]).is_empty());
    }

    /// Corners and edges exactly on the border of the picture are part of what is visible.
    #[test]
    fn corners_on_the_border_are_kept() {
        let middle = DVec3::ZERO;
        let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, middle, 8.0, [8, 8]).unwrap();
        let whole = [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];
        let diamond = [[0.0, -4.0], [4.0, 0.0], [0.0, 4.0], [-4.0, 0.0]];
        for corners in [whole, diamond] {
            let polygon = corners.map(|[x, y]| DVec3::new(x, y, 0.0));
            let expected = corners.map(|[x, y]| [x + 4.0, 4.0 - y]);
            assert_eq!(camera.clip(&polygon), expected);
        }
    }
}
