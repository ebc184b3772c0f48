//! Rays in the plane of a polygon that begin on its boundary.

use binspace::{Facing, Ray};
use testkit::prelude::*;

/// The hit is the start of the ray, not a place that an edge defines.
#[test]
fn a_ray_in_a_plane_that_begins_on_an_edge_is_hit_where_it_begins() {
    let square = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
    let tree = BspTree::build([square]).unwrap();
    let edge_or_corner = [[0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
    for from in edge_or_corner {
        for direction in [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0]] {
            let to = [from[0] + direction[0], from[1] + direction[1], 0.0];
            for ray in [Ray::new(from, direction), Ray::between(from, to)] {
                let hits: Vec<_> = tree.hits(ray).collect();
                assert_eq!((hits.len(), hits[0].parameter()), (1, 0.0), "{ray:?}");
                assert!(
                    hits[0].facing() == Facing::EdgeOn && hits[0].grid_points().is_none(),
                    "{ray:?}"
                );
            }
        }
    }
    // If the ray comes from outside, an edge defines the hit.
    let hits: Vec<_> = tree.hits(Ray::new([-1.0, 1.0, 0.0], [1.0, 0.0, 0.0])).collect();
    assert!(hits.len() == 1 && hits[0].grid_points().is_some());
}
