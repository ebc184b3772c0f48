//! Many triangles that pass through each other.

use glam::DVec3;

use super::pose::{Pose, empty, push_shuffled};
use super::trial::Trial;
use binspace::internals::SplitMix64;
use binspace::scene::Scene;

/// A triangle with corners at about `size` from its centre.
fn around(centre: DVec3, size: f64, random: &mut SplitMix64) -> Vec<DVec3> {
    let pose = Pose::random(random);
    // An equilateral triangle, each corner moved by up to a quarter.
    let corners = [(1.0, 0.0), (-0.5, 0.866), (-0.5, -0.866)];
    let place = |(x, y): (f64, f64)| {
        let moved = DVec3::new(x, y, 0.0) + random.point(-0.25, 0.25);
        centre + pose.direction(moved) * size
    };
    corners.map(place).to_vec()
}

fn crowd(
    count: u32,
    size: f64,
    centre: DVec3,
    random: &mut SplitMix64,
) -> impl Iterator<Item = Vec<DVec3>> {
    (0..count).map(move |_| {
        let at = centre + random.point(-0.5, 0.5);
        around(at, size, random)
    })
}

/// Forty triangles in a unit cube around a point at `distance` from the origin, and one with a corner at the
/// origin, so that the extent of the scene is about `distance`.
pub(super) fn offset(distance: f64, seed: u64) -> Trial {
    /// A unit vector, up to rounding.
    const AWAY: DVec3 = DVec3::new(0.6, 0.64, 0.48);
    let mut random = SplitMix64::new(seed);
    let mut pose = Pose::random(&mut random);
    pose.origin = AWAY * distance;
    let mut scene = empty("offset", distance);
    let mut triangles: Vec<_> = crowd(40, 0.35, pose.origin, &mut random).collect();
    triangles.push(vec![DVec3::ZERO, DVec3::X * 0.1, DVec3::Y * 0.1]);
    push_shuffled(&mut scene, triangles, &mut random);
    let looks = pose.looks(2.5, 0.6, &mut random);
    Trial::new(scene, looks)
}

/// A large triangle, and `count` small ones that stick through it, in random places of a grid.
pub(super) fn nesting(count: u32, seed: u64) -> Trial {
    let mut random = SplitMix64::new(seed);
    let mut pose = Pose::random(&mut random);
    pose.origin = random.point(0.0, 1.0);
    let mut scene = empty("nesting", f64::from(count));
    let large = [(-2.0, -1.1), (2.0, -1.1), (0.0, 2.4)];
    let mut triangles = vec![large.map(|(x, y)| pose.place(DVec3::new(x, y, 0.0))).to_vec()];
    let side = f64::from(count).sqrt().ceil();
    let cell = 1.6 / side;
    for i in 0..count {
        let (column, row) = (f64::from(i) % side, (f64::from(i) / side).floor());
        let corner = DVec3::new(column, row, 0.0) * cell - DVec3::new(0.8, 0.8, 0.0);
        let at = corner + DVec3::new(random.range(0.2, 0.8), random.range(0.2, 0.8), 0.0) * cell;
        let small = loop_until_through(at, 0.6 * cell, &mut random);
        triangles.push(small.into_iter().map(|p| pose.place(p)).collect());
    }
    push_shuffled(&mut scene, triangles, &mut random);
    let looks = pose.looks(2.9, 0.6, &mut random);
    Trial::new(scene, looks)
}

/// A triangle around a point of the plane z = 0, with corners on both sides of the plane.
fn loop_until_through(at: DVec3, size: f64, random: &mut SplitMix64) -> Vec<DVec3> {
    for _ in 0..1000 {
        let triangle = around(at, size, random);
        let z = |f: fn(f64, f64) -> f64| triangle.iter().map(|p| p.z).fold(0.0, f);
        if z(f64::min) < -0.2 * size && z(f64::max) > 0.2 * size {
            return triangle;
        }
    }
    let corners = [(1.0, 0.0, 0.5), (-1.0, 0.0, 0.5), (0.0, 0.5, -1.0)];
    corners.map(|(x, y, z)| at + DVec3::new(x, y, z) * size).to_vec()
}

/// `count` triangles with their centres in a unit cube, large enough that most cross.
pub(super) fn penetration(count: u32, seed: u64) -> Trial {
    let mut random = SplitMix64::new(seed);
    let pose = Pose::random(&mut random);
    let mut scene = empty("penetration", f64::from(count));
    let triangles = crowd(count, 0.5, DVec3::ZERO, &mut random).collect();
    push_shuffled(&mut scene, triangles, &mut random);
    let looks = pose.looks(2.8, 0.5, &mut random);
    Trial::new(scene, looks)
}

/// Adds `count` triangles that cross in a unit cube around a point.
pub(super) fn push_crowd(scene: &mut Scene, count: u32, centre: DVec3, random: &mut SplitMix64) {
    let triangles: Vec<_> = crowd(count, 0.35, centre, random).collect();
    push_shuffled(scene, triangles, random);
}
