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
    /// Point at the centre of the picture [default: the scene's centre]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) target: Option<DVec3>,
    #[command(flatten)]
    pub(crate) up: UpArgs,
    /// Vertical field of view in degrees
    #[arg(long, value_name = "DEGREES", default_value = "40", value_parser = values::field_of_view)]
    #[arg(allow_negative_numbers = true)]
    pub(crate) fov: f64,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = values::size)]
    pub(crate) size: [u32; 2],
    /// Empty border around a whole scene, in percent of the picture on each side
    #[arg(long, value_name = "PERCENT", default_value = "4", value_parser = values::margin)]
    #[arg(allow_negative_numbers = true, hide_short_help = true)]
    pub(crate) margin: f64,
}

/// The empty share of the picture on each side, by default.
pub(crate) const MARGIN: f64 = 0.04;

/// The usual views of a technical drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum View {
    /// Horizontal: towards +y if z is up, towards -z if y is up
    Front,
    /// From above
    Top,
    /// Horizontal: from the right side of the front view
    Right,
    /// Isometric: equally from the front, the right and above
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

/// The camera that the options describe. With a number of pixels for each unit of the scene, the picture of a
/// parallel view is as large as that takes.
pub(crate) fn asked(args: &ViewArgs, scene: &Scene, scale: Option<f64>) -> Result<Camera, Failure> {
    let (fov, size, margin) = (args.fov, args.size, args.margin);
    let (direction, up) = directed(args, scene);
    let [low, high] = bounds(scene);
    let target = args.target.unwrap_or(low * 0.5 + high * 0.5);
    let camera = match (args.eye, direction, args.target) {
        (None, None, None) => return whole(scene, up, fov, size, margin),
        (Some(eye), ..) => upright(scene, up, |up| Camera::perspective(eye, target, up, fov, size)),
        (None, Some(direction), target) => upright(scene, up, |up| {
            framing::parallel(direction, up, scene, target, size, scale, margin)
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

/// Makes a camera with the up vector from the options. By default the up vector is the scene's, or another
/// vector if the view is parallel to the scene's up vector.
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
        "too large for a camera: coordinates reach {furthest:.1e}, and points around the scene \
         overflow; scale it down"
    );
    Failure::about(scene.name(), problem)
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::args::{Cli, Command};

    /// Opposite corners of the block.
    const CORNERS: [DVec3; 2] = [DVec3::new(0.0, -0.5, 0.0), DVec3::new(2.0, 0.5, 3.0)];

    /// A block of 2 by 1 by 3 units that stands on z = 0, in an OBJ file.
    fn block() -> Scene {
        let mut text = String::new();
        for k in 0..8 {
            let [x, y, z] = [0, 1, 2].map(|axis| CORNERS[k >> axis & 1][axis]);
            text += &format!("v {x} {y} {z}\n");
        }
        text += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
        Scene::from_obj("block.obj", text.as_bytes(), |_| None).unwrap().0
    }

    fn camera(options: &str) -> Result<Camera, Failure> {
        let line = format!("binspace draw block.obj -o a.svg {options}");
        let Command::Draw(args) = Cli::try_parse_from(line.split(' ')).unwrap().command else {
            panic!("another command")
        };
        asked(&args.view, &block(), args.scale)
    }

    /// Checks where a camera shows points, in pixels from the upper left corner.
    #[track_caller]
    fn assert_shown(options: &str, points: &[(DVec3, [f64; 2])]) -> Camera {
        let camera = camera(options).unwrap();
        for (point, [x, y]) in points {
            let [found_x, found_y] = camera.project(*point).unwrap();
            assert!(
                (found_x - x).abs() < 1e-3 && (found_y - y).abs() < 1e-3,
                "{options}: {point} is at {found_x}, {found_y}, not at {x}, {y}"
            );
        }
        camera
    }

    #[test]
    fn views_by_name_are_neither_mirrored_nor_upside_down() {
        for (options, forward, low, high) in [
            ("--view front --size 200x300", DVec3::Y, [0.0, 300.0], [200.0, 0.0]),
            ("--view top --size 200x100", -DVec3::Z, [0.0, 100.0], [200.0, 0.0]),
            ("--view right --size 100x300", -DVec3::X, [0.0, 300.0], [100.0, 0.0]),
            ("--view front --up z --size 200x300", DVec3::Y, [0.0, 300.0], [200.0, 0.0]),
            ("--view top --up=0,0,7e200 --size 200x100", -DVec3::Z, [0.0, 100.0], [200.0, 0.0]),
            ("--view right --up=0,0,7e-200 --size 100x300", -DVec3::X, [0.0, 300.0], [100.0, 0.0]),
            ("--view front --up=-z --size 200x300", -DVec3::Y, [0.0, 0.0], [200.0, 300.0]),
            ("--view front --up y --size 200x100", -DVec3::Z, [0.0, 100.0], [200.0, 0.0]),
            ("--view top --up y --size 200x300", -DVec3::Y, [0.0, 0.0], [200.0, 300.0]),
            ("--view right --up y --size 300x100", -DVec3::X, [300.0, 100.0], [0.0, 0.0]),
            ("--view front --up x --size 100x200", DVec3::Z, [0.0, 200.0], [100.0, 0.0]),
            ("--direction=0,2,0 --size 200x300", DVec3::Y, [0.0, 300.0], [200.0, 0.0]),
        ] {
            let options = format!("{options} --margin 0");
            let camera = assert_shown(&options, &[(CORNERS[0], low), (CORNERS[1], high)]);
            assert!(camera.forward().distance(forward) < 1e-12, "{options}");
            assert_eq!(camera.eye(), None, "{options}");
        }
    }

    #[test]
    fn an_isometric_view_is_from_the_front_the_right_and_above() {
        let camera = camera("--view iso --scale 100").unwrap();
        let at = |point: DVec3| camera.project(point).unwrap();
        let origin = at(DVec3::ZERO);
        for (axis, [across, down]) in [
            (DVec3::X, [1.0 / 2f64.sqrt(), 1.0 / 6f64.sqrt()]),
            (DVec3::Y, [1.0 / 2f64.sqrt(), -1.0 / 6f64.sqrt()]),
            (DVec3::Z, [0.0, -2.0 / 6f64.sqrt()]),
        ] {
            let [x, y] = at(axis);
            let wrong =
                (x - origin[0] - 100.0 * across).abs() + (y - origin[1] - 100.0 * down).abs();
            assert!(wrong < 1e-3, "{axis}: {x}, {y} from {origin:?}");
        }
        // The corner nearest to the viewer is on the right, in front, and above.
        assert!(camera.forward().dot(DVec3::new(1.0, -1.0, 1.0)) < -1.7);
    }

    #[test]
    fn margins_scales_and_targets_place_a_parallel_view() {
        let [low, high] = CORNERS;
        let target = DVec3::new(2.0, 0.0, 3.0);
        for (options, size, points) in [
            // No edge lies exactly on the border of the picture.
            ("--scale 100 --margin 0", [201, 301], [(low, [0.5, 300.5]), (high, [200.5, 0.5])]),
            (
                "--scale 100 --margin 25",
                [400, 600],
                [(low, [100.0, 450.0]), (high, [300.0, 150.0])],
            ),
            (
                "--scale 100 --margin 0 --target=2,0,3",
                [401, 601],
                [(target, [200.5, 300.5]), (target - DVec3::X, [100.5, 300.5])],
            ),
            (
                "--size 400x600 --margin 25",
                [400, 600],
                [(low, [100.0, 450.0]), (high, [300.0, 150.0])],
            ),
            (
                "--size 400x300 --margin 0 --target=2,0,3",
                [400, 300],
                [(target, [200.0, 150.0]), (target + DVec3::Z, [200.0, 50.0])],
            ),
        ] {
            let camera = assert_shown(&format!("--view front {options}"), &points);
            assert_eq!(camera.size(), size, "{options}");
        }
    }

    #[test]
    fn eyes_targets_and_fields_of_view_place_a_perspective_view() {
        let middle = DVec3::new(1.0, 0.0, 1.5);
        let tangent = 20f64.to_radians().tan();
        for (options, top) in [("--fov 90", 10.0), ("", 10.0 * tangent)] {
            // Upwards it is half of the height to the border; across it is a quarter of the width.
            let across = middle + DVec3::X * top;
            let points = [
                (middle, [100.0, 50.0]),
                (middle + DVec3::Z * top, [100.0, 0.0]),
                (across, [150.0, 50.0]),
            ];
            let options = options.to_owned() + " --size 200x100";
            for target in ["", " --target=1,0,1.5"] {
                assert_shown(
                    &format!("--eye=1,-10,1.5{target} {options}").replace("  ", " "),
                    &points,
                );
            }
        }
        // A target alone is seen from as far away as the block is long.
        let camera = assert_shown("--target=0,0,3 --fov 90", &[(DVec3::Z * 3.0, [320.0, 240.0])]);
        let away = DVec3::Z * 3.0 - camera.eye().unwrap();
        let length = (CORNERS[1] - CORNERS[0]).length();
        assert!((away.length() - length).abs() < 1e-9);
        assert_shown(
            "--target=0,0,3 --fov 90",
            &[(DVec3::Z * 3.0 + camera.up() * length, [320.0, 0.0])],
        );
    }

    /// The block touches the margin at both ends of one direction, and nowhere reaches into the margin.
    #[test]
    fn without_a_camera_the_scene_fills_the_picture_up_to_the_margin() {
        for (options, fov, margin) in [
            ("", 40.0, 0.04),
            ("--margin 0 --fov 90", 90.0, 0.0),
            ("--margin 25 --size 100x300", 40.0, 0.25),
            ("--margin 10 --fov 10 --size 900x100", 10.0, 0.1),
        ] {
            let camera =
                camera(&format!("{options} --up z").trim_start().replace("  ", " ")).unwrap();
            let shown = block();
            let mut free = [f64::MAX; 4];
            for &corner in shown.polygons().flatten() {
                let at = camera.project(corner).unwrap();
                for axis in 0..2 {
                    let share = at[axis] / f64::from(camera.size()[axis]);
                    free[axis] = free[axis].min(share);
                    free[2 + axis] = free[2 + axis].min(1.0 - share);
                }
            }
            assert!(free.iter().all(|&free| free > margin - 1e-6), "{options}: {free:?}");
            let touches = |axis: usize| free[axis].max(free[2 + axis]) < margin + 1e-3;
            assert!(touches(0) || touches(1), "{options}: {free:?}");
            let half = f64::from(camera.size()[1]) / 2.0;
            let height = camera.pixel_size()[1] * half;
            assert!(
                (height - (0.5f64 * fov).to_radians().tan()).abs() < 1e-9,
                "{options}: {height}"
            );
        }
    }

    #[test]
    fn up_is_that_of_the_scene_unless_the_view_is_along_it() {
        let front = [(DVec3::new(1.0, 0.0, 1.5), [320.0, 240.0])];
        for (options, up) in [
            ("--eye=1,-9,1.5", DVec3::Z),
            ("--up auto --eye=1,-9,1.5", DVec3::Z),
            ("--up x --eye=1,-9,1.5", DVec3::X),
            ("--up=-x --eye=1,-9,1.5", -DVec3::X),
            ("--up=0,5,1e-3 --eye=1,-9,1.5", DVec3::Z),
            ("--up y --eye=9,0,1.5", DVec3::Y),
            // From above, z is no direction of the picture.
            ("--eye=1,0,9", DVec3::Y),
            ("--direction=0,0,-1", DVec3::Y),
        ] {
            let camera = assert_shown(options, &front);
            assert!(camera.up().distance(up) < 1e-6, "{options}: {}", camera.up());
        }
        for options in ["--up z --eye=1,0,9", "--up=0,0,-2 --direction=0,0,-1"] {
            let Err(Failure::Message(message)) = camera(options) else { panic!("{options}") };
            assert!(message.contains("up vector"), "{message}");
        }
        let along = ["--view=top", "--direction=0,0,1"];
        for (parallel, other) in
            along.iter().flat_map(|view| [(view, "--eye=1,2,3"), (view, "--fov=9")])
        {
            let line = ["binspace", "render", "block.obj", "-oa.png", parallel, other];
            let error = Cli::try_parse_from(line).unwrap_err();
            assert_eq!(error.kind(), clap::error::ErrorKind::ArgumentConflict, "{error}");
        }
    }
}
