//! Finds the nearest polygon along a ray by testing every polygon, in world coordinates and plain `f64`. Uses
//! no code of the library except the camera's vectors.

use super::Polygons;
use binspace::view::Projection;
use testkit::prelude::*;

/// A ray's start and direction.
fn ray(camera: &Camera, x: u32, y: u32) -> (DVec3, DVec3) {
    let [width, height] = camera.size().map(f64::from);
    let across = (f64::from(x) + 0.5 - 0.5 * width) * camera.pixel_size()[1];
    let down = (f64::from(y) + 0.5 - 0.5 * height) * camera.pixel_size()[1];
    let offset = camera.right() * across - camera.up() * down;
    match *camera.projection() {
        Projection::Perspective { eye, .. } => (eye, camera.forward() + offset),
        Projection::Parallel { centre, .. } => (centre + offset, camera.forward()),
    }
}

/// The intersection of a ray and a polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meeting {
    Nothing,
    /// The ray meets the polygon at this distance, in lengths of the ray's direction.
    At(f64),
    /// Undecided: the ray passes too near an edge, or is too parallel to the polygon.
    Doubtful,
}

/// Distances from an edge, in world units, and from another depth, as a share, below which a pixel is
/// undecided.
const NEAR: f64 = 1e-7;

pub(super) fn meet(polygon: &[DVec3], camera: &Camera, x: u32, y: u32) -> Meeting {
    let (start, direction) = ray(camera, x, y);
    let next = |i: usize| polygon[(i + 1) % polygon.len()];
    let normal: DVec3 =
        (0..polygon.len()).map(|i| (polygon[i] - polygon[0]).cross(next(i) - polygon[0])).sum();
    let normal = normal.normalize();
    let slant = normal.dot(direction);
    let t = normal.dot(polygon[0] - start) / slant;
    if slant.abs() < 1e-6 {
        return Meeting::Doubtful;
    }
    if t <= 0.0 && matches!(camera.projection(), Projection::Perspective { .. }) {
        return Meeting::Nothing;
    }
    let point = start + direction * t;
    let inside = |i: usize| {
        let edge = (next(i) - polygon[i]).normalize();
        edge.cross(point - polygon[i]).dot(normal)
    };
    let least = (0..polygon.len()).map(inside).fold(f64::INFINITY, f64::min);
    if least > NEAR {
        Meeting::At(t)
    } else if least < -NEAR {
        Meeting::Nothing
    } else {
        Meeting::Doubtful
    }
}

/// The nearest polygon in a pixel, if there is one; `None` if the result is uncertain.
pub(super) fn nearest(polygons: &Polygons, camera: &Camera, x: u32, y: u32) -> Option<Option<u32>> {
    let mut hits: Vec<(f64, u32)> = Vec::new();
    for (polygon, number) in polygons.iter().zip(0..) {
        match meet(polygon, camera, x, y) {
            Meeting::Nothing => {}
            Meeting::At(t) => hits.push((t, number)),
            Meeting::Doubtful => return None,
        }
    }
    hits.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    match hits[..] {
        [] => Some(None),
        [(a, _), (b, _), ..] if b - a < NEAR * (1.0 + a.abs()) => None,
        [(_, number), ..] => Some(Some(number)),
    }
}
