//! Compares the kept polygons with exact pictures.

use super::Cells;
use super::outline::{Plane, apart, clip, hull, split, without};
use super::sight::{NEAREST, SLACK};
use crate::interior;
use binspace::internals::SplitMix64;
use binspace::raster::{NONE, zbuffer};
use testkit::prelude::*;

/// The polygons that are visible in a pixel of a picture.
fn owners(tree: &BspTree, camera: &Camera) -> Vec<usize> {
    let rays = Rays::new(camera, tree.faces()).unwrap();
    let depth = zbuffer(&rays, tree.faces());
    let shown = depth.image().faces().iter().filter(|&&face| face != NONE);
    let mut owners: Vec<usize> = shown.map(|&face| tree.faces().polygon(face)).collect();
    owners.sort_unstable();
    owners.dedup();
    owners
}

#[test]
fn no_polygon_that_owns_a_pixel_is_left_out() {
    let level = interior::rooms(5);
    let tree = BspTree::build(&level).unwrap();
    let cells = Cells::new(&tree, level.len());
    let mut random = SplitMix64::new(5);
    let (mut owned, mut kept, mut kept_by_cell) = (0, 0, 0);
    for _ in 0..60 {
        let eye = dvec3(random.range(0.1, 39.9), random.range(0.1, 39.9), random.range(0.2, 2.9));
        let target = eye + random.point(-1.0, 1.0) * dvec3(1.0, 1.0, 0.3);
        let camera = Camera::perspective(eye, target, DVec3::Z, 1.2, [96, 72]).unwrap();
        let seen = cells.seen_from(eye, &camera.frustum());
        let at: Vec<usize> = cells.at(eye);
        assert_eq!(at.len(), 1);
        let from_cell = cells.seen_from_cell(at[0]);
        for polygon in owners(&tree, &camera) {
            assert!(seen.polygons[polygon], "{polygon} from {eye}");
            assert!(from_cell.polygons[polygon], "{polygon} from the cell of {eye}");
            owned += 1;
        }
        // An eye sees less than its cell.
        for (&by_eye, &by_cell) in seen.polygons.iter().zip(&from_cell.polygons) {
            assert!(!by_eye || by_cell);
        }
        kept += seen.polygon_count();
        kept_by_cell += from_cell.polygon_count();
    }
    let all = 60 * level.len();
    assert!(owned > 400, "{owned}");
    assert!(kept * 4 < 5 * owned, "{kept} of {owned}");
    assert!(kept_by_cell < all / 2, "{kept_by_cell} of {all}");
}

/// Eyes almost in the planes of doors, where roundings have the largest effect.
#[test]
fn nothing_is_left_out_from_the_threshold_of_a_door() {
    let level = interior::rooms(4);
    let tree = BspTree::build(&level).unwrap();
    let cells = Cells::new(&tree, level.len());
    let mut random = SplitMix64::new(7);
    let (mut owned, mut eyes) = (0, 0);
    for portal in cells.portals.iter().step_by(5) {
        let weights: Vec<f64> = portal.outline.iter().map(|_| random.range(0.05, 1.0)).collect();
        let sum: DVec3 = portal.outline.iter().zip(&weights).map(|(&p, w)| p * *w).sum();
        let foot = sum / weights.iter().sum::<f64>();
        for power in [-3, -4, -6, -9, -11, -13] {
            let eye = foot + portal.plane.normal * (10f64.powi(power) * cells.extent);
            let target = eye + random.point(-1.0, 1.0);
            let camera = Camera::perspective(eye, target, DVec3::Z, 1.3, [48, 36]).unwrap();
            let seen = cells.seen_from(eye, &camera.frustum());
            for polygon in owners(&tree, &camera) {
                assert!(seen.polygons[polygon], "{polygon} from {eye}");
                owned += 1;
            }
            eyes += 1;
        }
    }
    assert!(eyes > 200 && owned > 1000, "{owned} from {eyes}");
}

/// A target behind a wall with an opening, of which only a strip thinner than the slack is visible: it counts
/// as seen. If the view were narrowed by the slack instead of widened, the target would be left out.
#[test]
fn a_strip_along_the_boundary_of_an_opening_is_seen() {
    let wall = |x: [f64; 2], z: f64| {
        let y = [-20.0, 20.0];
        [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| dvec3(x[i], y[j], z)).to_vec()
    };
    let (eye, strip) = (DVec3::ZERO, 1e-6);
    // The view through x from 1 to 2 at depth 1 is x from 10 to 20 at depth 10.
    let scene = [
        wall([-20.0, 1.0], 1.0),
        wall([2.0, 20.0], 1.0),
        wall([3.0, 10.0 + strip], 10.0),
        wall([-20.0, 20.0], 20.0),
        wall([-20.0, 20.0], -1.0),
    ];
    let tree = BspTree::build(&scene).unwrap();
    let cells = Cells::new(&tree, scene.len());
    let target = dvec3(10.0 + 0.5 * strip, 0.1, 10.0);
    let camera = Camera::perspective(eye, target, DVec3::Y, 0.5, [1, 1]).unwrap();
    assert_eq!(owners(&tree, &camera), [2]);
    let frustum = camera.frustum();
    assert!(strip < SLACK * cells.extent);
    assert!(cells.seen_from(eye, &frustum).polygons[2]);
    assert!(!cells.seen_with(-SLACK, NEAREST, eye, &frustum).polygons[2]);
}

/// Eyes so close to the boundary of an opening that its rounding turns the view by more than the slack.
/// Polygons seen along the boundary are kept. They would be lost if such near openings narrowed the view.
#[test]
fn polygons_seen_along_the_boundary_of_an_opening_are_kept() {
    // An upright rectangle from one point of the ground to another.
    let upright = |from: DVec3, to: DVec3| {
        [(from, -20.0), (to, -20.0), (to, 20.0), (from, 20.0)].map(|(p, z)| p.with_z(z)).to_vec()
    };
    let mut random = SplitMix64::new(9);
    let (mut shown, mut lost) = (0, 0);
    for _ in 0..300 {
        // A wall along `along` with an opening that begins at `start`, and an eye before it.
        let angle = random.range(0.0, std::f64::consts::TAU);
        let along = dvec3(angle.cos(), angle.sin(), 0.0);
        let start = random.point(-5.0, 5.0).with_z(0.0);
        let across = dvec3(-along.y, along.x, 0.0);
        let size = 10f64.powf(random.range(-10.0, -8.0));
        let eye = start - (across + along * random.range(-0.5, 0.5)) * size;
        // The line of sight along the boundary, and a target that reaches a little past it.
        let sight = (start - eye).normalize();
        let left = dvec3(sight.y, -sight.x, 0.0);
        let end = eye + sight * 30.0 + left * 1e-5;
        let scene = [
            upright(start - along * 20.0, start),
            upright(start + along * 3.0, start + along * 20.0),
            upright(end - left * 5.0, end),
            upright(eye - across * 20.0 - along * 20.0, eye - across * 20.0 + along * 20.0),
            upright(eye + across * 40.0 - along * 20.0, eye + across * 40.0 + along * 20.0),
        ];
        let tree = BspTree::build(&scene).unwrap();
        let cells = Cells::new(&tree, scene.len());
        let target = end - left * 5e-6;
        let camera = Camera::perspective(eye, target, DVec3::Z, 0.5, [1, 1]).unwrap();
        if owners(&tree, &camera) != [2] {
            continue;
        }
        shown += 1;
        let frustum = camera.frustum();
        assert!(cells.seen_from(eye, &frustum).polygons[2], "from {eye}");
        lost += usize::from(!cells.seen_with(SLACK, 0.0, eye, &frustum).polygons[2]);
    }
    assert!(shown > 100 && lost > 5, "{lost} of {shown}");
}

/// The far wall is visible through a slit of a 4-millionth of the scene, a hundred times the width that
/// counts as closed.
#[test]
fn polygons_seen_through_a_slit_are_kept() {
    let wall = |x: [f64; 2], z: f64| {
        [(0, -20.0), (1, -20.0), (1, 20.0), (0, 20.0)].map(|(i, y)| dvec3(x[i], y, z)).to_vec()
    };
    let slit = 1e-5;
    let scene = [
        wall([-20.0, 0.0], 1.0),
        wall([slit, 20.0], 1.0),
        wall([-20.0, 20.0], 10.0),
        wall([-20.0, 20.0], -1.0),
    ];
    let tree = BspTree::build(&scene).unwrap();
    let cells = Cells::new(&tree, scene.len());
    let (eye, target) = (DVec3::ZERO, dvec3(5.0 * slit, 0.1, 10.0));
    let camera = Camera::perspective(eye, target, DVec3::Y, 0.5, [1, 1]).unwrap();
    assert_eq!(owners(&tree, &camera), [2]);
    assert!(cells.seen_from(eye, &camera.frustum()).polygons[2]);
}

/// A square with corners at `low` and `high` in the plane z = 0.
fn square(low: f64, high: f64) -> Vec<DVec3> {
    [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| dvec3(x, y, 0.0)).to_vec()
}

fn area(outline: &[DVec3]) -> f64 {
    let arms = outline.windows(2).map(|pair| (pair[0] - outline[0]).cross(pair[1] - outline[0]));
    0.5 * arms.sum::<DVec3>().length()
}

#[test]
fn outlines_by_hand() {
    let ground = Plane::new(DVec3::Z, DVec3::ZERO);
    let slope = Plane::new(dvec3(1.0, 1.0, 0.0).normalize(), dvec3(1.0, 0.0, 0.0));
    // The corner below x + y = 1 is half a unit square, of four.
    assert!((area(&clip(&square(0.0, 2.0), &slope)) - 3.5).abs() < 1e-12);
    let [front, back] = split(&square(0.0, 2.0), &slope, 1e-9);
    assert!((area(&front) - 3.5).abs() < 1e-12 && (area(&back) - 0.5).abs() < 1e-12);
    // A wall without a window in it is four pieces. A wall without a larger window is nothing. A wall without
    // a window beside it is the whole wall.
    let left = without(square(0.0, 4.0), &square(1.0, 2.0), &ground, 1e-9);
    assert_eq!(left.len(), 4);
    assert!((left.iter().map(|piece| area(piece)).sum::<f64>() - 15.0).abs() < 1e-12);
    assert!(without(square(1.0, 2.0), &square(0.0, 4.0), &ground, 1e-9).is_empty());
    assert!(without(square(1.0, 2.0), &square(1.0, 2.0 - 1e-12), &ground, 1e-9).is_empty());
    assert_eq!(without(square(0.0, 1.0), &square(1.0, 2.0), &ground, 1e-9).len(), 1);
    let both = [square(0.0, 1.0), square(2.0, 3.0)].concat();
    assert!((area(&hull(both, &ground)) - 5.0).abs() < 1e-12);
    // Above a square, beside it, and within it.
    let far = |x: f64, z: f64| apart(&[dvec3(x, 0.5, z)], &square(0.0, 1.0), &ground);
    assert_eq!([far(0.5, -3.0), far(3.0, 1.0), far(0.5, 0.0)], [3.0, 2.0, 0.0]);
}
