//! Examples of preparing polygons of any kind as convex planar faces: triangulated polygons, dropped
//! polygons, errors.

use binspace::Preparation;
use binspace::glam::DMat3;
use binspace::internals::DEFAULT_TOLERANCE;
use proptest::prelude::*;
use testkit::checks::{area, assert_convex_and_planar, face_area};
use testkit::prelude::*;
use testkit::rational;
use testkit::shapes;

fn prepare(polygons: &[Corners]) -> (Faces, Preparation) {
    Faces::new(polygons, None).expect("finite")
}

fn flat(corners: &[[f64; 2]]) -> Corners {
    corners.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
}

/// Asserts that the faces together have the polygon's area, and that each face has the polygon's orientation.
fn assert_area_is_conserved(faces: &Faces, polygon: &[DVec3]) {
    let whole = area(faces, polygon);
    let mut total = rational::point(DVec3::ZERO);
    for face in 0..faces.len() as u32 {
        let part = face_area(faces, face);
        assert!(rational::scalar(&part, &whole).is_positive(), "face {face} faces backwards");
        total = rational::sum(&total, &part);
    }
    assert_eq!(total, whole);
}

fn l_shape() -> Corners {
    flat(&[[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]])
}

fn star() -> Corners {
    let outline = [[0, 5], [1, 1], [5, 0], [1, -1], [0, -5], [-1, -1], [-5, 0], [-1, 1]];
    outline.iter().rev().map(|&[x, y]| DVec3::new(x.into(), y.into(), 0.0)).collect()
}

fn spiral() -> Corners {
    let out = [[0, 0], [9, 0], [9, 9], [2, 9], [2, 3], [6, 3], [6, 6], [4, 6], [4, 5]];
    let back = [[5, 5], [5, 4], [3, 4], [3, 8], [8, 8], [8, 1], [0, 1]];
    let corner = |&[x, y]: &[i32; 2]| DVec3::new(x.into(), y.into(), 0.0);
    out.iter().chain(&back).map(corner).collect()
}

fn pentagram() -> Corners {
    let around = shapes::regular(5, DMat3::IDENTITY, DVec3::ZERO);
    (0..5).map(|k| around[2 * k % 5]).collect()
}

/// Matrices whose rows are the rows of a rotation times powers of two, so that integers stay exact.
fn tilts() -> [DMat3; 4] {
    let rows = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| DMat3::from_cols_array_2d(&[a, b, c]);
    [
        DMat3::IDENTITY,
        rows([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        rows([1.0, 2.0, 2.0], [2.0, 1.0, -2.0], [2.0, -2.0, 1.0]),
        rows([1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [1.0, 0.0, -1.0]),
    ]
}

/// It is not a share of the diagonal of the bounding box.
#[test]
fn the_default_tolerance_is_a_share_of_the_longest_side() {
    for (share, triangulated) in [(0.9, 0), (1.1, 1), (1.6, 1)] {
        let height = share * DEFAULT_TOLERANCE;
        let quad = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, height], [0.0, 1.0, 0.0]];
        let long = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [1.0, 0.0, 0.5]];
        let (_, report) = prepare(&[quad.map(DVec3::from).into(), long.map(DVec3::from).into()]);
        assert_eq!(report.triangulated, triangulated, "{share}");
    }
}

#[test]
fn a_triangle_one_lattice_step_high_is_kept() {
    let step = 2f64.powi(-50);
    let polygon = flat(&[[-1.0, -1.0], [1.0, 1.0], [1.0, 1.0 - step]]);
    assert_eq!(prepare(&[polygon]).0.len(), 1);
    let quad = flat(&[[-1.0, -1.0], [0.0, 0.0], [1.0, 1.0], [0.0, step]]);
    let (faces, report) = prepare(&[quad]);
    assert_eq!((faces.len(), report.dropped), (1, 0));
}

#[test]
fn triangles_cover_shapes_that_are_not_convex() {
    for shape in [l_shape(), star(), spiral()] {
        for tilt in tilts() {
            let mut polygon: Corners = shape.iter().map(|&p| tilt * p).collect();
            for _ in 0..2 {
                let (faces, report) = prepare(std::slice::from_ref(&polygon));
                assert_eq!(report.triangulated, 1);
                assert!((0..faces.len()).all(|face| faces.polygon(face as u32) == 0));
                assert_area_is_conserved(&faces, &polygon);
                polygon.reverse();
            }
        }
    }
}

#[test]
fn a_tiny_shape_far_from_the_centre_faces_the_right_way() {
    for tilt in tilts() {
        for shape in [l_shape(), star(), spiral()] {
            let (size, far) = (2f64.powi(-40), DVec3::new(0.75, -0.875, 0.625));
            let polygon: Corners = shape.iter().map(|&p| tilt * p * size + far).collect();
            let frame = flat(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]]);
            let (faces, _) = Faces::new([&polygon, &frame], Some(0.0)).expect("finite");
            let whole = area(&faces, &polygon);
            for face in (0..faces.len() as u32).filter(|&face| faces.polygon(face) == 0) {
                let part = face_area(&faces, face);
                assert!(rational::scalar(&part, &whole).is_positive());
            }
        }
    }
}

#[test]
fn a_quad_that_is_not_planar_becomes_two_triangles() {
    let mut quad = shapes::square(DMat3::IDENTITY, DVec3::ZERO);
    quad[2].z = 1e-3;
    let (faces, report) = prepare(std::slice::from_ref(&quad));
    assert_eq!((faces.len(), report.triangulated), (2, 1));
    assert_area_is_conserved(&faces, &quad);
    let (faces, report) = Faces::new([&quad], Some(1e-2)).expect("finite");
    assert_eq!((faces.len(), report.triangulated), (1, 0));
}

#[test]
fn corner_numbers_count_from_the_first_face_with_a_repeated_corner() {
    let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y + DVec3::Z];
    let (faces, _) = prepare(&[vec![a, b, c], vec![a, b, b, c, d], vec![a, a, c, d]]);
    let numbers = |face: u32| -> Vec<u32> {
        (0..faces.corners(face).len() as u32).map(|k| faces.corner_number(face, k)).collect()
    };
    assert_eq!(numbers(0), [0, 1, 2]);
    // The edge from a repeated corner belongs to the last repetition.
    assert_eq!(numbers(1), [0, 2, 3, 4]);
    assert_eq!(numbers(2), [1, 2, 3]);
    assert_eq!(
        (0..4).map(|k| faces.outline_edge(1, k)).collect::<Vec<_>>(),
        numbers(1).iter().map(|&k| Some(k)).collect::<Vec<_>>()
    );
}

/// The fan over a bent polygon leaves out corners in the middle of its first side. This side is still one
/// edge of the polygon, and diagonals are not edges of the polygon.
#[test]
fn a_side_of_several_steps_is_the_outline_s_where_its_corners_are_left_out() {
    for middle in 1..5 {
        let first_side = (0..=middle + 1).map(|k| DVec3::X * f64::from(k));
        let bent = [DVec3::new(4.0, 7.0, 0.0), DVec3::new(0.0, 7.0, 3.0)];
        let (faces, report) = prepare(&[first_side.chain(bent).collect()]);
        assert_eq!((faces.len(), report.triangulated), (2, 1));
        let numbers = [0, 1].map(|face| [0, 1, 2].map(|k| faces.corner_number(face, k)));
        assert_eq!(numbers, [[0, middle + 1, middle + 2], [0, middle + 2, middle + 3]]);
        let edges = [0, 1].map(|face| [0, 1, 2].map(|k| faces.outline_edge(face, k)));
        let [far, last] = [middle + 1, middle + 2].map(Some);
        assert_eq!(edges, [[Some(0), far, None], [None, last, Some(middle + 3)]]);
    }
}

#[test]
fn a_polygon_that_ends_where_it_begins_is_the_same_without_its_last_corner() {
    let square = flat(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]);
    let closed = [&square[..], &square[..1], &square[..1]].concat();
    let (faces, report) = prepare(&[closed, square]);
    assert_eq!((faces.len(), report.triangulated, faces.duplicates()), (2, 0, 1));
    assert_eq!(faces.corners(0), faces.corners(1));
}

/// Corners in the middle of a straight side may be corners of triangles or may be left out. In both cases,
/// the side is still an edge of the polygon.
#[test]
fn an_outline_with_corners_in_the_middle_of_a_side_stays_closed() {
    let side = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [4.0, 0.0]];
    let other = [[1.0, 1.0], [0.0, 4.0], [0.0, 3.0], [0.0, 2.0], [0.0, 1.0]];
    let arrow = flat(&[side, other].concat());
    for start in 0..arrow.len() {
        let mut polygon = arrow.clone();
        polygon.rotate_left(start);
        let (faces, _) = prepare(std::slice::from_ref(&polygon));
        let mut length = 0.0;
        for face in 0..faces.len() as u32 {
            let corners = faces.corners(face);
            for k in (0..corners.len()).filter(|&k| faces.outline_edge(face, k as u32).is_some()) {
                let next = corners[(k + 1) % corners.len()];
                length += DVec3::from(corners[k]).distance(next.into());
            }
        }
        let whole = 2.0 * (4.0 + 10f64.sqrt());
        assert!((faces.lattice().length_to_world(length) / whole - 1.0).abs() < 1e-12, "{start}");
    }
}

/// The two edges of a bridge cancel, whether they are edges of triangles or not.
#[test]
fn an_outline_with_a_hole_stays_closed_and_its_corners_keep_their_numbers() {
    let hole = [[3.0, 3.0], [3.0, 6.0], [6.0, 6.0], [6.0, 3.0], [3.0, 3.0]];
    let keyhole = [&[[0.0, 0.0]], &hole[..], &[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]]];
    for start in 0..10 {
        let mut polygon = flat(&keyhole.concat());
        polygon.rotate_left(start);
        let (faces, report) = prepare(std::slice::from_ref(&polygon));
        assert_eq!((faces.len(), report.triangulated, report.crossing), (8, 1, 0));
        assert_area_is_conserved(&faces, &polygon);
        let mut seen = [0; 10];
        for face in 0..faces.len() as u32 {
            for k in 0..3 {
                let number = faces.corner_number(face, k) as usize;
                assert_eq!(faces.lattice().snap(polygon[number]), faces.corners(face)[k as usize]);
                if let Some(edge) = faces.outline_edge(face, k) {
                    seen[edge as usize] += 1;
                    let end = faces.corner_number(face, (k + 1) % 3) as usize;
                    assert_eq!(polygon[end], polygon[(number + 1) % 10]);
                }
            }
        }
        for edge in 0..10 {
            let [from, to] = [edge, edge + 1].map(|k| polygon[k % 10]);
            let is_bridge = (0..10).any(|k| polygon[k] == to && polygon[(k + 1) % 10] == from);
            assert!(seen[edge] == 1 || (is_bridge && seen[edge] == 0), "edge {edge}: {seen:?}");
        }
    }
}

/// The polygons include a bow tie of equal halves, whose area is 0, and a star whose outline runs around
/// twice.
#[test]
fn polygons_that_cross_themselves_become_triangles_and_are_counted() {
    let bow_tie = flat(&[[0.0, 0.0], [3.0, 2.0], [3.0, 0.0], [0.0, 1.0]]);
    let even_bow_tie = flat(&[[-1.0, -1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, 1.0]]);
    let loose = flat(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 5.0], [3.0, -1.0], [0.0, 4.0]]);
    let twice_round = [star(), star()].concat();
    let crossing = [bow_tie, even_bow_tie, loose, pentagram()].map(|polygon| (polygon, Some(1)));
    let others = [l_shape(), star(), spiral()].map(|polygon| (polygon, Some(0)));
    for (polygon, crossing) in crossing.into_iter().chain(others).chain([(twice_round, None)]) {
        for tilt in tilts() {
            let (faces, report) = prepare(&[polygon.iter().map(|&p| tilt * p).collect()]);
            assert_eq!((report.dropped, report.triangulated), (0, 1), "{polygon:?}");
            assert!(crossing.is_none_or(|number| report.crossing == number), "{polygon:?}");
            assert!(!faces.is_empty());
            assert!((0..faces.len()).all(|face| faces.corners(face as u32).len() == 3));
        }
    }
}

/// Coordinates in `f32` are off the polygon's plane by their rounding, which is not a bend.
#[test]
fn polygons_of_rounded_coordinates_that_cross_themselves_are_counted_without_a_tolerance() {
    for angle in [0.3, 0.5, 0.7] {
        let turn = DMat3::from_rotation_x(angle) * DMat3::from_rotation_y(2.0 * angle);
        let star: Vec<[f32; 3]> =
            pentagram().iter().map(|&p| (turn * p).as_vec3().to_array()).collect();
        let (_, report) = Faces::new([star], Some(0.0)).expect("finite");
        assert_eq!((report.triangulated, report.crossing), (1, 1));
    }
}

#[test]
fn corner_numbers_hold_if_the_very_first_corner_breaks_the_count() {
    // The quad is cut along its shorter diagonal, from corner 1 to 3.
    let quad = flat(&[[-2.0, 0.0], [0.0, -1.0], [2.0, 0.0], [0.0, 1.0]]);
    let bent = quad.iter().map(|&p| p + DVec3::Z * (0.1 * p.x.abs())).collect();
    let (faces, _) = prepare(&[bent]);
    assert_eq!([0, 1, 2].map(|k| faces.corner_number(0, k)), [1, 2, 3]);
    assert_eq!([0, 1, 2].map(|k| faces.corner_number(1, k)), [1, 3, 0]);
}

#[test]
fn corners_folded_onto_one_another_are_not_taken_for_convex() {
    // On the plane x + y = 0, which is as steep along x as along y. The two topmost corners differ along only
    // one axis. In a projection along this axis, they coincide.
    let fold = |along: DVec3| {
        let [left, right] = [DVec3::new(-1.0, 1.0, 0.0), DVec3::new(1.0, -1.0, 0.0)];
        let tip = DVec3::new(0.0, 0.0, 1.05);
        let beside = tip + along * 2f64.powi(-40);
        vec![left - DVec3::Z, right - DVec3::Z, right + DVec3::Z, beside, tip, left + DVec3::Z]
    };
    for along in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y] {
        let (faces, _) = prepare(&[fold(along)]);
        for face in 0..faces.len() as u32 {
            assert_convex_and_planar(&faces, face).expect("convex and planar");
        }
    }
}

proptest! {
    #![proptest_config(cases(256, file!()))]

    #[test]
    fn triangles_cover_shapes_anywhere_up_to_rounding(
        shape in prop::sample::select(vec![l_shape(), star(), spiral()]),
        turn in hard::turn(),
        offset in prop::array::uniform3(-1e6..1e6f64),
        scale in -100..=100i32,
        reversed in any::<bool>(),
    ) {
        let place = |p: &DVec3| (turn * *p + DVec3::from_array(offset)) * 2f64.powi(scale);
        let mut polygon: Corners = shape.iter().map(place).collect();
        if reversed {
            polygon.reverse();
        }
        let (faces, report) = prepare(std::slice::from_ref(&polygon));
        prop_assert_eq!(report.triangulated, 1);
        let whole = area(&faces, &polygon);
        let square = rational::scalar(&whole, &whole);
        let mut total = rational::point(DVec3::ZERO);
        for face in 0..faces.len() as u32 {
            let part = face_area(&faces, face);
            prop_assert!(rational::scalar(&part, &whole).is_positive());
            total = rational::sum(&total, &part);
        }
        let covered = rational::scalar(&total, &whole) / square;
        prop_assert!((covered.to_f64().value() - 1.0).abs() < 1e-9);
    }
}
