//! The whole field on the same scenes.

use std::collections::HashSet;
use testkit::prelude::*;

use super::{
    cameras, covers_by_itself, cycle_that_no_plane_cuts, disjoint, faces, judge, polygons_of, show,
};
use crate::method::{Bsp, Centroid, Method, Options, Space, all};

#[test]
fn names_are_unique() {
    let names: Vec<String> = all(&Options::DEFAULT).iter().map(|method| method.name()).collect();
    let unique: HashSet<&String> = names.iter().collect();
    assert_eq!(unique.len(), names.len(), "{names:?}");
    for name in ["bsp exact", "bsp f64 1e-6", "bsp f32 1e-4", "centroid", "newell", "z f64"] {
        assert!(names.iter().any(|n| n == name), "{name} is not among {names:?}");
    }
    for name in
        ["z 24 trapezoids", "z 24 integer edges", "z 24 or equal", "z 24 larger nearer cleared"]
    {
        assert!(names.iter().any(|n| n == name), "{name} is not among {names:?}");
    }
    let ranged = all(&Options::DEFAULT.with_range(0.5, 100.0));
    assert!(ranged.iter().any(|method| method.name() == "z 24 near 5e-1 far 1e2"));
}

#[test]
fn every_method_paints_every_kind_of_scene() {
    let scenes = [
        disjoint(4, 9),
        cycle_that_no_plane_cuts(),
        polygons_of(&scene::cornell_box()),
        polygons_of(&scene::random_triangles(40, 3)),
        polygons_of(&scene::city(60, 1)),
        vec![],
        vec![vec![DVec3::X, DVec3::Y, DVec3::Z]],
    ];
    for (number, polygons) in scenes.iter().enumerate() {
        let faces = faces(polygons, Some(0.0));
        let cameras = if polygons.is_empty() {
            // If a scene is a single point, its grid has no pixels for a parallel camera.
            cameras(&scenes[0], [40, 30], 4)[..3].to_vec()
        } else {
            cameras(polygons, [40, 30], 4)
        };
        for method in all(&Options::DEFAULT) {
            // An open surface shows its backs.
            if method.name().starts_with("fronts") {
                continue;
            }
            let (mut wrong, mut outside, mut covered) = (0, 0, 0);
            for camera in &cameras {
                let result = judge(&*method, &faces, camera);
                wrong += result.wrong();
                outside += result.holes + result.spills;
                covered += result.covered;
            }
            let name = method.name();
            assert_eq!(covered == 0, polygons.is_empty());
            if ["bsp exact", "z f64"].contains(&&*name) {
                assert_eq!(wrong, 0, "{name} on scene {number}");
            }
            if !covers_by_itself(&name) {
                assert_eq!(outside, 0, "{name} on scene {number}");
            }
            if method.space() == Space::Neither {
                assert!(wrong > 0 || number > 4, "{name} on scene {number}");
                continue;
            }
            assert!(wrong * 4 <= covered, "{name} on scene {number}: {wrong} of {covered}");
        }
    }
}

#[test]
fn a_tree_shows_its_pieces() {
    let polygons = polygons_of(&scene::crossing(4));
    let faces = faces(&polygons, None);
    let method = Bsp::exact(BuildOptions::DEFAULT);
    let prepared = method.prepare(&faces).unwrap();
    let area = |outline: &[[f64; 3]]| {
        let corner = |i: usize| DVec3::from_array(outline[i % outline.len()]);
        let arm = |i: usize| corner(i) - corner(0);
        let sum: DVec3 = (0..outline.len()).map(|i| arm(i).cross(arm(i + 1))).sum();
        0.5 * sum.length()
    };
    let (mut areas, mut count) = (vec![0.0; faces.len()], 0);
    prepared.for_each_piece(&mut |face, outline| {
        areas[face as usize] += area(outline);
        count += 1;
    });
    assert!(count > faces.len());
    for (face, sum) in (0..).zip(areas) {
        let whole = area(faces.corners(face));
        assert!((sum - whole).abs() < 1e-9 * whole, "face {face}: {sum} of {whole}");
    }
    let mut none = 0;
    Centroid.prepare(&faces).unwrap().for_each_piece(&mut |_, _| none += 1);
    assert_eq!(none, 0);
}

#[test]
fn centroids_are_right_for_layers_and_wrong_for_a_long_floor() {
    let camera = |eye: DVec3| Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 1.0, [40, 30]);
    let layers = polygons_of(&scene::layers(10, 0.01));
    let (low, high) = scene::layers(10, 0.01).bounds().unwrap();
    let above = camera((low + high) * 0.5 + DVec3::new(0.3, 0.2, 3.0) * (high - low).length());
    assert_eq!(judge(&Centroid, &faces(&layers, None), &above.unwrap()).wrong(), 0);
    // A floor whose middle is nearer than the box at its far end is painted over the box.
    let floor = vec![
        DVec3::new(-9.0, -9.0, 0.0),
        DVec3::new(9.0, -9.0, 0.0),
        DVec3::new(9.0, 9.0, 0.0),
        DVec3::new(-9.0, 9.0, 0.0),
    ];
    let wall: Vec<DVec3> = [(-8.0, 0.1), (8.0, 0.1), (8.0, 3.0), (-8.0, 3.0)]
        .map(|(x, z)| DVec3::new(x, 6.0, z))
        .to_vec();
    let eye = DVec3::new(0.0, -12.0, 8.0);
    let scene = faces(&vec![floor, wall], None);
    assert!(judge(&Centroid, &scene, &camera(eye).unwrap()).wrong_order > 20);
}

#[test]
fn methods_respect_rays_that_meet_only_fronts() {
    let mut back = vec![DVec3::new(-1.0, -1.0, 1.0), DVec3::new(1.0, -1.0, 1.0), DVec3::Z * 2.0];
    back.reverse();
    let front = vec![DVec3::new(-2.0, -2.0, 0.0), DVec3::new(2.0, -2.0, 0.0), DVec3::Y * 2.0];
    let faces = faces(&vec![front, back], None);
    let eye = DVec3::new(0.0, -0.5, 6.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 1.0, [24, 18]).unwrap();
    let rays = Rays::new(&camera, &faces).unwrap().with_front_faces_only();
    for method in all(&Options::DEFAULT) {
        let image = method.prepare(&faces).unwrap().paint(&camera, &rays).unwrap().image;
        assert!(image.faces().contains(&0) && !image.faces().contains(&1), "{}", method.name());
        let shows_backs = show(&*method, &faces, &camera).image.faces().contains(&1);
        assert_eq!(shows_backs, !method.name().starts_with("fronts"), "{}", method.name());
    }
}
