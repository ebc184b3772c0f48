//! Views that graze a floor within the tolerance of its plane.

use glam::DVec3;

use crate::random::SplitMix64;
use crate::raster::{Comparison, Image, Rays, compare, zbuffer};
use crate::tree::BspTree;
use crate::verify::Orders;
use crate::verify::judge;
use crate::view::Camera;
use crate::{BuildOptions, Heuristic};

const TOLERANCE: f64 = 1e-2;

/// A floor, and a wall that stands on it: only the wall's foot and the floor behind it are visible.
fn wall_on_floor() -> BspTree {
    let floor = [(0.0, -9.0), (20.0, -9.0), (20.0, 9.0), (0.0, 9.0)].map(|(x, y)| [x, y, 0.0]);
    let wall = [(-9.0, 0.0), (9.0, 0.0), (9.0, 1.0), (-9.0, 1.0)].map(|(y, z)| [1.0, y, z]);
    let first = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    first.with_tolerance(TOLERANCE).build([floor, wall]).unwrap()
}

/// Eyes half the tolerance above the floor. All their rays meet the wall below the eye, and the floor up to
/// 18 units behind the wall.
fn cameras() -> [Camera; 2] {
    let (eye, foot) =
        (DVec3::new(-1.0, 0.0, 0.5 * TOLERANCE), DVec3::new(1.0, 0.0, 0.2 * TOLERANCE));
    let size = [40, 30];
    [
        Camera::perspective(eye, foot, DVec3::Z, 1e-3, size).unwrap(),
        Camera::parallel(foot - eye, DVec3::Z, foot, 2e-3, size).unwrap(),
    ]
}

/// The verdicts on an order: the tree's own, or its reverse, which paints the floor over the wall.
fn judged(tree: &BspTree, camera: &Camera, is_reversed: bool) -> [Comparison; 2] {
    let mut orders = Orders::of(tree, camera.viewpoint());
    if is_reversed {
        orders.0.iter_mut().for_each(|list| list.reverse());
    }
    let verification = judge(tree, Rays::new(camera, tree.faces()).unwrap(), orders);
    [verification.comparison, verification.front_to_back]
}

#[test]
fn a_wrong_order_in_a_grazing_view_is_not_excused() {
    let tree = wall_on_floor();
    for camera in cameras() {
        for comparison in judged(&tree, &camera, false) {
            assert_eq!((comparison.wrong(), comparison.contested), (0, 0), "{camera:?}");
        }
        for comparison in judged(&tree, &camera, true) {
            let found = (comparison.wrong_order, comparison.contested);
            assert_eq!(found, (40 * 30, 0), "{camera:?}");
        }
    }
}

/// The polygons alone also decide this: the floor is far from the wall's plane.
#[test]
fn a_floor_far_behind_a_wall_is_not_contested_by_the_polygons() {
    let tree = wall_on_floor();
    for camera in cameras() {
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let truth = zbuffer(&rays, tree.faces()).into_image();
        let shown = Image::from_faces([40, 30], vec![0; 40 * 30], 0);
        let found = compare(&rays, tree.faces(), &shown, &truth);
        assert_eq!((found.wrong_order, found.contested), (40 * 30, 0), "{camera:?}");
    }
}

/// A wall that reaches below the floor's plane within the tolerance is excused only below the plane.
#[test]
fn walls_across_the_plane_within_the_tolerance_are_excused() {
    let floor = [(3.0, 5.0), (4.0, 5.0), (4.0, 6.0), (3.0, 6.0)].map(|(x, y)| [x, y, 0.0]);
    let wall = |x: f64, low: f64, high: f64| {
        [(-9.0, low), (9.0, low), (9.0, high), (-9.0, high)].map(|(y, z)| [x, y, z])
    };
    let polygons = [floor, wall(1.0, -0.9 * TOLERANCE, 1.0), wall(2.0, -1.0, 0.9 * TOLERANCE)];
    let first = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let tree = first.with_tolerance(TOLERANCE).build(polygons).unwrap();
    // Rays nearly along the plane, slightly upwards, all within the tolerance: the lower half below the
    // plane, the upper half above it. So the plane's back counts as nearer, and the wall behind is painted
    // last. The front wall reaches across the plane below it, the other wall above it.
    let along = DVec3::new(1.0, 0.0, 1e-9);
    let camera = Camera::parallel(along, DVec3::Z, DVec3::X, TOLERANCE, [10, 10]).unwrap();
    for (is_reversed, contested) in [(false, 100), (true, 0)] {
        for comparison in judged(&tree, &camera, is_reversed) {
            assert_eq!((comparison.covered, comparison.wrong()), (100, 0));
            assert_eq!(comparison.contested, contested);
        }
    }
}

/// Rectangles whose corners are off the planes of a coarse grid by up to twice the tolerance.
fn rough(random: &mut SplitMix64, tolerance: f64) -> Vec<[DVec3; 4]> {
    let mut whole = |limit: u64| (random.next() % limit) as f64 - (limit / 2) as f64;
    let mut polygons = Vec::new();
    for k in 0..10 {
        let (at, from) = (whole(3), [whole(4), whole(4)]);
        let to = from.map(|c| c + 1.0 + whole(3).abs());
        let place = |u: f64, v: f64| DVec3::from_array([[at, u, v], [v, at, u], [u, v, at]][k % 3]);
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
        polygons.push(corners.map(|(u, v)| place([from[0], to[0]][u], [from[1], to[1]][v])));
    }
    for corner in polygons.iter_mut().flatten() {
        *corner += random.point(-2.0, 2.0) * tolerance;
    }
    polygons
}

/// The views are along the planes, from inside the scene. Every exchange due to the tolerance is excused.
#[test]
fn the_orders_of_trees_are_never_wrong() {
    let mut random = SplitMix64::new(3);
    let (mut covered, mut contested) = (0, 0);
    for round in 0..60 {
        let tolerance = [1e-2, 1e-3, 1e-5][round % 3];
        let polygons = rough(&mut random, tolerance);
        let heuristic = Heuristic::ALL[round % Heuristic::ALL.len()];
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic).with_tolerance(tolerance);
        let tree = options.build(&polygons).unwrap();
        for view in 0..6 {
            let mut off = || random.point(-3.0, 3.0) * tolerance;
            let (eye, mut target) = (off(), off());
            target[view % 3] += if view < 3 { 2.0 } else { -2.0 };
            let up = [DVec3::Y, DVec3::Z, DVec3::X][view % 3];
            let size = [24, 24];
            for camera in [
                Camera::perspective(eye, target, up, [1.0, 5.0 * tolerance][view % 2], size),
                Camera::parallel(target - eye, up, target, [4.0, 9.0 * tolerance][view % 2], size),
            ] {
                let camera = camera.unwrap();
                for comparison in judged(&tree, &camera, false) {
                    assert_eq!(comparison.wrong(), 0, "round {round}, {heuristic}, {camera:?}");
                    (covered, contested) =
                        (covered + comparison.covered, contested + comparison.contested);
                }
            }
        }
    }
    assert!(covered > 300_000 && contested > 1000, "{covered} pixels, {contested} contested");
}
