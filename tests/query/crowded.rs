//! Thousands of polygons at one place. If the time were quadratic in their number, these tests would take
//! minutes.

use binspace::Ray;
use testkit::prelude::*;

fn polygons(tree: &BspTree, ray: Ray) -> Vec<usize> {
    tree.hits(ray).map(|hit| hit.polygon()).collect()
}

/// Squares in one plane, each around all squares before it.
fn nested(n: usize) -> impl Iterator<Item = [[f64; 3]; 4]> {
    (0..n).map(move |i| {
        let s = 1.0 + i as f64 / n as f64;
        [[-s, -s, 0.0], [s, -s, 0.0], [s, s, 0.0], [-s, s, 0.0]]
    })
}

#[test]
fn squares_in_one_plane_are_hit_in_input_order_from_both_sides() {
    let n = 30_000;
    let tree = BspTree::build(nested(n)).unwrap();
    for z in [-5.0, 5.0] {
        let ray = Ray::new([0.1, 0.2, z], [0.0, 0.0, -z]);
        assert_eq!(tree.hits(ray).next().unwrap().polygon(), 0);
        assert!(polygons(&tree, ray).into_iter().eq(0..n));
        assert!(tree.is_occluded(ray));
    }
    let point = [0.1, 0.2, 0.0];
    assert!(polygons(&tree, Ray::between(point, point)).into_iter().eq(0..n));
    // A ray along the plane hits each square where it enters the square.
    let along = Ray::new([-9.0, 0.125, 0.0], [1.0, 0.0, 0.0]);
    assert!(polygons(&tree, along).into_iter().eq((0..n).rev()));
}

#[test]
fn a_ray_through_the_apex_of_a_fan_hits_all_of_it() {
    let n = 50_000;
    let rim = |k: usize| {
        let (y, x) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
        [x, y, 0.0]
    };
    let mut blades: Vec<[[f64; 3]; 3]> = (0..n).map(|k| [[0.0; 3], rim(k), rim(k + 1)]).collect();
    let mut dice = Dice(5);
    dice.shuffle(&mut blades);
    let tree = BspTree::build(&blades).unwrap();
    assert_eq!(tree.len(), n);
    let ray = Ray::new([0.5, 0.25, 1.0], [-0.5, -0.25, -1.0]);
    assert!(polygons(&tree, ray).into_iter().eq(0..n));
    assert!(tree.is_occluded(ray));
}

/// More polygons than the few that are compared one by one. The ray meets two fragments of each.
#[test]
fn polygons_that_are_cut_where_the_ray_meets_them_are_hit_once() {
    for n in [7, 8, 9, 30, 10_000] {
        let upright = [[0.5, -9.0, -9.0], [0.5, 9.0, -9.0], [0.5, 9.0, 9.0], [0.5, -9.0, 9.0]];
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
        let tree = options.build(std::iter::once(upright).chain(nested(n))).unwrap();
        assert_eq!(tree.len(), 2 * n + 1, "each is cut");
        // Rays through the cut, rays that start at the cut, and rays without length.
        for (from, to) in [(1.0, -1.0), (0.0, -1.0), (1.0, 0.0), (0.0, 0.0)] {
            let ray = Ray::between([0.5, 0.1, from], [0.5, 0.1, to]);
            // The upright polygon is met where the ray begins.
            assert!(polygons(&tree, ray).into_iter().eq(0..=n), "{from} {to}");
        }
        // Rays along the squares, from one fragment of each to the other.
        let along = Ray::new([-9.0, 0.125, 0.0], [1.0, 0.0, 0.0]);
        assert!(polygons(&tree, along).into_iter().eq((1..=n).rev().chain([0])));
        // Rays that start at the cut.
        let along = Ray::new([0.5, 0.125, 0.0], [1.0, 0.0, 0.0]);
        assert!(polygons(&tree, along).into_iter().eq(0..=n));
    }
}
