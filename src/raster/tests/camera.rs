//! Rays agree with their camera.

use dashu_int::IBig;
use dashu_ratio::RBig;
use glam::{DMat4, DVec3};
use num_traits::FromPrimitive;

use super::{Random, cameras, faces, ray, skew};
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
                // The point where the ray is near the scene.
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

/// The largest distance of a ray from its true position, in pixels, over the corners of the picture. For a
/// parallel camera, positions are relative to the middle of the picture. `None` if there are no rays.
fn off(camera: &Camera, faces: &Faces, samples: u32) -> Option<f64> {
    let rays = Rays::sampled(camera, faces, samples).ok()?;
    let is_parallel = camera.eye().is_none();
    let exact = |value: f64| RBig::from_f64(value).unwrap();
    let [width, height] = camera.pixel_size().map(|side| match is_parallel {
        true => faces.lattice().length_to_lattice(side),
        false => side,
    });
    let axes = [(camera.middle(), 1.0), (camera.right(), width), (camera.up(), -height)];
    let axes = axes.map(|(axis, scale)| axis.to_array().map(|c| exact(c) * exact(scale)));
    let determinant = |[a, b, c]: [&[RBig; 3]; 3]| {
        let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
        &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
    };
    let whole = determinant(axes.each_ref());
    let size = rays.size();
    let mut most = 0.0_f64;
    for corner in 0..4 {
        let [x, y] = [0, 1].map(|i: usize| (size[i] - 1) * (corner >> i & 1));
        let [start, way] = ray(&rays, x, y);
        let arm = if is_parallel {
            let [opposite, _] = ray(&rays, size[0] - 1 - x, size[1] - 1 - y);
            [0, 1, 2].map(|i: usize| RBig::from(&start[i] - &opposite[i]) / RBig::from(2))
        } else {
            way.map(|c: IBig| RBig::from(c))
        };
        let [middle, right, down] = axes.each_ref();
        let along = determinant([&arm, right, down]) / &whole;
        let shares = [[middle, &arm, down], [middle, right, &arm]];
        let weight = if is_parallel { RBig::from(1) } else { along };
        let places = shares.map(|columns| determinant(columns) / &whole / &weight);
        let off = [(&places[0], x, size[0]), (&places[1], y, size[1])].map(|(place, at, side)| {
            let expected = (f64::from(at) - 0.5 * f64::from(side - 1)) / f64::from(samples);
            (place - exact(expected)).to_f64().value()
        });
        most = most.max(off[0].hypot(off[1]));
    }
    Some(most)
}

/// The views include the narrowest views that are accepted, oblong and skewed pixels, and pictures far
/// off-axis.
#[test]
fn rays_of_skewed_cameras_are_less_than_a_thousandth_of_a_pixel_off() {
    let mut random = Random::new(11);
    let faces = box_of(1.0);
    let (mut worst, mut refused, mut accepted) = (0.0_f64, 0, 0);
    let sizes = [[1000, 1000], [64, 48], [1, 1], [30, 90], [640, 480]];
    for round in 0..1500 {
        let size = sizes[round % 5];
        let matrix = cameras(&mut random, 1.0, size)[random.below(18) as usize].matrix(1.0, 2.0);
        let narrow = 10.0_f64.powf(5.5 + 5.5 * random.unit());
        let oblong = 10.0_f64.powf(random.unit());
        let mut shear = DMat4::from_scale(DVec3::new(narrow * oblong, narrow, 1.0));
        shear.y_axis.x = narrow * 10.0 * oblong * random.unit();
        let Ok(camera) = Camera::from_matrix(shear * skew(&mut random) * matrix, size) else {
            continue;
        };
        let samples = [1, 1, 3][random.below(3) as usize];
        match off(&camera, &faces, samples) {
            Some(off) => {
                assert!(off < 1e-3, "{off} px: {camera:?}");
                (worst, accepted) = (worst.max(off), accepted + 1);
            }
            None => refused += 1,
        }
    }
    assert!(accepted > 400 && refused > 200, "{accepted} {refused}");
    assert!(worst > 1e-4, "the nearest to the limit: {worst}");
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
