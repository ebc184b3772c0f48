//! Real scenes, from the folder that `BINSPACE_SCENES` names. A million rays take minutes:
//!
//! ```sh
//! BINSPACE_SCENES=… cargo test --release --test query a_million -- --ignored --nocapture
//! ```

#![allow(clippy::print_stderr, reason = "the scores are shown on request")]

use super::support::dice::Dice;
use super::support::hits::{Oracle, Score};
use super::support::real_scenes;
use super::support::shots::Shots;
use binspace::BspTree;
use binspace::scene::Scene;
use rayon::prelude::*;

const SCENES: [&str; 6] = [
    "bunny_4k.obj",
    "doom_e1m1.obj",
    "forklift_1k.obj",
    "spider_1k.obj",
    "suzanne_2k.obj",
    "teapot_quads_2k.obj",
];

fn shoot(rays: usize) {
    let Some(folder) = real_scenes::folder("rays at real scenes") else { return };
    let mut all = Score::default();
    for name in SCENES {
        let (scene, _) = Scene::read_obj(folder.join(name)).expect("a scene");
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        let (oracle, shots) = (Oracle::new(&tree), Shots::new(tree.faces()));
        let (each, parts) = (rays / SCENES.len(), 64);
        let score = (0..parts)
            .into_par_iter()
            .map(|part| {
                let (mut dice, mut score) = (Dice(part), Score::default());
                for _ in 0..each / parts as usize + 1 {
                    oracle
                        .check(shots.ray(&mut dice), &mut score)
                        .unwrap_or_else(|what| panic!("{name}: {what}"));
                }
                score
            })
            .reduce(Score::default, Score::add);
        eprintln!("{name}: {score:?}");
        all = all.add(score);
    }
    assert!(all.rays >= rays && all.hits > rays && all.ties > rays / 4, "{all:?}");
    assert!(all.blocked.min(all.clear) > rays / 10 && all.in_plane > rays / 10, "{all:?}");
}

#[test]
fn rays_at_real_scenes_hit_what_rationals_say() {
    shoot(3000);
}

#[test]
#[ignore = "takes minutes"]
fn a_million_rays_at_real_scenes_hit_what_rationals_say() {
    shoot(1_000_000);
}
