//! Checks of prepared faces, in rationals.

use super::model::Face;
use super::rational::{self, Point};
use binspace::glam::DVec3;
use binspace::internals::Faces;
use num_traits::Signed;
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

/// Returns twice the vector area of a polygon's corners on the lattice.
pub fn area(faces: &Faces, polygon: &[DVec3]) -> Point {
    let corners: Vec<Point> =
        polygon.iter().map(|&p| rational::point(faces.lattice().snap(p))).collect();
    rational::area(&corners)
}

pub fn face_area(faces: &Faces, face: u32) -> Point {
    let corners: Vec<Point> = faces.corners(face).iter().map(|&c| rational::point(c)).collect();
    rational::area(&corners)
}

/// Checks in rationals, with corners moved onto the plane: every edge has a length, all turns are to the
/// left seen from the front, and they add up to one full turn.
pub fn assert_convex_and_planar(faces: &Faces, face: u32) -> Result<(), TestCaseError> {
    let exact = Face::new(faces, face);
    let n = exact.corners.len();
    let edge = |k: usize| rational::difference(&exact.corners[(k + 1) % n], &exact.corners[k % n]);
    let mut winding = Vec::new();
    for k in 0..n {
        prop_assert!(exact.plane.at(&exact.corners[k]).is_zero());
        prop_assert!(edge(k).iter().any(|c| !c.is_zero()), "an edge without length");
        let turn =
            rational::scalar(&rational::product(&edge(k), &edge(k + 1)), &exact.plane.normal);
        prop_assert!(!turn.is_negative(), "a corner that turns inwards");
        let ahead = rational::scalar(&edge(k), &edge(k + 1));
        prop_assert!(turn.is_positive() || ahead.is_positive(), "an edge that turns back");
        let along = rational::scalar(&edge(0), &edge(k));
        let across = rational::scalar(&rational::product(&edge(0), &edge(k)), &exact.plane.normal);
        winding.push(across.is_positive() || (across.is_zero() && along.is_positive()));
    }
    let rises = (0..n).filter(|&k| !winding[k] && winding[(k + 1) % n]).count();
    prop_assert_eq!(rises, 1, "the corners go round once");
    Ok(())
}
