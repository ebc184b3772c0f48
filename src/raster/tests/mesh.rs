//! Faces that share edges leave no gap between them and do not overlap.

use glam::DVec3;

use super::{Random, cameras, faces};
use crate::exact::Faces;
use crate::raster::coverage::Coverage;
use crate::raster::{Outline, Rays};
use crate::view::Camera;

const PIXELS: [u32; 2] = [32, 32];

/// For each pixel, the number of faces met from the front minus the number met from behind, and the number of
/// all faces met.
fn layers(rays: &Rays, faces: &Faces) -> Vec<(i32, i32)> {
    let mut counts = vec![(0, 0); (PIXELS[0] * PIXELS[1]) as usize];
    for face in 0..faces.len() as u32 {
        if let Some(coverage) = Coverage::new(rays, faces, face, Outline::Whole) {
            let sign = if coverage.seen.positive == rays.is_perspective() { 1 } else { -1 };
            coverage.for_each_run(&mut |y, columns| {
                for x in columns {
                    let count = &mut counts[(y * PIXELS[0] + x) as usize];
                    *count = (count.0 + sign, count.1 + 1);
                }
            });
        }
    }
    counts
}

/// The cube from −1 to 1, its sides as squares or each as two triangles.
fn cube(triangles: bool, size: f64) -> Vec<Vec<DVec3>> {
    let mut sides = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let corner = |u: f64, v: f64| {
                let mut p = DVec3::ZERO;
                p[axis] = side;
                p[(axis + 1) % 3] = u * side;
                p[(axis + 2) % 3] = v;
                p * size
            };
            let [a, b, c, d] =
                [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(u, v)| corner(u, v));
            if triangles {
                sides.extend([vec![a, b, c], vec![a, c, d]]);
            } else {
                sides.push(vec![a, b, c, d]);
            }
        }
    }
    sides
}

#[test]
fn a_cube_has_a_front_for_every_back() {
    for (triangles, size) in [(false, 1.0), (true, 1.0), (true, 3e-20)] {
        let faces = faces(&cube(triangles, size), None);
        let mut random = Random::new(5);
        for _ in 0..8 {
            for camera in cameras(&mut random, size, PIXELS) {
                let Ok(rays) = Rays::new(&camera, &faces) else { continue };
                let inside = match camera.viewpoint() {
                    crate::Viewpoint::Eye(eye) => eye.abs().max_element() / size,
                    crate::Viewpoint::Direction(_) => 2.0,
                };
                if (inside - 1.0).abs() < 1e-12 {
                    continue; // on the surface, or next to it: matrices round their eyes
                }
                // From outside, each ray that enters also leaves; from inside, each ray leaves once.
                let expected = if inside < 1.0 { -1 } else { 0 };
                for &(signed, all) in &layers(&rays, &faces) {
                    assert_eq!(signed, expected, "{camera:?}");
                    assert!(all <= 2, "{all} layers in {camera:?}");
                }
            }
        }
    }
}

#[test]
fn a_grid_of_triangles_is_met_once_everywhere() {
    // Triangles of side 1/4, seen from where rays pass through their corners and along their edges.
    let mut polygons = Vec::new();
    let at = |i: i32, j: i32| DVec3::new(f64::from(i), f64::from(j), 0.0) / 4.0;
    for (i, j) in (-4..4).flat_map(|i| (-4..4).map(move |j| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        let flip = (i + j) % 2 == 0;
        polygons.extend(if flip {
            [vec![a, b, c], vec![a, c, d]]
        } else {
            [vec![a, b, d], vec![b, c, d]]
        });
    }
    let faces = faces(&polygons, None);
    let quarter = std::f64::consts::FRAC_PI_2;
    for z in [0.5, 1.0, 2.0] {
        let eye = DVec3::new(0.0, 0.0, z);
        let shifted = DVec3::new(1.0 / 32.0, -1.0 / 32.0, 0.0);
        for offset in [DVec3::ZERO, shifted, shifted * 2.0, shifted * 8.0] {
            let eye = eye + offset;
            let camera = Camera::perspective(eye, offset, DVec3::Y, quarter, PIXELS).unwrap();
            let parallel =
                Camera::parallel(DVec3::NEG_Z, DVec3::Y, offset, 2.0 * z, PIXELS).unwrap();
            for camera in [camera, parallel] {
                let rays = Rays::new(&camera, &faces).unwrap();
                for (i, &(signed, all)) in layers(&rays, &faces).iter().enumerate() {
                    let pitch = 2.0 * z / 32.0;
                    let x = (i % 32) as f64 * pitch - 15.5 * pitch + offset.x;
                    let y = 15.5 * pitch - (i / 32) as f64 * pitch + offset.y;
                    // Ties belong to the face on their right and below.
                    let inside = (-1.0..1.0).contains(&x) && -1.0 < y && y <= 1.0;
                    assert_eq!(
                        (signed, all),
                        (i32::from(inside), i32::from(inside)),
                        "{x} {y} {camera:?}"
                    );
                }
            }
        }
    }
}
