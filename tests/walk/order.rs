//! Walks compared with whole orders.

use crate::walk::{trees, viewpoints};
use binspace::{Flow, Node, Part};
use testkit::prelude::*;

/// The fragments and nodes that a walk visits.
fn walked(
    tree: &BspTree,
    viewpoint: Viewpoint,
    front_to_back: bool,
    skips: impl Fn(Node<'_>) -> bool,
    mut break_after: usize,
) -> (Vec<u32>, Vec<usize>, ControlFlow<u32>) {
    let (mut fragments, mut nodes) = (Vec::new(), Vec::new());
    let visit = |part: Part<'_>| match part {
        Part::Subtree(node) => {
            // No part of a subtree comes before the subtree's node.
            assert!(fragments.iter().all(|fragment| !node.fragments().contains(fragment)));
            nodes.push(node.index());
            if skips(node) { Flow::Skip } else { Flow::Descend }
        }
        Part::Fragment(fragment) => {
            fragments.push(fragment.index());
            if break_after == 0 {
                return Flow::Break(fragment.index());
            }
            break_after -= 1;
            if fragment.index() % 2 == 0 { Flow::Skip } else { Flow::Descend }
        }
    };
    let end = if front_to_back {
        tree.order(viewpoint).front_to_back().walk(visit)
    } else {
        tree.order(viewpoint).walk(visit)
    };
    (fragments, nodes, end)
}

#[test]
fn a_walk_is_the_whole_order_without_the_subtrees_that_it_skips() {
    let mut dice = Dice(11);
    let [mut skipped, mut kept, mut broken] = [0; 3];
    for tree in trees() {
        for viewpoint in viewpoints(&tree, &mut dice) {
            let mut order = Vec::new();
            tree.back_to_front_into(viewpoint, &mut order);
            for front_to_back in [false, true] {
                let (found, mut nodes, end) =
                    walked(&tree, viewpoint, front_to_back, |_| false, usize::MAX);
                assert_eq!(found, order);
                assert_eq!(end, ControlFlow::Continue(()));
                nodes.sort_unstable();
                assert!(nodes.into_iter().eq(0..tree.stats().nodes));

                let seed = dice.roll();
                let share = [3, 10, 40][dice.below(3)];
                let skips = |node: Node<'_>| Dice(seed ^ node.index() as u64).below(share) == 0;
                let mut is_skipped = vec![false; tree.len()];
                for node in tree.nodes().filter(|&node| skips(node)) {
                    node.fragments().for_each(|fragment| is_skipped[fragment as usize] = true);
                }
                let expected: Vec<u32> =
                    order.iter().copied().filter(|&f| !is_skipped[f as usize]).collect();
                let (found, _, _) = walked(&tree, viewpoint, front_to_back, skips, usize::MAX);
                assert_eq!(found, expected);
                kept += found.len();
                skipped += tree.len() - found.len();

                let count = dice.below(expected.len() + 2);
                let (found, _, end) = walked(&tree, viewpoint, front_to_back, skips, count);
                let first = &expected[..expected.len().min(count + 1)];
                assert_eq!(found, first);
                if let Some(&last) = expected.get(count) {
                    assert_eq!(end, ControlFlow::Break(last));
                    broken += 1;
                }
                order.reverse();
            }
        }
    }
    enough!(skipped > 10_000, kept > 10_000, broken > 500; "{skipped} {kept} {broken}");
}
