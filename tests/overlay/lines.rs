//! Lines and points among polygons that stay and polygons that move, judged by rays in rationals.

use binspace::overlay::{Overlay, Shapes};
use testkit::prelude::*;

use crate::overlay::oracle::{self, Counts};
use crate::overlay::tiling::{self, Given};

type Corners = Vec<DVec3>;

/// Half the side of the grid, in whole numbers.
const ROOM: f64 = 64.0;

/// Polygons, lines and points on few whole coordinates, so that much coincides.
#[derive(Default)]
struct Scene {
    polygons: Vec<Corners>,
    lines: Vec<Corners>,
    points: Vec<DVec3>,
}

fn whole(dice: &mut Dice) -> DVec3 {
    // Multiples of four, so that a midpoint between midpoints has integer coordinates.
    dice.whole_point(3) * 4.0
}

fn polygon(dice: &mut Dice) -> Corners {
    let at = whole(dice);
    let [u, v] = [0, 1].map(|_| whole(dice));
    match dice.below(3) {
        0 => vec![at, at + u, at + v],
        1 => vec![at, at + u, at + u + v, at + v],
        _ => {
            // Perpendicular to an axis, in a plane that contains other polygons as well.
            let axis = dice.below(3);
            let [u, v] =
                [DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]].map(|a| 8.0 * a);
            vec![at - u - v, at + u - v, at + u + v, at - u + v]
        }
    }
}

/// A line that touches or crosses a polygon or another line.
fn line(scene: &Scene, dice: &mut Dice) -> Corners {
    let of = &scene.polygons[dice.below(scene.polygons.len())];
    let n = of.len();
    let k = dice.below(n);
    let (a, b, c) = (of[k], of[(k + 1) % n], of[(k + 2) % n]);
    match dice.below(8) {
        // Along an edge, and beyond the edge.
        0 => vec![a, b],
        1 => vec![a - (b - a), b + (b - a), whole(dice)],
        // Across the polygon, in its plane.
        2 => vec![(a + b) / 2.0, c, (b + c) / 2.0],
        // Through a corner, or through the middle of an edge.
        3 => {
            let step = whole(dice);
            vec![a - step, a + step, b]
        }
        4 => {
            let (step, middle) = (whole(dice), (a + b) / 2.0);
            vec![middle + step, middle - step]
        }
        // A part of another line, or across another line.
        5 if !scene.lines.is_empty() => {
            let other = &scene.lines[dice.below(scene.lines.len())];
            vec![(other[0] + other[1]) / 2.0, other[1], other[0]]
        }
        6 if !scene.lines.is_empty() => {
            let other = &scene.lines[dice.below(scene.lines.len())];
            let (step, middle) = (whole(dice), (other[0] + other[1]) / 2.0);
            vec![middle + step, middle - step, middle - step]
        }
        _ => (0..2 + dice.below(4)).map(|_| whole(dice)).collect(),
    }
}

fn point(scene: &Scene, dice: &mut Dice) -> DVec3 {
    let lists = [&scene.polygons, &scene.lines][dice.below(2)];
    let of = &lists[dice.below(lists.len())];
    match dice.below(3) {
        0 => of[dice.below(of.len())],
        1 => (of[0] + of[1]) / 2.0,
        _ => whole(dice) + whole(dice) / 2.0,
    }
}

fn scene(dice: &mut Dice) -> Scene {
    let polygons = (0..1 + dice.below(10)).map(|_| polygon(dice)).collect();
    let mut scene = Scene { polygons, ..Scene::default() };
    for _ in 0..1 + dice.below(10) {
        let line = line(&scene, dice);
        scene.lines.push(line);
    }
    for _ in 0..dice.below(6) {
        let point = point(&scene, dice);
        scene.points.push(point);
    }
    scene
}

/// Viewpoints in whole numbers: anywhere, or in line with a point and another place.
fn eyes(scene: &Scene, dice: &mut Dice) -> Vec<DVec3> {
    let mut eyes: Vec<DVec3> = (0..4).map(|_| whole(dice) * 2.0 + dvec3(1.0, 2.0, -1.0)).collect();
    eyes.push(whole(dice));
    for &x in &scene.points {
        let line = &scene.lines[dice.below(scene.lines.len())];
        let other = scene.points[dice.below(scene.points.len())];
        for target in [(line[0] + line[1]) / 2.0, other] {
            let times = [1.0, 2.0, -2.0, -3.0][dice.below(4)];
            eyes.push(x + (x - target) * times);
        }
    }
    eyes
}

/// Puts the polygons with odd numbers into the tree, and everything else into the overlay. Judges the order
/// from some eyes.
fn judge(scene: &Scene, by: Heuristic, eyes: &[DVec3], counts: &mut Counts) {
    let bounds = DVec3::splat(ROOM);
    let options = BuildOptions::DEFAULT.with_heuristic(by).with_tolerance(0.0);
    let still = scene.polygons.iter().skip(1).step_by(2);
    let tree = options.with_bounds(-bounds, bounds).build(still).expect("a tree");
    let mut overlay = Overlay::new(&tree);
    // Other contents come first, so that remains of them would be visible.
    let before = Shapes::NONE.with_lines(&scene.lines);
    let before = before.with_points(scene.lines[0].iter().copied());
    overlay.replace_with(&tree, before).expect("on the grid");
    let shapes = Shapes::NONE
        .with_polygons(scene.polygons.iter().step_by(2))
        .with_lines(&scene.lines)
        .with_points(scene.points.iter().copied());
    overlay.replace_with(&tree, shapes).expect("on the grid");
    judge_overlay(&tree, &overlay, scene, eyes, counts);
}

fn judge_overlay(
    tree: &BspTree,
    overlay: &Overlay,
    scene: &Scene,
    eyes: &[DVec3],
    counts: &mut Counts,
) {
    let given = Given::new(overlay, &scene.lines, &scene.points);
    tiling::tiles(tree, overlay, &given, counts).expect("tiles");
    for &eye in eyes {
        let eye = overlay.faces().lattice().to_lattice(eye).map(f64::round);
        oracle::judge(tree, overlay, &given, eye, counts).expect("a right order");
    }
}

#[test]
fn lines_and_points_come_in_the_exact_order_where_much_coincides() {
    let mut counts = Counts::default();
    for seed in seeds(60) {
        let mut dice = Dice(seed);
        let scene = scene(&mut dice);
        let by = Heuristic::ALL[dice.below(Heuristic::ALL.len())];
        judge(&scene, by, &eyes(&scene, &mut dice), &mut counts);
    }
    let Counts { lines, line_polygon, line_on_polygon, point_line, points, .. } = counts;
    enough!(lines > 2_500, line_polygon > 10_000, line_on_polygon > 1_000; "{counts:?}");
    enough!(point_line > 100, points > 50; "{counts:?}");
    enough!(counts.point_polygon > 350, counts.point_on_polygon > 35; "{counts:?}");
    assert!(counts.edge_on < point_line + points && counts.pieces > counts.segments * 3 / 2);
}

/// A scene of numbers with many digits: nothing coincides, and most numbers are rounded.
fn tangle(polygons: usize, lines: usize, points: usize, dice: &mut Dice) -> Scene {
    let mut any = |size: f64| dice.point(-0.5, 0.5) * size;
    let mut scene = Scene::default();
    for _ in 0..polygons {
        let at = any(40.0);
        scene.polygons.push((0..3).map(|_| at + any(40.0)).collect());
    }
    for _ in 0..lines {
        let at = any(60.0);
        scene.lines.push((0..4).map(|k| at + any(if k == 0 { 60.0 } else { 30.0 })).collect());
    }
    scene.points = (0..points).map(|_| any(60.0)).collect();
    scene
}

#[test]
fn lines_and_points_come_in_the_exact_order_in_a_tangle() {
    let mut counts = Counts::default();
    for seed in seeds(16) {
        let mut dice = Dice(1000 + seed);
        let scene = tangle(dice.below(12), 3 + dice.below(12), 12, &mut dice);
        let by = Heuristic::ALL[dice.below(Heuristic::ALL.len())];
        let mut eyes: Vec<DVec3> = (0..4).map(|_| whole(&mut dice) * 1.7).collect();
        // The eye is not exactly in line with the two points, because of rounding.
        eyes.push(scene.points[0] * 2.0 - scene.points[1]);
        judge(&scene, by, &eyes, &mut counts);
    }
    let Counts { lines, line_polygon, point_polygon, points, edge_on, .. } = counts;
    enough!(lines > 500, line_polygon > 1_000, point_polygon > 80; "{counts:?}");
    assert!(points > 4 && edge_on == 0 && counts.pieces > counts.segments * 3 / 2, "{counts:?}");
}
