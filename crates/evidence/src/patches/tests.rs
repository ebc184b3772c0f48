//! Form factors against closed formulas and sums of small parts.

use std::f64::consts::PI;
use testkit::prelude::*;

use super::{FormFactors, Patch, patches, seen};
use crate::rectangles::{above_a_point, facing, in_a_corner};
use binspace::internals::{SplitMix64, cuboid};

/// A room of 4 by 4 by 4, with fronts inside, and a body in the room if `with_body`.
fn room(with_body: bool) -> Vec<[DVec3; 4]> {
    let inwards = |[a, b, c, d]: [DVec3; 4]| [d, c, b, a];
    let walls = cuboid(DVec3::ZERO, DVec3::splat(4.0)).map(inwards);
    let body = cuboid(dvec3(1.0, 1.5, 1.0), dvec3(2.5, 2.5, 3.0));
    walls.into_iter().chain(body.into_iter().filter(|_| with_body)).collect()
}

fn factors(quads: &[[DVec3; 4]], length: f64, side: u32) -> (Vec<Patch>, FormFactors) {
    let tree = BspTree::build(quads.iter().copied()).unwrap();
    let patches = patches(quads, length);
    let found = FormFactors::new(&tree, &patches, side, 1);
    (patches, found)
}

#[test]
fn form_factors_of_a_cube_match_the_closed_formulas() {
    let (patches, found) = factors(&room(false), 1.0, 6);
    for quad in 0..6 {
        let wall = |to: usize| {
            let pairs = (0..256).map(|k| found.factor(16 * quad + k / 16, 16 * to + k % 16));
            pairs.sum::<f64>() / 16.0
        };
        for to in 0..6 {
            let truth = match to {
                _ if to == quad => 0.0,
                _ if to / 2 == quad / 2 => facing([4.0; 2], 4.0),
                _ => in_a_corner(4.0, 4.0, 4.0),
            };
            assert!((wall(to) - truth).abs() < 0.01, "{quad} {to}: {} for {truth}", wall(to));
        }
    }
    assert_eq!(patches.len(), 96);
}

#[test]
fn light_in_a_closed_room_is_conserved_within_a_bound_that_falls() {
    let mut one_way = Vec::new();
    let off = [1, 3, 9].map(|side| {
        let (patches, found) = factors(&room(true), 1.0, side);
        let n = patches.len();
        // The light is the same in both directions.
        let light = |i: usize, j: usize| found.factor(i, j) * patches[i].area();
        let all = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let off = all.map(|(i, j)| (light(i, j) - light(j, i)).abs()).sum::<f64>();
        one_way.push(off / patches.iter().map(Patch::area).sum::<f64>());
        (0..n).map(|i| (found.sum(i) - 1.0).abs()).sum::<f64>() / n as f64
    });
    assert!(off[1] < 0.5 * off[0] && off[2] < 0.5 * off[1] && off[2] < 0.02, "{off:?}");
    assert!(one_way[2] < 0.3 * one_way[0] && one_way[2] < 0.05, "{one_way:?}");
}

/// A rectangle in a level plane. Its front is above, or below if `is_turned`.
fn level(x: [f64; 2], y: [f64; 2], z: f64, is_turned: bool) -> [DVec3; 4] {
    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| dvec3(x[i], y[j], z));
    let [a, b, c, d] = corners;
    if is_turned { [d, c, b, a] } else { corners }
}

/// The form factor from the first quad to the second, with the other quads as obstacles.
fn factor(quads: &[[DVec3; 4]], side: u32) -> f64 {
    let tree = BspTree::build(quads.iter().copied()).unwrap();
    let whole = patches(&quads[..2], 1e9);
    FormFactors::new(&tree, &whole, side, 3).factor(0, 1)
}

#[test]
fn rectangles_of_other_shapes_match_the_closed_formulas() {
    let floor = level([0.0, 2.0], [0.0, 3.0], 0.0, false);
    let over = level([0.0, 2.0], [0.0, 3.0], 1.5, true);
    let wall = [(0.0, 0.0), (3.0, 0.0), (3.0, 4.0), (0.0, 4.0)].map(|(y, z)| dvec3(0.0, y, z));
    for (other, truth) in [(over, facing([2.0, 3.0], 1.5)), (wall, in_a_corner(3.0, 2.0, 4.0))] {
        let off = [4, 16, 64].map(|side| (factor(&[floor, other], side) / truth - 1.0).abs());
        assert!(off[0] < 0.05 && off[1] < 0.01 && off[2] < 0.001, "{off:?}");
    }
}

/// A small patch sees a large wall through a window in a screen. The form factor of the wall is the form
/// factor of the window.
#[test]
fn a_wall_behind_a_window_gets_the_form_factor_of_the_window() {
    let small = level([-1e-3, 1e-3], [-1e-3, 1e-3], 0.0, false);
    let wall = level([-40.0, 40.0], [-40.0, 40.0], 4.0, true);
    // The window is one unit above the patch. It reaches from the point straight above the patch to 2 in x
    // and 3 in y.
    let ([low, high], reach) = ([0.0, 0.0], 90.0);
    let [right, up] = [2.0, 3.0];
    let screen = [
        level([-reach, low], [-reach, reach], 1.0, true),
        level([right, reach], [-reach, reach], 1.0, true),
        level([low, right], [-reach, high], 1.0, true),
        level([low, right], [up, reach], 1.0, true),
    ];
    let quads = [[small, wall].as_slice(), &screen].concat();
    let truth = above_a_point([2.0, 3.0], 1.0);
    let off = [8, 128].map(|side| (factor(&quads, side) / truth - 1.0).abs());
    assert!(off[1] < 0.03 && off[1] < off[0], "{off:?}");
}

/// A screen right above a patch, at a thousandth of the way, hides everything.
#[test]
fn screens_near_an_end_of_a_sight_line_block_it() {
    let floor = level([0.0, 2.0], [0.0, 3.0], 0.0, false);
    let over = level([0.0, 2.0], [0.0, 3.0], 1.5, true);
    for height in [1.5e-3, 1.5 - 1.5e-3] {
        let screen = level([-1.0, 3.0], [-1.0, 4.0], height, true);
        assert_eq!(factor(&[floor, over, screen], 8), 0.0, "{height}");
    }
}

/// The form factor from a point to a patch equals a sum over small parts, also for patches partly below the
/// point's horizon.
#[test]
fn the_point_form_factor_is_the_sum_over_small_parts() {
    const PARTS: u32 = 200;
    let mut random = SplitMix64::new(6);
    let (mut cut, mut compared) = (0, 0);
    for _ in 0..60 {
        let [x, y] = [0, 1].map(|_| random.range(0.5, 2.0));
        let patch = Patch { corners: level([-x, x], [-y, y], 0.0, false), quad: 0 };
        let point = dvec3(random.range(-2.0, 2.0), random.range(-2.0, 2.0), random.range(0.5, 2.0));
        let normal = random.point(-1.0, 1.0).normalize();
        let part = |k: u32| 2.0 * (f64::from(k) + 0.5) / f64::from(PARTS) - 1.0;
        let of_part = |k: u32| {
            let way = dvec3(x * part(k % PARTS), y * part(k / PARTS), 0.0) - point;
            let slopes = normal.dot(way).max(0.0) * -way.z;
            slopes / (PI * way.length_squared().powi(2))
        };
        let area = 4.0 * x * y / f64::from(PARTS * PARTS);
        let truth = area * (0..PARTS * PARTS).map(of_part).sum::<f64>();
        let found = seen(point, normal, &patch);
        assert!((found - truth).abs() < 1e-4, "{found} {truth}");
        let above = patch.corners.iter().filter(|&&c| normal.dot(c - point) > 0.0).count();
        cut += usize::from((1..4).contains(&above));
        compared += usize::from(truth > 0.01);
    }
    assert!(cut > 15 && compared > 20, "{cut} {compared}");
}
