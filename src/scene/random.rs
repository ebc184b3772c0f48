//! Triangles at random.

use super::{Material, Scene};
use crate::random::SplitMix64;
use glam::DVec3;

/// The shortest and the longest edge of a random triangle.
const EDGES: (f64, f64) = (0.1, 0.3);

/// `count` triangles anywhere in the unit cube, every edge between 0.1 and 0.3 long; up is z. Most
/// of a dense scene's triangles cross others.
pub fn random_triangles(count: u32, seed: u64) -> Scene {
    let mut scene = Scene::new(format!("random:{count}"), DVec3::Z);
    Material::palette().for_each(|material| {
        scene.add_material(material);
    });
    let mut random = SplitMix64::new(seed);
    for index in 0..count {
        scene.push(triangle(&mut random), index % 8);
    }
    scene
}

/// Draws until the triangle fits. One draw in about 16 does; a thousand misses in a row are as good
/// as impossible, and then a fixed triangle ends the loop.
fn triangle(random: &mut SplitMix64) -> [DVec3; 3] {
    for _ in 0..1000 {
        let a = random.point(0.0, 1.0);
        let b = a + random.point(-EDGES.1, EDGES.1);
        let c = a + random.point(-EDGES.1, EDGES.1);
        if fits([a, b, c]) {
            return [a, b, c];
        }
    }
    [DVec3::ZERO, DVec3::X * EDGES.1, DVec3::Y * EDGES.1 * 0.5]
}

fn fits([a, b, c]: [DVec3; 3]) -> bool {
    let edges = [b - a, c - b, a - c].map(DVec3::length_squared);
    let inside = |p: DVec3| p.min_element() >= 0.0 && p.max_element() <= 1.0;
    let fair = |square| (EDGES.0 * EDGES.0..=EDGES.1 * EDGES.1).contains(&square);
    inside(b) && inside(c) && edges.into_iter().all(fair)
}
