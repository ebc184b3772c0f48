//! Shades of polygons in vector pictures: as in the painter's pictures, but constant over a polygon, so
//! that the seams of its fragments do not show.

use binspace::glam::DVec3;
use binspace::raster::brightness;
use binspace::view::{Camera, Projection};

/// A polygon's colour, darker the more obliquely it is seen.
pub(crate) fn shaded(colour: [u8; 3], polygon: &[DVec3], camera: &Camera) -> [u8; 3] {
    let share = brightness_of(polygon, camera);
    colour.map(|channel| (f64::from(channel) * share).round() as u8)
}

fn brightness_of(polygon: &[DVec3], camera: &Camera) -> f64 {
    let share = 1.0 / polygon.len() as f64;
    let middle: DVec3 = polygon.iter().map(|&corner| corner * share).sum();
    // Newell's normal, as polygons need not be planar.
    let arms = polygon.iter().map(|&corner| corner - middle);
    let next = arms.clone().cycle().skip(1);
    let normal: DVec3 = arms.zip(next).map(|(arm, next)| arm.cross(next)).sum();
    let direction = match *camera.projection() {
        Projection::Perspective { eye, .. } => (middle - eye).normalize_or_zero(),
        Projection::Parallel { .. } => camera.forward(),
    };
    brightness(normal.normalize_or_zero(), direction)
}

/// A colour in SVG.
pub(crate) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
