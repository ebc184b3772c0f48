//! Compares Newell's algorithm with brute force, and tests cycles.

use glam::DQuat;
use testkit::prelude::*;

use super::oracle::nearest;
use super::{Polygons, cameras, cycle_that_no_plane_cuts, disjoint, faces, polygons_of, show};
use crate::method::{Method, Newell};
use binspace::internals::SplitMix64;
use binspace::raster::NONE;

/// Asserts that every pixel for which brute force is certain shows the result of brute force. Returns the
/// number of pieces of all views together.
fn assert_right(name: &str, polygons: &Polygons, cameras: &[Camera]) -> usize {
    let faces = faces(polygons, Some(0.0));
    let (mut certain, mut all, mut pieces) = (0, 0, 0);
    for camera in cameras {
        let painted = show(&Newell::DEFAULT, &faces, camera);
        let [width, _] = camera.size();
        for (pixel, &face) in (0u32..).zip(painted.image.faces()) {
            let (x, y) = (pixel % width, pixel / width);
            all += 1;
            let Some(expected) = nearest(polygons, camera, x, y) else { continue };
            certain += 1;
            let shown = (face != NONE).then(|| faces.polygon(face) as u32);
            assert_eq!(shown, expected, "{name}: {camera:?} at ({x}, {y})");
        }
        pieces += painted.pieces;
    }
    assert!(certain * 100 > all * 97, "{name}: {certain} of {all} pixels are certain");
    pieces
}

/// A square around the origin whose corners are moved by `place`.
fn square(half: f64, place: impl Fn(f64, f64) -> DVec3) -> Vec<DVec3> {
    [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| place(x, y)).to_vec()
}

#[test]
fn disjoint_triangles_agree_with_brute_force() {
    for seed in 0..3 {
        let polygons = disjoint(5, seed);
        assert_right("disjoint", &polygons, &cameras(&polygons, [48, 36], seed));
    }
}

#[test]
fn crossing_and_cyclic_scenes_agree_with_brute_force() {
    let scenes = [scene::newell_bars(), scene::crossing(6), scene::random_triangles(60, 5)];
    for scene in scenes {
        let polygons = polygons_of(&scene);
        let views = cameras(&polygons, [48, 36], 7);
        let pieces = assert_right(scene.name(), &polygons, &views);
        assert!(pieces > 0, "{}", scene.name());
    }
}

#[test]
fn thin_layers_agree_with_brute_force() {
    // Tilted by more than their distance, in alternating directions, in no order of depth.
    let layer = |i: u32| {
        let height = 1e-3 * f64::from(i * 7 % 20);
        let (tilt, reach) = (2e-4 * f64::from(i % 3) - 2e-4, 0.3 + 0.03 * f64::from(i * 3 % 20));
        square(reach, |x, y| {
            let y = y + 0.1 * f64::from(i % 4);
            DVec3::new(x, y, height + tilt * (x + y) + 0.3 * x)
        })
    };
    let polygons: Polygons = (0..20).map(layer).collect();
    let views = cameras(&polygons, [48, 36], 11);
    assert_right("thin layers", &polygons, &views);
    assert_right("thin layers", &polygons, &from_above(2.5, [40, 40]));
}

#[test]
fn polygons_just_behind_the_nearest_corner_are_compared() {
    // A slope that reaches far down, and a small square just below its upper end.
    let slope = square(1.0, |x, y| DVec3::new(x, y, x));
    let square = [(0.994, -0.01), (1.005, -0.01), (1.005, 0.01), (0.994, 0.01)];
    let square = square.map(|(x, y)| DVec3::new(x, y, 0.994)).to_vec();
    let (down, centre) = (DVec3::NEG_Z, DVec3::new(1.0, 0.0, 0.0));
    let camera = Camera::parallel(down, DVec3::Y, centre, 0.04, [40, 40]).unwrap();
    assert_right("a slope", &vec![slope, square], &[camera]);
}

/// From above, and from an eye above.
fn from_above(height: f64, size: [u32; 2]) -> [Camera; 2] {
    let eye = DVec3::new(0.03, 0.02, 4.0);
    let perspective = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.6, size).unwrap();
    let down = DVec3::new(0.01, 0.02, -1.0);
    [perspective, Camera::parallel(down, DVec3::Y, DVec3::ZERO, height, size).unwrap()]
}

/// The cycle of three bars: each bar is over the next at one end.
fn three_bars() -> Polygons {
    let bar = |number: i32| {
        let corner = |x: f64, y: f64, z: f64| {
            let (sin, cos) = (f64::from(number) * std::f64::consts::TAU / 3.0).sin_cos();
            DVec3::new(x * cos - y * sin, x * sin + y * cos, z)
        };
        let (low, high) = (-0.2, 0.2);
        vec![
            corner(-1.0, -0.5, low),
            corner(1.0, -0.5, high),
            corner(1.0, -0.3, high),
            corner(-1.0, -0.3, low),
        ]
    };
    (0..3).map(bar).collect()
}

#[test]
fn a_cycle_of_three_is_cut() {
    for camera in from_above(2.5, [60, 60]) {
        let pieces = assert_right("three bars", &three_bars(), &[camera]);
        // One cut would suffice, but each plane cuts both other bars, which counts as penetration.
        assert!((4..=7).contains(&pieces), "{pieces}");
    }
}

/// Spikes along the sides of a polygon around the z axis. Where two spikes meet, each is over the next, and
/// the last is over the first. (Spikes are triangles, which stay planar if they are rotated.)
fn random_ring(random: &mut SplitMix64) -> Polygons {
    let count = 3 + random.next() % 6;
    let angle = |i: u64| std::f64::consts::TAU * (i % count) as f64 / count as f64;
    let mut between =
        |low: f64, high: f64| low + (high - low) * 0.5 * (random.range(-1.0, 1.0) + 1.0);
    let corners: Vec<DVec3> = (0..count)
        .map(|i| between(0.8, 1.0) * DVec3::new(angle(i).cos(), angle(i).sin(), 0.0))
        .collect();
    let heights: Vec<f64> = corners.iter().map(|_| between(0.02, 0.2)).collect();
    let mut spike = |i: usize| {
        let next = (i + 1) % corners.len();
        let from = corners[i] - DVec3::Z * heights[i];
        let along = corners[next] + DVec3::Z * heights[next] - from;
        let (start, end) = (from - 0.2 * along, from + 1.2 * along);
        let side = 0.5 * between(0.05, 0.1) * along.cross(DVec3::Z).normalize();
        vec![start - side, start + side, end]
    };
    (0..count as usize).map(&mut spike).collect()
}

fn any_turn(random: &mut SplitMix64) -> DQuat {
    let axis = random.point(-1.0, 1.0).normalize();
    DQuat::from_axis_angle(axis, 3.0 * random.range(-1.0, 1.0))
}

#[test]
fn random_cycles_agree_with_brute_force() {
    let mut random = SplitMix64::new(17);
    for number in 0..24 {
        let ring = random_ring(&mut random);
        let turn = any_turn(&mut random);
        let (scale, shift) = (10f64.powf(random.range(-1.0, 1.0)), 4.0 * random.point(-1.0, 1.0));
        let place = |point: DVec3| turn * point * scale + shift;
        let polygons: Polygons =
            ring.iter().map(|spike| spike.iter().map(|&corner| place(corner)).collect()).collect();
        // From above, the whole ring is visible, and no order of whole spikes is right.
        let eye =
            place(DVec3::new(0.3 * random.range(-1.0, 1.0), 0.3 * random.range(-1.0, 1.0), 4.0));
        let [target, up] = [place(DVec3::ZERO), turn * DVec3::Y];
        let above = Camera::perspective(eye, target, up, 0.8, [60, 60]).unwrap();
        let name = format!("ring {number} of {}", ring.len());
        let pieces = assert_right(&name, &polygons, &[above]);
        assert!(pieces > ring.len(), "{name}: {pieces}");
        assert_right(&name, &polygons, &cameras(&polygons, [48, 36], number));
    }
}

#[test]
fn random_cycles_in_each_other_agree_with_brute_force() {
    let mut random = SplitMix64::new(23);
    for number in 0..8 {
        let mut polygons = Polygons::new();
        for _ in 0..3 {
            let turn = any_turn(&mut random);
            let shift = 0.3 * random.point(-1.0, 1.0);
            let place = |spike: Vec<DVec3>| spike.iter().map(|&c| turn * c + shift).collect();
            polygons.extend(random_ring(&mut random).into_iter().map(place));
        }
        let views = cameras(&polygons, [48, 36], number);
        assert_right(&format!("rings {number}"), &polygons, &views);
    }
}

#[test]
fn two_crossing_polygons_become_three_pieces() {
    let tilted = |tilt: f64| square(1.0, |x, y| DVec3::new(x, y, tilt * x));
    for camera in from_above(2.5, [40, 40]) {
        assert_eq!(assert_right("a cross", &vec![tilted(0.5), tilted(-0.4)], &[camera]), 3);
    }
}

#[test]
fn a_cycle_that_no_plane_cuts_is_cut_along_an_outline() {
    for camera in from_above(2.5, [60, 60]) {
        let pieces = assert_right("blades", &cycle_that_no_plane_cuts(), &[camera]);
        assert!((6..=15).contains(&pieces), "{pieces}");
    }
}

/// The upper layer reaches further down the slope, so a sort by depth alone would paint it first.
#[test]
fn layers_much_further_apart_than_the_epsilon_are_told_apart() {
    let slope = |half, lift: f64| square(half, |x, y| DVec3::new(x, y, x + lift));
    let polygons = vec![slope(1.0, 1e-8), slope(0.5, 0.0)];
    let faces = faces(&polygons, Some(0.0));
    for camera in from_above(2.5, [40, 40]) {
        let painted = show(&Newell::DEFAULT, &faces, &camera);
        let shown = painted.image.faces().iter().filter(|&&face| face != NONE);
        assert!(shown.map(|&face| faces.polygon(face)).all(|polygon| polygon == 0));
    }
}

#[test]
fn scenes_with_an_order_are_not_cut() {
    let polygons = polygons_of(&scene::layers(40, 0.01));
    let faces = faces(&polygons, Some(0.0));
    for camera in cameras(&polygons, [32, 24], 2) {
        assert!(show(&Newell::DEFAULT, &faces, &camera).pieces <= faces.len());
    }
}

#[test]
fn errors_of_budgets_name_the_limit() {
    let polygons = polygons_of(&scene::random_triangles(60, 5));
    let faces = faces(&polygons, None);
    let camera = cameras(&polygons, [32, 24], 2)[0];
    let rays = Rays::new(&camera, &faces).unwrap();
    let fails = |method: Newell, figure: &str| {
        let error = method.prepare(&faces).unwrap().paint(&camera, &rays).unwrap_err();
        assert!(error.is_over_budget());
        assert!(error.to_string().contains(figure), "{error}");
    };
    fails(Newell { max_pieces: 61, ..Newell::DEFAULT }, "more than 61 pieces");
    fails(Newell { max_comparisons: 99, ..Newell::DEFAULT }, "more than 99 pairs");
}

#[test]
fn a_long_chain_of_swaps_needs_no_stack() {
    // Parallel and tilted: the higher a plank, the deeper it reaches. So the highest of the remaining planks
    // is always the furthest, and all others take its place, one after the other.
    let count = 4000;
    let plank = |i: i32| {
        let (height, reach) = (1e-4 * f64::from(i), -1.0 - 1e-3 * f64::from(i));
        let corners = [(reach, -1.0), (1.0, -1.0), (1.0, 1.0), (reach, 1.0)];
        corners.map(|(x, y)| DVec3::new(x, y, height + x)).to_vec()
    };
    let polygons: Polygons = (0..count).map(plank).collect();
    let faces = faces(&polygons, Some(0.0));
    let (down, size) = (DVec3::NEG_Z, [12, 12]);
    let camera = Camera::parallel(down, DVec3::Y, DVec3::ZERO, 12.0, size).unwrap();
    let paint = move || {
        let painted = show(&Newell::DEFAULT, &faces, &camera);
        assert_eq!(painted.pieces, 4000);
        assert_eq!(painted.image.faces()[6 * 12 + 6], 3999);
    };
    std::thread::Builder::new().stack_size(1 << 17).spawn(paint).unwrap().join().unwrap();
}

/// Two squares, or polygons in their place. P, the further, comes first. One test decides each pair.
#[test]
fn each_test_decides_the_pair_that_it_is_for() {
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 12.0, [120, 120]).unwrap();
    let points = |corners: &[[f64; 3]]| -> Vec<DVec3> {
        corners.iter().map(|&c| DVec3::from_array(c)).collect()
    };
    // P reaches from depth 2 down to depth 5, at z = −2 and −5.
    let p = [[0.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 2.0, -5.0], [0.0, 2.0, -5.0]];
    let moved = |x: f64, y: f64, z: f64| p.map(|[a, b, c]| [a + x, b + y, c + z]);
    let counts = |other: &[[f64; 3]]| {
        let faces = faces(&vec![points(&p), points(other)], Some(0.0));
        Newell::DEFAULT.decisions(&faces, &camera).unwrap()
    };
    // Q is to the right of P; above P; or just in front of P's plane. Or Q is a triangle with P behind its
    // plane, but not all of Q is in front of P's plane. Or only the box of Q overlaps P.
    let right = counts(&moved(3.0, 0.0, 0.5));
    assert_eq!((right.compared, right.by_test), (1, [1, 0, 0, 0, 0]));
    let above = counts(&moved(0.0, 3.0, 0.5));
    assert_eq!((above.compared, above.by_test), (1, [0, 1, 0, 0, 0]));
    let over = counts(&moved(0.0, 0.0, 0.5));
    assert_eq!((over.compared, over.by_test), (1, [0, 0, 1, 0, 0]));
    // The plane of Q, z = −4.5 + x, cuts P, but all of Q is in front of P's plane.
    let steep = counts(&[[0.5, 1.5, -4.0], [1.5, 1.5, -3.0], [1.5, 1.9, -3.0], [0.5, 1.9, -4.0]]);
    assert_eq!((steep.compared, steep.by_test), (1, [0, 0, 0, 1, 0]));
    // Q is beside a corner of P. The plane of Q cuts P, and Q is on both sides of P's plane.
    let beside = counts(&[[1.5, 2.6, -4.5], [2.6, 1.5, -4.5], [2.6, 2.6, -3.0]]);
    assert_eq!((beside.compared, beside.by_test), (1, [0, 0, 0, 0, 1]));
    // Q is behind P's plane, but nearer than P's furthest vertex, so Q takes P's place.
    let below = counts(&[[0.5, 0.2, -4.5], [1.5, 0.2, -4.5], [1.5, 0.6, -4.5], [0.5, 0.6, -4.5]]);
    assert_eq!((below.moved, below.cuts, below.painted), (1, 0, 2));
    // Q goes through P.
    let through = counts(&[[0.5, 0.2, -3.5], [1.5, 0.2, -3.5], [1.5, 1.8, -3.5], [0.5, 1.8, -3.5]]);
    assert_eq!((through.cuts, through.begun, through.painted), (1, 2, 3));
}

#[test]
fn every_compared_pair_is_decided_moved_cut_or_passed() {
    let mut compared = 0;
    for scene in [scene::newell_bars(), scene::crossing(6), scene::random_triangles(60, 5)] {
        let polygons = polygons_of(&scene);
        let faces = faces(&polygons, Some(0.0));
        for camera in cameras(&polygons, [48, 36], 7) {
            let found = Newell::DEFAULT.decisions(&faces, &camera).unwrap();
            let decided = found.of_one_face + found.by_test.iter().sum::<u64>();
            assert_eq!(found.compared, decided + found.moved + found.cuts + found.passed);
            assert_eq!(found.painted, found.begun + found.cuts as usize);
            assert_eq!(found.painted, show(&Newell::DEFAULT, &faces, &camera).pieces);
            compared += found.compared;
        }
    }
    assert!(compared > 1000, "{compared}");
}
