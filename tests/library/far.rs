//! The default tolerance far from the origin, where numbers are coarse.

use binspace::Tolerance;
use binspace::glam::Vec3;
use binspace::partition::Extent;
use testkit::divided::extent;
use testkit::prelude::*;
use testkit::shapes::Claim;

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-6 * expected, "{found:e}, not {expected:e}");
}

/// The sides of a cube of side 1, at a place.
fn cube(at: DVec3) -> Vec<[DVec3; 4]> {
    let side = |axis: usize, level: f64| {
        let [j, k] = [(axis + 1) % 3, (axis + 2) % 3];
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| {
            let mut corner = DVec3::ZERO;
            (corner[axis], corner[j], corner[k]) = (level, u, v);
            at + corner
        })
    };
    (0..6).map(|k| side(k / 2, [0.0, 1.0][k % 2])).collect()
}

fn tolerance<P: Polygon>(polygons: impl IntoIterator<Item = P>) -> f64 {
    BspTree::build(polygons).unwrap().stats().tolerance
}

#[test]
fn of_f64_it_is_a_share_of_the_extent_until_steps_are_more() {
    for (at, expected) in [
        (0.0, 1e-9),
        (1e6, 1e-9),
        (1e9, 4.0 * f64::EPSILON * (1e9 + 1.0)),
        (2f64.powi(40), 4.0 * f64::EPSILON * 2f64.powi(40)),
    ] {
        near(tolerance(cube(DVec3::new(at, 0.0, 3.0))), expected);
    }
}

#[test]
fn of_f32_it_is_four_steps_of_the_largest_coordinate() {
    for at in [0.0, 100.0, -3000.0, 100_000.0] {
        let sides: Vec<[Vec3; 4]> =
            cube(DVec3::new(at, 0.0, 3.0)).iter().map(|side| side.map(|p| p.as_vec3())).collect();
        let largest = f64::max(4.0, (at + 1.0).abs().max(at.abs()));
        let steps = 4.0 * f64::from(f32::EPSILON) * largest;
        near(tolerance(&sides), steps.min(1.0 / 128.0).min(tolerance_limit()));
        // A box around the polygons does not change their precision.
        let room = [DVec3::new(at - 2.0, -2.0, 0.0), DVec3::new(at + 3.0, 2.0, 4.0)];
        let options = BuildOptions::DEFAULT.with_bounds(room[0], room[1]);
        let stats = options.build(&sides).unwrap().stats();
        near(stats.tolerance, steps.min(4.0 * tolerance_limit()));
    }
}

/// The largest tolerance of a scene of extent 1.
fn tolerance_limit() -> f64 {
    let options = BuildOptions::DEFAULT.with_tolerance(f64::INFINITY);
    options.build(cube(DVec3::ZERO)).unwrap().stats().tolerance
}

#[test]
fn claimed_precision_counts_up_to_a_share_of_the_extent_at_any_place() {
    for at in [0.0, 1e4, 5.4e6] {
        let sides = cube(DVec3::new(at, 0.0, 3.0));
        for (claimed, expected) in [(0.0, 1e-9), (1e-7, 1e-7), (0.04, 1e-5), (1e9, 1e-5)] {
            let claim = |side: &[DVec3; 4]| Claim { corners: side.to_vec(), precision: claimed };
            near(tolerance(sides.iter().map(claim)), expected);
        }
    }
}

#[test]
fn cells_have_the_tolerance_of_one_tree() {
    for at in [0.0, 1e4, 1e9] {
        let sides = cube(DVec3::new(at, 0.0, 3.0));
        let whole: Vec<Vec<DVec3>> = sides.iter().map(|side| side.to_vec()).collect();
        let single: Vec<[Vec3; 4]> = sides.iter().map(|side| side.map(|p| p.as_vec3())).collect();
        let mut coarse = Extent::default();
        single.iter().for_each(|side| coarse.include(side));
        let room = BuildOptions::DEFAULT
            .with_bounds(DVec3::new(at, -2.0, 0.0), DVec3::new(at + 2.0, 1.0, 5.0));
        for options in [BuildOptions::DEFAULT, room] {
            assert_eq!(options.tolerance, Tolerance::Default);
            let of_cells =
                |extent: Extent| options.partition(&extent, [DVec3::ZERO; 0], 1).unwrap();
            let tree = options.build(&whole).unwrap();
            assert_eq!(of_cells(extent(&whole)).tolerance(), tree.stats().tolerance);
            let tree = options.build(&single).unwrap();
            assert_eq!(of_cells(coarse).tolerance(), tree.stats().tolerance);
        }
    }
}
