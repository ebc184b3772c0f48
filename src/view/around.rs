//! Cameras that show a whole scene, and views from around and inside a scene.

use crate::Error;
use glam::DVec3;

use super::{Camera, unit};
use crate::random::SplitMix64;

/// The field of view of cameras that stand around a scene, in radians.
const AROUND: f64 = 0.7;
/// The share of the picture left free around a whole scene.
const BORDER: f64 = 0.05;
/// The field of view of cameras inside, wide enough for a room.
const INSIDE: f64 = 1.4;

impl Camera {
    /// Creates a perspective camera that shows a whole bounding box, from the front, the right and above.
    ///
    /// # Errors
    ///
    /// If a number is not finite, `up` is zero, a side of the picture is 0 or above
    /// [`MAX_SIDE`](Self::MAX_SIDE), or the picture has more than [`MAX_PIXELS`](Self::MAX_PIXELS) pixels.
    pub fn looking_at_all(bounds: [DVec3; 2], up: DVec3, size: [u32; 2]) -> Result<Self, Error> {
        let [up, side, ahead] = axes(up);
        let from = ahead * 0.8 + side * 0.45 + up * 0.4;
        around(bounds, up, from, 1.0, size)
    }
}

/// Creates `count` cameras at random places: alternately a camera outside a bounding box that shows the whole
/// box, and a camera inside the box. The same seed creates the same cameras.
///
/// # Errors
///
/// If a number is not finite, `up` is zero, a side of the picture is 0 or above
/// [`MAX_SIDE`](Camera::MAX_SIDE), or the picture has more than [`MAX_PIXELS`](Camera::MAX_PIXELS) pixels.
pub fn views(
    bounds: [DVec3; 2],
    up: DVec3,
    count: usize,
    size: [u32; 2],
    seed: u64,
) -> Result<Vec<Camera>, Error> {
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
                // At a point in the middle four fifths of the box, looking at another such point.
                let [eye, target] = [(); 2].map(|()| {
                    let share = random.point(0.1, 0.9);
                    bounds[0] * (1.0 - share) + bounds[1] * share
                });
                // If the box has no extent, the two points coincide or one is vertically above the other.
                Camera::perspective(eye, target, up, INSIDE, size)
                    .or_else(|_| around(bounds, up, ahead + side, 0.1, size))
            }
        })
        .collect()
}

/// A camera that looks at the middle of a box from the direction `from`. At distance 1 the box exactly fits
/// the picture.
fn around(
    [min, max]: [DVec3; 2],
    up: DVec3,
    from: DVec3,
    distance: f64,
    size: [u32; 2],
) -> Result<Camera, Error> {
    let centre = min * 0.5 + max * 0.5;
    let half = max * 0.5 - min * 0.5;
    // A scene that is a single point still needs a viewing distance.
    let points = [half.abs().max_element(), centre.abs().max_element(), 1.0];
    let largest = points.into_iter().find(|&size| size > 0.0).unwrap_or(1.0);
    let from = unit(from).unwrap_or(DVec3::ZERO);
    let orientation = Camera::perspective(from, DVec3::ZERO, up, AROUND, size)?;
    let [width, height] = size.map(f64::from);
    let rise = (AROUND * 0.5).tan() * (1.0 - BORDER);
    let run = rise * width / height;
    // A corner at c from the centre has depth d − c·from, and must lie within the picture at that depth.
    let needs = |corner: usize| {
        let sign = |axis: usize| if corner >> axis & 1 == 0 { 1.0 } else { -1.0 };
        let c = half / largest * DVec3::new(sign(0), sign(1), sign(2));
        let (x, y) = (c.dot(orientation.right()).abs(), c.dot(orientation.up()).abs());
        c.dot(from) + (x / run).max(y / rise)
    };
    let step = (0..8).map(needs).fold(1e-3, f64::max) * distance;
    Camera::perspective(centre + from * (step * largest), centre, up, AROUND, size)
}

/// Three perpendicular unit vectors. The first is along `up`, the second points to the right, and the third
/// to the front. For up = z, the vectors are z, x and −y; for up = y, the vectors are y, x and z.
fn axes(up: DVec3) -> [DVec3; 3] {
    let up = unit(up).unwrap_or(DVec3::ZERO);
    let reference = if up.z.abs() > 0.9 { DVec3::NEG_Y } else { DVec3::Z };
    let side = unit(up.cross(reference)).unwrap_or(DVec3::X);
    [up, side, side.cross(up)]
}

#[cfg(test)]
mod tests {
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
