//! Cameras from the options, and default cameras for a scene.

use binspace::Error;
use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::view::{Camera, Projection, views};

use clap::{Args, ValueEnum};

use crate::args::UpArgs;
use crate::failure::Failure;
use crate::upright::up_of;
use crate::{framing, values};

/// The default vertical field of view in radians: 40 degrees.
pub(crate) const FIELD_OF_VIEW: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// Scenes with coordinates this large are too large for a camera: a thousandth of the largest
/// number.
const TOO_LARGE: f64 = f64::MAX / 1000.0;

/// Options of the camera of one picture.
#[derive(Args, Debug)]
#[command(next_help_heading = "View")]
pub(crate) struct ViewArgs {
    /// Position of the eye
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) eye: Option<DVec3>,
    /// Direction of view of a parallel projection
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction)]
    #[arg(allow_hyphen_values = true, group = "parallel", conflicts_with_all = ["eye", "fov"])]
    pub(crate) direction: Option<DVec3>,
    /// Parallel view by name: front, top, right or iso
    #[arg(long, value_name = "NAME", value_enum, hide_possible_values = true)]
    #[arg(group = "parallel", conflicts_with_all = ["eye", "fov"])]
    pub(crate) view: Option<View>,
    /// Point in the middle of the picture [default: the scene's middle]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) target: Option<DVec3>,
    #[command(flatten)]
    pub(crate) up: UpArgs,
    /// Vertical field of view in degrees
    #[arg(long, value_name = "DEGREES", default_value = "40", value_parser = values::field_of_view)]
    pub(crate) fov: f64,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = values::size)]
    pub(crate) size: [u32; 2],
    /// Empty share of the picture on each side of a whole scene, in percent
    #[arg(long, value_name = "PERCENT", default_value = "4", value_parser = values::margin)]
    #[arg(hide_short_help = true)]
    pub(crate) margin: f64,
}

/// The empty share of the picture on each side, by default.
pub(crate) const MARGIN: f64 = 0.04;

/// The usual views of a technical drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum View {
    /// Horizontally: along y if z is up, against z if y is up
    Front,
    /// From above
    Top,
    /// Horizontally, from the right of the front view
    Right,
    /// Isometric: from the front, the right and above alike
    Iso,
}

impl View {
    /// The direction of view and the up direction of the picture, for an up direction of the scene.
    fn axes(self, up: DVec3) -> [DVec3; 2] {
        // Scaled first, so that no square overflows or vanishes.
        let up = (up / up.abs().max_element()).normalize();
        let side = if up.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
        let forward = up.cross(side).normalize();
        let right = forward.cross(up);
        match self {
            Self::Front => [forward, up],
            Self::Top => [-up, forward],
            Self::Right => [-right, up],
            Self::Iso => [forward - right - up, up],
        }
    }
}

/// A camera that shows all of the scene.
pub(crate) fn whole(
    scene: &Scene,
    up: Option<DVec3>,
    fov: f64,
    size: [u32; 2],
    margin: f64,
) -> Result<Camera, Failure> {
    let camera = upright(scene, up, |up| {
        // A suggested view gives the direction; the distance depends on the picture's shape.
        let roughly = match scene.suggested_view() {
            Some((eye, target)) => Camera::perspective(eye, target, up, fov, size)?,
            None => Camera::looking_at_all(bounds(scene), up, size)?,
        };
        // No camera is better for a scene that is almost a point, or as large as the largest floats.
        Ok(framing::near(&roughly, scene, fov, margin).unwrap_or(roughly))
    });
    camera.map_err(|error| about(scene, &error))
}

/// The camera that the options describe.
pub(crate) fn asked(args: &ViewArgs, scene: &Scene) -> Result<Camera, Failure> {
    let (fov, size, margin) = (args.fov, args.size, args.margin);
    let (direction, up) = directed(args, scene);
    let [low, high] = bounds(scene);
    let target = args.target.unwrap_or(low * 0.5 + high * 0.5);
    let camera = match (args.eye, direction, args.target) {
        (None, None, None) => return whole(scene, up, fov, size, margin),
        (Some(eye), ..) => upright(scene, up, |up| Camera::perspective(eye, target, up, fov, size)),
        (None, Some(direction), target) => upright(scene, up, |up| {
            let whole = framing::parallel(direction, up, scene, size, margin)?;
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

/// The direction of a parallel view, and the up direction of the picture, from the options.
fn directed(args: &ViewArgs, scene: &Scene) -> (Option<DVec3>, Option<DVec3>) {
    let up = args.up.given();
    let Some(view) = args.view else { return (args.direction, up) };
    let [direction, up] = view.axes(up.unwrap_or_else(|| up_of(scene)));
    (Some(direction), Some(up))
}

/// A parallel camera that shows a scene with a number of pixels for each of its units. The picture is as large as
/// that takes.
pub(crate) fn to_scale(args: &ViewArgs, scene: &Scene, scale: f64) -> Result<Camera, Failure> {
    // The command line takes a scale only with a direction.
    let (Some(direction), up) = directed(args, scene) else { return asked(args, scene) };
    let camera =
        upright(scene, up, |up| framing::to_scale(direction, up, scene, scale, args.margin));
    let camera = camera.map_err(|error| about(scene, &error))?;
    match args.target {
        None => Ok(camera),
        Some(target) => {
            let height = f64::from(camera.size()[1]) / scale;
            let moved = Camera::parallel(direction, camera.up(), target, height, camera.size());
            moved.map_err(|error| about(scene, &error))
        }
    }
}

/// Cameras alternately around the scene and inside it.
pub(crate) fn around_and_inside(
    scene: &Scene,
    up: Option<DVec3>,
    count: usize,
    size: [u32; 2],
    seed: u64,
) -> Result<Vec<Camera>, Failure> {
    let cameras = views(bounds(scene), up.unwrap_or_else(|| up_of(scene)), count, size, seed);
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
    let first = make(up_of(scene));
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
