//! Real scenes, from the folder that `BINSPACE_SCENES` names. A million rays take some minutes:
//!
//! ```sh
//! BINSPACE_EFFORT=140 BINSPACE_SCENES=… cargo test --release query::real_scenes -- --ignored --nocapture
//! ```

#![allow(clippy::print_stderr, reason = "the scores are shown on request")]

use binspace::BspTree;
use binspace::scene::Scene;
use rayon::prelude::*;
use testkit::dice::Dice;
use testkit::effort::effort;
use testkit::enough;
use testkit::hits::{Oracle, Score};
use testkit::quick_hits::QuickOracle;
use testkit::real_scenes;
use testkit::shots::Shots;

const SCENES: [&str; 7] = [
    "bunny_4k.obj",
    "doom_e1m1.obj",
    "doom_map12_big.obj",
    "forklift_1k.obj",
    "spider_1k.obj",
    "suzanne_2k.obj",
    "teapot_quads_2k.obj",
];

/// Shoots rays from many seeds.
fn shoot(
    (name, tree): (&str, &BspTree),
    rays: usize,
    check: impl Fn(binspace::Ray, &mut Score) -> Result<(), String> + Sync,
) -> Score {
    let (shots, parts) = (Shots::new(tree.faces()), 64);
    (0..parts)
        .into_par_iter()
        .map(|part| {
            let (mut dice, mut score) = (Dice(part), Score::default());
            for _ in 0..rays / parts as usize + 1 {
                check(shots.ray(&mut dice), &mut score)
                    .unwrap_or_else(|what| panic!("{name}: {what}"));
            }
            score
        })
        .reduce(Score::default, Score::plus)
}

#[test]
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn rays_at_real_scenes_hit_what_integers_say() {
    let folder = real_scenes::folder();
    let rays = 7_000 * effort();
    let mut all = Score::default();
    for name in SCENES {
        let (scene, _) = Scene::read_obj(folder.join(name)).expect("a scene");
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        let oracle = QuickOracle::new(&tree);
        let begin = std::time::Instant::now();
        let check = |ray, score: &mut Score| oracle.check(ray, score);
        let score = shoot((name, &tree), rays / SCENES.len(), check);
        eprintln!("{name}: {score:?}, {:.1} s", begin.elapsed().as_secs_f64());
        all = all.plus(score);
    }
    eprintln!("all: {all:?}");
    assert!(all.rays >= rays && all.hits > rays && all.ties > rays / 4, "{all:?}");
    assert!(all.blocked.min(all.clear) > rays / 10 && all.in_plane > rays / 10, "{all:?}");
}

/// A few, by the other oracle.
#[test]
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn rays_at_real_scenes_hit_what_rationals_say() {
    let folder = real_scenes::folder();
    for name in ["forklift_1k.obj", "spider_1k.obj"] {
        let (scene, _) = Scene::read_obj(folder.join(name)).expect("a scene");
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        let oracle = Oracle::new(&tree);
        let score = shoot((name, &tree), 500, |ray, score| oracle.check(ray, score));
        enough!(score.rays >= 500, score.hits > 500; "{score:?}");
    }
}
