//! Checks that the faces of any scene are convex, planar, at the positions of the input, and whole if
//! possible.

use binspace::internals::{PreparedPlane, Side, Vertex, split};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::TestCaseError;
use testkit::checks::{area, assert_convex_and_planar};
use testkit::hard::HardScene;
use testkit::model::Face;
use testkit::prelude::*;
use testkit::shapes;

/// Corners that are moved onto a plane move by little. The other corners do not move.
fn assert_corners_are_the_input_s(
    faces: &Faces,
    face: u32,
    polygon: &[DVec3],
) -> Result<(), TestCaseError> {
    for (k, &corner) in faces.corners(face).iter().enumerate() {
        let number = faces.corner_number(face, k as u32) as usize;
        let given = faces.lattice().snap(polygon[number]);
        let moved = (DVec3::from(corner) - DVec3::from(given)).abs().max_element();
        prop_assert!(moved <= faces.tolerance() * 1.74 + 1.0, "corner {k} moved by {moved}");
        let reference = faces
            .reference_triangle(face)
            .contains(&(faces.corner_range(face).start as u32 + k as u32));
        prop_assert!(moved == 0.0 || !reference);
    }
    // For a corner moved onto the plane, the nearest lattice point is stored.
    let exact = Face::new(faces, face);
    let half = Rational::from_parts_signed(1.into(), 2.into());
    for (kept, exact) in faces.corners(face).iter().zip(&exact.corners) {
        let off = rational::difference(exact, &rational::point(*kept));
        prop_assert!(off.iter().all(|off| off.abs() <= half), "{exact:?} kept as {kept:?}");
    }
    Ok(())
}

fn with_repeats(mut scene: HardScene, repeats: &[(Index, Index)]) -> HardScene {
    for (polygon, corner) in repeats {
        let polygon = polygon.get_mut(&mut scene.polygons);
        let at = corner.index(polygon.len());
        polygon.insert(at, polygon[at]);
    }
    scene
}

/// Any finite number: numbers of every size, and typical coordinates.
fn any_finite() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>().prop_filter("finite", |x| x.is_finite()),
        any::<u64>().prop_map(|bits| f64::from_bits(bits & !(0x7ff << 52))),
        prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 1e300, -1e300, 1e-300, f64::MAX, f64::MIN]),
        -1.0..1.0f64,
    ]
}

/// Makes every decision about the faces of a scene.
fn decide_all(faces: &Faces) {
    for face in 0..faces.len() as u32 {
        let corners = 0..faces.corners(face).len() as u32;
        let whole: Vec<_> = corners.clone().map(|k| Vertex::corner(faces, face, k)).collect();
        let planes = (0..faces.len() as u32).map(PlaneId::face);
        for plane in planes.chain(corners.map(|k| PlaneId::axis(k as usize % 3, k))) {
            let prepared = PreparedPlane::new(faces, plane);
            if prepared.classify(faces, face, None) == Side::Spanning {
                let (mut front, mut back) = (Vec::new(), Vec::new());
                split(faces, &prepared, face, &whole, &mut front, &mut back);
                assert!(front.len() >= 3 && back.len() >= 3);
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(1000, file!()))]

    #[test]
    fn faces_of_hard_scenes_are_convex_planar_and_where_the_input_is(
        scene in hard::scene(),
        repeats in prop::collection::vec(any::<(Index, Index)>(), 0..4),
    ) {
        let scene = with_repeats(scene, &repeats);
        let (faces, report) = Faces::new(&scene.polygons, scene.tolerance()).expect("finite");
        prop_assert_eq!(report.polygons, scene.polygons.len());
        for face in 0..faces.len() as u32 {
            assert_convex_and_planar(&faces, face)?;
            let polygon = &scene.polygons[faces.polygon(face)];
            assert_corners_are_the_input_s(&faces, face, polygon)?;
        }
    }

    #[test]
    fn planar_convex_polygons_stay_whole(polygon in hard::lattice_ngon()) {
        let (faces, report) = Faces::new([&polygon], None).expect("finite");
        if area(&faces, &polygon).iter().all(Rational::is_zero) {
            prop_assert_eq!(report.dropped, 1);
        } else {
            prop_assert_eq!(report.triangulated, 0);
            prop_assert_eq!(faces.len(), 1);
            prop_assert_eq!(faces.corners(0).len(), polygon.len());
        }
    }

    #[test]
    fn rounded_convex_polygons_stay_whole(
        n in 3..=40usize,
        turn in hard::turn(),
        noise in prop::collection::vec(-1e-10..1e-10f64, 40),
    ) {
        let mut polygon = shapes::regular(n, turn, DVec3::new(0.3, -0.1, 0.7));
        for (corner, noise) in polygon.iter_mut().zip(noise) {
            *corner += turn.z_axis * noise;
        }
        let (faces, report) = Faces::new([&polygon], None).expect("finite");
        prop_assert_eq!((faces.len(), report.triangulated, report.dropped), (1, 0, 0));
        prop_assert_eq!(faces.corners(0).len(), n);
        assert_corners_are_the_input_s(&faces, 0, &polygon)?;
    }

    #[test]
    fn any_finite_input_is_accepted(
        polygons in prop::collection::vec(
            prop::collection::vec(prop::array::uniform3(any_finite()), 0..8), 0..5),
        tolerance in prop::option::of(any_finite().prop_map(f64::abs)),
    ) {
        let (faces, _) = Faces::new(&polygons, tolerance).expect("finite");
        for face in 0..faces.len() as u32 {
            assert_convex_and_planar(&faces, face)?;
        }
        decide_all(&faces);
    }
}
