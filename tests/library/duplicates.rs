//! Polygons that are given more than once are kept and counted.

use testkit::prelude::*;

const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// The corners of the square in another order.
fn named<const N: usize>(order: [usize; N]) -> Vec<[f64; 3]> {
    order.map(|k| SQUARE[k]).to_vec()
}

fn duplicates(polygons: &[Vec<[f64; 3]>]) -> usize {
    let tree = BspTree::build(polygons).expect("finite");
    tree.duplicates()
}

/// A repeated face is counted from any corner in either direction, also with a corner repeated or rounded to
/// the same place. A face with other corners, or with the same corners in another cyclic order, is not a
/// duplicate.
#[test]
fn faces_given_again_are_counted() {
    let first = || named([0, 1, 2, 3]);
    for again in [[0, 1, 2, 3], [2, 3, 0, 1], [3, 2, 1, 0], [1, 0, 3, 2]] {
        assert_eq!(duplicates(&[first(), named(again)]), 1, "{again:?}");
    }
    let mut rounded = named([0, 0, 1, 2, 3]);
    (rounded[4][0], rounded[0][2]) = (1e-17, -0.0);
    let mut other = first();
    other[2][0] = 1.0 + f64::EPSILON * 8.0;
    // A bow tie.
    let tie = named([0, 2, 1, 3]);
    for (polygons, expected) in [
        (vec![first()], 0),
        (vec![first(), named([1, 2, 3, 0]), first()], 2),
        (vec![first(), tie.clone()], 0),
        (vec![tie, named([1, 3, 0, 2])], 1),
        (vec![first(), rounded], 1),
        (vec![first(), other], 0),
        // Polygons without area are dropped.
        (vec![named([0, 1, 0]), named([0, 1, 0]), first()], 0),
    ] {
        assert_eq!(duplicates(&polygons), expected, "{polygons:?}");
    }
}

#[test]
fn of_duplicates_the_later_one_shows_from_both_sides() {
    let tree = BspTree::build([named([0, 1, 2, 3]), named([3, 2, 1, 0])]).expect("finite");
    for z in [5.0, -5.0] {
        let last = tree.back_to_front(Viewpoint::Eye(DVec3::new(0.5, 0.5, z))).next_back();
        assert_eq!(last.map(|fragment| fragment.polygon()), Some(1));
    }
}

#[test]
fn a_hundred_thousand_duplicates_and_as_many_different_faces_are_counted() {
    let face = |i: u32| {
        let x = f64::from(i / 2);
        [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, f64::from(i % 2)]]
    };
    let all: Vec<_> = (0..200_000).map(|i| face(if i % 2 == 0 { 0 } else { i })).collect();
    let tree = BspTree::build(&all).expect("finite");
    assert_eq!(tree.duplicates(), 99_999);
}
