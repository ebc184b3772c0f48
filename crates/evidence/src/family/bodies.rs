//! Scenes with ties, with faces that almost coincide, and with cycles.

use glam::DVec3;

use super::pose::{Pose, empty, push_shuffled};
use super::trial::Trial;
use binspace::internals::SplitMix64;
use binspace::internals::cuboid;
use binspace::internals::unit_circle;

/// Unit squares of an integer grid with `side` cells a side: half of all squares, some of them twice, and
/// diagonals through cells. One eye is a point of the grid.
pub(super) fn lattice(side: u32, seed: u64) -> Trial {
    let mut random = SplitMix64::new(seed);
    let mut scene = empty("lattice", f64::from(side));
    let mut squares = Vec::new();
    for cell in cells(side) {
        for axis in 0..3 {
            let [u, v] = [DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]];
            let square = vec![cell, cell + u, cell + u + v, cell + v];
            match random.next() % 16 {
                0..7 => squares.push(square),
                7 => {
                    squares.push(square.iter().rev().copied().collect());
                    squares.push(square);
                }
                8 => {
                    let w = DVec3::AXES[axis];
                    squares.push(vec![cell, cell + u, cell + u + v + w, cell + v + w]);
                }
                _ => {}
            }
        }
    }
    push_shuffled(&mut scene, squares, &mut random);
    let half = 0.5 * f64::from(side);
    let mut pose = Pose::random(&mut random);
    pose.origin = DVec3::splat(half);
    let mut looks = pose.looks(5.5 * half, half, &mut random);
    let grid = Pose { axes: DVec3::AXES, origin: DVec3::ZERO };
    looks[2] = grid.look(DVec3::splat(half.floor()), DVec3::new(0.0, 0.25, 0.5) * half);
    Trial::new(scene, looks)
}

fn cells(side: u32) -> impl Iterator<Item = DVec3> {
    let number = move |i: u32| f64::from(i % side);
    (0..side * side * side)
        .map(move |i| DVec3::new(number(i), number(i / side), number(i / side / side)))
}

/// Boxes of a grid with `side` cells a side, all rotated in the same way, each with a label on its top. Four
/// cells in ten are empty. The corners of each box are computed separately, so coincident corners differ by
/// rounding.
pub(super) fn boxes(side: u32, seed: u64) -> Trial {
    let mut random = SplitMix64::new(seed);
    let mut pose = Pose::random(&mut random);
    pose.origin = random.point(0.0, 1.0);
    let mut scene = empty("boxes", f64::from(side));
    let half = 0.5 * f64::from(side);
    let mut triangles = Vec::new();
    for cell in cells(side) {
        if random.next() % 10 < 4 {
            continue;
        }
        let corner = pose.place(cell - half);
        let turned = |p: DVec3| corner + pose.direction(p);
        for face in cuboid(DVec3::ZERO, DVec3::ONE) {
            let [a, b, c, d] = face.map(turned);
            triangles.extend([vec![a, b, c], vec![a, c, d]]);
        }
        let label = [(0.2, 0.1), (0.9, 0.3), (0.4, 0.8)];
        triangles.push(label.map(|(x, y)| turned(DVec3::new(x, y, 1.0))).to_vec());
    }
    push_shuffled(&mut scene, triangles, &mut random);
    let looks = pose.looks(5.5 * half, half, &mut random);
    Trial::new(scene, looks)
}

/// `count` bars along the sides of a regular polygon, each longer than the side. The end of each bar lies
/// over the beginning of the next bar.
pub(super) fn cycle(count: u32, seed: u64) -> Trial {
    let mut random = SplitMix64::new(seed);
    let mut pose = Pose::random(&mut random);
    pose.origin = random.point(0.0, 1.0);
    let mut scene = empty("cycle", f64::from(count));
    // The sides of a polygon inscribed in the unit circle, each extended beyond its ends by a part of its
    // length.
    let n = u64::from(count);
    let side = unit_circle(1, n).distance(unit_circle(0, n));
    let (past, width, rise) = (0.3 * side, 0.12 * side.min(0.6), 0.1 * side);
    let bars = (0..n).map(|i| {
        let (from, to) = (unit_circle(i, n), unit_circle(i + 1, n));
        let along = (to - from).normalize();
        let out = along.perp() * -width;
        let (from, to) = (from - along * past, to + along * past);
        let corners =
            [(from - out, -rise), (to - out, rise), (to + out, rise), (from + out, -rise)];
        corners.map(|(p, z)| pose.place(p.extend(z))).to_vec()
    });
    push_shuffled(&mut scene, bars.collect(), &mut random);
    let mut looks = pose.looks(3.4, 0.6, &mut random);
    // One view is from nearby, because the bars are small if there are many.
    let eye = DVec3::new(1.0 + 0.5 * side, 0.1 * side, 3.0 * side);
    looks[1] = pose.look(eye, DVec3::X);
    Trial::new(scene, looks)
}
