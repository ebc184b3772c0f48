//! Squares that all cross in one axis.

use super::turn::unit_circle;
use super::{Material, Scene};
use glam::DVec3;

/// `count` upright squares of side 2 that all cross in the z axis, like the leaves of a revolving
/// door; up is z.
///
/// Square `i` is turned by `i`/`count` of half a turn, so two are perpendicular. `2·count` pieces
/// suffice for an order.
pub fn crossing(count: u32) -> Scene {
    let mut scene = Scene::new(format!("crossing:{count}"), DVec3::Z)
        .with_view(DVec3::new(2.5, -4.5, 2.0), DVec3::ZERO);
    Material::palette().for_each(|material| {
        scene.add_material(material);
    });
    for index in 0..count {
        let reach = unit_circle(index.into(), 2 * u64::from(count));
        let (near, far) = (reach.extend(0.0), -reach.extend(0.0));
        let square = [far - DVec3::Z, near - DVec3::Z, near + DVec3::Z, far + DVec3::Z];
        scene.push(square, index % 8);
    }
    scene
}
