//! A sphere of quads.

use super::turn::unit_circle;
use super::{Material, Scene};
use glam::{DVec2, DVec3};

/// A unit sphere of about `faces` faces, up is z: quads between parallels and meridians, triangles
/// at the poles.
///
/// It has `rows` × 2·`rows` faces, with `rows` = √(`faces`/2) rounded, at least 2 (an octahedron).
/// Every quad is an isosceles trapezium inscribed in the sphere, so all faces are planar and the
/// body is convex, up to the rounding of the corners. The worst case for trees whose planes are the
/// faces' own: none of them splits anything off but its own face.
pub fn sphere(faces: u32) -> Scene {
    let rows = (f64::from(faces) / 2.0).sqrt().round().max(2.0) as u64;
    let columns = 2 * rows;
    let mut scene = Scene::new(format!("sphere:{faces}"), DVec3::Z);
    let shades = [0.95, 0.75]
        .map(|grey| scene.add_material(Material::new("sphere", [0.5 * grey, 0.7 * grey, grey])));
    let meridian: Vec<DVec2> = (0..=columns).map(|step| unit_circle(step, columns)).collect();
    // From the south pole, a quarter turn back, to the north pole.
    let parallel: Vec<DVec2> =
        (0..=rows).map(|row| unit_circle(3 * rows + 2 * row, 4 * rows)).collect();
    let corner =
        |row: usize, column: usize| (meridian[column] * parallel[row].x).extend(parallel[row].y);
    for row in 0..rows as usize {
        for column in 0..columns as usize {
            let material = shades[(row + column) % 2];
            let (a, b) = (corner(row, column), corner(row, column + 1));
            let (c, d) = (corner(row + 1, column + 1), corner(row + 1, column));
            if row == 0 {
                scene.push([a, c, d], material);
            } else if row + 1 == rows as usize {
                scene.push([a, b, c], material);
            } else {
                scene.push([a, b, c, d], material);
            }
        }
    }
    scene
}
