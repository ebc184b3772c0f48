//! Sight lines between points of surfaces and a lamp, against whole numbers of 128 bits.

use binspace::Ray;
use binspace_evidence::shadows::{Zone, courtyard, is_umbra, lamp, zone};
use testkit::prelude::*;
use testkit::vector::{Plane, difference, product, scalar};

type Point = [i128; 3];

fn whole(p: DVec3) -> Point {
    assert_eq!(p, p.round());
    p.to_array().map(|c| c as i128)
}

/// A convex polygon, and its plane.
struct Wall {
    corners: Vec<Point>,
    plane: Plane<i128>,
}

impl Wall {
    fn new(corners: Vec<Point>) -> Self {
        let plane = Plane::through([&corners[0], &corners[1], &corners[2]]);
        Self { corners, plane }
    }
}

/// Whether a polygon has a point between two points that are not both in the polygon's plane.
fn blocks(Wall { corners, plane }: &Wall, a: Point, b: Point) -> bool {
    let [at_a, at_b] = [a, b].map(|p| plane.at(&p));
    assert!(at_a != 0 || at_b != 0, "no sight line is in a plane");
    if at_a.signum() * at_b.signum() >= 0 {
        return false;
    }
    // The line and the plane meet at the point `met` / `by`.
    let (by, sign) = (at_a - at_b, (at_a - at_b).signum());
    let met: Point = std::array::from_fn(|i| a[i] * by + at_a * (b[i] - a[i]));
    (0..corners.len()).all(|k| {
        let (p, q) = (corners[k], corners[(k + 1) % corners.len()]);
        let arm = difference(&met, &p.map(|c| c * by));
        sign * scalar(&plane.normal, &product(&difference(&q, &p), &arm)) >= 0
    })
}

fn setting() -> (Scene, BspTree, Vec<Wall>) {
    let scene = courtyard();
    let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build(scene.polygons()).unwrap();
    let corners = |k: usize| scene.polygon(k).iter().map(|&p| whole(p)).collect();
    let walls = (0..scene.len()).map(|k| Wall::new(corners(k))).collect();
    (scene, tree, walls)
}

/// A point of a surface in whole numbers, often on a boundary or in line with a boundary.
fn point(scene: &Scene, dice: &mut Dice) -> DVec3 {
    // The floor is the first polygon, and half of the points are on it.
    let polygon = match dice.roll() % 2 {
        0 => 0,
        _ => (dice.roll() % scene.len() as u64) as usize,
    };
    let [a, b, _, d] = std::array::from_fn(|k| scene.polygon(polygon)[k]);
    let [u, v] = [0, 1].map(|_| match dice.roll() % 8 {
        0 => (dice.roll() % 2) as f64,
        _ => (dice.roll() % 4097) as f64 / 4096.0,
    });
    (a + u * (b - a) + v * (d - a)).round()
}

#[test]
fn sight_lines_agree_with_integers() {
    compare_sight_lines(100_000);
}

#[test]
#[ignore = "takes seconds; with fewer above"]
fn a_million_sight_lines_agree_with_integers() {
    compare_sight_lines(1_000_000);
}

fn compare_sight_lines(count: usize) {
    let (scene, tree, polygons) = setting();
    let (mut dice, lamp) = (Dice(9), lamp(9));
    let (mut blocked, mut wrong) = (0, 0);
    for k in 0..count {
        let (point, at) = (point(&scene, &mut dice), lamp[k % lamp.len()]);
        let found = tree.is_occluded(Ray::between(point, at));
        let truth = polygons.iter().any(|polygon| blocks(polygon, whole(point), whole(at)));
        wrong += usize::from(found != truth);
        blocked += usize::from(truth);
    }
    assert_eq!(wrong, 0);
    assert!(blocked > count / 5 && blocked < count / 5 * 4, "{blocked}");
}

#[test]
fn a_wrong_shadow_is_noticed() {
    let wall = Wall::new(vec![[0, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]]);
    assert!(blocks(&wall, [1, -2, 1], [1, 2, 1]));
    assert!(blocks(&wall, [4, -2, 1], [4, 2, 1]), "along an edge");
    assert!(!blocks(&wall, [5, -2, 1], [5, 2, 1]));
    assert!(!blocks(&wall, [1, 0, 1], [1, 2, 1]), "its own");
}

#[test]
fn zones_agree_with_many_more_points_except_near_a_boundary() {
    let (scene, tree, polygons) = setting();
    let mut dice = Dice(4);
    let (corners, some, many) = (lamp(2), lamp(5), lamp(25));
    let (mut counts, mut certain, mut differing) = ([0; 3], 0, [0; 2]);
    for _ in 0..times(700) {
        let point = point(&scene, &mut dice);
        let from = whole(point);
        let is_hidden = |at: &DVec3| polygons.iter().any(|wall| blocks(wall, from, whole(*at)));
        // More points of the lamp are tested until one is hidden and another is seen.
        let first = is_hidden(&many[0]);
        let truth = match many.iter().all(|at| is_hidden(at) == first) {
            true if first => Zone::Umbra,
            true => Zone::Lit,
            false => Zone::Penumbra,
        };
        counts[truth as usize] += 1;
        if is_umbra(&tree, point, &corners) {
            assert_eq!(truth, Zone::Umbra, "{point}");
            certain += 1;
        }
        for (differing, lamp) in differing.iter_mut().zip([&corners, &some]) {
            let found = zone(&tree, point, lamp);
            // With fewer points, only a penumbra may be taken for another zone.
            assert!(found == truth || truth == Zone::Penumbra, "{point}");
            *differing += usize::from(found != truth);
        }
    }
    assert!(counts.iter().all(|&count| count > 45), "{counts:?}");
    assert!(certain > 45 && certain <= counts[2], "{certain} of {counts:?}");
    assert!(differing[1] <= differing[0] && differing[0] * 50 < times(700), "{differing:?}");
    assert_eq!(point_lamp(&tree), [Zone::Lit, Zone::Umbra]);
}

/// The zones of a point beside the table and of a point under the table.
fn point_lamp(tree: &BspTree) -> [Zone; 2] {
    let lamp = [dvec3(2751.0, 1951.0, 2999.0)];
    [[3900.0, 500.0], [2750.0, 1950.0]].map(|[x, y]| zone(tree, dvec3(x, y, 0.0), &lamp))
}
