//! Tests the statements in the docs of `BspTree::hits` and `BspTree::is_occluded` on hand-made cases.

use binspace::{Facing, Ray};
use testkit::prelude::*;

fn square(z: f64) -> Vec<[f64; 3]> {
    vec![[0.0, 0.0, z], [4.0, 0.0, z], [4.0, 4.0, z], [0.0, 4.0, z]]
}

/// Polygon, parameter and side of each hit.
fn hits(tree: &BspTree, ray: Ray) -> Vec<(usize, f64, Facing)> {
    tree.hits(ray).map(|hit| (hit.polygon(), hit.parameter(), hit.facing())).collect()
}

#[test]
fn sides_and_parameters() {
    let tree = BspTree::build([square(0.0), square(2.0)]).unwrap();
    let down = Ray::new([1.0, 1.0, 4.0], [0.0, 0.0, -0.5]);
    assert_eq!(hits(&tree, down), [(1, 4.0, Facing::Front), (0, 8.0, Facing::Front)]);
    let up = Ray::between([1.0, 1.0, -1.0], [1.0, 1.0, 3.0]);
    assert_eq!(hits(&tree, up), [(0, 0.25, Facing::Back), (1, 0.75, Facing::Back)]);
    // Both ends count. At the start, a polygon is hit from the side from which a longer ray would come.
    let between = Ray::between([1.0, 1.0, 0.0], [1.0, 1.0, 2.0]);
    assert_eq!(hits(&tree, between), [(0, 0.0, Facing::Back), (1, 1.0, Facing::Back)]);
    assert!(!tree.is_occluded(between));
    assert!(tree.is_occluded(Ray::between([1.0, 1.0, 0.0], [1.0, 1.0, 2.0_f64.next_up()])));
    assert!(tree.is_occluded(Ray::new([1.0, 1.0, 0.0], [0.0, 0.0, 1e-300])));
    assert!(!tree.is_occluded(Ray::new([1.0, 1.0, 0.0], [0.0, 0.0, -1e300])));
}

#[test]
fn edges_and_corners_belong_to_a_polygon() {
    // Two squares that share an edge, and a third square that cuts one of them.
    let right = vec![[4.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 4.0, 0.0], [4.0, 4.0, 0.0]];
    let upright = vec![[2.0, -9.0, -9.0], [2.0, 9.0, -9.0], [2.0, 9.0, 9.0], [2.0, -9.0, 9.0]];
    let tree = BspTree::build([square(0.0), right, upright]).unwrap();
    enough!(tree.len() > 3; "one is cut");
    let down = |x: f64, y: f64| -> Vec<usize> {
        let ray = Ray::new([x, y, 5.0], [0.0, 0.0, -1.0]);
        tree.hits(ray).map(|hit| hit.polygon()).collect()
    };
    assert_eq!(down(4.0, 1.0), [0, 1]);
    assert_eq!(down(4.0, 0.0), [0, 1]);
    assert_eq!(down(0.0, 0.0), [0]);
    // A ray along the polygon, through the cut, hits it once.
    assert_eq!(down(2.0, 1.0), [2, 0]);
    assert_eq!(down(-1e-30, 1.0), [0; 0]);
    assert_eq!(down(8.0_f64.next_up(), 1.0), [0; 0]);
}

#[test]
fn a_ray_in_the_plane_of_a_polygon_hits_it_where_it_enters() {
    let upright = vec![[2.0, -9.0, -9.0], [2.0, 9.0, -9.0], [2.0, 9.0, 9.0], [2.0, -9.0, 9.0]];
    let tree = BspTree::build([square(0.0), square(2.0), upright]).unwrap();
    let along = Ray::between([-4.0, 1.0, 0.0], [12.0, 1.0, 0.0]);
    // The ray goes through two fragments of the square, and through the upright square.
    assert_eq!(hits(&tree, along), [(0, 0.25, Facing::EdgeOn), (2, 0.375, Facing::Back)]);
    let inside = Ray::new([1.0, 1.0, 0.0], [0.0, 1.0, 0.0]);
    assert_eq!(hits(&tree, inside), [(0, 0.0, Facing::EdgeOn)]);
    // Rays along an edge, and through a corner only.
    assert_eq!(hits(&tree, Ray::new([-1.0, 0.0, 0.0], [2.0, 0.0, 0.0]))[0].1, 0.5);
    let corner = Ray::between([-1.0, 1.0, 2.0], [1.0, -1.0, 2.0]);
    assert_eq!(hits(&tree, corner), [(1, 0.5, Facing::EdgeOn)]);
    assert!(tree.is_occluded(corner));
    assert!(tree.is_occluded(Ray::between([0.0, 0.0, 0.0], [1.0, 0.0, 0.0])));
    // Only the last point of the ray touches.
    assert!(!tree.is_occluded(Ray::between([-1.0, 1.0, 0.0], [0.0, 1.0, 0.0])));
    assert_eq!(hits(&tree, Ray::between([-1.0, 1.0, 0.0], [0.0, 1.0, 0.0]))[0].1, 1.0);
}

#[test]
fn coplanar_polygons_come_in_input_order_from_both_sides() {
    let tree = BspTree::build([square(0.0), square(1.0), square(0.0), square(0.0)]).unwrap();
    for (from, expected) in [(9.0, [1, 0, 2, 3]), (-9.0, [0, 2, 3, 1])] {
        let ray = Ray::between([1.0, 1.0, from], [1.0, 1.0, -from]);
        assert!(tree.hits(ray).map(|hit| hit.polygon()).eq(expected));
        let all: Vec<_> = tree.hits(ray).collect();
        for (i, a) in all.iter().enumerate() {
            for (j, b) in all.iter().enumerate() {
                let touch = expected[i] != 1 && expected[j] != 1;
                assert_eq!(a.compare(b), if touch { Ordering::Equal } else { i.cmp(&j) });
            }
        }
    }
}

#[test]
fn a_polygon_that_is_not_convex_is_hit_wherever_it_is_entered() {
    // A comb of three teeth, and a bent square.
    let comb = [
        [0.0, 0.0],
        [5.0, 0.0],
        [5.0, 2.0],
        [4.0, 2.0],
        [4.0, 1.0],
        [3.0, 1.0],
        [3.0, 2.0],
        [2.0, 2.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
    ];
    let comb = comb.map(|[x, y]| [x, y, 0.0]).to_vec();
    let bent = vec![[10.0, 5.0, 0.0], [12.0, 5.0, 0.0], [12.0, 7.0, 1.0], [10.0, 7.0, 0.0]];
    let tree = BspTree::build([comb, bent]).unwrap();
    let parameters = |ray: Ray| hits(&tree, ray).iter().map(|hit| hit.1).collect::<Vec<_>>();
    assert_eq!(parameters(Ray::new([-1.0, 1.5, 0.0], [1.0, 0.0, 0.0])), [1.0, 3.0, 5.0]);
    // The ray runs along edges from the start of the teeth, and does not leave the polygon.
    assert_eq!(parameters(Ray::new([-1.0, 1.0, 0.0], [1.0, 0.0, 0.0])), [1.0]);
    assert_eq!(parameters(Ray::new([2.5, 1.5, 1.0], [0.0, 0.0, -1.0])), [1.0]);
    // The ray goes through both triangles, for either diagonal.
    assert_eq!(hits(&tree, Ray::new([11.0, 6.0, 9.0], [0.0, 0.0, -1.0])).len(), 1);
}

#[test]
fn invalid_rays_hit_nothing() {
    let tree = BspTree::build([square(0.0)]).unwrap();
    let good = DVec3::new(1.0, 1.0, 1.0);
    assert_eq!(tree.hits(Ray::new(good, DVec3::NEG_Z)).count(), 1);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e40] {
        for axis in 0..3 {
            let mut point = good;
            point[axis] = bad;
            for ray in [
                Ray::new(point, DVec3::NEG_Z),
                Ray::between(point, -good),
                Ray::between(-good, point),
            ] {
                assert_eq!((tree.hits(ray).count(), tree.is_occluded(ray)), (0, false), "{ray:?}");
            }
            assert_eq!(tree.locate(point), None);
            if !bad.is_finite() {
                let mut direction = DVec3::NEG_Z;
                direction[axis] = bad;
                let ray = Ray::new(good, direction);
                assert_eq!((tree.hits(ray).count(), tree.is_occluded(ray)), (0, false));
            }
        }
    }
    let nothing = BspTree::build::<[[f64; 3]; 3]>([]).unwrap();
    assert_eq!(nothing.hits(Ray::new(good, DVec3::NEG_Z)).count(), 0);
    assert!(!nothing.is_occluded(Ray::new(good, DVec3::NEG_Z)));
}

/// Directions of any length, and rays from the largest allowed distance.
#[test]
fn parameters_follow_the_direction() {
    let tree = BspTree::build([square(0.0), square(-3.0)]).unwrap();
    for length in [5e-324, 1e-300, 0.1, 7.0, 1e300] {
        let ray = Ray::new([1.0, 1.0, 6.0], [0.0, 0.0, -length]);
        let parameters: Vec<f64> = tree.hits(ray).map(|hit| hit.parameter()).collect();
        assert_eq!(parameters, [6.0 / length, 9.0 / length]);
        assert_eq!(tree.hits(ray).next().unwrap().point(), DVec3::new(1.0, 1.0, 0.0));
    }
    for distance in [1e3, 1e9, 1e15, 1e20] {
        let target = DVec3::new(1.0, 1.0, -distance);
        let ray = Ray::between([1.0, 1.0, distance], target);
        assert!(tree.hits(ray).map(|hit| hit.polygon()).eq([0, 1]), "{distance}");
        let slanted = Ray::between([distance, distance, distance], [-1.0, -1.0, -1.0]);
        assert!(tree.hits(slanted).map(|hit| hit.polygon()).eq([0]), "{distance}");
    }
}

/// Iterators over hits behave like other iterators of the library.
#[test]
fn hits_can_be_copied_and_keep_returning_none() {
    let tree = BspTree::build((0..20).map(|k| square(f64::from(k)))).unwrap();
    let mut hits = tree.hits(Ray::new([1.0, 2.0, 30.0], [0.0, 0.0, -1.0]));
    assert_eq!(hits.next().map(|hit| hit.polygon()), Some(19));
    let rest = hits.clone();
    assert!(rest.map(|hit| hit.polygon()).eq((0..19).rev()));
    assert!(hits.by_ref().skip(18).map(|hit| hit.polygon()).eq([0]));
    assert!(hits.next().is_none() && hits.next().is_none());
    assert!(format!("{hits:?}").contains("Hits"));
}

/// Scenes of any size are hit. (If the units of a ray differ much from the scene's, boxes are not used.)
#[test]
fn scenes_of_every_size_are_hit() {
    for scale in [1e-300, 1e-260, 1e-180, 1.0, 1e180, 1e250, 1e300] {
        let squares = [0.0, 2.0, 1.0].map(|z| square(z).into_iter().map(|p| p.map(|c| c * scale)));
        let tree = BspTree::build(squares.map(Vec::from_iter)).unwrap();
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * scale;
        for ray in [
            Ray::new(at(1.0, 1.0, 5.0), [0.0, 0.0, -1.0]),
            Ray::new(at(1.0, 1.0, 5.0), at(0.0, 0.0, -1.0)),
            Ray::between(at(1.0, 1.0, 5.0), at(1.5, 1.5, -1.0)),
        ] {
            assert!(tree.hits(ray).map(|hit| hit.polygon()).eq([1, 2, 0]), "{scale}: {ray:?}");
            assert!(tree.is_occluded(ray), "{scale}: {ray:?}");
        }
        let beside = Ray::new(at(5.0, 1.0, 5.0), [0.0, 0.0, -1.0]);
        assert!(tree.hits(beside).next().is_none() && !tree.is_occluded(beside));
    }
}

/// Both ends are finite, but the vector from one end to the other is not.
#[test]
fn a_segment_longer_than_any_number_hits_the_polygons_on_it() {
    let most = 1.5 * 2.0_f64.powi(1023);
    let square = |z: f64| {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [most * x, most * y, z])
    };
    let tree = BspTree::build([0.0, 0.5 * most, -0.5 * most].map(square)).unwrap();
    for slope in [0.0, 0.25, 1.0] {
        for (turn, expected) in [(1.0, [2, 0, 1]), (-1.0, [1, 0, 2])] {
            let end = |z: f64| DVec3::new(slope * z, -0.5 * slope * z, z * turn);
            let ray = Ray::between(end(-most), end(most));
            let shares: Vec<f64> = tree.hits(ray).map(|hit| hit.parameter()).collect();
            assert_eq!(shares, [0.25, 0.5, 0.75], "{ray:?}");
            assert!(tree.hits(ray).map(|hit| hit.polygon()).eq(expected), "{ray:?}");
            assert!(tree.is_occluded(ray), "{ray:?}");
        }
    }
}
