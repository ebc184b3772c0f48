//! Round bodies with integer corners, all their sides planar to the last bit: globes, shells, cones, pipes.

use std::f64::consts::{PI, TAU};
use testkit::as_given::scene::{Point, Scene, add, between, each, tilt, times};
use testkit::prelude::*;
use testkit::shapes::rotation;

/// `sides` corners on a circle around the z axis, convex although rounded.
fn ring(sides: usize, radius: i64) -> Vec<Point> {
    let angle = |k: usize| TAU * (k as f64 + 0.3) / sides as f64;
    let whole = |x: f64| (x * radius as f64).round() as i64;
    (0..sides).map(|k| [whole(angle(k).cos()), whole(angle(k).sin()), 0]).collect()
}

/// A globe of trapezoids, with triangles at the poles.
fn globe(slices: usize, rings: usize) -> Vec<Vec<Point>> {
    let ring = ring(slices, 4000);
    // Rings are scaled copies of one ring, in units so fine that rounding makes no dent.
    const FINE: f64 = 100_000.0;
    let part = |k: usize| PI * k as f64 / rings as f64;
    let height = |k: usize| (FINE * 4000.0 * part(k).cos()).round() as i64;
    let width = |k: usize| (FINE * part(k).sin()).round() as i64;
    let at = |slice: usize, k: usize| {
        let [x, y, _] = ring[slice % slices];
        [width(k) * x, width(k) * y, height(k)]
    };
    let mut faces = Vec::new();
    for slice in 0..slices {
        for k in 0..rings {
            let mut face =
                vec![at(slice, k), at(slice, k + 1), at(slice + 1, k + 1), at(slice + 1, k)];
            face.dedup();
            if face[0] == face[face.len() - 1] {
                face.pop();
            }
            faces.push(face);
        }
    }
    faces
}

pub(crate) fn sphere(dice: &mut Dice, n: usize) -> Scene {
    let rings = (n / 2).isqrt();
    Scene::new("sphere", each(globe(n / rings, rings), tilt)).shuffled(dice)
}

/// A globe of triangles that is convex except for the rounding of its corners: neighbours are almost in one
/// plane, and dents are no deeper than the rounding. Neighbours are consecutive.
pub(crate) fn rough_globe(dice: &mut Dice, n: usize) -> Scene {
    let rings = (n / 2 / 2).isqrt();
    let slices = n / rings / 2;
    let radius = (1u64 << 45) as f64 * (0.5 + 0.5 * dice.share());
    let turn = rotation([dice.share(), dice.share(), dice.share()]);
    let at = |slice: usize, ring: usize| -> Point {
        let (a, b) = (TAU * (slice % slices) as f64, PI * ring as f64);
        let (a, b) = (a / slices as f64, b / rings as f64);
        let point = DVec3::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos());
        (turn * point * radius).round().to_array().map(|c| c as i64)
    };
    let mut faces = Vec::new();
    for (slice, ring) in (0..slices).flat_map(|slice| (0..rings).map(move |ring| (slice, ring))) {
        let [a, b] = [at(slice, ring), at(slice + 1, ring)];
        let [c, d] = [at(slice, ring + 1), at(slice + 1, ring + 1)];
        faces.push(if ring == 0 { vec![a, c, d] } else { vec![a, c, b] });
        if ring > 0 && ring + 1 < rings {
            faces.push(vec![b, c, d]);
        }
    }
    Scene::new("rough globe", faces)
}

/// Globes within globes.
pub(crate) fn shells(dice: &mut Dice, n: usize) -> Scene {
    let shells = 6;
    let rings = (n / 2 / shells).isqrt().max(3);
    let globe = globe(n / shells / rings, rings);
    let shell = |k: i64| each(globe.clone(), |p| times(k, tilt(p)));
    Scene::new("shells", (1..=shells as i64).flat_map(shell).collect()).shuffled(dice)
}

/// Cones around several axes, some within others, all with one apex.
pub(crate) fn cones(dice: &mut Dice, n: usize) -> Scene {
    let sides = 40;
    let mut polygons = Vec::new();
    for k in 0..n / sides {
        let ring = ring(sides, between(dice, 500, 4000));
        let height = between(dice, 1000, 4000) * [-1, 1][k % 2];
        let turn = |[x, y, z]: Point| match k / 2 % 3 {
            0 => tilt([x, y, z]),
            1 => tilt([z, x, y]),
            _ => [5 * x, 3 * y, 7 * z],
        };
        for i in 0..sides {
            let on = |k: usize| turn(add(ring[k % sides], [0, 0, height]));
            polygons.push(vec![[0; 3], on(i), on(i + 1)]);
        }
    }
    Scene::new("cones", polygons).shuffled(dice)
}

/// A long pipe with discs across it, one behind the other, as wide as the pipe or smaller.
pub(crate) fn pipe(dice: &mut Dice, n: usize) -> Scene {
    let sides = n * 3 / 4;
    let outer = ring(sides, 1 << 20);
    let length = 1 << 22;
    let side = |i: usize| {
        let [a, b] = [outer[i], outer[(i + 1) % sides]];
        [(a, -1), (b, -1), (b, 1), (a, 1)].map(|(p, end)| add(p, [0, 0, end * length])).to_vec()
    };
    let mut polygons: Vec<Vec<Point>> = (0..sides).map(side).collect();
    for k in 0..n as i64 / 4 {
        let disc = if k % 10 == 0 { outer.clone() } else { ring(3 + dice.below(20), 1 << 18) };
        let height = (k - n as i64 / 8) * (4 * length / n as i64);
        polygons.push(disc.into_iter().map(|p| add(p, [0, 0, height])).collect());
    }
    Scene::new("pipe", each(polygons, tilt)).shuffled(dice)
}

#[test]
fn convex_bodies_are_not_cut_by_auto() {
    for count in [450, 2200] {
        let sphere = sphere(&mut Dice(1), count);
        let tree = sphere.build(Heuristic::Auto, 100 * count).expect("within budget");
        assert_eq!(tree.len(), sphere.polygons.len());
        assert!(tree.len() > count * 9 / 10);
    }
}
