//! Checks that all forms of an order are the same.

use super::judge::{Verdict, ensure};
use binspace::{BspTree, Flow, Fragment, Part, Viewpoint};
use std::ops::ControlFlow;

/// Checks that every fragment occurs once, that iterators and lists of indices have the same order in both
/// directions, and that a walk visits nothing after it breaks off.
pub fn check(tree: &BspTree, viewpoint: Viewpoint) -> Verdict {
    let id = |fragment: Fragment<'_>| fragment.index();
    let mut far_first = vec![7; 3];
    tree.back_to_front_into(viewpoint, &mut far_first);
    let mut sorted = far_first.clone();
    sorted.sort_unstable();
    ensure(sorted.iter().copied().eq(0..tree.len() as u32), || format!("{far_first:?}"))?;

    let listed: Vec<u32> = tree.back_to_front(viewpoint).map(id).collect();
    ensure(listed == far_first, || format!("iterator {listed:?}, index form {far_first:?}"))?;
    let reverse: Vec<u32> = far_first.iter().rev().copied().collect();
    // The list is longer than the working space and has no zero, so that no part of the space is zero at
    // first.
    let mut near_first = vec![u32::MAX; 4 * tree.len() + 40];
    tree.order(viewpoint).front_to_back().write_into(&mut near_first);
    ensure(near_first == reverse, || format!("{near_first:?} not {reverse:?}"))?;
    let listed: Vec<u32> = tree.order(viewpoint).front_to_back().into_iter().map(id).collect();
    ensure(listed == reverse, || format!("iterator {listed:?} not {reverse:?}"))?;

    let stop = tree.len() / 2;
    let mut seen = Vec::new();
    let broken = tree.order(viewpoint).front_to_back().walk(|part| match part {
        Part::Subtree(_) => Flow::Descend,
        Part::Fragment(fragment) => {
            seen.push(fragment.index());
            if seen.len() > stop { Flow::Break(fragment.index()) } else { Flow::Descend }
        }
    });
    let expected =
        reverse.get(stop).map_or(ControlFlow::Continue(()), |&id| ControlFlow::Break(id));
    ensure(broken == expected && seen[..] == reverse[..seen.len()], || {
        format!("broke off with {broken:?} after {seen:?}")
    })?;
    let mut rest = tree.back_to_front(viewpoint);
    let first = rest.by_ref().take(stop).count();
    ensure(rest.len() == tree.len() - first && rest.count() == tree.len() - first, || {
        "an iterator misjudges how much is left".into()
    })
}
