//! Cameras from the options, and default cameras for a scene.

use binspace::Error;
use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::view::{Camera, Projection, views};

use clap::Args;

use crate::args::UpArgs;
use crate::failure::Failure;
use crate::{framing, values};

/// The default vertical field of view in radians: 40 degrees.
pub(crate) const FIELD_OF_VIEW: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// Scenes with coordinates this large are too large for a camera: a thousandth of the largest
/// number.
const TOO_LARGE: f64 = f64::MAX / 1000.0;

/// Options of the camera of one picture.
#[derive(Args, Debug)]
pub(crate) struct ViewArgs {
    /// Position of the eye
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) eye: Option<DVec3>,
    /// Direction of view, from infinitely far away: a parallel projection
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction)]
    #[arg(allow_hyphen_values = true, conflicts_with_all = ["eye", "fov"])]
    pub(crate) direction: Option<DVec3>,
    /// Point in the middle of the picture [default: the scene's middle]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) target: Option<DVec3>,
    #[command(flatten)]
    pub(crate) up: UpArgs,
    /// Field of view from bottom to top, in degrees
    #[arg(long, value_name = "DEGREES", default_value = "40", value_parser = values::field_of_view)]
    pub(crate) fov: f64,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = values::size)]
    pub(crate) size: [u32; 2],
}

/// A camera that shows all of the scene.
pub(crate) fn whole(
    scene: &Scene,
    up: Option<DVec3>,
    fov: f64,
    size: [u32; 2],
) -> Result<Camera, Failure> {
    let camera = upright(scene, up, |up| {
        // A suggested view gives the direction; the distance depends on the picture's shape.
        let roughly = match scene.suggested_view() {
            Some((eye, target)) => Camera::perspective(eye, target, up, fov, size)?,
            None => Camera::looking_at_all(bounds(scene), up, size)?,
        };
        // No camera is better for a scene that is almost a point, or as large as the largest floats.
        Ok(framing::near(&roughly, scene, fov).unwrap_or(roughly))
    });
    camera.map_err(|error| about(scene, &error))
}

/// The camera that the options describe.
pub(crate) fn asked(args: &ViewArgs, scene: &Scene) -> Result<Camera, Failure> {
    let (up, fov, size) = (args.up.up, args.fov, args.size);
    let [low, high] = bounds(scene);
    let target = args.target.unwrap_or(low * 0.5 + high * 0.5);
    let camera = match (args.eye, args.direction, args.target) {
        (None, None, None) => return whole(scene, up, fov, size),
        (Some(eye), ..) => upright(scene, up, |up| Camera::perspective(eye, target, up, fov, size)),
        (None, Some(direction), target) => upright(scene, up, |up| {
            let whole = framing::parallel(direction, up, scene, size)?;
            let height = whole.pixel_size()[1] * f64::from(size[1]);
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

/// Makes a camera with the up vector from the options. By default it is the scene's, or another if the view
/// is along that.
fn upright(
    scene: &Scene,
    up: Option<DVec3>,
    make: impl Fn(DVec3) -> Result<Camera, Error>,
) -> Result<Camera, Error> {
    if let Some(up) = up {
        return make(up);
    }
    let first = make(scene.up());
    let others = [DVec3::Y, DVec3::NEG_Z, DVec3::X];
    first.or_else(|error| others.into_iter().find_map(|up| make(up).ok()).ok_or(error))
}

/// Whether a camera is inside the box around a scene.
pub(crate) fn is_inside(camera: &Camera, scene: &Scene) -> bool {
    let Projection::Perspective { eye, .. } = *camera.projection() else {
        return false;
    };
    scene.bounds().is_some_and(|(low, high)| eye.cmpge(low).all() && eye.cmple(high).all())
}

fn bounds(scene: &Scene) -> [DVec3; 2] {
    scene.bounds().map_or([DVec3::ZERO; 2], |(low, high)| [low, high])
}

/// A failure to make a camera for a scene.
pub fn about(scene: &Scene, error: &Error) -> Failure {
    let [low, high] = bounds(scene);
    let furthest = low.abs().max(high.abs()).max_element();
    if furthest < TOO_LARGE {
        return Failure::about(scene.name(), error);
    }
    let problem = format!(
        "the scene is too large for a camera: its coordinates reach {furthest:.1e}, so points \
         around it overflow; scale it down"
    );
    Failure::about(scene.name(), problem)
}
