//! Scenes rotated off the axes, where free planes cut and own planes are needed.

use super::scale::{mosaic, with_a_small_stack};
use binspace::glam::DQuat;
use binspace::scene::ScenePolygon;
use std::f64::consts::{PI, TAU};
use testkit::orders;
use testkit::prelude::*;
use testkit::scenes::scene_of;

/// The same scene rotated away from all axes, where every free plane cuts.
fn tilted(scene: &Scene) -> Vec<Vec<DVec3>> {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.7, 0.2).normalize(), 1.1);
    let turned =
        |polygon: ScenePolygon<'_>| polygon.points().iter().map(|&corner| turn * corner).collect();
    scene.polygons().map(turned).collect()
}

/// The sides of a prism.
fn prism(sides: u32) -> impl Iterator<Item = Vec<DVec3>> {
    (0..sides).map(move |i| {
        let at = |k: u32, z| {
            let a = f64::from(k) * TAU / f64::from(sides);
            DVec3::new(a.cos(), a.sin(), z)
        };
        vec![at(i, -20.0), at(i + 1, -20.0), at(i + 1, 20.0), at(i, 20.0)]
    })
}

/// A sphere of slices and rings.
fn globe(slices: u32, rings: u32, radius: f64) -> Vec<[DVec3; 3]> {
    let at = |slice: u32, ring: u32| {
        let a = f64::from(slice % slices) * TAU / f64::from(slices);
        let b = f64::from(ring) * PI / f64::from(rings);
        DVec3::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos()) * radius
    };
    let mut faces = Vec::new();
    for (slice, ring) in (0..slices).flat_map(|slice| (0..rings).map(move |ring| (slice, ring))) {
        let [a, b] = [at(slice, ring), at(slice + 1, ring)];
        let [c, d] = [at(slice, ring + 1), at(slice + 1, ring + 1)];
        if ring > 0 {
            faces.push([a, c, b]);
        }
        if ring + 1 < rings {
            faces.push([b, c, d]);
        }
    }
    faces
}

/// Each scene has a largest allowed number of fragments per face.
#[test]
fn scenes_turned_off_the_axes_are_cut_little() {
    let stack = |gap: f64| {
        scene_of(
            "polygons",
            (0..5000).map(|i| {
                let corner = |x, y| DVec3::new(x, y, f64::from(i) * gap);
                [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)]
            }),
        )
    };
    let shells = (1..=10).flat_map(|radius| globe(40, 20, radius.into()));
    for (name, scene, most) in [
        ("chain", scene::chain(20_000), 1.05),
        ("dense stack", stack(0.001), 1.0),
        ("stack", stack(0.01), 1.2),
        ("loose stack", stack(0.1), 1.1),
        ("mosaic", mosaic(100), 1.2),
        ("prism", scene_of("polygons", prism(10_000)), 1.0),
        ("slim globe", scene_of("polygons", globe(1000, 4, 1.0)), 1.0),
        ("globe", scene_of("polygons", globe(100, 50, 1.0)), 1.1),
        ("shells", scene_of("polygons", shells), 1.6),
        ("city", scene::city(3000, 1), 1.4),
    ] {
        let stats = with_a_small_stack(|| BspTree::build(tilted(&scene)).expect("finite").stats());
        assert!(stats.fragments as f64 <= most * stats.faces as f64, "{name}: {stats:?}");
    }
}

/// The number of progress calls measures the work.
#[test]
fn a_disc_within_a_prism_does_not_keep_it_whole() {
    let calls = |polygons: &[Vec<DVec3>]| {
        let mut calls = 0;
        let tree = BuildOptions::DEFAULT.build_with_progress(polygons, |_| {
            calls += 1;
            ControlFlow::Continue(())
        });
        let tree = tree.expect("finite");
        assert_eq!((tree.len(), tree.validate()), (polygons.len(), Ok(())));
        calls
    };
    let mut polygons = vec![vec![DVec3::X * 0.3, DVec3::Y * 0.3, DVec3::new(-0.3, -0.3, 0.0)]];
    polygons.extend(prism(3000));
    let polygons = tilted(&scene_of("polygons", polygons));
    let (whole, empty) = (calls(&polygons), calls(&polygons[1..]));
    assert!(whole <= 2 * empty, "{whole} calls, and {empty} without the disc");
}

/// A prism with some polygons inside. The convex part is peeled at once, and the rest is divided.
#[test]
fn a_convex_set_with_things_inside_is_taken_apart_around_them() {
    let mut polygons = tilted(&scene_of("polygons", globe(600, 4, 2.0)));
    polygons.extend(tilted(&scene::crossing(20)));
    let tree = BspTree::build(&polygons).expect("finite");
    assert_eq!(tree.validate(), Ok(()));
    let inside = BspTree::build(&polygons[polygons.len() - 20..]).expect("finite").len();
    assert!(tree.len() <= polygons.len() + 4 * inside, "{tree:?}, {inside}");
    for viewpoint in [Viewpoint::eye([0.1, 10.3, 0.2]), Viewpoint::eye([0.1, 0.3, 0.2])] {
        assert_eq!(orders::check(&tree, viewpoint), Ok(()));
    }
}
