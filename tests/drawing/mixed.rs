//! Drawings of scenes in which some polygons are translucent and some are not.

use super::scenes::cameras;
use super::translucent::crossing_triangles;
use binspace::drawing::{EdgeKind, EdgeRun, VisibilityMap};
use binspace::glam::DVec3;
use binspace::raster::Rays;
use binspace::scene::{Builtin, Scene};
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions};
use testkit::enough;
use testkit::layered::{Layers, check_mixed, check_sight};

/// Opacities of a third of the polygons, of nearly all, and with some left out.
const MIXES: [fn(usize) -> f64; 3] = [
    |polygon| if polygon.is_multiple_of(3) { 0.5 } else { 1.0 },
    |polygon| if polygon.is_multiple_of(17) { 1.0 } else { 0.25 },
    |polygon| [0.0, 1.0, 0.75, 1.0][polygon / 5 % 4],
];

fn check_scene(scene: &Scene, score: &mut Layers) {
    let tree = BuildOptions::DEFAULT.build(scene.polygons()).unwrap();
    for (i, camera) in cameras(scene, 4, [96, 72]).into_iter().enumerate() {
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        check_mixed(&tree, &camera, rays.clone(), &MIXES[i % 3], score)
            .and_then(|()| check_sight(&tree, &camera, rays, &MIXES[i % 3], score))
            .unwrap_or_else(|fault| panic!("{}, {i}, {camera:?}: {fault}", scene.name()));
    }
}

#[test]
fn layers_of_whole_scenes_end_at_what_is_opaque() {
    let mut score = Layers::default();
    for builtin in Builtin::ALL {
        let size = builtin.default_size().map(|size| size.min(300));
        check_scene(&builtin.build(size, 3), &mut score);
    }
    enough!(score.pixels > 400_000, score.layers > 300_000; "{score:?}");
    assert!(score.unsure < score.pixels / 100, "{score:?}");
    enough!(score.hidden > 6_000, score.rays > 10_000, score.small > 3_000; "{score:?}");
    enough!(score.regions > 30_000; "{score:?}");
    // Few polygons are in parts.
    assert!(score.paths * 10 < score.polygons * 11, "{score:?}");
}

/// Polygons that cross: opaque ones are clipped, translucent ones in parts.
#[test]
fn layers_of_crossing_triangles_end_at_what_is_opaque() {
    let mut score = Layers::default();
    crossing_triangles().for_each(|scene| check_scene(&scene, &mut score));
    assert!(score.clipped > 50 && score.paths > score.polygons, "{score:?}");
}

/// Two panes that go through one another: the line is there once, whatever shows through.
#[test]
fn panes_cross_in_one_line() {
    let upright = [[0.3, -1.0, -1.0], [0.3, 1.0, -1.0], [0.3, 1.0, 1.0], [0.3, -1.0, 1.0]];
    let level = [[-1.0, -1.0, 0.1], [1.0, -1.0, 0.1], [1.0, 1.0, 0.1], [-1.0, 1.0, 0.1]];
    let tree = BspTree::build([upright, level].map(|square| square.map(DVec3::from))).unwrap();
    let eye = DVec3::new(4.0, 3.0, 5.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.9, [300, 200]).unwrap();
    let rays = Rays::new(&camera, tree.faces()).unwrap();
    let runs = |opacities: [f64; 2]| {
        let opacity = |polygon: usize| opacities[polygon];
        let map = VisibilityMap::with_opacities(&tree, rays.clone(), opacity).unwrap();
        map.crossings().unwrap()
    };
    let length = |run: &EdgeRun| {
        let [[ax, ay], [bx, by]] = run.ends;
        (bx - ax).hypot(by - ay)
    };
    let [glass, thick, front] = [[0.5, 0.5], [1.0, 1.0], [1.0, 0.5]].map(runs);
    for runs in [&glass, &thick, &front] {
        assert_eq!(runs.len(), 1, "{runs:?}");
        assert_eq!((runs[0].polygon, runs[0].kind), (0, EdgeKind::Crossing(1)));
        assert!(length(&runs[0]) <= length(&glass[0]) + 1e-9);
    }
    // All of it shows through glass.
    assert!((length(&glass[0]) - length(&thick[0])).abs() < 1e-9, "{glass:?} {thick:?}");
    assert!(runs([0.0, 0.5]).is_empty());
}
