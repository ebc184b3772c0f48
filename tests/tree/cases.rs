//! Cases from the tests of other libraries, rewritten.

use testkit::judge::judge;
use testkit::prelude::*;
use testkit::snapshot::polygons;

type Square = Vec<DVec3>;

/// A square of side 2 around a point, perpendicular to an axis and facing along it.
fn square(axis: usize, centre: [f64; 3]) -> Square {
    let around = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corner = |[u, v]: [f64; 2]| {
        let mut at = centre;
        at[(axis + 1) % 3] += u;
        at[(axis + 2) % 3] += v;
        DVec3::from_array(at)
    };
    around.map(corner).to_vec()
}

fn build(by: Heuristic, polygons: &[Square]) -> BspTree {
    let tree = BuildOptions::DEFAULT.with_heuristic(by).build(polygons).unwrap();
    assert_eq!(judge(&tree, polygons), Ok(()), "{by}");
    tree
}

#[test]
fn three_parallel_squares_come_by_depth() {
    let squares = [5.0, -2.0, 1.0].map(|z| square(2, [0.0, 0.0, z]));
    for &by in Heuristic::ALL {
        let tree = build(by, &squares);
        assert_eq!(tree.len(), 3, "{by}");
        let order = |viewpoint| polygons(&tree, viewpoint);
        assert_eq!(order(Viewpoint::eye([0.0, 0.0, 9.0])), [1, 2, 0], "{by}");
        assert_eq!(order(Viewpoint::eye([0.0, 0.0, -9.0])), [0, 2, 1], "{by}");
        assert_eq!(order(Viewpoint::direction([0.1, 0.0, -1.0])), [1, 2, 0], "{by}");
        assert_eq!(order(Viewpoint::direction([0.1, 0.0, 1.0])), [0, 2, 1], "{by}");
        // From between two squares, each square is only behind the squares on its own side.
        let between = order(Viewpoint::eye([0.0, 0.0, 0.0]));
        let at = |polygon| between.iter().position(|&p| p == polygon);
        assert!(at(0) < at(2), "{by}: {between:?}");
    }
}

#[test]
fn two_crossing_squares_make_three_pieces() {
    let squares = [square(0, [0.0; 3]), square(1, [0.0; 3])];
    for &by in Heuristic::ALL {
        let tree = build(by, &squares);
        assert_eq!(tree.len(), 3, "{by}");
        let whole = tree.fragments().filter(|fragment| fragment.is_whole()).count();
        assert_eq!(whole, 1, "{by}");
        for eye in [[4.0, 1.0, 0.0], [-4.0, 1.0, 0.0], [4.0, -1.0, 0.0], [-4.0, -1.0, 0.0]] {
            // The piece on the eye's side of the uncut square is last, and the other piece is first.
            let order: Vec<_> = tree.back_to_front(Viewpoint::eye(eye)).collect();
            assert!(order[1].is_whole(), "{by}");
        }
    }
}

#[test]
fn a_square_on_one_side_of_the_other_is_not_cut_if_the_other_comes_first() {
    // The second square stands on the first. The second square's plane would cut the first in two.
    let (floor, wall) = (square(2, [0.0; 3]), square(0, [0.0, 0.0, 1.5]));
    let first = |squares: [&Square; 2]| build(Heuristic::First, &squares.map(Clone::clone)).len();
    assert_eq!(first([&floor, &wall]), 2);
    assert_eq!(first([&wall, &floor]), 3);
    for by in [Heuristic::FewestSplits, Heuristic::ALL[4], Heuristic::ALL[5], Heuristic::Auto] {
        assert_eq!(build(by, &[wall.clone(), floor.clone()]).len(), 2, "{by}");
    }
}

#[test]
fn coplanar_squares_come_in_input_order_from_both_sides_whichever_way_they_wind() {
    let nested = |half: f64| -> Square {
        square(2, [0.0; 3]).iter().map(|&corner| corner * half + DVec3::Z).collect()
    };
    for turned in 0..8 {
        let squares: Vec<Square> = [3.0, 2.0, 1.0]
            .into_iter()
            .enumerate()
            .map(|(i, half)| {
                let mut square = nested(half);
                if turned >> i & 1 == 1 {
                    square.reverse();
                }
                square
            })
            .collect();
        for &by in Heuristic::ALL {
            let tree = build(by, &squares);
            for z in [9.0, -9.0, 1.0] {
                let order = polygons(&tree, Viewpoint::eye([0.5, 0.5, z]));
                assert_eq!(order, [0, 1, 2], "{by}, windings {turned:b}, from {z}");
            }
            for z in [1.0, -1.0] {
                assert_eq!(polygons(&tree, Viewpoint::direction([0.0, 0.0, z])), [0, 1, 2]);
            }
        }
    }
}

#[test]
fn a_pentagon_with_a_corner_on_the_plane_is_cut_in_two_proper_pieces() {
    let floor: Square = square(2, [0.0; 3]).iter().map(|&corner| corner * 20.0).collect();
    let pentagon = [
        [9.0, 9.0, 5.0],
        [1.0, 1.0, 0.001],
        [1.0, 1.0, 0.0],
        [1.002, 1.002, -0.005],
        [9.0, 9.0, -4.0],
    ];
    let pentagon: Square = pentagon.map(DVec3::from_array).to_vec();
    for tolerance in [0.0, 1e-9, 1e-4] {
        let input = [floor.clone(), pentagon.clone()];
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
        let tree = options.with_tolerance(tolerance).build(&input).unwrap();
        assert_eq!(judge(&tree, &input), Ok(()));
        let pieces: Vec<Vec<DVec3>> = tree
            .fragments()
            .filter(|fragment| fragment.polygon() == 1)
            .map(|fragment| fragment.vertices().collect())
            .collect();
        assert_eq!(pieces.iter().map(Vec::len).collect::<Vec<_>>(), [4, 4]);
        for (piece, side) in pieces.iter().zip([1.0, -1.0]) {
            assert!(piece.iter().all(|vertex| vertex.z * side >= 0.0), "{piece:?}");
            assert!(piece.contains(&DVec3::new(1.0, 1.0, 0.0)), "{piece:?}");
            assert!(piece.contains(&DVec3::new(9.0, 9.0, 0.0)), "{piece:?}");
        }
    }
}

#[test]
fn a_square_that_touches_a_plane_with_an_edge_is_not_cut() {
    let floor: Square = square(2, [0.0; 3]).iter().map(|&corner| corner * 20.0).collect();
    for side in [1.0, -1.0] {
        let wall = square(0, [0.0, 0.0, side]);
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
        for tolerance in [0.0, 1e-9, 1e-3] {
            let tree = options.clone().with_tolerance(tolerance).build([&floor, &wall]).unwrap();
            assert_eq!(tree.len(), 2);
            assert!(tree.fragments().all(|fragment| fragment.is_whole()));
            let order = polygons(&tree, Viewpoint::eye([5.0, 0.0, 7.0]));
            assert_eq!(order, if side > 0.0 { [0, 1] } else { [1, 0] });
        }
    }
}
