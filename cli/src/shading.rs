//! Shades of polygons in vector pictures: one brightness for each plane, so that neither the triangles of a
//! flat wall nor the pieces of a polygon differ.
//!
//! In a parallel view, the brightness is that of the painter's pictures, lit by a lamp at the eye. In a
//! perspective, such a lamp would shade a plane unevenly. So the lamp of a perspective is far away, above the
//! viewer's left shoulder.

use binspace::glam::DVec3;
use binspace::raster;
use binspace::view::Camera;

/// A polygon's colour under the light.
pub(crate) fn shaded(colour: [u8; 3], polygon: &[DVec3], camera: &Camera) -> [u8; 3] {
    let share = brightness(normal_to_viewer(polygon, camera), camera);
    colour.map(|channel| (f64::from(channel) * share).round() as u8)
}

/// The brightness of a plane, given the unit normal on the side that the viewer sees. In a perspective, the
/// brightness is 0.5 + 0.5 · (1 + n·l) / (1 + m·l), at most 1 (half-Lambert shading): n is the normal, l
/// points to the lamp, and m to the viewer. A plane that faces the viewer has full brightness.
fn brightness(normal: DVec3, camera: &Camera) -> f64 {
    if camera.eye().is_none() {
        return raster::brightness(normal, camera.forward());
    }
    let lamp = (0.4 * camera.up() - 0.8 * camera.right() - camera.forward()).normalize();
    let share = (1.0 + normal.dot(lamp)) / (1.0 - camera.forward().dot(lamp));
    0.5 + 0.5 * share.min(1.0)
}

/// The unit normal of the side of a polygon that the viewer sees.
fn normal_to_viewer(polygon: &[DVec3], camera: &Camera) -> DVec3 {
    let share = 1.0 / polygon.len() as f64;
    let middle: DVec3 = polygon.iter().map(|&corner| corner * share).sum();
    // Newell's normal, as polygons need not be planar.
    let arms = polygon.iter().map(|&corner| corner - middle);
    let next = arms.clone().cycle().skip(1);
    let normal: DVec3 = arms.zip(next).map(|(arm, next)| arm.cross(next)).sum();
    let to_viewer = camera.eye().map_or(-camera.forward(), |eye| eye - middle);
    let normal = normal.normalize_or_zero();
    if normal.dot(to_viewer) < 0.0 { -normal } else { normal }
}

#[cfg(test)]
mod tests {
    use super::shaded;
    use binspace::glam::DVec3;
    use binspace::view::Camera;

    /// A wall as a fan of triangles, and the walls beside it.
    #[test]
    fn the_triangles_of_a_flat_wall_have_one_shade_and_walls_differ() {
        let eye = DVec3::new(0.0, -5.0, 1.0);
        let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 1.2, [80, 60]).unwrap();
        let corner = |x: f64, z: f64| DVec3::new(x, 4.0, z);
        let wall = [corner(-4.0, -2.0), corner(4.0, -2.0), corner(4.0, 3.0), corner(-4.0, 3.0)];
        let middle = corner(0.3, 0.7);
        let shades = [0, 1, 2, 3].map(|k| {
            // Alternately from either side, as in careless models.
            let [a, b] = [wall[k], wall[(k + 1) % 4]];
            let triangle = if k % 2 == 0 { [middle, a, b] } else { [middle, b, a] };
            shaded([200; 3], &triangle, &camera)
        });
        assert!(shades.iter().all(|&shade| shade == shades[0]), "{shades:?}");
        let side = |x: f64| [[x, -4.0, -1.0], [x, 4.0, -1.0], [x, 4.0, 3.0]].map(DVec3::from);
        let floor = [[-4.0, -4.0, -1.0], [4.0, -4.0, -1.0], [4.0, 4.0, -1.0]].map(DVec3::from);
        let [left, right] = [-4.0, 4.0].map(|x| shaded([200; 3], &side(x), &camera));
        let mut all = [shades[0], left, right, shaded([200; 3], &floor, &camera)];
        all.sort_unstable();
        assert!(all.windows(2).all(|pair| pair[0] != pair[1]), "{all:?}");
    }
}
