//! The long run: seed after seed.

#![allow(clippy::print_stdout, reason = "the run prints a table")]

use super::all_scenes::{self, KINDS};
use super::trial::Trial;
use std::collections::BTreeMap;
use testkit::as_given::trees_by_rays::Score;
use testkit::effort::effort;
use testkit::prelude::*;

/// Judges one scene of a seed, with 450 to 850 polygons, or with up to 5 000 polygons and only the fast
/// heuristics.
fn one(seed: u64, kind: usize) -> (String, Score) {
    const FAST: [Heuristic; 4] = [
        Heuristic::Auto,
        Heuristic::FreePlanes,
        Heuristic::Random { seed: 1 },
        Heuristic::Sampled { candidates: 16 },
    ];
    let large = seed % 2 == 1;
    let heuristics: &[Heuristic] = if large { &FAST } else { Heuristic::ALL };
    let trial = Trial { heuristics, views: 20, rays: 20, most: 20 };
    let seed = seed << 8 | kind as u64;
    let mut dice = Dice(seed);
    let n = if large { 1000 + dice.below(4000) } else { 450 + dice.below(400) };
    let scene = match kind.checked_sub(KINDS) {
        None => all_scenes::scene(kind, &mut dice, n),
        Some(noisy) => all_scenes::noisy(noisy, &mut dice, n),
    };
    (scene.name.clone(), trial.hold(&scene, seed))
}

#[test]
#[ignore = "takes a minute for each unit of BINSPACE_EFFORT"]
fn scenes_of_seed_after_seed_are_in_order() {
    // The number of scenes of a name, and their score.
    let mut table: BTreeMap<String, (usize, Score)> = BTreeMap::new();
    for (seed, kind) in (1000..).take(effort()).flat_map(|s| (0..KINDS + 2).map(move |k| (s, k))) {
        let (name, score) = one(seed, kind);
        let row = table.entry(name).or_default();
        *row = (row.0 + 1, row.1.plus(score));
    }
    table.iter().for_each(|(name, (scenes, score))| println!("{name}: {scenes} scenes, {score:?}"));
    assert!(table.len() >= KINDS, "every kind had its turn");
}
