//! Many polygons that meet in one place have one point there.

use std::f64::consts::{SQRT_2, TAU};
use testkit::prelude::*;

/// Integers of up to `bits` bits; most have all bits.
fn whole(dice: &mut Dice, bits: i32) -> DVec3 {
    let mut number = || ((2.0 * dice.share() - 1.0) * 2f64.powi(bits)).round();
    dvec3(number(), number(), number())
}

/// An edge through the lattice's centre, where another polygon has a corner and oblique polygons cut it. The
/// coordinates are 0 there, so their rounding error is not bounded by a share of their size.
#[test]
fn a_junction_at_the_centre_of_the_scene_is_one_point() {
    let mut dice = Dice(31);
    let mut cut = 0;
    for _ in 0..times(60) {
        let along = whole(&mut dice, 48);
        let mut polygons: Vec<Vec<DVec3>> = (0..3)
            .map(|_| {
                let (a, b) = (whole(&mut dice, 50), whole(&mut dice, 50));
                vec![a, b, -a, -b]
            })
            .collect();
        // A polygon with the long edge, and two polygons with edges that end at the centre.
        polygons.push(vec![along * 3.0, along * -2.0, whole(&mut dice, 50)]);
        polygons.push(vec![DVec3::ZERO, along * 3.0, whole(&mut dice, 50)]);
        polygons.push(vec![along * -2.0, DVec3::ZERO, whole(&mut dice, 50)]);
        // These polygons make the scene's box symmetric around the origin.
        let far = DVec3::splat(2f64.powi(51) - 1.0);
        for end in [far, -far] {
            polygons.push(vec![end, end * dvec3(0.99, 1.0, 1.0), end * dvec3(1.0, 0.99, 1.0)]);
        }
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_tolerance(0.0);
        let tree = options.build(&polygons).unwrap();
        let mesh = tree.welded_mesh().unwrap();
        let is_long = |f: &binspace::Fragment<'_>| f.polygon() == 3;
        cut += usize::from(tree.fragments().filter(is_long).count() > 1);
        // The long edge has one point at the centre, for any cuts.
        let mut points: Vec<u32> = mesh
            .vertices()
            .filter(|v| (3..6).contains(&v.polygon) && v.position.length() < 1.0)
            .map(|v| v.point)
            .collect();
        points.sort_unstable();
        points.dedup();
        assert_eq!(points.len(), 1, "{polygons:?}");
    }
    enough!(cut > 40; "{cut}");
}

/// All pages have the spine as an edge, and one plane cuts all pages. So one point has 40 000 names.
#[test]
fn a_book_of_many_pages_is_welded() {
    let pages = 40_000;
    let mut polygons =
        vec![vec![[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]]];
    polygons.extend((0..pages).map(|k| {
        // Angles are multiples of an irrational share of a turn, so that each page divides the rest about in
        // half.
        let (y, x) = (TAU * (f64::from(k) * SQRT_2).fract()).sin_cos();
        vec![[0.0, 0.0, -1.0], [x, y, -1.0], [x, y, 1.0], [0.0, 0.0, 1.0]]
    }));
    let tree = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).build(&polygons).unwrap();
    assert!(tree.len() > 2 * pages as usize);
    let mesh = tree.welded_mesh().unwrap();
    let on_spine = |at: &&DVec3| at.truncate() == binspace::glam::DVec2::ZERO;
    let heights: Vec<f64> = mesh.positions().iter().filter(on_spine).map(|at| at.z).collect();
    assert_eq!(heights.len(), 3, "{heights:?}");
    assert!(tree.mesh().unwrap().positions().len() == mesh.positions().len());
}
