//! Polygons that are given more than once are kept and counted.

use testkit::prelude::*;

const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// The corners of the square in another order.
fn named(order: [usize; 4]) -> Vec<[f64; 3]> {
    order.map(|k| SQUARE[k]).to_vec()
}

fn duplicates(polygons: &[Vec<[f64; 3]>]) -> usize {
    let tree = BspTree::build(polygons).expect("finite");
    tree.duplicates()
}

#[test]
fn a_face_given_again_from_any_corner_in_either_direction_is_counted() {
    let first = named([0, 1, 2, 3]);
    for again in [[0, 1, 2, 3], [2, 3, 0, 1], [3, 2, 1, 0], [1, 0, 3, 2]] {
        assert_eq!(duplicates(&[first.clone(), named(again)]), 1, "{again:?}");
    }
    let thrice = [first.clone(), named([1, 2, 3, 0]), first.clone()];
    assert_eq!(duplicates(&thrice), 2);
    assert_eq!(duplicates(&[first]), 0);
}

#[test]
fn the_same_corners_in_another_order_around_are_no_duplicate() {
    // A bow tie.
    assert_eq!(duplicates(&[named([0, 1, 2, 3]), named([0, 2, 1, 3])]), 0);
    assert_eq!(duplicates(&[named([0, 2, 1, 3]), named([1, 3, 0, 2])]), 1);
}

#[test]
fn a_corner_repeated_or_rounded_to_the_same_place_makes_no_difference() {
    let mut again = named([0, 1, 2, 3]);
    again.insert(1, SQUARE[0]);
    again[3][0] += 1e-17;
    again[0][2] = -0.0;
    assert_eq!(duplicates(&[named([0, 1, 2, 3]), again]), 1);
    let mut other = named([0, 1, 2, 3]);
    other[2][0] = 1.0 + f64::EPSILON * 8.0;
    assert_eq!(duplicates(&[named([0, 1, 2, 3]), other]), 0);
}

#[test]
fn faces_without_area_are_dropped_and_no_duplicates() {
    let line = vec![SQUARE[0], SQUARE[1], SQUARE[0]];
    let tree = BspTree::build([line.clone(), line, named([0, 1, 2, 3])]).expect("finite");
    assert_eq!((tree.preparation().dropped, tree.duplicates()), (2, 0));
    assert_eq!(tree.dropped().collect::<Vec<_>>(), [0, 1]);
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
