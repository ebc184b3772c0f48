//! Checks of prepared faces, in rationals and in integers.

use super::model::Face;
use super::rational::{self, Point};
use super::vector::{difference, product, sum};
use binspace::glam::DVec3;
use binspace::internals::Faces;
use num_traits::Signed;
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use std::collections::BTreeMap;

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

/// A corner on the lattice.
type Corner = [i128; 3];

/// The sum of directed edges. All edges are divided at the points on them.
fn chain(points: &[Corner], edges: &[[Corner; 2]]) -> BTreeMap<[Corner; 2], i32> {
    let mut chain = BTreeMap::new();
    for &[a, b] in edges {
        let [low, high] = if a < b { [a, b] } else { [b, a] };
        let along = difference(&high, &low);
        let on_edge = |p: &&Corner| {
            (low..=high).contains(*p) && product(&along, &difference(p, &low)) == [0; 3]
        };
        let mut stops: Vec<Corner> = points.iter().filter(on_edge).copied().collect();
        stops.sort_unstable();
        stops.dedup();
        for pair in stops.windows(2) {
            *chain.entry([pair[0], pair[1]]).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    chain.retain(|_, times| *times != 0);
    chain
}

fn around(corners: &[Corner]) -> impl Iterator<Item = [Corner; 2]> {
    (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]])
}

/// Twice the vector area of an outline.
fn whole_area(corners: &[Corner]) -> Corner {
    around(corners).fold([0; 3], |total, [a, b]| {
        let [a, b] = [a, b].map(|p| difference(&p, &corners[0]));
        sum(&total, &product(&a, &b))
    })
}

/// Asserts in integers that a polygon's faces keep its outline: their directed edges sum to the outline, and
/// their vector areas to that of the polygon.
pub fn assert_outline_kept(faces: &Faces, polygon: &[DVec3]) {
    let whole = |p: [f64; 3]| p.map(|c| c as i128);
    let corners: Vec<Corner> = polygon.iter().map(|&p| whole(faces.lattice().snap(p))).collect();
    let all: Vec<Vec<Corner>> = (0..faces.len() as u32)
        .map(|face| faces.corners(face).iter().map(|&p| whole(p)).collect())
        .collect();
    let expected = chain(&corners, &around(&corners).collect::<Vec<_>>());
    let edges: Vec<_> = all.iter().flat_map(|face| around(face)).collect();
    assert_eq!(chain(&corners, &edges), expected, "{polygon:?}\n{all:?}");
    let area = all.iter().fold([0; 3], |total, face| sum(&total, &whole_area(face)));
    assert_eq!(area, whole_area(&corners), "{polygon:?}");
}
