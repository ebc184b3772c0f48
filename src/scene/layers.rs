//! Nested squares, one above the other.

use super::{Material, Scene};
use glam::DVec3;

/// `count` nested squares, `gap` above one another; up is z.
///
/// Square `i` lies at height `i`·`gap`, faces up, and is centred on the z axis; the lowest has side
/// 2 and each is smaller by a `count`-th than the one below, so that a strip of every layer stays
/// visible from above. A gap of 0 makes all of them coplanar; a small one tells exact decisions
/// from tolerances.
pub fn layers(count: u32, gap: f64) -> Scene {
    let mut scene = Scene::new(format!("layers:{count}"), DVec3::Z)
        .with_view(DVec3::new(0.8, -1.6, 2.6), DVec3::ZERO);
    Material::palette().for_each(|material| {
        scene.add_material(material);
    });
    for index in 0..count {
        let half = f64::from(count - index) / f64::from(count);
        let z = f64::from(index) * gap;
        let square = [(-half, -half), (half, -half), (half, half), (-half, half)];
        scene.push(square.map(|(x, y)| DVec3::new(x, y, z)), index % 8);
    }
    scene
}
