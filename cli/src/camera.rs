//! The cameras that the user asks for, or that suit a scene.

use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::view::{Camera, CameraError, views};

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::framing;

/// The vertical field of view, in radians, where the user does not say: 40 degrees.
pub(crate) const FIELD_OF_VIEW: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// Where coordinates reach this far, cameras have no room: a thousandth of the largest number.
const TOO_LARGE: f64 = f64::MAX / 1000.0;

/// A camera that shows all of the scene.
pub(crate) fn whole(
    scene: &Scene,
    up: Option<DVec3>,
    fov: f64,
    size: [u32; 2],
) -> Result<Camera, Failure> {
    let camera = upright(scene, up, |up| {
        // Of a usual view, the direction: how near to go, the picture's shape decides.
        let roughly = match scene.suggested_view() {
            Some((eye, target)) => Camera::perspective(eye, target, up, fov, size)?,
            None => Camera::looking_at_all(bounds(scene), up, size)?,
        };
        // A scene that is all but a point, or as large as numbers go, has no better one.
        Ok(framing::near(&roughly, scene, fov).unwrap_or(roughly))
    });
    camera.map_err(|error| about(scene, &error))
}

/// The camera that the options ask for.
pub(crate) fn asked(args: &RenderArgs, scene: &Scene) -> Result<Camera, Failure> {
    let (up, fov, size) = (args.up.up, args.fov, args.size);
    let [low, high] = bounds(scene);
    let target = args.target.unwrap_or(low * 0.5 + high * 0.5);
    let camera = match (args.eye, args.direction, args.target) {
        (None, None, None) => return whole(scene, up, fov, size),
        (Some(eye), ..) => upright(scene, up, |up| Camera::perspective(eye, target, up, fov, size)),
        (None, Some(direction), target) => upright(scene, up, |up| {
            let whole = framing::parallel(direction, up, scene, size)?;
            let height = whole.pixel_size() * f64::from(size[1]);
            target.map_or(Ok(whole), |target| Camera::parallel(direction, up, target, height, size))
        }),
        (None, None, Some(target)) => upright(scene, up, |up| {
            let roughly = Camera::looking_at_all(bounds(scene), up, size)?;
            let eye = target - roughly.forward() * (high - low).length();
            Camera::perspective(eye, target, up, fov, size)
        }),
    };
    camera.map_err(|error| about(scene, &error))
}

/// Cameras alternately around the scene and inside it.
pub(crate) fn around_and_inside(
    scene: &Scene,
    up: Option<DVec3>,
    count: usize,
    size: [u32; 2],
    seed: u64,
) -> Result<Vec<Camera>, Failure> {
    let cameras = views(bounds(scene), up.unwrap_or(scene.up()), count, size, seed);
    cameras.map_err(|error| about(scene, &error))
}

/// Makes a camera with the up vector asked for; if none was, with the scene's, or, for a view along
/// that, another.
fn upright(
    scene: &Scene,
    up: Option<DVec3>,
    make: impl Fn(DVec3) -> Result<Camera, CameraError>,
) -> Result<Camera, CameraError> {
    if let Some(up) = up {
        return make(up);
    }
    let first = make(scene.up());
    let others = [DVec3::Y, DVec3::NEG_Z, DVec3::X];
    first.or_else(|error| others.into_iter().find_map(|up| make(up).ok()).ok_or(error))
}

fn bounds(scene: &Scene) -> [DVec3; 2] {
    scene.bounds().map_or([DVec3::ZERO; 2], |(low, high)| [low, high])
}

/// A failure to make a camera for a scene.
pub(crate) fn about(scene: &Scene, error: &CameraError) -> Failure {
    let [low, high] = bounds(scene);
    let furthest = low.abs().max(high.abs()).max_element();
    if furthest < TOO_LARGE {
        return Failure::about(scene.name(), error);
    }
    let problem = format!(
        "the scene is too large for a camera: its coordinates reach {furthest:.1e}, and what is \
         around it is beyond all numbers; scale it down"
    );
    Failure::about(scene.name(), problem)
}
