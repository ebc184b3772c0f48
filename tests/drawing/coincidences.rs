//! Small scenes full of coincidences, from hard places.

use binspace::view::views;
use proptest::prelude::*;
use testkit::fill::{Score, check};
use testkit::hard::HardScene;
use testkit::layered::{Layers, check_layers, check_mixed};
use testkit::prelude::*;

#[test]
fn hard_scenes_are_drawn_as_rays_meet_them() {
    let cases = (hard::scene(), hard::heuristic(), any::<u64>());
    let score = tally(file!(), 256, cases, |score: &mut Score, (scene, heuristic, seed)| {
        for_each_view(&scene, heuristic, seed, |tree, camera| check(tree, camera, score))
            .map_err(fail)
    });
    enough!(score.pictures > 400, score.pixels > 500_000; "{score:?}");
    enough!(score.paths > 1000, score.clipped > 10; "{score:?}");
}

#[test]
fn layers_of_hard_scenes_agree_with_the_tree() {
    let cases = (hard::scene(), hard::heuristic(), any::<u64>());
    let score = tally(file!(), 256, cases, |score: &mut Layers, (scene, heuristic, seed)| {
        for_each_view(&scene, heuristic, seed, |tree, camera| check_layers(tree, camera, score))
            .map_err(fail)
    });
    enough!(score.pixels > 500_000, score.layers > 100_000; "{score:?}");
    assert!(
        score.paths > score.polygons + 10 && 2 * score.fragments > 3 * score.paths,
        "{score:?}"
    );
}

#[test]
fn layers_of_hard_scenes_end_at_opaque_polygons() {
    let cases = (hard::scene(), hard::heuristic(), any::<u64>());
    let score = tally(file!(), 128, cases, |score: &mut Layers, (scene, heuristic, seed)| {
        let opacity = |polygon: usize| [1.0, 0.5, 0.25, 1.0, 0.0][polygon * 7 % 11 % 5];
        for_each_view(&scene, heuristic, seed, |tree, camera| {
            check_mixed(tree, camera, &opacity, score)
        })
        .map_err(fail)
    });
    enough!(score.pixels > 250_000, score.layers > 25_000; "{score:?}");
    enough!(score.hidden > 50, score.small > 5, score.regions > 500; "{score:?}");
}

fn for_each_view(
    scene: &HardScene,
    heuristic: Heuristic,
    seed: u64,
    mut check: impl FnMut(&BspTree, &Camera) -> Result<(), String>,
) -> Result<(), String> {
    let tree = scene.build(heuristic)?;
    let Some(bounds) = scene.bounds() else { return Ok(()) };
    for camera in views(bounds, DVec3::Z, 3, [48, 36], seed).into_iter().flatten() {
        // Some scenes are flat: a camera inside is too near to distinguish pixels.
        if Rays::new(&camera, tree.faces()).is_ok() {
            check(&tree, &camera)?;
        }
    }
    Ok(())
}
