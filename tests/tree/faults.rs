//! Reduced cases of earlier faults.

use testkit::judge::judge;
use testkit::prelude::*;

/// The plane was equally steep along two axes. Convexity was tested along one of them, and corners were moved
/// onto the plane along the other.
#[test]
fn corners_moved_onto_a_plane_leave_the_face_convex() {
    let octagon = [
        [-59.83159237641274, 0.0, 0.0],
        [-61.83159237641274, -2.0, 0.0],
        [-65.83159237641274, -8.0, 4.0],
        [-61.83159237641274, -5.0, 6.0],
        [-57.83159237641273, -2.0, 8.000000000000002],
        [-55.83159237641274, 0.0, 8.0],
        [-51.83159237641275, 6.0, 4.0],
        [-55.83159237641274, 3.0, 2.0],
    ];
    let octagon = vec![octagon.map(DVec3::from_array).to_vec()];
    let tree = BuildOptions::DEFAULT.with_tolerance(0.1).build(&octagon).unwrap();
    assert_eq!(judge(&tree, &octagon), Ok(()));
}
