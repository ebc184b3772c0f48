//! Trees of hard scenes against oracles of their own: exact rationals for what the fragments are,
//! rays in big integers for the order.

mod cases;
mod faults;
mod input;
mod order;
#[cfg(feature = "triangulate")]
mod picture;
mod progress;
mod same;
mod scale;
#[path = "../support/mod.rs"]
mod support;
mod tilted;

use binspace::{BspTree, BuildOptions, Heuristic};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use support::dice::Dice;
use support::hard::{self, HardScene};
use support::rays::Rays;
use support::{judge, orders, views};

fn options(scene: &HardScene, heuristic: Heuristic) -> BuildOptions {
    let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
    scene.tolerance().map_or(options, |tolerance| options.with_tolerance(tolerance))
}

fn build(scene: &HardScene, heuristic: Heuristic) -> Result<BspTree, TestCaseError> {
    // Without ear clipping, the few faces that are not convex are refused.
    let refusal =
        if cfg!(feature = "triangulate") { TestCaseError::fail } else { TestCaseError::reject };
    options(scene, heuristic).build(&scene.polygons).map_err(|error| refusal(error.to_string()))
}

fn fail(what: String) -> TestCaseError {
    TestCaseError::fail(what)
}

fn heuristic() -> impl Strategy<Value = Heuristic> {
    prop_oneof![
        4 => prop::sample::select(&Heuristic::ALL[..]),
        1 => any::<u64>().prop_map(|seed| Heuristic::Random { seed }),
        1 => (0.0..32.0f64, -1.0..4.0f64, -1.0..8.0f64)
            .prop_map(|(splits, balance, axial)| Heuristic::Weighted { splits, balance, axial }),
        1 => (1..5u32).prop_map(|candidates| Heuristic::Sampled { candidates }),
    ]
}

/// Shoots rays from several viewpoints.
fn shoot(tree: &BspTree, seed: u64) -> Result<[usize; 2], TestCaseError> {
    let mut dice = Dice(seed);
    let mut rays = Rays::new(tree);
    for _ in 0..if tree.is_empty() { 0 } else { 6 } {
        let view = views::some_view(tree.faces(), &rays, &mut dice);
        orders::check(tree, view.viewpoint).map_err(fail)?;
        rays.check(&view, 8, &mut dice).map_err(fail)?;
    }
    Ok([rays.pairs, rays.contested])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn fragments_are_exact_pieces_on_their_sides(scene in hard::scene(), by in heuristic()) {
        let tree = build(&scene, by)?;
        judge::judge(&tree, &scene.polygons).map_err(fail)?;
    }

    #[test]
    fn nearer_fragments_are_painted_later(
        scene in hard::scene(), by in heuristic(), seed in any::<u64>(),
    ) {
        shoot(&build(&scene, by)?, seed)?;
    }
}
