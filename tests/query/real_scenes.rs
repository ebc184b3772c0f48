//! Real scenes, from the folder that `BINSPACE_SCENES` names. A million rays take some minutes:
//!
//! ```sh
//! BINSPACE_EFFORT=140 BINSPACE_SCENES=… cargo test --release query::real_scenes -- --ignored --nocapture
//! ```

#![allow(clippy::print_stderr, reason = "the scores are shown on request")]

use rayon::prelude::*;
use testkit::effort::effort;
use testkit::hits::{Oracle, Score};
use testkit::prelude::*;
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

/// Parts that run in parallel; each shoots rays from a separate seed.
const PARTS: usize = 64;

#[test]
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn rays_at_real_scenes_agree_with_integers() {
    let folder = real_scenes::folder();
    let rays = 7_000 * effort();
    let mut all = Score::default();
    for name in SCENES {
        let (scene, _) = Scene::read_obj(folder.join(name)).expect("a scene");
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        let oracle = Oracle::new(&tree);
        let begin = std::time::Instant::now();
        let shots = Shots::new(tree.faces());
        let shoot = |part: usize| {
            let (mut dice, mut score) = (Dice(part as u64), Score::default());
            for _ in 0..=rays / SCENES.len() / PARTS {
                let judged = oracle.check(shots.ray(&mut dice), &mut score);
                judged.unwrap_or_else(|what| panic!("{name}: {what}"));
            }
            score
        };
        let score = (0..PARTS).into_par_iter().map(shoot).reduce(Score::default, Score::plus);
        eprintln!("{name}: {score:?}, {:.1} s", begin.elapsed().as_secs_f64());
        all = all.plus(score);
    }
    eprintln!("all: {all:?}");
    assert!(all.rays >= rays && all.hits > rays && all.ties > rays / 4, "{all:?}");
    assert!(all.blocked.min(all.clear) > rays / 10 && all.in_plane > rays / 10, "{all:?}");
}
