//! Rays are those of their camera.

use glam::DVec3;

use super::{Random, cameras, faces, ray};
use crate::exact::Faces;
use crate::raster::{Rays, depth_map, zbuffer};
use crate::view::Camera;

fn box_of(size: f64) -> Faces {
    let corner = DVec3::splat(size);
    faces(&[vec![-corner, corner, DVec3::X * size]], None)
}

#[test]
fn the_ray_of_a_pixel_projects_to_its_centre() {
    let mut random = Random::new(9);
    for size in [1.0, 1e-30, 3e200] {
        let faces = box_of(size);
        for camera in cameras(&mut random, size, [31, 20]) {
            let Ok(rays) = Rays::new(&camera, &faces) else { continue };
            for [x, y] in [[0, 0], [30, 0], [0, 19], [15, 10]] {
                let [start, direction] = ray(&rays, x, y)
                    .map(|v| DVec3::from_array(v.map(|c| c.to_string().parse().unwrap())));
                let reach = direction.abs().max_element();
                // Where the ray is near the scene.
                let along = -start.dot(direction) / direction.length_squared();
                let step = if along > 0.0 { along } else { 2f64.powi(50) / reach };
                let point = faces.lattice().to_world((start + direction * step).to_array());
                let [px, py] = camera.project(point).unwrap();
                let error = (px - f64::from(x) - 0.5).abs().max((py - f64::from(y) - 0.5).abs());
                assert!(error < 1e-3, "{x} {y} came back as {px} {py} of {camera:?}");
            }
        }
    }
}

#[test]
fn cameras_that_the_integers_cannot_hold_are_errors() {
    let (faces, up, size) = (box_of(1.0), DVec3::Z, [64, 64]);
    let message = |camera: Camera| Rays::new(&camera, &faces).unwrap_err().to_string();
    let from = |eye: f64, fov| Camera::perspective(DVec3::X * eye, DVec3::ZERO, up, fov, size);
    assert!(Rays::new(&from(1e8, 1e-8).unwrap(), &faces).is_ok());
    assert!(message(from(1e12, 1e-8).unwrap()).contains("parallel camera"));
    assert!(message(from(1e300, 1e-8).unwrap()).contains("parallel camera"));
    assert!(message(from(5.0, 1e-12).unwrap()).contains("narrow"));
    let at = |centre: f64, height| {
        Camera::parallel(DVec3::X, up, DVec3::Y * centre, height, size).unwrap()
    };
    assert!(Rays::new(&at(0.0, 100.0), &faces).is_ok());
    assert!(message(at(0.0, 1e5)).contains("too far"));
    assert!(message(at(1e300, 1.0)).contains("too far"));
    assert!(message(at(0.0, 1e-14)).contains("narrow"));
}

#[test]
fn an_empty_scene_makes_an_empty_picture() {
    let faces = faces(&[], None);
    let camera = Camera::looking_at_all([DVec3::ZERO, DVec3::ZERO], DVec3::Z, [5, 4]).unwrap();
    let rays = Rays::new(&camera, &faces).unwrap();
    let depth = zbuffer(&rays, &faces);
    assert_eq!(depth.image().covered(), 0);
    assert_eq!(depth_map(&depth, [255, 40]), [0; 5 * 4 * 3]);
}
