//! Boxes whose flat sides are triangles with rounded corners, at default tolerances: their crossings are as
//! long as with a tolerance of 0, and no edge divides a flat side.

use super::map_of;
use binspace::drawing::{EdgeKind, EdgeRun};
use binspace::glam::{DQuat, EulerRot};
use testkit::prelude::*;

/// The corners of a box of triangles.
const SIDES: [[usize; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

fn boxes(dice: &mut Dice) -> Vec<Vec<DVec3>> {
    let mut triangles = Vec::new();
    for _ in 0..2 {
        let mut angle = || dice.range(-3.0, 3.0);
        let turn = DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle());
        let (at, size) = (dice.point(-0.4, 0.4), dice.point(0.3, 1.2));
        let corner = |k: usize| {
            let sign = |bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
            at + turn * (dvec3(sign(0), sign(1), sign(2)) * size)
        };
        for side in SIDES {
            let [a, b, c, d] = side.map(corner);
            let is_other = dice.below(2) == 0;
            let both = if is_other { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            triangles.extend(both.map(|triangle| triangle.to_vec()));
        }
    }
    // In either order of any two triangles, not only one box after the other.
    if dice.below(2) == 0 {
        let other = triangles.split_off(triangles.len() / 2);
        let pairs = other.into_iter().rev().zip(triangles);
        triangles = pairs.flat_map(|(a, b)| [a, b]).collect();
    }
    triangles
}

/// Two prisms whose ends are fans of triangles, and whose sides are two triangles each.
fn prisms(dice: &mut Dice) -> Vec<Vec<DVec3>> {
    let mut triangles = Vec::new();
    for _ in 0..2 {
        let mut angle = || dice.range(-3.0, 3.0);
        let turn = DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle());
        let (at, size) = (dice.point(-0.4, 0.4), dice.point(0.5, 1.2));
        let sides = 5 + dice.below(8);
        let corner = |k: usize, z: f64| {
            let (sin, cos) = (std::f64::consts::TAU * (k % sides) as f64 / sides as f64).sin_cos();
            at + turn * (dvec3(cos, sin, z) * size)
        };
        for k in 0..sides {
            let [a, b, c, d] =
                [corner(k, -1.0), corner(k + 1, -1.0), corner(k + 1, 1.0), corner(k, 1.0)];
            triangles.extend([vec![a, b, c], vec![a, c, d]]);
            if 0 < k && k + 1 < sides {
                triangles.push(vec![corner(0, 1.0), d, c]);
                triangles.push(vec![corner(0, -1.0), b, a]);
            }
        }
    }
    dice.shuffle(&mut triangles);
    triangles
}

fn length(runs: &[EdgeRun]) -> f64 {
    runs.iter()
        .map(|run| (run.ends[0][0] - run.ends[1][0]).hypot(run.ends[0][1] - run.ends[1][1]))
        .sum()
}

/// Whether the picture of a triangle is narrower than so many pixels.
fn is_thin(triangle: &[DVec3], camera: &Camera, width: f64) -> bool {
    let [a, b, c] = [0, 1, 2].map(|k| DVec2::from(camera.project(triangle[k]).unwrap()));
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    (b - a).perp_dot(c - a).abs() < width * longest
}

/// The number of trees with visible crossings, and the number of creases.
type Counts = [usize; 2];

/// Compares the crossings of some triangles at default tolerances with those at a tolerance of 0, for corners in
/// `f64`, in `f32`, and with so many decimals.
fn judge(polygons: &[Vec<DVec3>], places: i32, dice: &mut Dice, [crossed, creases]: &mut Counts) {
    let single: Vec<Vec<[f32; 3]>> =
        polygons.iter().map(|p| p.iter().map(|p| p.as_vec3().to_array()).collect()).collect();
    let eye = dice.point(-1.0, 1.0).normalize() * 8.0;
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.6, [400, 300]).unwrap();
    let step = 10f64.powi(-places);
    let round = |p: &DVec3| (p / step).round() * step;
    let decimals: Vec<Vec<DVec3>> =
        polygons.iter().map(|polygon| polygon.iter().map(round).collect()).collect();
    let default = BuildOptions::DEFAULT;
    let exact = default.clone().with_tolerance(0.0);
    // As a reader of decimals builds it.
    let of_decimals = default.with_tolerance(4.0 * step);
    // The picture of a face that is nearly seen edge-on is as narrow as the decimals: an end may be anywhere.
    let is_clear = !polygons.iter().any(|p| is_thin(p, &camera, 1e6 * step));
    for (name, tree, exactly, slack) in [
        ("f64", BspTree::build(polygons).unwrap(), exact.build(polygons).unwrap(), 0.02),
        ("f32", BspTree::build(&single).unwrap(), exact.build(&single).unwrap(), 2e4 * step),
        (
            "decimals",
            of_decimals.build(&decimals).unwrap(),
            exact.build(&decimals).unwrap(),
            2e4 * step,
        ),
    ] {
        if name == "decimals" && !is_clear {
            continue;
        }
        let [found, expected] = [&tree, &exactly]
            .map(|tree| length(&map_of(tree, &camera).crossings(Hidden::Skip).unwrap()));
        *crossed += usize::from(expected > 10.0);
        assert!(
            (found - expected).abs() < slack,
            "{name}: {found} for {expected} from {eye:?}: {polygons:?}"
        );
        for run in map_of(&tree, &camera).edges(Hidden::Keep).unwrap() {
            if let EdgeKind::Crease(angle) = run.kind {
                *creases += 1;
                assert!(angle > 0.1, "{name}: {run:?} from {eye:?}: {polygons:?}");
            }
        }
    }
}

#[test]
fn flat_sides_of_triangles_have_whole_crossings_and_no_edges_inside() {
    let mut counts = [0; 2];
    for seed in seeds(60) {
        let mut dice = Dice(seed);
        judge(&boxes(&mut dice), 6, &mut dice, &mut counts);
    }
    enough!(counts[0] > 85, counts[1] > 1500; "{counts:?}");
}

#[test]
fn flat_ends_of_many_triangles_have_whole_crossings_and_no_edges_inside() {
    let mut counts = [0; 2];
    for seed in seeds(60) {
        let mut dice = Dice(seed);
        judge(&prisms(&mut dice), 5, &mut dice, &mut counts);
    }
    enough!(counts[0] > 85, counts[1] > 3000; "{counts:?}");
}

/// The first polygon lies on the plane of the third one, which cuts the second: the first is the largest, and the
/// third is not on its plane.
#[test]
fn a_large_face_crosses_what_the_plane_of_a_small_one_cut() {
    let faces = [
        [
            [-0.382655, -0.444632, 0.602688],
            [-0.292546, -0.361408, 0.70012],
            [-0.679151, -0.28858, -0.014455],
        ],
        [
            [-0.808365, -0.565369, 0.111514],
            [-0.37719, -0.81534, 0.344477],
            [-0.212897, 0.88995, 0.919243],
        ],
        [
            [-0.123077, -0.079124, 0.796598],
            [-0.074934, 0.066964, 0.778547],
            [-0.292546, -0.361408, 0.70012],
        ],
    ];
    let direction = DVec3::new(-0.21039811250284918, -0.5202409828758623, -0.827696776598529);
    let camera = Camera::parallel(direction, DVec3::Y, DVec3::ZERO, 2.0, [400, 400]).unwrap();
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        let lengths = [4e-6, 0.0].map(|tolerance| {
            let tree = options.clone().with_tolerance(tolerance).build(faces).unwrap();
            length(&map_of(&tree, &camera).crossings(Hidden::Skip).unwrap())
        });
        enough!(lengths[1] > 5.0; "{lengths:?}");
        assert!((lengths[0] - lengths[1]).abs() < 0.02, "{heuristic}: {lengths:?}");
    }
}
