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

/// Two prisms with uneven sides of two triangles each, whose ends are halved into triangles again and again.
fn prisms(dice: &mut Dice) -> Vec<Vec<DVec3>> {
    let mut triangles = Vec::new();
    for _ in 0..2 {
        let mut angle = || dice.range(-3.0, 3.0);
        let turn = DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle());
        let (at, size) = (dice.point(-0.4, 0.4), dice.point(0.5, 1.2));
        let n = 5 + dice.below(16);
        let angles: Vec<f64> =
            (0..n).map(|k| (k as f64 + dice.range(0.0, 0.8)) / n as f64).collect();
        let corner = |k: usize, z: f64| {
            let (sin, cos) = (std::f64::consts::TAU * angles[k % n]).sin_cos();
            at + turn * (dvec3(cos, sin, z) * size)
        };
        for k in 0..n {
            let [a, b, c, d] =
                [corner(k, -1.0), corner(k + 1, -1.0), corner(k + 1, 1.0), corner(k, 1.0)];
            triangles.extend([vec![a, b, c], vec![a, c, d]]);
        }
        let mut parts = vec![(0..n).collect::<Vec<usize>>()];
        while let Some(mut part) = parts.pop() {
            if let [a, b, c] = part[..] {
                triangles.push([a, b, c].map(|k| corner(k, 1.0)).to_vec());
                triangles.push([c, b, a].map(|k| corner(k, -1.0)).to_vec());
                continue;
            }
            let half = part.len() / 2;
            let rest = [&part[half..], &part[..1]].concat();
            part.truncate(half + 1);
            parts.extend([part, rest]);
        }
    }
    dice.shuffle(&mut triangles);
    triangles
}

/// How far the ends of lines may move if corners move by a length in the picture: an end on a side moves along its line by
/// that length divided by the sine of the angle between both.
fn shift(runs: &[EdgeRun], polygons: &[Vec<DVec3>], camera: &Camera, moved: f64) -> f64 {
    let corner = |p: &DVec3| camera.project(*p).expect("in front of the eye");
    let outlines: Vec<Vec<DVec2>> = polygons
        .iter()
        .map(|polygon| polygon.iter().map(|p| DVec2::from_array(corner(p))).collect())
        .collect();
    let of_end = |[end, other]: [DVec2; 2]| {
        let way = (other - end).normalize();
        let sides = outlines.iter().flat_map(|outline| {
            outline.iter().zip(outline.iter().cycle().skip(1)).filter_map(|(&a, &b)| {
                let along = (b - a).normalize();
                let is_near = (end - a).perp_dot(along).abs() < 0.1
                    && (-0.1..=a.distance(b) + 0.1).contains(&(end - a).dot(along));
                is_near.then(|| moved / along.perp_dot(way).abs())
            })
        });
        sides.fold(0.0, f64::max)
    };
    let ends = |run: &EdgeRun| {
        let [a, b] = run.ends.map(DVec2::from_array);
        if a.distance(b) > 1e-3 { of_end([a, b]) + of_end([b, a]) } else { 0.0 }
    };
    runs.iter().map(ends).sum()
}

fn length(runs: &[EdgeRun]) -> f64 {
    runs.iter()
        .map(|run| (run.ends[0][0] - run.ends[1][0]).hypot(run.ends[0][1] - run.ends[1][1]))
        .sum()
}

/// The numbers of trees with visible crossings, for each kind of corners, and the number of creases.
#[derive(Debug, Default)]
struct Counts {
    crossed: [usize; 3],
    creases: usize,
}

/// Compares the crossings of some triangles at default tolerances with those at a tolerance of 0, for corners in
/// `f64`, in `f32`, and with so many decimals.
fn judge(polygons: &[Vec<DVec3>], places: i32, dice: &mut Dice, counts: &mut Counts) {
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
    let kinds = [
        (BspTree::build(polygons).unwrap(), exact.build(polygons).unwrap()),
        (BspTree::build(&single).unwrap(), exact.build(&single).unwrap()),
        (of_decimals.build(&decimals).unwrap(), exact.build(&decimals).unwrap()),
    ];
    for (kind, (tree, exactly)) in kinds.into_iter().enumerate() {
        let name = ["f64", "f32", "decimals"][kind];
        let [runs, exact_runs] =
            [&tree, &exactly].map(|tree| map_of(tree, &camera).crossings(Hidden::Skip).unwrap());
        let [found, expected] = [&runs, &exact_runs].map(|runs| length(runs));
        // A unit is at most seventy pixels.
        let moved = 70.0 * 4.0 * tree.stats().tolerance;
        let slack = 0.02 + shift(&exact_runs, polygons, &camera, moved);
        counts.crossed[kind] += usize::from(expected > 10.0 && slack < 2.0);
        assert!(
            (found - expected).abs() < slack,
            "{name}: {found} for {expected} from {eye:?}: {polygons:?}"
        );
        for run in map_of(&tree, &camera).edges(Hidden::Keep).unwrap() {
            if let EdgeKind::Crease(angle) = run.kind {
                counts.creases += 1;
                assert!(angle > 0.01, "{name}: {run:?} from {eye:?}: {polygons:?}");
            }
        }
    }
}

#[test]
fn flat_sides_of_triangles_have_whole_crossings_and_no_edges_inside() {
    let mut counts = Counts::default();
    for seed in seeds(60) {
        let mut dice = Dice(seed);
        judge(&boxes(&mut dice), 6, &mut dice, &mut counts);
    }
    enough!(counts.crossed.iter().all(|&n| n > 25), counts.creases > 1500; "{counts:?}");
}

#[test]
fn flat_ends_of_many_triangles_have_whole_crossings_and_no_edges_inside() {
    let mut counts = Counts::default();
    for seed in seeds(100) {
        let mut dice = Dice(seed);
        judge(&prisms(&mut dice), 5, &mut dice, &mut counts);
    }
    enough!(counts.crossed.iter().all(|&n| n > 50), counts.creases > 3000; "{counts:?}");
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

/// The first and the second triangle meet at a right angle along a part of an edge. The third cuts both: its plane is
/// within the tolerance of the edge.
#[test]
fn faces_that_touch_within_the_tolerance_do_not_cross() {
    let faces = [
        [
            [-0.38820, -0.84004, 0.82570],
            [-0.47825, -0.60981, 0.55483],
            [-0.19471, -1.03776, 0.59332],
        ],
        [
            [-0.85185, 0.04836, 0.24545],
            [-0.94190, 0.27858, -0.02543],
            [-0.74841, 0.08085, -0.25780],
        ],
        [
            [0.43866, -0.09677, -0.80342],
            [-0.16795, -0.51232, -0.95493],
            [-0.94190, 0.27858, -0.02543],
        ],
    ];
    let eye = DVec3::new(-3.6714836744344677, -6.984670433096557, 1.317037041767594);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.6, [400, 300]).unwrap();
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic).with_tolerance(4e-5);
        let tree = options.build(faces).unwrap();
        let found = length(&map_of(&tree, &camera).crossings(Hidden::Keep).unwrap());
        assert!(found < 0.1, "{heuristic}: {found}");
    }
}
