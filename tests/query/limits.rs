//! How far along a ray the search continues for hits that may come before the nearest hit so far.

use binspace::Ray;
use testkit::prelude::*;

/// The numbers of the polygons that a ray hits.
fn hits(tree: &BspTree, ray: Ray) -> Vec<usize> {
    tree.hits(ray).map(|hit| hit.polygon()).collect()
}

/// A ray meets a floor at such a flat angle that floats give only a rough place. A wall before this place
/// reaches across the floor's plane by less than the tolerance, so it counts as behind the floor. So the
/// search tests the floor before the wall.
#[test]
fn a_wall_before_a_floor_that_is_met_flat_is_hit_first() {
    const S: f64 = ((1_u64 << 51) - 1) as f64;
    let floor = [[-S, -S, 0.0], [S, -S, 0.0], [S, S, 0.0], [-S, S, 0.0]];
    let wall = |x: f64, [low, high]: [f64; 2]| {
        [(-1e15, low), (1e15, low), (1e15, high), (-1e15, high)].map(|(y, z)| [x, y, z])
    };
    let polygons = [floor, wall(6e14, [-2e15, -1e15]), wall(6.2e14, [-1e15, 1000.0])];
    let tree = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).build(polygons).unwrap();
    let flat = Ray::new([0.0, 0.0, 8.0], [1.0, 0.0, -49.6 * f64::EPSILON]);
    // At x = 6.2e14, where it is 1.2 above the floor, and at 7.3e14.
    assert_eq!(hits(&tree, flat), [2, 0]);
}

/// Distances count from the scene, not from the origin: rays from beside a small scene far out hit it.
#[test]
fn rays_from_within_2_to_the_67_extents_of_a_small_scene_far_out_hit_it() {
    for exponent in [-20, -60, -100, -115] {
        let size = 2f64.powi(exponent);
        let corners = [[0.0, -2.0, 0.0], [size, -2.0, 0.0], [0.0, -2.0, size]];
        let tree = BspTree::build([corners]).unwrap();
        let from = [0.25 * size, -2.0 + 2f64.powi(exponent + 67), 0.25 * size];
        assert_eq!(hits(&tree, Ray::new(from, [0.0, -1.0, 0.0])), [0], "2^{exponent}");
        let past = [from[0], -2.0 - 2f64.powi(exponent + 67), from[2]];
        assert_eq!(hits(&tree, Ray::between(from, past)), [0], "2^{exponent}");
    }
}
