//! Small scenes full of coincidences.

use binspace::{BspTree, BuildOptions, FrameBuilder, Heuristic};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use testkit::dice::Dice;
use testkit::enough;
use testkit::hard::{self, HardScene};
use testkit::hits::{Oracle, Score};
use testkit::shots::Shots;
use testkit::tally::tally;

#[test]
fn rays_hit_what_rationals_say() {
    let heuristic = prop::sample::select(Heuristic::ALL);
    let cases = (hard::scene(), heuristic, any::<u64>(), any::<bool>());
    let score = tally(file!(), 256, cases, |score: &mut Score, (scene, heuristic, seed, one)| {
        let tree = build(&scene, heuristic, one)?;
        if tree.is_empty() {
            return Ok(());
        }
        let (oracle, shots) = (Oracle::new(&tree), Shots::new(tree.faces()));
        let mut dice = Dice(seed);
        for _ in 0..50 {
            oracle.check(shots.ray(&mut dice), score).map_err(TestCaseError::fail)?;
        }
        Ok(())
    });
    enough!(score.rays > 10_000, score.hits > 10_000; "{score:?}");
    enough!(score.in_plane > 2000, score.ties > 2000, score.at_ends > 2000; "{score:?}");
    assert!(score.blocked.min(score.clear) > 3000, "{score:?}");
}

fn build(
    scene: &HardScene,
    heuristic: Heuristic,
    one_view: bool,
) -> Result<BspTree, TestCaseError> {
    let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
    let options = match scene.tolerance() {
        Some(tolerance) => options.with_tolerance(tolerance),
        None => options,
    };
    let fail = |error: binspace::Error| TestCaseError::fail(error.to_string());
    if one_view {
        let mut builder = FrameBuilder::new(options);
        return Ok(builder.build(&scene.polygons).map_err(fail)?.clone());
    }
    options.build(&scene.polygons).map_err(fail)
}
