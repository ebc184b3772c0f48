//! Judgements of right trees and of wrong orders.

mod contested;
mod grazing;
mod mix;
mod orders;

use super::verify;
use crate::paint::paint_tree_in_colour;
use crate::raster::{colour_of, picture};
use crate::scene::Scene;
use crate::view::{Camera, views};
use crate::{BspTree, BuildOptions, Heuristic, scene};
use glam::DVec3;

/// Cameras around a scene and inside it, with small pictures.
fn cameras(scene: &Scene, count: usize) -> Vec<Camera> {
    let (low, high) = scene.bounds().unwrap();
    views([low, high], scene.up(), count, [96, 72], 3).unwrap()
}

#[test]
fn a_tree_paints_the_picture_of_the_depth_buffer() {
    for scene in [scene::newell_bars(), scene::crossing(5), scene::random_triangles(60, 1)] {
        let cameras = cameras(&scene, 4);
        for &heuristic in Heuristic::ALL {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
            let tree = options.build(scene.polygons()).unwrap();
            for camera in &cameras {
                let result = verify(&tree, camera).unwrap();
                let place = format!("{} {heuristic} {camera:?}", scene.name());
                let comparison = &result.comparison;
                assert!(comparison.covered > 0, "{place}");
                assert_eq!(comparison.wrong(), 0, "{place}");
                assert_eq!(result.front_to_back.wrong(), 0, "{place}");
                assert_eq!(result.miscounted, 0, "{place}");
                assert_eq!(result.orders, Ok(()), "{place}");
                assert!(result.is_right(), "{place}");
            }
        }
    }
}

/// Square 0 is at the side, and square 1 counts as on its plane. The eye is between this plane and square 1.
/// So square 2, far behind square 1, counts as nearer.
#[test]
fn pictures_of_an_eye_within_the_tolerance_of_a_plane_are_contested() {
    let square =
        |x: f64, z: f64, r: f64| [[x - r, -r, z], [x + r, -r, z], [x + r, r, z], [x - r, r, z]];
    for unit in [1e-2, 1e-6] {
        let squares = [square(10.0, 0.0, 1.0), square(0.0, 0.5 * unit, 2.0), square(0.0, 1.0, 5.0)];
        let look = |tolerance, z: f64| {
            let first = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
            let tree = first.with_tolerance(tolerance).build(squares).unwrap();
            let eye = DVec3::new(0.0, 0.0, z * unit);
            let camera = Camera::perspective(eye, eye + DVec3::Z, DVec3::Y, 1.0, [40, 30]);
            verify(&tree, &camera.unwrap()).unwrap().comparison
        };
        let within = look(unit, 0.2);
        assert_eq!((within.wrong(), within.contested), (0, 40 * 30), "{unit}");
        for (tolerance, z) in [(0.0, 0.2), (unit, -1.2)] {
            let comparison = look(tolerance, z);
            assert_eq!((comparison.wrong(), comparison.contested), (0, 0), "{unit} {z}");
        }
    }
}

/// Two walls, seen along the plane of a floor at the side. Both reach across that plane by less than the
/// tolerance, one upwards and the other downwards.
#[test]
fn pixels_of_rays_along_a_plane_within_the_tolerance_are_contested() {
    let unit = 1e-2;
    let wall = |x: f64, low: f64, high: f64| {
        [[x, -1.0, low], [x, 1.0, low], [x, 1.0, high], [x, -1.0, high]]
    };
    let floor = [[3.0, 5.0, 0.0], [4.0, 5.0, 0.0], [4.0, 6.0, 0.0], [3.0, 6.0, 0.0]];
    let polygons = [floor, wall(1.0, -0.5 * unit, 1.0), wall(2.0, -1.0, 0.5 * unit)];
    let look = |tolerance, z: f64| {
        let first = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
        let tree = first.with_tolerance(tolerance).build(polygons).unwrap();
        let eye = DVec3::new(-1.0, 0.0, z);
        let target = DVec3::new(1.0, 0.0, 0.0);
        let camera = Camera::perspective(eye, target, DVec3::Z, 0.01, [40, 40]).unwrap();
        verify(&tree, &camera).unwrap().comparison
    };
    // From below, the wall in front is painted first, and the far wall over its lower end.
    let within = look(unit, -1e-6);
    assert_eq!(within.wrong(), 0);
    assert!(within.contested > 0);
    let exact = look(0.0, -1e-6);
    assert_eq!((exact.wrong(), exact.contested), (0, 0));
}

#[test]
fn opaque_colours_equal_the_picture_of_polygons() {
    let scene = scene::random_triangles(60, 1);
    let tree = BspTree::build(scene.polygons()).unwrap();
    let camera = &cameras(&scene, 1)[0];
    let seen = verify(&tree, camera).unwrap();
    let look = |polygon: usize| (colour_of(polygon), 1.0);
    let picture = picture(&seen.rays, tree.faces(), &seen.painted, colour_of, [9; 3]);
    let viewpoint = camera.viewpoint();
    assert!(paint_tree_in_colour(&tree, viewpoint, &seen.rays, look, [9; 3]) == picture);
    let clear = |polygon: usize| (colour_of(polygon), 0.0);
    let nothing = paint_tree_in_colour(&tree, viewpoint, &seen.rays, clear, [9; 3]);
    assert!(nothing.iter().all(|&channel| channel == 9));
}

#[test]
fn an_empty_tree_is_an_empty_picture() {
    let tree = BspTree::build(Vec::<[[f64; 3]; 3]>::new()).unwrap();
    let bounds = [[0.0; 3], [1.0; 3]].map(glam::DVec3::from);
    let camera = &views(bounds, glam::DVec3::Z, 1, [8, 8], 0).unwrap()[0];
    let result = verify(&tree, camera).unwrap().comparison;
    assert_eq!((result.covered, result.wrong()), (0, 0));
}
