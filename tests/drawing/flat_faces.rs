//! Boxes whose flat sides are polygons with rounded corners, at default tolerances: their crossings are as
//! long as with a tolerance of 0, sides that touch do not cross, and no edge divides a flat side.

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

/// The corners of a side's parts, as shares of its width and height: rectangles halved again and again, some into
/// triangles. Corners of some parts lie on edges of others.
fn parts(dice: &mut Dice, [from, to]: [DVec2; 2], depth: usize, found: &mut Vec<Vec<DVec2>>) {
    if depth > 0 && dice.below(3) > 0 {
        let at = from + (to - from) * dice.range(0.2, 0.8);
        let is_across = dice.below(2) == 0;
        let (end, start) = match is_across {
            true => (dvec2(at.x, to.y), dvec2(at.x, from.y)),
            false => (dvec2(to.x, at.y), dvec2(from.x, at.y)),
        };
        parts(dice, [from, end], depth - 1, found);
        parts(dice, [start, to], depth - 1, found);
        return;
    }
    let [a, b, c, d] = [from, dvec2(to.x, from.y), to, dvec2(from.x, to.y)];
    found.extend(match dice.below(3) {
        0 => vec![vec![a, b, c, d]],
        1 => vec![vec![a, b, c], vec![a, c, d]],
        _ => vec![vec![a, b, d], vec![b, c, d]],
    });
}

/// The parts of a box's sides, with so many decimals.
fn divided_box(dice: &mut Dice, places: i32) -> Vec<Vec<DVec3>> {
    let mut angle = || dice.range(-3.0, 3.0);
    let turn = DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle());
    let (at, size) = (dice.point(-0.4, 0.4), dice.point(0.2, 1.1));
    let scale = 10f64.powi(places);
    let mut polygons = Vec::new();
    for (axis, sign) in (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]) {
        let mut found = Vec::new();
        parts(dice, [DVec2::NEG_ONE, DVec2::ONE], 3, &mut found);
        let corner = |p: &DVec2| {
            let mut corner = [sign, p.x * sign, p.y];
            corner.rotate_right(axis);
            ((at + turn * (DVec3::from(corner) * size)) * scale).round() / scale
        };
        polygons.extend(found.iter().map(|part| part.iter().map(corner).collect::<Vec<_>>()));
    }
    dice.shuffle(&mut polygons);
    polygons
}

/// Rounded corners reach through the sides that they touch, by less than the tolerance.
#[test]
fn sides_of_one_box_do_not_cross_each_other() {
    let (mut crossed, mut pieces) = (0, 0);
    for seed in seeds(60) {
        let mut dice = Dice(seed);
        let places = 3 + dice.below(4) as i32;
        let mut polygons = divided_box(&mut dice, places);
        let first = polygons.len();
        polygons.extend(divided_box(&mut dice, places));
        let heuristic = Heuristic::ALL[dice.below(Heuristic::ALL.len())];
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        // As a reader of decimals builds it.
        let tree = options.with_tolerance(4.0 * 10f64.powi(-places)).build(&polygons).unwrap();
        let eye = dice.point(-1.0, 1.0).normalize() * 8.0;
        let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.6, [400, 300]).unwrap();
        pieces += tree.len() - polygons.len();
        for run in map_of(&tree, &camera).crossings(Hidden::Keep).unwrap() {
            let EdgeKind::Crossing(other) = run.kind else { panic!("{run:?}") };
            let is_of_both = (run.polygon < first) != (other < first);
            let long = length(std::slice::from_ref(&run));
            assert!(is_of_both || long < 0.1, "{seed}: {run:?} from {eye:?}: {polygons:?}");
            crossed += usize::from(is_of_both && run.is_visible && long > 1.0);
        }
    }
    enough!(crossed > 250, pieces > 3000; "{crossed} {pieces}");
}

/// Two sides of a box that touch in one corner and along a line. The first reaches a little through the second.
#[test]
fn sides_of_a_box_that_touch_do_not_cross() {
    let faces = [
        [
            [-0.66204, -0.16897, -1.11299],
            [1.16358, -0.65537, -0.91293],
            [1.10167, -0.94004, -1.04009],
            [-0.72395, -0.45364, -1.24016],
        ],
        [
            [1.34348, 0.59232, 0.4789],
            [0.94867, -1.22306, -0.33203],
            [1.10167, -0.94004, -1.04009],
            [1.49648, 0.87534, -0.22916],
        ],
    ];
    let eye = DVec3::new(1.616837426999533, 4.666508729624264, -6.293610490886299);
    for (heuristic, [found, exact]) in lengths(&faces.map(Vec::from), 4e-5, eye) {
        assert!(found < 0.1 && exact < 0.1, "{heuristic}: {found}, {exact} at 0");
    }
}

/// The second polygon, a strip, crosses the last one, which the plane of the third cut. The third lies beside the strip
/// in one flat side, but neither is on the other's plane.
#[test]
fn a_strip_crosses_what_the_plane_of_its_neighbour_cut() {
    let faces = [
        vec![
            [0.0146, -0.272187, -1.03018],
            [-1.285277, -0.077362, -0.544107],
            [0.344428, 0.062354, -0.28223],
        ],
        vec![
            [0.227563, 0.553801, -0.102408],
            [-0.425157, -0.189787, 1.251953],
            [-0.394639, -0.22636, 1.246581],
            [0.258082, 0.517228, -0.107779],
        ],
        vec![
            [0.185456, 0.217941, 0.218828],
            [0.133965, 0.159282, 0.325668],
            [0.284781, -0.021454, 0.299123],
            [0.336272, 0.037205, 0.192283],
        ],
        vec![
            [0.748857, -0.264995, 1.419081],
            [0.024276, 0.523471, -0.633351],
            [0.031603, 1.167592, 0.024605],
        ],
    ];
    let eye = DVec3::new(2.245992383392225, 6.8982652113299086, 3.3718622878017475);
    for faces in [&faces[..], &faces[1..]] {
        for (heuristic, [found, exact]) in lengths(faces, 4e-6, eye) {
            enough!(exact > 3.0; "{exact}");
            assert!((found - exact).abs() < 0.02, "{heuristic}: {found}, {exact} at 0");
        }
    }
}

/// The lengths of all visible crossings at a tolerance and at 0, by every heuristic and two cameras.
fn lengths(faces: &[Vec<[f64; 3]>], tolerance: f64, eye: DVec3) -> Vec<(Heuristic, [f64; 2])> {
    let perspective = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.6, [400, 300]);
    let parallel = Camera::parallel(-eye, DVec3::Z, DVec3::ZERO, 4.0, [400, 300]);
    let cameras = [perspective.unwrap(), parallel.unwrap()];
    let of = |heuristic: Heuristic, camera: &Camera| {
        [tolerance, 0.0].map(|tolerance| {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
            let tree = options.with_tolerance(tolerance).build(faces).unwrap();
            length(&map_of(&tree, camera).crossings(Hidden::Skip).unwrap())
        })
    };
    let all = Heuristic::ALL.iter();
    all.flat_map(|&heuristic| cameras.each_ref().map(|c| (heuristic, of(heuristic, c)))).collect()
}

/// A floor in the shape of an L is divided into triangles along a diagonal. A wall goes through it along this diagonal.
#[test]
fn a_wall_crosses_a_floor_along_the_edge_between_its_triangles() {
    let floor = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    for seed in seeds(60) {
        let mut dice = Dice(seed);
        let mut angle = || dice.range(-3.0, 3.0);
        let turn = DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle());
        let at = dice.point(-0.4, 0.4);
        let place =
            |x: f64, y: f64, z: f64| ((at + turn * dvec3(x - 0.7, y - 0.7, z)) * 1e5).round() / 1e5;
        let walls = [[[0.0, 0.0], [1.0, 1.0]], [[0.0, 1.0], [1.0, 1.0]], [[1.0, 0.0], [1.0, 1.0]]];
        for [a, b] in walls {
            let corners = [(a, -0.5), (b, -0.5), (b, 0.5), (a, 0.5)];
            let wall = corners.map(|([x, y], z)| place(x, y, z)).to_vec();
            let mut polygons = vec![floor.map(|[x, y]| place(x, y, 0.0)).to_vec(), wall];
            if dice.below(2) == 0 {
                polygons.reverse();
            }
            // Not almost in the plane of either.
            let way = dvec3(dice.range(0.2, 0.3), dice.range(0.5, 0.8), 0.5);
            let eye = turn * way.normalize() * 8.0;
            let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.6, [400, 300]).unwrap();
            let ends = [a, b].map(|[x, y]| camera.project(place(x, y, 0.0)).unwrap());
            let expected = DVec2::from(ends[0]).distance(ends[1].into());
            for &heuristic in Heuristic::ALL {
                let options = BuildOptions::DEFAULT.with_heuristic(heuristic).with_tolerance(4e-5);
                let tree = options.build(&polygons).unwrap();
                let found = length(&map_of(&tree, &camera).crossings(Hidden::Skip).unwrap());
                let is_whole = (found - expected).abs() < 0.3;
                assert!(is_whole, "{heuristic}: {found} for {expected}: {polygons:?}");
            }
        }
    }
}
