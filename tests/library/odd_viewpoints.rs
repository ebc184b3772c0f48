//! Viewpoints with NaN or infinite coordinates, and directions of zero length.

use testkit::prelude::*;
use testkit::snapshot::polygons;

fn square(z: f64) -> [DVec3; 4] {
    [(2.0, 4.0), (4.0, 4.0), (4.0, 6.0), (2.0, 6.0)].map(|(x, y)| dvec3(x, y, z))
}

/// Two squares above each other and four upright squares side by side, around (3, 5, 1).
fn boxed() -> BspTree {
    let upright = |x: f64| square(0.0).map(|p| dvec3(x, p.y, p.x - 2.0));
    let upright = [2.0, 2.5, 3.5, 4.0].map(upright);
    BspTree::build([square(-1.0), square(3.0)].into_iter().chain(upright)).unwrap()
}

#[test]
fn a_nan_coordinate_counts_as_the_middle() {
    let tree = boxed();
    for z in [-9.0, 0.5, 1.5, 9.0] {
        let at = |x: f64| polygons(&tree, Viewpoint::eye([x, 5.0, z]));
        assert_eq!(at(f64::NAN), at(3.0));
        assert!(at(3.0) != at(0.0) && at(3.0) != at(9.0), "the case shows nothing");
    }
    let middle = polygons(&tree, Viewpoint::eye([3.0, 5.0, 1.0]));
    assert_eq!(polygons(&tree, Viewpoint::Eye(DVec3::NAN)), middle);
    let along = |x: f64| polygons(&tree, Viewpoint::direction([x, 0.1, 0.2]));
    assert_eq!(along(f64::NAN), along(0.0));
}

#[test]
fn an_infinite_eye_looks_along_its_infinite_coordinates() {
    let tree = boxed();
    for sign in [-1.0, 1.0] {
        let infinite = sign * f64::INFINITY;
        let eye = |x, y, z| polygons(&tree, Viewpoint::eye([x, y, z]));
        let towards = |x, y, z| polygons(&tree, Viewpoint::direction([x, y, z]));
        assert_eq!(eye(-7.0, 5.0, infinite), towards(0.0, 0.0, -sign));
        assert_eq!(eye(-7.0, 5.0, sign * f64::MAX), towards(0.0, 0.0, -sign));
        assert_eq!(eye(infinite, 5.0, 1e200), towards(-sign, 0.0, 0.0));
        assert_eq!(eye(infinite, 5.0, infinite), towards(-sign, 0.0, -sign));
        assert_eq!(towards(infinite, 5.0, infinite), towards(sign, 0.0, sign));
    }
}

#[test]
fn a_direction_of_no_length_is_downwards() {
    let tree = boxed();
    let down = polygons(&tree, Viewpoint::Direction(DVec3::NEG_Z));
    assert_ne!(down, polygons(&tree, Viewpoint::Direction(DVec3::Z)), "the case shows nothing");
    for odd in [DVec3::ZERO, -DVec3::ZERO, DVec3::NAN, dvec3(f64::NAN, 0.0, 0.0)] {
        assert_eq!(polygons(&tree, Viewpoint::Direction(odd)), down);
    }
    // Directions of any length except zero.
    for length in [5e-324, 1e-300, 1.0, f64::MAX] {
        let up = Viewpoint::Direction(DVec3::Z * length);
        assert_eq!(polygons(&tree, up), polygons(&tree, Viewpoint::Direction(DVec3::Z)));
    }
}
