//! Cameras that show all of a scene, as large as the picture allows.

use binspace::Error;
use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::view::Camera;

/// The largest share of a picture that a scene fills. With 1, edges of the scene may lie exactly on the
/// border of the picture, where they are not drawn.
const FULL: f64 = 1.0 - 1e-6;

/// A perspective camera with the direction of another camera, moved so that the scene just fills the picture.
///
/// The eye sees all corners p if, for each side of the picture, all p lie on the inner side of the plane
/// through the eye and that side. With r, u, b the directions right, up and back, and t the tangent of half
/// the width: ±(p − eye)·r ≤ t (eye − p)·b, so that eye·b must be at least (max(p·r + t p·b) + max(−p·r + t
/// p·b)) / 2t; the same holds up and down.
pub(crate) fn near(like: &Camera, scene: &Scene, fov: f64, margin: f64) -> Result<Camera, Error> {
    let [width, height] = like.size().map(f64::from);
    let tangent = (0.5 * fov).tan() * (1.0 - 2.0 * margin).min(FULL);
    let (right, up, back) = (like.right(), like.up(), -like.forward());
    let sides = [(right, tangent * width / height), (up, tangent)];
    let reaches = sides.map(|(axis, t)| [axis, -axis].map(|side| reach(scene, side / t + back)));
    let distance = reaches.iter().map(|[a, b]| 0.5 * a + 0.5 * b).fold(f64::MIN, f64::max);
    let mut eye = back * distance;
    for ((axis, t), [a, b]) in sides.into_iter().zip(reaches) {
        // From all positions between these, the whole scene is seen.
        let allowed = [t * (a - distance), t * (distance - b)];
        eye += axis * middle(scene, axis, back, distance, allowed);
    }
    let furthest = distance + reach(scene, -back);
    Camera::perspective(eye, eye - back * furthest, up, fov, like.size())
}

/// Finds, between two limits along an axis, the eye at which the margins on both sides of the picture are equal.
///
/// The next place is where the two outermost corners would be equally far from the middle of the picture. If
/// they still are the outermost corners there, it is the right place; a place beyond the limits is replaced by
/// bisection.
fn middle(scene: &Scene, axis: DVec3, back: DVec3, distance: f64, mut limits: [f64; 2]) -> f64 {
    let tiny = 1e-9 * (limits[1] - limits[0]);
    let mut place = 0.5 * limits[0] + 0.5 * limits[1];
    // Twenty halvings are a thousandth of a pixel.
    for _ in 0..20 {
        // For each side, the slope towards the outermost corner, and where that is along the axis and ahead.
        let [mut low, mut high] = [[0.0f64; 3]; 2];
        for corner in scene.polygons().flatten() {
            let (along, ahead) = (corner.dot(axis), distance - corner.dot(back));
            let slope = (along - place) / ahead;
            if slope < low[0] {
                low = [slope, along, ahead];
            }
            if slope > high[0] {
                high = [slope, along, ahead];
            }
        }
        limits[usize::from(high[0] + low[0] < 0.0)] = place;
        let equal = (low[1] * high[2] + high[1] * low[2]) / (low[2] + high[2]);
        if (equal - place).abs() <= tiny {
            break;
        }
        let is_within = limits[0] < equal && equal < limits[1];
        place = if is_within { equal } else { 0.5 * limits[0] + 0.5 * limits[1] };
    }
    place
}

/// A parallel camera along `direction` that just holds the scene. The picture has a size or, with a number of
/// pixels for each unit, is as large as the scene takes. A target is at the centre of the picture.
pub(crate) fn parallel(
    direction: DVec3,
    up: DVec3,
    scene: &Scene,
    target: Option<DVec3>,
    size: [u32; 2],
    scale: Option<f64>,
    margin: f64,
) -> Result<Camera, Error> {
    // For its axes.
    let axes = Camera::parallel(direction, up, DVec3::ZERO, 1.0, [1, 1])?;
    let mut centre = DVec3::ZERO;
    for axis in [axes.right(), axes.up(), axes.forward()] {
        centre += axis * (0.5 * reach(scene, axis) - 0.5 * reach(scene, -axis));
    }
    let at = target.unwrap_or(centre);
    let fill = (1.0 - 2.0 * margin).min(FULL);
    let axes_of_picture = [axes.right(), axes.up()];
    if let Some(scale) = scale {
        let size = axes_of_picture.map(|axis| {
            let half = [axis, -axis].map(|side| reach(scene, side) - at.dot(side));
            let side = 2.0 * half[0].max(half[1]) * scale;
            // Numbers too large for an integer become the largest, which is an error of the camera.
            (side / fill).ceil().max(1.0) as u32
        });
        return Camera::parallel(direction, up, at, f64::from(size[1]) / scale, size);
    }
    let sides = axes_of_picture.map(|axis| extent(scene, axis));
    let [width, height] = size.map(f64::from);
    let shown = sides[1].max(sides[0] * height / width) / fill;
    // A scene seen edge-on, or a point, has no extent: show its surroundings.
    let fallback = extent(scene, axes.forward()).max(centre.length() * 1e-3);
    let shown = [shown, fallback, 1.0].into_iter().find(|&length| length > 0.0).unwrap_or(1.0);
    Camera::parallel(direction, up, at, shown, size)
}

/// The extent of the scene along an axis.
fn extent(scene: &Scene, axis: DVec3) -> f64 {
    reach(scene, axis) + reach(scene, -axis)
}

/// The largest coordinate of the scene along a direction.
fn reach(scene: &Scene, direction: DVec3) -> f64 {
    let corners = scene.polygons().flatten();
    corners.map(|corner| corner.dot(direction)).fold(f64::MIN, f64::max)
}
