//! Rays among slivers, at the default tolerance.

use testkit::hits::{Oracle, Score};
use testkit::prelude::*;
use testkit::scenes::trees;
use testkit::shots::Shots;
use testkit::slivers::{Point, Sliver, along, whole};

/// Slivers, polygons next to their planes, and some polygons anywhere.
fn scene(dice: &mut Dice) -> Vec<Vec<[f64; 3]>> {
    let size = 1 << (20 + dice.below(30));
    let mut polygons: Vec<[Point; 3]> = Vec::new();
    for _ in 0..1 + dice.below(2) {
        let Sliver { corners, steps } = Sliver::new(dice, size);
        polygons.push(corners);
        for _ in 0..dice.below(3) {
            let off = [0; 3].map(|_| whole(dice, (size >> 26).max(2)));
            polygons.push([0; 3].map(|_| {
                let at = along(corners[0], steps, [0; 2].map(|_| whole(dice, size / 16)));
                [0, 1, 2].map(|i| at[i] + off[i])
            }));
        }
    }
    for _ in 0..5 {
        polygons.push([0; 3].map(|_| [0; 3].map(|_| whole(dice, size))));
    }
    polygons.rotate_right(dice.below(4));
    let float = |polygon: [Point; 3]| polygon.map(|p| p.map(|c| c as f64)).to_vec();
    polygons.into_iter().map(float).collect()
}

#[test]
fn rays_among_slivers_agree_with_integers() {
    let mut score = Score::default();
    for seed in 0..40 {
        let mut dice = Dice(seed);
        let polygons = scene(&mut dice);
        for (name, tree) in &trees(&polygons, BuildOptions::DEFAULT) {
            let (oracle, shots) = (Oracle::new(tree), Shots::new(tree.faces()));
            for _ in 0..12 {
                let judged = oracle.check(shots.ray(&mut dice), &mut score);
                judged.unwrap_or_else(|what| panic!("seed {seed}, {name}: {what}"));
            }
        }
    }
    assert!(score.rays > 3000 && score.hits > 2000 && score.blocked > 500, "{score:?}");
}
