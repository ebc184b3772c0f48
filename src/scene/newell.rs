//! Three bars that overlap in a cycle.

use super::cuboid::cuboid;
use super::{Material, Scene};
use glam::DVec3;

/// Three bars in a cycle: each covers a part of the next, so that no order of whole bars is right
/// and one must be cut. 18 rectangles; up is z.
///
/// The classic counterexample to sorting by depth, after M. E. Newell, R. G. Newell and T. L.
/// Sancha, "A solution to the hidden surface problem", ACM 1972. Here the bars are axis-aligned
/// boxes of 9 × 1 × 1 along x, y and z that do not touch, each the cyclic permutation of the other;
/// seen from (1, 1, 1) the bar along y covers that along x, z covers y, and x covers z.
pub fn newell_bars() -> Scene {
    let mut scene = Scene::new("newell", DVec3::Z).with_view(DVec3::splat(9.0), DVec3::ZERO);
    let mut low = DVec3::new(-4.5, 0.5, -1.5);
    let mut high = DVec3::new(4.5, 1.5, -0.5);
    let hues = [[0.80, 0.25, 0.20], [0.25, 0.65, 0.30], [0.25, 0.40, 0.80]];
    // Without lighting, opposite faces share a shade and the three axes differ.
    for (bar, rgb) in ["x", "y", "z"].into_iter().zip(hues) {
        let shades = [0.7, 0.85, 1.0].map(|shade: f32| {
            let color = rgb.map(|channel: f32| channel * shade);
            scene.add_material(Material::new(format!("bar along {bar}"), color))
        });
        for (side, face) in cuboid(low, high).into_iter().enumerate() {
            scene.push(face, shades[side / 2]);
        }
        low = DVec3::new(low.z, low.x, low.y);
        high = DVec3::new(high.z, high.x, high.y);
    }
    scene
}
