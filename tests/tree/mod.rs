//! Compares trees of hard scenes with separate oracles: exact rationals judge the fragments, and rays in big
//! integers judge the order.

mod cases;
mod decals;
mod extend;
mod faults;
mod frames;
mod input;
mod one_plane;
mod order;
mod picture;
mod progress;
mod same;
mod scale;
mod tilted;

use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use testkit::prelude::*;
use testkit::rays::Rays;
use testkit::{judge, orders, views};

fn heuristic() -> impl Strategy<Value = Heuristic> {
    prop_oneof![
        4 => hard::heuristic(),
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

#[test]
fn fragments_are_exact_pieces_on_their_sides() {
    let scenes = (hard::scene(), heuristic());
    let [trees, cut] = tally(file!(), 128, scenes, |[trees, cut]: &mut [usize; 2], (scene, by)| {
        let tree = scene.build(by).map_err(fail)?;
        *trees += usize::from(!tree.is_empty());
        *cut += usize::from(tree.len() > tree.faces().len());
        judge::judge(&tree, &scene.polygons).map_err(fail)
    });
    enough!(trees > 100, cut > 30; "{trees} trees, {cut} of them with cuts");
}

#[test]
fn nearer_fragments_are_painted_later() {
    let scenes = (hard::scene(), heuristic(), any::<u64>());
    let counts = tally(file!(), 256, scenes, |counts: &mut [usize; 2], (scene, by, seed)| {
        let [pairs, contested] = shoot(&scene.build(by).map_err(fail)?, seed)?;
        counts[0] += pairs;
        counts[1] += contested;
        Ok(())
    });
    let [pairs, contested] = counts;
    assert!(pairs > 10_000 && contested * 5 < pairs, "{pairs} pairs, {contested} contested");
}
