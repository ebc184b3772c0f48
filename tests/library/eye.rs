//! The side of a plane on which an eye lies, compared with exact rationals; and the lattice of eyes and
//! corners.

use binspace::internals::{Eye, Lattice};
use proptest::prelude::*;
use testkit::prelude::*;
use testkit::rational::{Plane, Point};
use testkit::views::{in_lattice, power_of_two, rounded_eye};

fn side(faces: &Faces, plane: PlaneId, viewpoint: Viewpoint) -> Ordering {
    faces.eye_side(plane, &Eye::new(viewpoint, faces.lattice()))
}

fn planes(faces: &Faces) -> impl Iterator<Item = PlaneId> {
    let corners = (0..faces.len().min(8) as u32).map(|face| faces.corner_range(face).start as u32);
    let axes = corners.map(|corner| PlaneId::axis(corner as usize % 3, corner));
    (0..faces.len() as u32).map(PlaneId::face).chain(axes)
}

/// The side of an eye infinitely far in a direction; `None` if rounding the direction to 52 bits may change
/// the side.
fn side_of_direction(plane: &Plane, towards: &Point) -> Option<Ordering> {
    let value = rational::scalar(&plane.normal, towards);
    let size = |v: &Point| v.iter().map(Signed::abs).max().expect("three");
    let doubt = size(&plane.normal) * size(towards) * Rational::from(3);
    (value.abs() * power_of_two(50) > doubt).then(|| rational::sign(&value))
}

/// Points on corners, in the planes of faces, and from inside the scene to 1e40 extents away.
fn eye_offsets() -> impl Strategy<Value = (prop::sample::Index, [f64; 3], f64)> {
    let direction = prop_oneof![
        prop::array::uniform3(-1.0..1.0f64),
        prop::array::uniform3((-2..=2i32).prop_map(f64::from)),
    ];
    let distance = prop_oneof![
        Just(0.0),
        (-20.0..3.0f64).prop_map(|e| 10f64.powf(e)),
        (3.0..40.0f64).prop_map(|e| 10f64.powf(e)),
        (40.0..250.0f64).prop_map(|e| 10f64.powf(e)),
        (-52..=70i32).prop_map(|e| 2f64.powi(e)),
    ];
    (any::<prop::sample::Index>(), direction, distance)
}

proptest! {
    #![proptest_config(cases(700, file!()))]

    #[test]
    fn eyes_are_on_the_side_that_rationals_say(
        scene in hard::scene(),
        offsets in prop::collection::vec(eye_offsets(), 6),
    ) {
        let faces = scene.faces();
        let extent = hard::extent(&scene.polygons);
        let corners = scene.polygons.concat();
        for (corner, direction, distance) in offsets {
            let from = *corner.get(&corners);
            let at = from + DVec3::from_array(direction) * extent * distance;
            let lattice = faces.lattice().to_lattice(at);
            let is_point = lattice.iter().all(|c| c.is_finite());
            let exact = is_point.then(|| in_lattice(faces.lattice(), at)).and_then(rounded_eye);
            for plane in planes(&faces) {
                let found = side(&faces, plane, Viewpoint::eye(at));
                let plane = model::plane(&faces, plane);
                match &exact {
                    Some(eye) => prop_assert_eq!(found, rational::sign(&plane.at(eye))),
                    None if is_point => {
                        let certain = side_of_direction(&plane, &lattice.map(rational::exact));
                        prop_assert!(certain.is_none_or(|side| side == found));
                    }
                    None => {}
                }
            }
        }
    }

    #[test]
    fn directions_are_on_the_side_that_rationals_say(
        scene in hard::scene(),
        direction in prop::array::uniform3(-1.0..1.0f64),
        small in prop::array::uniform3(-4..=4i32),
        scale in -300..=300i32,
    ) {
        let faces = scene.faces();
        let scale = 2f64.powi(scale);
        for plane in planes(&faces) {
            let exact = model::plane(&faces, plane);
            let certain = side_of_direction(&exact, &rational::point(DVec3::from_array(direction)));
            let looking = DVec3::from_array(direction) * -scale;
            let found = side(&faces, plane, Viewpoint::direction(looking));
            prop_assert!(certain.is_none_or(|side| side == found));
            // If the largest component is a power of two, the direction is not rounded.
            let largest = small.iter().map(|c| c.unsigned_abs()).max().expect("three");
            if largest.is_power_of_two() {
                let towards = small.map(f64::from);
                let value = rational::scalar(&exact.normal, &towards.map(rational::exact));
                let looking = DVec3::from_array(towards) * -scale;
                let found = side(&faces, plane, Viewpoint::direction(looking));
                let expected = match rational::sign(&value) {
                    // If the plane is seen edge-on, the side of the lattice's origin counts.
                    Ordering::Equal => rational::sign(&-exact.offset),
                    side => side,
                };
                prop_assert_eq!(found, expected);
            }
        }
    }

    #[test]
    fn eyes_on_a_grid_are_decided_in_the_scene_s_own_coordinates(
        corners in prop::collection::vec(prop::array::uniform3(-64..=64i32), 3),
        eye in prop::array::uniform3(-1024..=1024i32),
        exponent in -40..=40i32,
        on_plane in any::<Option<(i8, i8)>>(),
    ) {
        let unit = 2f64.powi(exponent);
        let polygon: Vec<DVec3> =
            corners.iter().map(|c| DVec3::from_array(c.map(f64::from)) * unit).collect();
        let (faces, _) = Faces::new([&polygon], None).expect("finite");
        let eye = match on_plane {
            None => DVec3::from_array(eye.map(f64::from)) * (unit / 8.0),
            Some((s, t)) => {
                let [u, w] = [1, 2].map(|k| polygon[k] - polygon[0]);
                polygon[0] + (u * f64::from(s) + w * f64::from(t)) / 8.0
            }
        };
        if !faces.is_empty() {
            let [a, b, c] = [0, 1, 2].map(|k| rational::point(polygon[k]));
            let expected = rational::sign(&Plane::through([&a, &b, &c]).at(&rational::point(eye)));
            prop_assert_eq!(side(&faces, PlaneId::face(0), Viewpoint::eye(eye)), expected);
            prop_assert!(on_plane.is_none() || expected.is_eq());
        }
    }

    #[test]
    fn f32_corners_within_a_factor_of_the_extent_are_not_moved(
        bits in prop::collection::vec((any::<bool>(), 0..24i32, 0..1u32 << 23), 6),
        exponent in -60..=60i32,
    ) {
        // Components of at least 2⁻²⁴ of the largest: their 24 bits end above 2⁻⁵⁰ of the largest.
        let value = |&(negative, below, fraction): &(bool, i32, u32)| {
            let size = f32::from_bits(fraction | 127 << 23) * 2f32.powi(exponent - below);
            f64::from(if negative { -size } else { size })
        };
        let values: Vec<f64> = bits.iter().map(value).collect();
        let [a, b] = [DVec3::from_slice(&values[..3]), DVec3::from_slice(&values[3..])];
        let lattice = Lattice::new(a.min(b), a.max(b));
        let largest = (a.max(b) - a.min(b)).max_element();
        let spread = a.abs().max(b.abs()).max_element() / largest;
        if spread <= 2.0 {
            for corner in [a, b] {
                prop_assert_eq!(lattice.to_world(lattice.snap(corner)), corner);
            }
        }
    }

    #[test]
    fn a_scene_scaled_by_a_power_of_two_has_the_same_lattice_points(
        scene in hard::scene(),
        exponent in -100..=100i32,
    ) {
        let scaled: Vec<Vec<DVec3>> = scene
            .polygons
            .iter()
            .map(|polygon| polygon.iter().map(|&p| p * 2f64.powi(exponent)).collect())
            .collect();
        let tolerance = scene.tolerance().map(|t| t * 2f64.powi(exponent));
        let (faces, report) = Faces::new(&scene.polygons, scene.tolerance()).expect("finite");
        let (other, mut other_report) = Faces::new(&scaled, tolerance).expect("finite");
        for length in [&mut other_report.flattened_by, &mut other_report.bent_by] {
            *length *= 2f64.powi(-exponent);
        }
        prop_assert_eq!(report, other_report);
        prop_assert_eq!(faces.len(), other.len());
        for face in 0..faces.len() as u32 {
            prop_assert_eq!(faces.corners(face), other.corners(face));
        }
    }
}

#[test]
fn eyes_at_infinity_or_not_a_number_have_a_side() {
    let polygon = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from);
    let (faces, _) = Faces::new([polygon], None).expect("finite");
    let above = |z: f64| side(&faces, PlaneId::face(0), Viewpoint::eye(DVec3::new(3.0, -1.0, z)));
    assert_eq!(above(f64::INFINITY), Ordering::Greater);
    assert_eq!(above(f64::NEG_INFINITY), Ordering::Less);
    assert_eq!(above(f64::MAX), Ordering::Greater);
    let looking = |z: f64| side(&faces, PlaneId::face(0), Viewpoint::direction(DVec3::Z * z));
    assert_eq!(looking(f64::NEG_INFINITY), Ordering::Greater);
    assert_eq!(looking(f64::from_bits(1)), Ordering::Less);
    for odd in [DVec3::NAN, DVec3::ZERO, DVec3::INFINITY] {
        side(&faces, PlaneId::face(0), Viewpoint::direction(odd));
        side(&faces, PlaneId::face(0), Viewpoint::eye(odd));
    }
}
