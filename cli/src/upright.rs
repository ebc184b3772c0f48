//! The up direction of files that do not state which way is up.

use binspace::glam::DVec3;
use binspace::scene::Scene;

use crate::args::UpArgs;
use crate::terminal::remark;

/// The largest distance from 0 of the lowest point of something on the ground, as a share of its height. Too
/// small: rounded files are missed. Too large: things that hang somewhat above 0 count as well.
const ON_GROUND: f64 = 0.01;
/// Things lower than this share of their shorter side are flat. Too large: furniture counts as a building.
/// Too small: rooms of usual proportions do not count.
const FLAT: f64 = 0.25;
/// The least share of the bounding box's volume that inward faces span. Too small: open surfaces count as
/// rooms because of rounding.
const INWARDS: f64 = 0.05;
/// The least ratio of the area of a room or town seen from above to the area seen from a side. Too large:
/// towns of high houses are missed. Too small: blinds count as rooms.
const SEEN_FROM_ABOVE: f64 = 0.8;
/// A scene with more than this share of its area perpendicular to z is a drawing in layers, which has no up
/// direction.
const LAYERS: f64 = 0.98;
/// The sine of the angle within which a face counts as perpendicular to z is below this.
const PERPENDICULAR: f64 = 0.2;

/// The direction that points up in pictures: the scene's up direction, or z for an OBJ file that looks as if
/// z pointed up. (OBJ files do not say which way is up.)
pub(crate) fn up_of(scene: &Scene) -> DVec3 {
    taken(scene).map_or(scene.up(), |_| DVec3::Z)
}

/// Notes that z was taken for up, unless the user has given the up direction.
pub(crate) fn note_up(scene: &Scene, up: &UpArgs) {
    if let (None, Some(reason)) = (up.given(), taken(scene)) {
        let full = format!("z points up, because {reason}; `--up y` or `--up z` overrides this");
        remark(scene.name(), format!("z points up, because {reason}"), full);
    }
}

/// The reason for taking z as the up direction of a file; `None` if z is not taken.
fn taken(scene: &Scene) -> Option<&'static str> {
    let is_silent = scene.up() == DVec3::Y && !scene.is_empty() && scene.line(0).is_some();
    is_silent.then(|| sign_of_z_up(scene)).flatten()
}

/// The reason why a scene looks as if z pointed up, if there is one. One of two signs suffices:
///
/// - The scene stands on z = 0: its lowest z is 0, while y reaches from below 0 to above 0. Things that are
///   flat in z do not count: plates on walls look the same if y is up.
/// - The scene is a room, a level or a town: flat in z, with hardly less area seen from above than from a
///   side, and with faces that look inwards, as floors, ceilings and walls do.
///
/// Neither counts as a sign if the scene stands on y = 0 in the same way, or is a stack of layers across z.
///
/// A scene that hangs, or was moved off the ground, shows no sign.
fn sign_of_z_up(scene: &Scene) -> Option<&'static str> {
    let (low, high) = scene.bounds()?;
    let size = high - low;
    let stands = |up: usize, across: usize| {
        let beside = low[across] / size[across];
        low[up].abs() <= ON_GROUND * size[up] && (-0.9..=-0.1).contains(&beside)
    };
    if !(size.is_finite() && size.min_element() > 0.0) || stands(1, 2) {
        return None;
    }
    let found = Areas::of(scene, low * 0.5 + high * 0.5);
    if found.perpendicular >= LAYERS * found.total {
        return None;
    }
    let flat = size.z <= FLAT * size.x.min(size.y);
    let inwards = found.volume <= -INWARDS * 6.0 * size.element_product();
    if !flat && stands(2, 1) {
        Some("it stands on z = 0")
    } else if flat && found.seen.z >= SEEN_FROM_ABOVE * found.seen.max_element() && inwards {
        Some("it is flat along z and has floors")
    } else {
        None
    }
}

/// Sums over the faces of a scene. Areas are doubled.
#[derive(Debug, Default)]
struct Areas {
    total: f64,
    /// The area of faces that are nearly perpendicular to z.
    perpendicular: f64,
    /// The area seen along each axis, from both sides.
    seen: DVec3,
    /// Six times the volume between the faces and a point, positive if the faces look away from the point.
    volume: f64,
}

impl Areas {
    fn of(scene: &Scene, middle: DVec3) -> Self {
        let mut sums = Self::default();
        for polygon in scene.polygons() {
            let Some(&first) = polygon.points().first() else { continue };
            let fan =
                polygon.points().windows(2).map(|ends| (ends[0] - first).cross(ends[1] - first));
            let normal: DVec3 = fan.sum();
            let area = normal.length();
            sums.total += area;
            sums.seen += normal.abs();
            sums.volume += normal.dot(first - middle);
            if normal.truncate().length() < PERPENDICULAR * area {
                sums.perpendicular += area;
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use binspace::scene::{city, cornell_box, crossing, layers, newell_bars, sphere, teapot};

    /// A scene with its corners moved.
    fn moved(scene: &Scene, to: impl Fn(DVec3) -> DVec3) -> Scene {
        let mut result = Scene::new(scene.name(), DVec3::Y);
        for polygon in scene.polygons() {
            result.push(polygon.points().iter().map(|&corner| to(corner)), 0);
        }
        result
    }

    fn is_z_up(scene: &Scene) -> bool {
        sign_of_z_up(scene).is_some()
    }

    #[test]
    fn what_stands_on_the_ground_and_towns_are_recognised() {
        for scene in [teapot(3), city(2000, 1), city(5000, 2)] {
            assert!(is_z_up(&scene), "{}", scene.name());
            // With y up, as it should be.
            assert!(!is_z_up(&moved(&scene, |p| DVec3::new(p.x, p.z, -p.y))), "{}", scene.name());
            assert!(is_z_up(&moved(&scene, |p| p * 1e-9)), "{}", scene.name());
        }
        // A teapot in the air.
        assert!(!is_z_up(&moved(&teapot(3), |p| p + DVec3::Z)));
    }

    #[test]
    fn what_has_no_ground_is_left_alone() {
        let lifted = moved(&layers(5, 0.1), |p| DVec3::new(p.x, p.y, p.z + 0.1));
        let plate = moved(&sphere(200), |p| DVec3::new(p.x, p.y, 0.1 + 0.1 * p.z));
        let scenes =
            [cornell_box(), crossing(3), newell_bars(), sphere(200), layers(5, 0.1), lifted, plate];
        for scene in scenes {
            assert!(!is_z_up(&scene), "{}", scene.name());
        }
        let flat = moved(&teapot(2), |p| p.with_z(0.0));
        // A niche in a wall, seen along z: a room, but it stands on y = 0.
        let niche = moved(&cornell_box(), |p| DVec3::new(p.x, p.y, 0.1 * p.z - 20.0));
        assert!(!is_z_up(&niche) && is_z_up(&moved(&niche, |p| p - DVec3::Y * 300.0)));
        let vast = moved(&teapot(2), |p| p * 1e305);
        assert!(!is_z_up(&flat) && !is_z_up(&Scene::new("", DVec3::Y)));
        // So large that areas overflow: no panic.
        let _ = is_z_up(&vast);
    }
}
