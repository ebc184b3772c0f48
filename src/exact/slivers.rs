//! Planes of triangles so thin that rounding takes their normals.

use std::cmp::Ordering;

use super::{Exact, Faces, Kernel, PlaneId};

/// In the plane z = 0. Twice its area is 1 in lattice steps, and in floats 2⁴⁸.
fn faces(tolerance: Option<f64>) -> Faces {
    let sliver = [
        [-1.0, -1.0, 0.0],
        [0.719_638_576_572_251_9, 0.75, 0.0],
        [0.931_029_674_363_226_3, 0.965_123_355_671_395_6, 0.0],
    ];
    let rest = [[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]];
    Faces::new([sliver, rest], tolerance).unwrap().0
}

#[test]
fn points_are_beyond_the_tolerance_by_their_distance() {
    for tolerance in [None, Some(0.0), Some(1e-3)] {
        let faces = faces(tolerance);
        let length = faces.tolerance();
        let splitter = Exact.splitter(&faces, PlaneId::face(0));
        let near = (length * (1.0 - 1e-9)).floor();
        let far = (length * (1.0 + 1e-9)).floor() + 1.0;
        let up = faces.plane(PlaneId::face(0)).normal()[2].signum() as f64;
        for (z, expected) in [
            (far, Ordering::Greater),
            (-far, Ordering::Less),
            (near, Ordering::Equal),
            (-near, Ordering::Equal),
            (2f64.powi(48), Ordering::Greater),
        ] {
            let side = splitter.side_beyond(&faces, &[12345.0, -678.0, z * up]);
            assert_eq!(side, expected, "{z} of {length}");
        }
    }
}

#[test]
fn a_tolerance_that_is_another_length_is_noticed() {
    for tolerance in [None, Some(1e-3)] {
        let faces = faces(tolerance);
        for plane in [PlaneId::face(0), PlaneId::face(1), PlaneId::axis(1, 2)] {
            let splitter = Exact.splitter(&faces, plane);
            assert!(splitter.has_length_of(&faces));
            for share in [0.0, 1.0 - 1e-6, 1.0 + 1e-6, 2.0] {
                let band = (splitter.band * share).floor();
                let other = splitter.with_band(band);
                assert!(!other.has_length_of(&faces), "{share} at {plane:?}");
            }
        }
    }
}
