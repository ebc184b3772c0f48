//! Texture coordinates, normals and colours of corners.

use super::{read, with_corners};
use testkit::prelude::*;

#[test]
fn corners_keep_the_values_of_the_file() {
    let text = with_corners(
        "vt 0.25 0.5\nvt 1 0 0\nvt 0.125\nvn 0 0 2\nvn 1 0 0 # to the right\n\
         f 1/1/1 2/2/2 3/3/-1 4\nf 1//1 2//2 3/-3 4/-1/1",
    );
    let (scene, report) = read(text).unwrap();
    assert!(report.is_clean(), "{report}");
    let uv: Vec<_> = (0..4).map(|k| scene.uv(0, k)).collect();
    let expected = [[0.25, 0.5], [1.0, 0.0], [0.125, 0.0]].map(|uv| Some(DVec2::from(uv)));
    assert_eq!(uv, [expected[0], expected[1], expected[2], None]);
    let normals: Vec<_> = (0..4).map(|k| scene.normal(0, k)).collect();
    let (up, right) = (Some(DVec3::Z * 2.0), Some(DVec3::X));
    assert_eq!(normals, [up, right, right, None]);
    let uv: Vec<_> = (0..4).map(|k| scene.uv(1, k)).collect();
    assert_eq!(uv, [None, None, expected[0], expected[2]]);
    let normals: Vec<_> = (0..4).map(|k| scene.normal(1, k)).collect();
    assert_eq!(normals, [up, right, None, up]);
    assert_eq!(scene.color(0, 0), None);
}

#[test]
fn vertices_with_colours_are_told_from_those_with_weights() {
    let (scene, report) =
        read("v 0 0 0 1 0.5 0\nv 1 0 0 0.7\nv 1 1 0 0 0 1 # blue\nv 0 1 0\nf 1 2 3\nf 4 3 1")
            .unwrap();
    assert!(report.is_clean(), "{report}");
    let (orange, blue) = (Some([1.0, 0.5, 0.0]), Some([0.0, 0.0, 1.0]));
    assert_eq!([0, 1, 2].map(|k| scene.color(0, k)), [orange, None, blue]);
    assert_eq!([0, 1, 2].map(|k| scene.color(1, k)), [None, blue, orange]);
    assert_eq!(scene.uv(0, 0), None);
}

#[test]
fn malformed_and_missing_parts_are_left_out_and_counted() {
    let (scene, report) =
        read(with_corners("vt x 1\nvn 0 1\nvt 1 1\nf 1/1/1 2/2/7 3/0 4/-5\nf 1/x 2/9 3//y"))
            .unwrap();
    // Skipped are two lines, two references to these lines, which have no value, and the references 7, 0, -5,
    // x, 9 and y.
    assert_eq!(report.skipped_attributes, 8);
    assert!(report.to_string().contains("texture coordinates and normals skipped: 8"), "{report}");
    let uv: Vec<_> = (0..4).map(|k| scene.uv(0, k)).collect();
    assert_eq!(uv, [None, Some(DVec2::ONE), None, None]);
    assert_eq!(scene.normal(0, 0), None);
    // The referenced element comes later in the file.
    let (scene, report) = read(with_corners("f 1/1 2/1 3/1\nvt 0.5 0.5")).unwrap();
    assert!(report.is_clean(), "{report}");
    assert_eq!(scene.uv(0, 2), Some(DVec2::splat(0.5)));
}

#[test]
#[should_panic(expected = "corner 3 of a polygon of 3 corners")]
fn a_corner_that_is_not_there_is_a_mistake() {
    let (scene, _) = read(with_corners("vt 1 1\nf 1/1 2/1 3/1\nf 1/1 2/1 3/1")).unwrap();
    scene.uv(0, 3);
}
