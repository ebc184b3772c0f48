//! Input with little or no content, and degenerate viewpoints: results are as documented, and nothing panics.

use binspace::ErrorKind;
use testkit::orders;
use testkit::prelude::*;
use testkit::snapshot::polygons;

const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// Viewpoints without a picture, and viewpoints that are only hard to decide.
fn viewpoints() -> Vec<Viewpoint> {
    let odd =
        [0.0, -0.0, 1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 5e-324];
    let mut list = Vec::new();
    for x in odd {
        for y in odd {
            for z in odd {
                list.push(Viewpoint::eye([x, y, z]));
                list.push(Viewpoint::direction([x, y, z]));
            }
        }
    }
    list
}

fn check_orders(polygons: &[impl Polygon]) {
    for &by in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(by);
        let exact = options.build(polygons).unwrap();
        assert_eq!(exact.validate(), Ok(()));
        for viewpoint in viewpoints() {
            orders::check(&exact, viewpoint).unwrap();
        }
    }
}

#[test]
fn no_polygons_make_an_empty_tree() {
    let nothing: [[[f64; 3]; 4]; 0] = [];
    let tree = BspTree::build(nothing).unwrap();
    assert!(tree.is_empty() && tree.root().is_none());
    assert_eq!(tree.stats().depth_max, 0);
    check_orders(&nothing);
}

#[test]
fn one_polygon_is_one_fragment_on_its_own_plane() {
    let tree = BspTree::build([SQUARE]).unwrap();
    let corners: Vec<DVec3> = tree.fragment(0).vertices().collect();
    assert_eq!(corners, SQUARE.map(DVec3::from_array));
    assert!(tree.fragment(0).edges().eq([Some(0), Some(1), Some(2), Some(3)]));
    assert_eq!((tree.len(), tree.stats().nodes, tree.stats().depth_max), (1, 1, 1));
    check_orders(&[SQUARE]);
}

#[test]
fn polygons_without_area_are_dropped_and_counted() {
    let [a, b, c] = [1.0, 2.0, 3.0].map(|k| DVec3::new(1.0, 2.0, -3.0) * k);
    let degenerate = [
        vec![],
        vec![a],
        vec![a, b],
        vec![a, a, a],
        vec![b; 7],
        vec![a, b, a],
        vec![a, a, b],
        vec![a, b, c],
        vec![a, b, a, b],
        vec![a, b, c, b],
        vec![c, a, b, -a, c],
        vec![c, a, b, c, a, b],
        vec![a, b, c, (a + b) * 0.5, (b + c) * 0.5],
        vec![DVec3::ZERO, a, DVec3::X, a],
    ];
    let square = SQUARE.map(DVec3::from_array).to_vec();
    for polygon in &degenerate {
        // Alone, and beside a polygon with area.
        let tree = BspTree::build([polygon]).unwrap();
        let found = tree.preparation();
        assert!(tree.is_empty() && tree.faces().is_empty(), "{polygon:?}");
        assert_eq!((found.polygons, found.dropped), (1, 1), "{polygon:?}");
        let tree = BspTree::build([polygon, &square]).unwrap();
        assert_eq!(tree.preparation().dropped, 1, "{polygon:?}");
        assert_eq!(polygons(&tree, Viewpoint::eye([0.0, 0.0, 1.0])), [1]);
    }
    let tree = BspTree::build(&degenerate).unwrap();
    assert_eq!((tree.len(), tree.preparation().dropped), (0, degenerate.len()));
    check_orders(&degenerate);
    // Polygons with area keep their numbers.
    let mut some = degenerate.to_vec();
    some.insert(3, square);
    let tree = BspTree::build(&some).unwrap();
    assert_eq!(polygons(&tree, Viewpoint::eye([0.0, 0.0, 1.0])), [3]);
    assert_eq!(tree.preparation().dropped, degenerate.len());
}

#[test]
fn every_viewpoint_gives_every_fragment_once() {
    let turned = |k: usize| {
        SQUARE.map(|p| DVec3::new(p[k % 3] - 0.5, p[(k + 1) % 3], p[(k + 2) % 3] - 0.25))
    };
    check_orders(&[turned(0), turned(1), turned(2)]);
    check_orders(&[SQUARE; 9]);
}

#[test]
fn coordinates_that_are_not_finite_are_errors_that_name_the_polygon() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut polygons = [SQUARE; 5];
            polygons[3][2][axis] = bad;
            let error = BspTree::build(polygons).unwrap_err();
            assert_eq!(error.polygon(), Some(3));
            assert!(
                error.kind() != ErrorKind::OverBudget && error.to_string().contains('3'),
                "{error}"
            );
        }
    }
}

#[test]
fn a_tolerance_that_is_no_length_is_an_error() {
    for bad in [-1.0, f64::NAN, f64::NEG_INFINITY, -f64::MIN_POSITIVE, -5e-324] {
        let error = BuildOptions::DEFAULT.with_tolerance(bad).build([SQUARE]).unwrap_err();
        assert!(error.to_string().contains("tolerance"), "{error}");
    }
    for good in [0.0, -0.0, 5e-324, f64::MIN_POSITIVE, 1e300, f64::MAX, f64::INFINITY] {
        assert_eq!(BuildOptions::DEFAULT.with_tolerance(good).build([SQUARE]).unwrap().len(), 1);
    }
}

#[test]
fn coordinates_at_the_ends_of_the_range_are_taken() {
    for size in [5e-324, f64::MIN_POSITIVE, 1e-300, 1e300, f64::MAX] {
        let square = SQUARE.map(|[x, y, _]| [(2.0 * x - 1.0) * size, (2.0 * y - 1.0) * size, 0.0]);
        let upright = square.map(|[x, y, z]| [z, x, y]);
        let tree = BspTree::build([square, upright]).unwrap();
        assert_eq!(tree.validate(), Ok(()), "size {size:e}");
        assert_eq!(tree.len(), 3, "size {size:e}");
        check_orders(&[square, upright]);
    }
}
