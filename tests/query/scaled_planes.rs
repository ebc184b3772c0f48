//! A region's plane does not change if its numbers are multiplied by any power of two, down to the smallest
//! numbers.

use binspace::{Culling, Frustum};
use testkit::prelude::*;

/// A number times a power of two that may be beyond the range of `f64`.
fn scaled(value: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    value * 2f64.powi(half) * 2f64.powi(exponent - half)
}

/// Squares at x = 0, 1, … 40.
fn squares() -> BspTree {
    let square = |x: f64| [[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 1.0, 1.0], [x, 0.0, 1.0]];
    BspTree::build((0..=40).map(|x| square(f64::from(x)))).unwrap()
}

/// The polygons in a region, and the polygons that culling keeps.
fn found(tree: &BspTree, (normal, offset): (DVec3, f64)) -> [Vec<usize>; 2] {
    let region = Frustum::new([(normal, offset)]);
    let polygon = |fragment: u32| tree.fragment(fragment).polygon();
    let mut inside: Vec<usize> = tree.fragments_in(&region).map(polygon).collect();
    let (mut kept, viewpoint) = (Vec::new(), Viewpoint::direction([1.0, 0.0, 0.0]));
    let culling = Culling::NONE.with_frustum(region);
    tree.order(viewpoint).culled(&culling).write_into(&mut kept);
    inside.sort_unstable();
    let mut kept: Vec<usize> = kept.into_iter().map(polygon).collect();
    kept.sort_unstable();
    [inside, kept]
}

#[test]
fn planes_of_subnormal_numbers_keep_the_inside() {
    let tree = squares();
    let least = f64::from_bits(1);
    // x ≤ 3.
    let [inside, kept] = found(&tree, (dvec3(-least, 0.0, 0.0), -3.0 * least));
    assert_eq!(inside, [0, 1, 2, 3]);
    assert_eq!(kept, [0, 1, 2, 3]);
}

#[test]
fn planes_are_the_same_times_any_power_of_two() {
    let tree = squares();
    let planes = [
        (dvec3(-1.0, 0.0, 0.0), -7.0),
        (dvec3(1.0, 0.0, 0.0), 7.0),
        (dvec3(3.0, -2.0, 1.0), 29.0),
        (dvec3(-3.0, 5.0, -7.0), -31.0),
        (dvec3(0.0, 1.0, 0.0), 1.0),
        (dvec3(0.0, 1.0, 0.0), 2.0),
    ];
    for (normal, offset) in planes {
        let expected = found(&tree, (normal, offset));
        for exponent in [-1074, -1073, -1060, -1030, -1022, -500, -1, 1, 600, 1000] {
            let normal = DVec3::from_array(normal.to_array().map(|c| scaled(c, exponent)));
            let plane = (normal, scaled(offset, exponent));
            assert_eq!(found(&tree, plane), expected, "{normal} {exponent}");
        }
    }
}
