//! Projects points and clips polygons to the picture.

use glam::DVec3;

use super::camera::{Camera, Projection};
use crate::frustum::Frustum;

/// Polygons are clipped at this distance from the eye's plane, as a share of the distance of their
/// furthest vertex. Larger: parts near the eye are missing. Smaller: coordinates lose digits.
const NEAR: f64 = 1e-9;

impl Camera {
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

#[cfg(test)]
mod tests {
    use super::*;

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
