//! Pictures of six by six pixels, and depths, worked out by hand.

use super::{Polygons, faces, show};
use crate::method::{
    Centroid, DepthBuffer, DepthFormat, FrontFaces, InputOrder, Interpolation, Method, Newell,
    Options, all,
};
use binspace::raster::NONE;
use testkit::prelude::*;

/// Looks down the z axis at the square from 0 to 6, so that pixel (x, y) is the world's
/// (x + ½, 5½ − y), and depth is −z.
fn camera() -> Camera {
    let centre = DVec3::new(3.0, 3.0, 0.0);
    Camera::parallel(DVec3::NEG_Z, DVec3::Y, centre, 6.0, [6, 6]).unwrap()
}

fn drawn(method: &dyn Method, polygons: &Polygons, camera: &Camera) -> String {
    let faces = faces(polygons, Some(0.0));
    let painted = show(method, &faces, camera);
    let letter = |&face: &u32| match face {
        NONE => '.',
        face => (b'A' + faces.polygon(face) as u8) as char,
    };
    let rows = painted.image.faces().chunks(6);
    rows.map(|row| row.iter().map(letter).collect::<String>()).collect::<Vec<_>>().join(" ")
}

fn points<const N: usize>(corners: [[f64; 3]; N]) -> Vec<DVec3> {
    corners.map(DVec3::from).to_vec()
}

/// A has depth 5 everywhere. B covers the part above the diagonal, from depth 4 at the left to depth 10 at
/// the right. At the centres of the columns, its depths are 4.5, 5.5, 6.5, ….
fn two_triangles() -> Polygons {
    let a = points([[0.0, 0.0, -5.0], [12.0, 0.0, -5.0], [0.0, 12.0, -5.0]]);
    let b = points([[0.0, 0.0, -4.0], [6.0, 6.0, -10.0], [0.0, 6.0, -4.0]]);
    vec![a, b]
}

const NEARER_WINS: &str = "BAAAAA BAAAAA BAAAAA BAAAAA BAAAAA AAAAAA";

#[test]
fn the_nearer_of_two_triangles_wins_pixel_by_pixel() {
    let (there, mut back) = (two_triangles(), two_triangles());
    back.reverse();
    let swapped = NEARER_WINS.replace('A', "x").replace('B', "A").replace('x', "B");
    for method in all(&Options::DEFAULT) {
        let name = method.name();
        if name == "centroid" || name.ends_with("input order") {
            continue;
        }
        assert_eq!(drawn(&*method, &there, &camera()), NEARER_WINS, "{name}");
        assert_eq!(drawn(&*method, &back, &camera()), swapped, "{name}, the other order");
    }
    // The last face is on top, whatever its depth. If its back is to the eye, it is left out.
    let all_a = "AAAAAA ".repeat(6);
    let b_on_top = "BBBBBA BBBBAA BBBAAA BBAAAA BAAAAA AAAAAA";
    assert_eq!(drawn(&InputOrder, &there, &camera()), b_on_top);
    assert_eq!(drawn(&InputOrder, &back, &camera()), all_a.trim().replace('A', "B"));
    assert_eq!(drawn(&FrontFaces(InputOrder), &there, &camera()), b_on_top);
    let mut turned = there.clone();
    turned[1].reverse();
    assert_eq!(drawn(&FrontFaces(InputOrder), &turned, &camera()), all_a.trim());
    // B's centroid is at depth 6 and A's centroid at depth 5, so A is painted over all of B.
    assert_eq!(drawn(&Centroid, &there, &camera()), all_a.trim());
}

#[test]
fn a_cut_piece_is_painted_as_far_as_it_reaches() {
    // B dips under A at x = 1: its left part, painted last, covers the first column.
    let faces = faces(&two_triangles(), Some(0.0));
    assert_eq!(show(&Newell::DEFAULT, &faces, &camera()).pieces, 3);
}

#[test]
fn of_two_in_one_plane_painters_show_the_later_and_depth_buffers_the_earlier() {
    let a = points([[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [4.0, 6.0, 1.0], [0.0, 6.0, 1.0]]);
    let b = points([[2.0, 0.0, 1.0], [6.0, 0.0, 1.0], [6.0, 6.0, 1.0], [2.0, 6.0, 1.0]]);
    for method in all(&Options::DEFAULT) {
        let name = method.name();
        // All faces are at the far plane, and this buffer is cleared to it, so nothing shows.
        if name.ends_with("cleared") {
            continue;
        }
        let is_buffer = (name.starts_with('z') || name.starts_with('w')) && name != "z f64";
        let is_buffer = is_buffer && !name.ends_with("or equal");
        let row = if is_buffer { "AAAABB" } else { "AABBBB" };
        let expected = [row; 6].join(" ");
        assert_eq!(drawn(&*method, &vec![a.clone(), b.clone()], &camera()), expected, "{name}");
    }
}

#[test]
fn two_bits_tell_four_depths_apart() {
    // From near 0 to far 9, steps of 3: depths below 1.5 are 0, below 4.5 are 1, below 7.5 are 2. A is at
    // depth 5, which is stored as 2. B is from depth ¾ at the left to 5¾ at the right, which is stored as 0 1
    // 1 1 2 2.
    let a = points([[0.0, 0.0, -5.0], [12.0, 0.0, -5.0], [0.0, 12.0, -5.0]]);
    let b = points([[0.0, 0.0, -0.25], [12.0, 0.0, -12.25], [0.0, 12.0, -0.25]]);
    let row = |text: &str| [text; 6].join(" ");
    for interpolation in [Interpolation::EdgeFunctions, Interpolation::Incremental] {
        for format in [DepthFormat::Integer(2), DepthFormat::LinearInteger(2)] {
            let method = DepthBuffer::new(format).with_interpolation(interpolation);
            let method = method.with_range(0.0, 9.0);
            let there = drawn(&method, &vec![a.clone(), b.clone()], &camera());
            // In two bits, 4¾ is as far as A, and the earlier face shows.
            assert_eq!(there, row("BBBBAA"), "{method:?}");
            let back = drawn(&method, &vec![b.clone(), a.clone()], &camera());
            assert_eq!(back, row("AAAAAA"), "{method:?}, the other order");
        }
        let exact = DepthBuffer::new(DepthFormat::Integer(16)).with_interpolation(interpolation);
        let there = drawn(&exact, &vec![a.clone(), b.clone()], &camera());
        assert_eq!(there, row("BBBBBA"), "with 16 bits, 4¾ is less than 5");
    }
}

#[test]
fn perspective_depths_crowd_at_the_far_plane_and_linear_ones_do_not() {
    // The near plane is 1, the far plane 4, and there are two bits. So z = 4 (w − 1) / 3w has steps of 1/3,
    // and w has steps of 1 from 1 on. A wall at depth 4 is step 3 of both. At depth 2.2, z = 0.727: step 2 of
    // both. At depth 3, z = 8/9: step 3 of z, and step 2 of w. At depth 1.2, z = 2/9: step 1 of z, and step 0
    // of w.
    let camera = Camera::perspective(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 1.0, [6, 6]).unwrap();
    let wall = |depth: f64| {
        let c = 2.0 * depth;
        points([[-c, -c, -depth], [c, -c, -depth], [c, c, -depth], [-c, c, -depth]])
    };
    let shown = |format, first: f64, second: f64| {
        let method = DepthBuffer::new(format).with_range(1.0, 4.0);
        let picture = drawn(&method, &vec![wall(first), wall(second)], &camera);
        picture.chars().next().unwrap()
    };
    let (z, w) = (DepthFormat::Integer(2), DepthFormat::LinearInteger(2));
    assert_eq!(shown(z, 3.9, 2.2), 'B', "3 against 2");
    assert_eq!(shown(z, 3.9, 3.0), 'A', "3 against 3");
    assert_eq!(shown(w, 3.9, 3.0), 'B', "3 against 2");
    assert_eq!(shown(z, 2.2, 1.2), 'B', "2 against 1");
    assert_eq!(shown(w, 2.4, 1.6), 'A', "1 against 1");
    assert_eq!(shown(z, 2.4, 1.6), 'A', "z of 7/9 and of 1/2: 2.33 and 1.5, rounded to 2 and 2");
    assert_eq!(shown(z, 2.4, 1.59), 'B', "2 against 1");
}
