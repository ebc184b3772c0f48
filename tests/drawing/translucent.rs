//! Drawings in which nothing is hidden, of whole scenes.

use super::scenes::cameras;
use binspace::BuildOptions;
use binspace::raster::Rays;
use binspace::scene::{Builtin, Scene};
use testkit::dice::Dice;
use testkit::enough;
use testkit::layered::{Layers, check_layers};
use testkit::scenes::{scene_of, triangles};

fn check_scene(scene: &Scene, score: &mut Layers) {
    let tree = BuildOptions::DEFAULT.build(scene.polygons()).unwrap();
    for camera in cameras(scene, 4, [96, 72]) {
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        check_layers(&tree, &camera, rays, score)
            .unwrap_or_else(|fault| panic!("{}, {camera:?}: {fault}", scene.name()));
    }
}

#[test]
fn layers_of_whole_scenes_are_those_of_the_tree() {
    let mut score = Layers::default();
    for builtin in Builtin::ALL {
        let size = builtin.default_size().map(|size| size.min(300));
        check_scene(&builtin.build(size, 3), &mut score);
    }
    enough!(score.pixels > 400_000, score.layers > 500_000; "{score:?}");
    assert!(score.unsure < score.pixels / 100, "{score:?}");
    // Most cuts of the tree are undone.
    assert!(score.paths * 2 < score.polygons * 3, "{score:?}");
}

/// Scenes of random triangles that cross: small ones, large ones, and few that are larger still.
pub(crate) fn crossing_triangles() -> impl Iterator<Item = Scene> {
    let mut dice = Dice(1);
    [(300, 0.1), (150, 0.5), (50, 1.0)].into_iter().map(move |(count, edge)| {
        let triangles = triangles(&mut dice, count, [0.0, 1.0], edge);
        scene_of(format!("{count} triangles"), triangles)
    })
}

/// Polygons that cross have to be in parts.
#[test]
fn layers_of_crossing_triangles() {
    let mut score = Layers::default();
    crossing_triangles().for_each(|scene| check_scene(&scene, &mut score));
    assert!(score.layers > 200_000 && score.paths > 3 * score.polygons, "{score:?}");
}
