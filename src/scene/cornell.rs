//! The Cornell box.

use super::{Material, Scene};
use glam::{DVec3, dvec3};

/// The corners of the short and of the tall block's top, counter-clockwise from above.
const BLOCKS: [[[f64; 3]; 4]; 2] = [
    [[130.0, 165.0, 65.0], [82.0, 165.0, 225.0], [240.0, 165.0, 272.0], [290.0, 165.0, 114.0]],
    [[423.0, 330.0, 247.0], [265.0, 330.0, 296.0], [314.0, 330.0, 456.0], [472.0, 330.0, 406.0]],
];
const FLOOR: [[f64; 3]; 4] =
    [[552.8, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 559.2], [549.6, 0.0, 559.2]];
const CEILING: [[f64; 3]; 4] =
    [[556.0, 548.8, 0.0], [556.0, 548.8, 559.2], [0.0, 548.8, 559.2], [0.0, 548.8, 0.0]];
const LAMP: [[f64; 3]; 4] =
    [[343.0, 548.8, 227.0], [343.0, 548.8, 332.0], [213.0, 548.8, 332.0], [213.0, 548.8, 227.0]];

/// Returns the Cornell box, of 16 quads. The unit is the millimetre, up is y, and the box is open towards −z.
///
/// The Cornell University Program of Computer Graphics published the measurements and the camera position
/// ("Cornell Box Data"). The room's walls face inwards. The blocks face outwards and have no underside. As in
/// the measurements, the walls are not rectangles, the red wall is not exactly planar, and the lamp lies in
/// the plane of the ceiling. The order of the quads: floor, ceiling, lamp, back wall, green wall, red wall,
/// short block, tall block (top, then sides). Colours are for display and are not derived from the measured
/// spectra.
pub fn cornell_box() -> Scene {
    let mut scene = Scene::new("cornell", DVec3::Y).with_view(
        // Published: direction 0 0 1. The room is 559.2 deep.
        dvec3(278.0, 273.0, -800.0),
        dvec3(278.0, 273.0, 279.6),
    );
    let white = scene.add_material(Material::new("white", [0.85, 0.84, 0.80]));
    let ceiling = scene.add_material(Material::new("ceiling", [0.70, 0.69, 0.66]));
    let back = scene.add_material(Material::new("back wall", [0.77, 0.76, 0.73]));
    let lamp = scene.add_material(Material::new("lamp", [1.00, 0.97, 0.80]));
    let green = scene.add_material(Material::new("green", [0.25, 0.55, 0.22]));
    let red = scene.add_material(Material::new("red", [0.68, 0.14, 0.12]));
    let shades = [0.92, 0.55, 0.62, 0.70, 0.62].map(|grey| {
        let color = [grey, grey * 0.98, grey * 0.94];
        scene.add_material(Material::new("block", color))
    });

    let (floor, top) = (FLOOR.map(DVec3::from), CEILING.map(DVec3::from));
    scene.push(floor, white);
    // Before the lamp, because the later of coplanar polygons is visible.
    scene.push(top, ceiling);
    scene.push(LAMP.map(DVec3::from), lamp);
    scene.push([floor[3], floor[2], top[2], top[1]], back);
    scene.push([floor[2], floor[1], top[3], top[2]], green);
    scene.push([floor[0], floor[3], top[1], top[0]], red);
    for block in BLOCKS {
        let top = block.map(DVec3::from);
        scene.push(top, shades[0]);
        for side in 0..4 {
            let (a, b) = (top[side], top[(side + 1) % 4]);
            let (under_a, under_b) = (dvec3(a.x, 0.0, a.z), dvec3(b.x, 0.0, b.z));
            scene.push([under_a, under_b, b, a], shades[side + 1]);
        }
    }
    scene
}
