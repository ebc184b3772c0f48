//! Parallel squares, one behind the other.

use super::{Material, Scene};
use glam::DVec3;

/// `count` parallel squares, one behind the other; up is z.
///
/// Square `i` lies in the plane y = `i`, has side 10 and faces −y. No plane of one touches another;
/// a tree of their own planes can be a list of depth `count`, which is what makes the scene hard.
pub fn chain(count: u32) -> Scene {
    let mut scene = Scene::new(format!("chain:{count}"), DVec3::Z);
    Material::palette().for_each(|material| {
        scene.add_material(material);
    });
    for index in 0..count {
        let y = f64::from(index);
        let corner = |x: f64, z: f64| DVec3::new(x, y, z);
        let square = [corner(-5.0, -5.0), corner(5.0, -5.0), corner(5.0, 5.0), corner(-5.0, 5.0)];
        scene.push(square, index % 8);
    }
    scene
}
