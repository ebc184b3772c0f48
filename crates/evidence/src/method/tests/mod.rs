//! Compares methods with hand computation, with brute force, with each other, and with the judge.

mod attributes;
mod depth;
mod field;
mod hand;
mod nasty;
mod newell;
mod oracle;
mod rounded;
mod rules;

use super::{Method, Painted};
use binspace::internals::SplitMix64;
use binspace::raster::{Comparison, compare, zbuffer};
use binspace::view::views;
use testkit::prelude::*;

type Polygons = Vec<Vec<DVec3>>;

/// Triangles that do not touch each other. Each is in a separate cell of a cubic grid in the cube from −1 to
/// 1, and away from the cell's walls.
fn disjoint(side: usize, seed: u64) -> Polygons {
    let mut random = SplitMix64::new(seed);
    let cell = 2.0 / side as f64;
    let mut polygons = Vec::new();
    for i in 0..side * side * side {
        let index = [i % side, i / side % side, i / side / side];
        let centre = DVec3::from_array(index.map(|c| (c as f64 + 0.5) * cell - 1.0));
        polygons.push((0..3).map(|_| centre + random.point(-1.0, 1.0) * 0.45 * cell).collect());
    }
    polygons
}

/// Blades around the z axis. Each blade is over the next, and the last over the first. No plane of a blade
/// cuts a neighbour.
fn cycle_that_no_plane_cuts() -> Polygons {
    // Five blades overlap if each reaches further than 36 degrees in both directions. A blade's plane cuts
    // the next blade if they reach further than 54 degrees.
    let blade = |number: f64| {
        let corner = |radius: f64, angle: f64| {
            let turned = (72.0 * number + angle).to_radians();
            let height = 0.3 * radius * angle.to_radians().sin();
            DVec3::new(radius * turned.cos(), radius * turned.sin(), height)
        };
        vec![corner(0.5, -45.0), corner(1.0, -45.0), corner(1.0, 45.0), corner(0.5, 45.0)]
    };
    (0..5).map(|number| blade(f64::from(number))).collect()
}

fn polygons_of(scene: &Scene) -> Polygons {
    scene.polygons().map(|polygon| polygon.points().to_vec()).collect()
}

fn faces(polygons: &Polygons, tolerance: Option<f64>) -> Faces {
    Faces::new(polygons, tolerance).unwrap().0
}

/// Cameras outside a scene and within it, and parallel cameras.
fn cameras(polygons: &Polygons, size: [u32; 2], seed: u64) -> Vec<Camera> {
    let corners = || polygons.iter().flatten();
    let low = corners().fold(DVec3::INFINITY, |low, &p| low.min(p));
    let high = corners().fold(DVec3::NEG_INFINITY, |high, &p| high.max(p));
    let mut cameras = views([low, high], DVec3::Z, 3, size, seed).unwrap();
    let (centre, extent) = ((low + high) * 0.5, (high - low).max_element());
    let mut random = SplitMix64::new(seed);
    for _ in 0..2 {
        let (eye, target) =
            (random.point(-1.0, 1.0) * extent, random.point(-1.0, 1.0) * 0.3 * extent);
        let inside = Camera::perspective(centre + eye * 0.3, centre + target, DVec3::Z, 1.4, size);
        cameras.push(inside.unwrap());
        let parallel =
            Camera::parallel(random.point(-1.0, 1.0), DVec3::Z, centre, 1.2 * extent, size);
        cameras.push(parallel.unwrap());
    }
    cameras
}

/// Whether a method's coverage differs from the judge's.
fn covers_by_itself(name: &str) -> bool {
    let ends = ["incremental", "trapezoids", "integer edges", "cleared"];
    name.starts_with("bsp f32") || ends.iter().any(|end| name.ends_with(end))
}

fn show(method: &dyn Method, faces: &Faces, camera: &Camera) -> Painted {
    let rays = Rays::new(camera, faces).unwrap();
    method.prepare(faces).unwrap().paint(camera, &rays).unwrap()
}

/// The judge's result for a method's picture.
fn judge(method: &dyn Method, faces: &Faces, camera: &Camera) -> Comparison {
    let rays = Rays::new(camera, faces).unwrap();
    let painted = method.prepare(faces).unwrap().paint(camera, &rays).unwrap();
    compare(&rays, faces, &painted.image, zbuffer(&rays, faces).image())
}
