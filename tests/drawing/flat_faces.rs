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

fn length(runs: &[EdgeRun]) -> f64 {
    runs.iter()
        .map(|run| (run.ends[0][0] - run.ends[1][0]).hypot(run.ends[0][1] - run.ends[1][1]))
        .sum()
}

/// Whether the picture of a triangle is narrower than a pixel.
fn is_thin(triangle: &[DVec3], camera: &Camera) -> bool {
    let [a, b, c] = [0, 1, 2].map(|k| DVec2::from(camera.project(triangle[k]).unwrap()));
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    (b - a).perp_dot(c - a).abs() < longest
}

#[test]
fn flat_sides_of_triangles_have_whole_crossings_and_no_edges_inside() {
    let (mut crossed, mut creases) = (0, 0);
    for seed in seeds(60) {
        let mut dice = Dice(seed);
        let polygons = boxes(&mut dice);
        let single: Vec<Vec<[f32; 3]>> =
            polygons.iter().map(|p| p.iter().map(|p| p.as_vec3().to_array()).collect()).collect();
        let eye = dice.point(-1.0, 1.0).normalize() * 8.0;
        let size = [400, 300];
        let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.6, size).unwrap();
        let step = 1e-6;
        let round = |p: &DVec3| (p / step).round() * step;
        let decimals: Vec<Vec<DVec3>> =
            polygons.iter().map(|polygon| polygon.iter().map(round).collect()).collect();
        let default = BuildOptions::DEFAULT;
        let exact = default.clone().with_tolerance(0.0);
        // As a reader of decimals builds it.
        let of_decimals = default.with_tolerance(4.0 * step);
        for (name, tree, exactly) in [
            ("f64", BspTree::build(&polygons).unwrap(), exact.build(&polygons).unwrap()),
            ("f32", BspTree::build(&single).unwrap(), exact.build(&single).unwrap()),
            ("decimals", of_decimals.build(&decimals).unwrap(), exact.build(&decimals).unwrap()),
        ] {
            // The picture of a face that is nearly seen edge-on is as narrow as the decimals: an end may be anywhere.
            if name == "decimals" && polygons.iter().any(|p| is_thin(p, &camera)) {
                continue;
            }
            let [found, expected] = [&tree, &exactly]
                .map(|tree| length(&map_of(tree, &camera).crossings(Hidden::Skip).unwrap()));
            crossed += usize::from(expected > 10.0);
            assert!((found - expected).abs() < 0.02, "{seed}, {name}: {found} for {expected}");
            for run in map_of(&tree, &camera).edges(Hidden::Keep).unwrap() {
                if let EdgeKind::Crease(angle) = run.kind {
                    creases += 1;
                    assert!(angle > 1.0, "{seed}, {name}: {run:?}");
                }
            }
        }
    }
    enough!(crossed > 85, creases > 1500; "{crossed} {creases}");
}
