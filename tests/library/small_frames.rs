//! Trees of frames with small sets, for which the builder tries own planes first. Squares lie in a few
//! planes: many on one plane, and many cut.

use testkit::prelude::*;

type Square = [[f64; 3]; 4];

/// Upright and flat rectangles with corners on a small lattice, so that many lie on one plane.
fn rectangles(dice: &mut Dice, count: usize) -> Vec<Square> {
    let mut below = |most: usize| dice.below(most) as f64;
    let mut rectangle = |_| {
        let (axis, at) = (below(3) as usize, below(6));
        let [u, v] = [below(5), below(5)];
        let [across, up] = [2.0 + below(7), 2.0 + below(7)];
        [[u, v], [u + across, v], [u + across, v + up], [u, v + up]].map(|[u, v]| {
            let mut corner = [u, v, at];
            corner.rotate_right(axis);
            corner
        })
    };
    (0..count).map(&mut rectangle).collect()
}

/// A builder fails here if it does not sort the pieces on a node's plane, or if it divides a set by the sides
/// of pieces against another plane.
#[test]
fn small_sets_with_many_cuts_are_divided_right() {
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT.with_tolerance(0.0));
    let (mut cuts, mut together) = (0, 0);
    for seed in seeds(600) {
        let mut dice = Dice(seed);
        let count = 4 + dice.below(28);
        let polygons = rectangles(&mut dice, count);
        let tree = builder.build(&polygons).unwrap();
        tree.validate().unwrap_or_else(|fault| panic!("{seed}: {fault}"));
        cuts += tree.stats().splits;
        for node in tree.nodes() {
            let on: Vec<usize> = node.on().map(|k| tree.fragment(k).polygon()).collect();
            assert!(on.is_sorted(), "{seed}: {on:?} on one plane, in another order than given");
            together += usize::from(on.len() > 1);
        }
    }
    enough!(cuts > 5000, together > 2000; "{cuts} cuts, {together} planes of several pieces");
}
