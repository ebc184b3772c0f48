//! A city of houses on one ground square.

use super::cuboid::cuboid;
use super::{Material, Scene};
use crate::random::SplitMix64;
use glam::DVec3;

/// The side of a building plot with half the street around it, in metres.
const PLOT: f64 = 30.0;

/// A city of about `polygons` polygons in metres, up is z: a grid of houses on one ground square.
///
/// There are `side`² houses, with `side` = √((`polygons` − 1)/5) rounded, at least 1: axis-aligned
/// boxes without an underside, 12 to 24 wide and deep, 6 to 120 high, that stand apart. Low houses
/// are frequent, high ones rare.
pub fn city(polygons: u32, seed: u64) -> Scene {
    let wanted = (f64::from(polygons.saturating_sub(1)) / 5.0).sqrt();
    let side = wanted.round().max(1.0) as u32;
    let width = f64::from(side) * PLOT;
    let mut scene = Scene::new(format!("city:{polygons}"), DVec3::Z).with_view(
        DVec3::new(-0.35 * width, -0.45 * width, 0.35 * width + 100.0),
        DVec3::new(0.45 * width, 0.45 * width, 20.0),
    );
    let ground = scene.add_material(Material::new("ground", [0.35, 0.37, 0.35]));
    let walls = [0.55, 0.75, 0.62, 0.68]
        .map(|grey| scene.add_material(Material::new("wall", [grey, 0.95 * grey, 0.85 * grey])));
    let roof = scene.add_material(Material::new("roof", [0.70, 0.42, 0.35]));

    let square = [(0.0, 0.0), (width, 0.0), (width, width), (0.0, width)];
    scene.push(square.map(|(x, y)| DVec3::new(x, y, 0.0)), ground);
    let mut random = SplitMix64::new(seed);
    for plot in 0..u64::from(side) * u64::from(side) {
        let (column, row) = (plot % u64::from(side), plot / u64::from(side));
        let centre = DVec3::new(column as f64 + 0.5, row as f64 + 0.5, 0.0) * PLOT;
        let half_x = random.range(6.0, 12.0);
        let half_y = random.range(6.0, 12.0);
        let tallness = random.range(0.0, 1.0);
        let height = 6.0 + 114.0 * tallness * tallness * tallness;
        let faces = cuboid(
            centre - DVec3::new(half_x, half_y, 0.0),
            centre + DVec3::new(half_x, half_y, height),
        );
        for (face, material) in faces[..4].iter().zip(walls) {
            scene.push(*face, material);
        }
        scene.push(faces[5], roof);
    }
    scene
}
