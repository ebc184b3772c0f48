//! Orders of trees past every threshold of the builder.

use super::all_scenes::{self, KINDS};
use super::trial::Trial;
use testkit::as_given::trees_by_rays::Score;
use testkit::effort::effort;
use testkit::prelude::*;

#[test]
fn scenes_of_every_kind_are_in_order_by_every_heuristic() {
    let trial = Trial { heuristics: Heuristic::ALL, views: times(3), rays: 8, most: 100 };
    let scores = trial.hold_all(KINDS, 1, |kind, dice| all_scenes::scene(kind, dice, 350));
    for (name, score) in &scores {
        enough!(score.trees >= 6, score.pairs > 12; "{name}: {score:?}");
    }
    let all = Score::total(&scores);
    assert!(all.trees + all.given_up == KINDS * Heuristic::ALL.len(), "{all:?}");
    assert!(all.given_up <= 20, "{all:?}");
    enough!(all.rays > 4_200, all.pairs > 180_000; "{all:?}");
    enough!(all.coplanar > 2_700, all.borders > 4_200; "{all:?}");
    assert!(all.grazing < all.pairs / 20 && all.excused == 0, "{all:?}");
}

#[test]
fn large_scenes_of_every_kind_are_in_order() {
    let heuristics = [Heuristic::Auto, Heuristic::FreePlanes, Heuristic::Random { seed: 7 }];
    let trial = Trial { heuristics: &heuristics, views: 10, rays: 12, most: 20 };
    // Every third kind, and fewer polygons, unless the effort is larger.
    let step = 3 / effort().min(3);
    let scores = trial.hold_all(KINDS.div_ceil(step), 2, |number, dice| {
        let kind = number * step;
        if step > 1 && kind > 0 {
            return all_scenes::scene(kind, dice, 800);
        }
        let n = if kind.is_multiple_of(5) { 5000 } else { 1500 };
        all_scenes::scene(kind, dice, n)
    });
    for (name, score) in &scores {
        enough!(score.trees >= 1, score.pairs > 20; "{name}: {score:?}");
    }
    let all = Score::total(&scores);
    enough!(all.rays > 1600, all.pairs > 40_000; "{all:?}");
}

#[test]
fn noisy_scenes_are_in_order_up_to_the_tolerance() {
    let trial = Trial { heuristics: Heuristic::ALL, views: times(5), rays: 20, most: 30 };
    let scores = trial.hold_all(6, 3, |kind, dice| all_scenes::noisy(kind, dice, 600));
    let all = Score::total(&scores);
    enough!(all.trees >= 40, all.pairs > 15_000; "{all:?}");
    assert!(all.borders < all.pairs / 100, "{all:?}");
    assert!(all.excused > 0 && all.excused < all.pairs / 5, "{all:?}");
}
