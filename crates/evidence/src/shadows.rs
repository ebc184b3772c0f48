//! Shadows: the points of surfaces that a lamp lights, and the lit parts of surfaces as pieces of polygons.

mod casters;
mod pieces;
mod shade;
#[cfg(test)]
mod tests;

pub use pieces::{Piece, Pieces, pieces};

use binspace::glam::{DVec3, dvec3};
use binspace::internals::cuboid;
use binspace::raster::{NONE, Rays, zbuffer};
use binspace::scene::Scene;
use binspace::view::Camera;
use binspace::{BspTree, Ray};

/// The part of a lamp that a point sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zone {
    /// The point sees all tested points of the lamp.
    Lit,
    /// The point sees some of the tested points.
    Penumbra,
    /// The point sees none of the tested points.
    Umbra,
}

/// Returns the zone of a point, by exact sight lines to points of a lamp.
///
/// For a point lamp, the zone is always right. For a rectangular lamp, the zone may be wrong near the
/// shadow's boundary, because visible or hidden parts of the lamp between the points are not noticed.
/// [`is_umbra`] is certain.
pub fn zone(tree: &BspTree, point: DVec3, lamp: &[DVec3]) -> Zone {
    let sees = |&at: &DVec3| !tree.is_occluded(Ray::between(point, at));
    match lamp.iter().filter(|at| sees(at)).count() {
        0 => Zone::Umbra,
        n if n == lamp.len() => Zone::Lit,
        _ => Zone::Penumbra,
    }
}

/// Returns whether one convex polygon lies between a point and all corners of a lamp. Then it hides the whole
/// lamp, because the hidden part of the lamp's plane is convex.
pub fn is_umbra(tree: &BspTree, point: DVec3, corners: &[DVec3]) -> bool {
    let between = |&at: &DVec3| {
        let hits = tree.hits(Ray::between(point, at));
        hits.filter(|hit| hit.parameter() > 0.0).map(|hit| hit.polygon()).collect::<Vec<_>>()
    };
    let mut all = corners.iter().map(between);
    let mut common = all.next().unwrap_or_default();
    for hits in all {
        common.retain(|polygon| hits.contains(polygon));
    }
    !common.is_empty()
}

/// Returns a floor with a body, a table and a post, in whole numbers, so that points of its surfaces are
/// exact. Up is z; all polygons are upright or level.
pub fn courtyard() -> Scene {
    let mut scene = Scene::new("courtyard", DVec3::Z);
    let floor = [[0.0, 0.0], [4096.0, 0.0], [4096.0, 4096.0], [0.0, 4096.0]];
    scene.push(floor.map(|[x, y]| dvec3(x, y, 0.0)), 0);
    for (low, high) in [
        ([900.0, 1500.0, 0.0], [1600.0, 2300.0, 700.0]),
        ([2200.0, 1400.0, 600.0], [3300.0, 2500.0, 660.0]),
        ([1900.0, 2900.0, 0.0], [2000.0, 3000.0, 1300.0]),
    ] {
        cuboid(low.into(), high.into()).into_iter().for_each(|quad| scene.push(quad, 0));
    }
    scene
}

/// Points of the courtyard's lamp, `side` by `side` from corner to corner, in whole numbers.
pub fn lamp(side: u32) -> Vec<DVec3> {
    let step = |k: u32| (720.0 * f64::from(k) / f64::from(side - 1)).round();
    let at = |k: u32| dvec3(1733.0 + step(k % side), 1871.0 + step(k / side), 2999.0);
    (0..side * side).map(at).collect()
}

/// Returns the points of surfaces that a camera sees, rounded to whole numbers; `None` in empty pixels.
pub fn seen_points(camera: &Camera, eye: DVec3, rays: &Rays, tree: &BspTree) -> Vec<Option<DVec3>> {
    let [width, height] = camera.size().map(f64::from);
    let depth = zbuffer(rays, tree.faces());
    let pixels = depth.image().faces().iter().zip(depth.depths()).enumerate();
    let point = |(k, (&face, far)): (usize, (&u32, f64))| {
        let (x, y) = ((k as f64 % width).floor() + 0.5, (k as f64 / width).floor() + 0.5);
        let [right, down] = [x - 0.5 * width, y - 0.5 * height].map(|c| c * camera.pixel_size()[1]);
        let way = camera.forward() + right * camera.right() - down * camera.up();
        (face != NONE).then(|| (eye + far * way).round())
    };
    pixels.map(point).collect()
}
