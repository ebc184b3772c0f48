//! Pictures small enough to compute by hand.

use std::cmp::Ordering;

use glam::DVec3;

use super::faces;
use crate::exact::{EdgeLine, Faces, PlaneId};
use crate::raster::{
    Comparison, Image, NONE, Outline, Painter, Piece, Rays, Verdict, colour_of, compare, depth_map,
    difference, is_open, picture, zbuffer,
};
use crate::view::Camera;

const SIZE: [u32; 2] = [6, 6];

/// Looks down the z axis at the square from 0 to 6, so that the centre of pixel (x, y) is the point (x + ½,
/// 5½ − y) of the world.
fn rays(faces: &Faces) -> Rays {
    let centre = DVec3::new(3.0, 3.0, 0.0);
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, centre, 6.0, SIZE).unwrap();
    Rays::new(&camera, faces).unwrap()
}

fn square([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], z: f64) -> Vec<DVec3> {
    [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| DVec3::new(x, y, z)).to_vec()
}

fn drawn(faces: &[u32]) -> String {
    let letter = |&face: &u32| if face == NONE { '.' } else { (b'A' + face as u8) as char };
    let rows: Vec<String> = faces.chunks(6).map(|row| row.iter().map(letter).collect()).collect();
    rows.join(" ")
}

fn whole<'a>(order: &'a [u32]) -> impl Iterator<Item = Piece<'a>> {
    order.iter().map(|&face| Piece { face, outline: Outline::Whole })
}

/// Paints pieces given from back to front.
fn paint<'p>(rays: &Rays, faces: &Faces, pieces: impl IntoIterator<Item = Piece<'p>>) -> Image {
    let mut painter = Painter::new(rays, faces);
    pieces.into_iter().for_each(|piece| painter.draw(piece));
    painter.finish()
}

/// A at depth 5 everywhere; B from depth 4 at the left to depth 10 at the right, above the diagonal.
fn two_triangles() -> Faces {
    let a =
        vec![DVec3::new(0.0, 0.0, -5.0), DVec3::new(12.0, 0.0, -5.0), DVec3::new(0.0, 12.0, -5.0)];
    let b =
        vec![DVec3::new(0.0, 0.0, -4.0), DVec3::new(6.0, 6.0, -10.0), DVec3::new(0.0, 6.0, -4.0)];
    faces(&[a, b], None)
}

#[test]
fn the_nearer_wins_pixel_by_pixel() {
    let faces = two_triangles();
    let depth = zbuffer(&rays(&faces), &faces);
    // B is nearer where x < 1: in column 0, whose centres are at x = ½. B covers the pixels above the
    // diagonal. Pixels on the diagonal belong to the face on their right: to A, except in the corner.
    assert_eq!(drawn(depth.image().faces()), "BAAAAA BAAAAA BAAAAA BAAAAA BAAAAA AAAAAA");
    let depths: Vec<f64> = depth.depths().collect();
    // Measured from the middle of the scene, at z = −7.
    assert!((depths[0] - (4.5 - 7.0)).abs() < 1e-9 && (depths[1] - (5.0 - 7.0)).abs() < 1e-9);
}

#[test]
fn later_pieces_cover_earlier_ones() {
    let faces = two_triangles();
    let rays = rays(&faces);
    let image = paint(&rays, &faces, whole(&[0, 1]));
    assert_eq!(drawn(image.faces()), "BBBBBA BBBBAA BBBAAA BBAAAA BAAAAA AAAAAA");
    assert_eq!((image.covered(), image.drawn()), (36, 36 + 15));
    assert_eq!(drawn(paint(&rays, &faces, whole(&[1, 0])).faces()), "AAAAAA ".repeat(6).trim());
    let mut painter = Painter::new(&rays, &faces).front_to_back();
    whole(&[1, 0]).for_each(|piece| painter.draw(piece));
    assert_eq!(painter.finish().faces(), image.faces());
}

#[test]
fn rounded_pieces_cover_what_their_vertices_span() {
    let faces = two_triangles();
    let rays = rays(&faces);
    let lattice = faces.lattice();
    let vertices = square([1.0, 1.0], [3.0, 5.0], -5.0).into_iter().map(|p| lattice.to_lattice(p));
    let vertices: Vec<[f64; 3]> = vertices.collect();
    let piece = Piece { face: 0, outline: Outline::Vertices(&vertices) };
    let image = paint(&rays, &faces, [piece]);
    assert_eq!(drawn(image.faces()), "...... .AA... .AA... .AA... .AA... ......");
}

fn judged(painted: &[u32], faces: &Faces) -> Comparison {
    let rays = rays(faces);
    let painted = paint(&rays, faces, whole(painted));
    compare(&rays, faces, &painted, zbuffer(&rays, faces).image())
}

#[test]
fn wrong_orders_holes_and_spills_are_told_apart() {
    let near = square([0.0, 0.0], [2.0, 6.0], 1.0);
    let far = square([0.0, 0.0], [4.0, 6.0], 0.0);
    let scene = faces(&[near.clone(), far.clone()], None);
    let right = judged(&[1, 0], &scene);
    assert_eq!((right.covered, right.wrong(), right.contested), (24, 0, 0));
    let wrong = judged(&[0, 1], &scene);
    assert_eq!((wrong.wrong_order, wrong.wrong(), wrong.contested), (12, 12, 0));
    assert_eq!(wrong.verdicts[0], Verdict::WrongOrder);
    assert_eq!(wrong.verdicts[2], Verdict::Right);
    assert_eq!(wrong.verdicts[5], Verdict::Empty);
    let missing = judged(&[0], &scene);
    assert_eq!((missing.holes, missing.wrong()), (12, 12));
    assert_eq!(missing.verdicts[2], Verdict::Hole);
    // A piece that reaches beyond its face, as from rounding algorithms.
    let rays = rays(&scene);
    let vertices = square([0.0, 0.0], [5.0, 6.0], 0.0).into_iter();
    let vertices: Vec<_> = vertices.map(|p| scene.lattice().to_lattice(p)).collect();
    let pieces = [Piece { face: 1, outline: Outline::Vertices(&vertices) }];
    let painted = paint(&rays, &scene, pieces.into_iter().chain(whole(&[0])));
    let spilt = compare(&rays, &scene, &painted, zbuffer(&rays, &scene).image());
    assert_eq!((spilt.spills, spilt.wrong()), (6, 6));
    let base = picture(&rays, &scene, &painted, colour_of, [0; 3]);
    assert_eq!(&difference(&spilt, &base)[12..15], &[255, 0, 255]);
    assert_eq!(&base[0..3], &colour_of(0), "seen straight on, a colour is itself");
}

#[test]
fn polygons_within_the_tolerance_of_each_other_are_contested() {
    let pair = |gap: f64, tolerance| {
        let (a, b) = (square([0.0; 2], [6.0; 2], gap), square([0.0; 2], [6.0; 2], 0.0));
        faces(&[a, b], Some(tolerance))
    };
    // Painted in input order, so that the further square covers the nearer.
    let verdict = |gap, tolerance| judged(&[0, 1], &pair(gap, tolerance)).verdicts[7];
    assert_eq!(verdict(1.9e-3, 1e-3), Verdict::Contested);
    assert_eq!(verdict(2.1e-3, 1e-3), Verdict::WrongOrder);
    assert_eq!(verdict(1e-12, 0.0), Verdict::WrongOrder);
    // At the same depth the later polygon counts, and the other order is contested.
    assert_eq!(verdict(0.0, 0.0), Verdict::Right);
    assert_eq!(judged(&[1, 0], &pair(0.0, 0.0)).verdicts[7], Verdict::Contested);
}

#[test]
fn backs_are_left_out_on_request() {
    let mut back = square([0.0; 2], [6.0, 3.0], 1.0);
    back.reverse();
    let scene = faces(&[square([0.0; 2], [6.0; 2], 0.0), back], None);
    let rays = rays(&scene);
    let bare = |rays: &Rays| drawn(zbuffer(rays, &scene).image().faces());
    assert_eq!(bare(&rays), "AAAAAA AAAAAA AAAAAA BBBBBB BBBBBB BBBBBB");
    assert_eq!(bare(&rays.clone().with_front_faces_only()), "AAAAAA ".repeat(6).trim());
}

#[test]
fn near_is_bright_in_a_depth_map_or_far() {
    let scene =
        faces(&[square([0.0; 2], [3.0, 6.0], 1.0), square([3.0, 0.0], [5.0, 6.0], 0.0)], None);
    let depth = zbuffer(&rays(&scene), &scene);
    for [near, far] in [[255, 40], [40, 255]] {
        let map = depth_map(&depth, [near, far]);
        assert_eq!([0, 3, 5].map(|x| map[3 * x]), [near, far, 0], "{:?}", &map[..18]);
    }
}

#[test]
fn nothing_behind_the_eye_is_shown_mirrored() {
    // A floor that reaches behind the eye, with its right edge just right of the eye. By this edge alone,
    // rays to the left are inside, also those upwards, although the floor is behind them.
    let floor = [(-9.0, 9.0), (0.1, 9.0), (0.1, -9.0), (-9.0, -9.0)];
    let floor = floor.map(|(x, z)| DVec3::new(x, -1.0, z));
    let scene = faces(&[floor.to_vec()], None);
    let quarter = std::f64::consts::FRAC_PI_2;
    let camera = Camera::perspective(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, quarter, SIZE).unwrap();
    let rays = Rays::new(&camera, &scene).unwrap();
    let lines = [EdgeLine::edge(1)];
    let outline = Outline::Lines { lines: &lines, vertices: scene.corners(0) };
    let image = paint(&rays, &scene, [Piece { face: 0, outline }]);
    assert_eq!(drawn(image.faces()), "...... ...... ...... AAA... AAA... AAA...");
}

#[test]
fn rays_through_lines_belong_to_the_piece_on_their_right() {
    // Two cuts that meet in (5.5, 2.5), on the right edge.
    let cut = |y: f64| {
        let [p, q] = [0.0, 1.0].map(|z| DVec3::new(5.5, 2.5, z));
        vec![p, q, DVec3::new(3.5, y, 0.0)]
    };
    let mut lower = cut(0.5);
    lower.reverse();
    let scene = faces(&[square([0.0; 2], [5.5; 2], 0.0), cut(4.5), lower], None);
    let rays = rays(&scene);
    let corners = scene.corners(0);
    let show = |lines: &[EdgeLine]| {
        let outline = Outline::Lines { lines, vertices: corners };
        drawn(paint(&rays, &scene, [Piece { face: 0, outline }]).faces())
    };
    let [upper, lower] = [1, 2].map(PlaneId::face);
    let left = [
        EdgeLine::edge(0),
        EdgeLine::cut(lower, false),
        EdgeLine::cut(upper, false),
        EdgeLine::edge(2),
        EdgeLine::edge(3),
    ];
    assert_eq!(show(&left), "AA.... AAA... AAAA.. AAAAA. AAAA.. AAA...");
    let below = [EdgeLine::edge(0), EdgeLine::edge(1), EdgeLine::cut(lower, true)];
    assert_eq!(show(&below), "...... ...... ...... ...... ....A. ...AA.");
}

/// The camera looks down at a steep face that crosses a flat face.
#[test]
fn both_faces_have_to_be_near_the_plane_of_the_other() {
    let tolerance = 0.01;
    // In column 2 the flat face is met within the tolerance of the steep plane.
    for (apart, is_near) in [(10.0 * tolerance, false), (1.9 * tolerance, true)] {
        for (above, order, wrong) in [(apart, [1, 0], 18), (-apart, [0, 1], 12)] {
            let flat = square([0.0, 0.0], [6.0, 6.0], 0.0);
            let lift = |p: DVec3| p.with_z(10.0 * (p.x - 2.5) + above);
            let steep = flat.iter().map(|&p| lift(p)).collect();
            let faces = faces(&[flat, steep], Some(tolerance));
            let rays = rays(&faces);
            let (painted, truth) = (paint(&rays, &faces, whole(&order)), zbuffer(&rays, &faces));
            let result = compare(&rays, &faces, &painted, truth.image());
            let expected = if is_near { (6, wrong) } else { (0, wrong + 6) };
            assert_eq!((result.contested, result.wrong_order), expected, "{above}");
        }
    }
}

#[test]
fn without_a_tolerance_no_order_is_open() {
    let [a, b] = [0.0, 1e-15].map(|z| square([0.0, 0.0], [6.0, 6.0], z));
    for (tolerance, expected) in [(0.0, false), (1e-9, true)] {
        let faces = faces(&[a.clone(), b.clone()], Some(tolerance));
        let pieces = [(1, Ordering::Equal), (0, Ordering::Equal)];
        let open = is_open(&rays(&faces), &faces, PlaneId::face(0), pieces, [2, 2]);
        assert_eq!(open, expected, "{tolerance}");
    }
}

/// The face is so near that the rounding of its corners would put the eye behind it.
#[test]
fn an_eye_a_few_units_before_a_face_sees_nothing_else() {
    let faces = faces(&[square([0.0, 0.0], [6.0, 6.0], 0.0)], None);
    let unit = faces.lattice().length_to_world(1.0);
    for height in [1.0, 2.0, 3.0, 5.0, 9.0, 17.0] {
        let eye = DVec3::new(3.0, 2.5, height * unit);
        let target = DVec3::new(3.0, 2.5, -1.0);
        let camera = Camera::perspective_by_slope(eye, target, DVec3::Y, 1.0, SIZE).unwrap();
        let image = zbuffer(&Rays::new(&camera, &faces).unwrap(), &faces).into_image();
        assert_eq!(image.covered(), 36, "{height} units");
    }
}
