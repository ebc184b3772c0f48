//! Scenes large enough to reach every part of the code: tiles, threads, cycles.

use super::map_of;
use binspace::view::views;
use testkit::fill::{Score, check_with_rays};
use testkit::prelude::*;
use testkit::scenes::{scene_of, triangles};

const SIZE: [u32; 2] = [240, 180];

/// Cameras around a scene and inside it, perspective and parallel.
pub(crate) fn cameras(scene: &Scene, count: usize, size: [u32; 2]) -> Vec<Camera> {
    let (low, high) = scene.bounds().expect("polygons");
    let mut cameras = views([low, high], scene.up(), count, size, 5).unwrap();
    let extent = (high - low).max_element();
    for direction in [DVec3::new(1.0, 2.0, -0.7), DVec3::NEG_Z, DVec3::X] {
        let up = if direction.x == 0.0 { DVec3::Y } else { DVec3::Z };
        cameras.push(Camera::parallel(direction, up, (low + high) * 0.5, extent, size).unwrap());
    }
    cameras
}

fn check_scene(scene: &Scene, score: &mut Score) {
    let tree = BuildOptions::DEFAULT.build(scene.polygons()).unwrap();
    for camera in cameras(scene, 2, SIZE) {
        check_with_rays(&tree, &camera, score)
            .unwrap_or_else(|fault| panic!("{}, {camera:?}: {fault}", scene.name()));
    }
}

#[test]
fn drawings_of_whole_scenes_agree_with_rays() {
    let mut score = Score::default();
    for builtin in Builtin::ALL {
        let size = builtin.default_size().map(|size| size.min(400));
        check_scene(&builtin.build(size, 3), &mut score);
    }
    enough!(score.pixels > 3_500_000, score.pictures > 35; "{score:?}");
    assert!(score.unsure < score.pixels / 100, "{score:?}");
    enough!(score.clipped > 70, score.rays > 1400; "{score:?}");
}

/// More and more polygons per pixel, so that tiles are halved down to a few pixels and less.
#[test]
fn many_small_triangles() {
    let mut dice = Dice(1);
    let mut score = Score::default();
    for (count, edge) in [(3000, 0.03), (1000, 0.3), (200, 1.0)] {
        let triangles = triangles(&mut dice, count, [0.0, 1.0], edge);
        check_scene(&scene_of(format!("{count} triangles"), triangles), &mut score);
    }
    enough!(score.pixels > 700_000, score.clipped > 350; "{score:?}");
}

/// In height fields and convex bodies, no polygon is in a cycle.
#[test]
fn nothing_is_clipped_of_scans() {
    for builtin in [Builtin::Terrain, Builtin::Sphere] {
        let scene = builtin.build(Some(2000), 3);
        let tree = BspTree::build(scene.polygons()).unwrap();
        for camera in cameras(&scene, 4, SIZE) {
            let map = map_of(&tree, &camera);
            let drawing = map.drawing().unwrap();
            assert!(drawing.paths().all(|path| !path.is_clipped()), "{builtin:?}");
        }
    }
}
