//! Trees whose small sets were divided after trials of subtrees.

use binspace::{BuildOptions, ErrorKind};
use testkit::judge::{self, judge};
use testkit::prelude::*;
use testkit::snapshot::Snapshot;

#[test]
fn trees_are_exact_after_trials() {
    let strategy = (hard::scene(), 1..10_usize);
    let [trees, fewer] = tally(file!(), 192, strategy, |seen: &mut [usize; 2], (scene, planes)| {
        let options = scene.options(Heuristic::Auto);
        let tree = options.clone().with_trials(planes).build(&scene.polygons).map_err(fail)?;
        judge(&tree, &scene.polygons).map_err(fail)?;
        seen[0] += 1;
        seen[1] += usize::from(tree.len() < options.build(&scene.polygons).map_err(fail)?.len());
        Ok::<_, _>(())
    });
    enough!(trees > 150, fewer > 3; "{trees} {fewer}");
}

/// The more planes are tried, the fewer fragments: not in every scene, but in these by some percents.
#[test]
fn trials_cut_less() {
    let scenes =
        [scene::random_triangles(300, 4), scene::random_triangles(1500, 1), scene::teapot(12)];
    for scene in scenes {
        let fragments = [0, 1, 4, 16].map(|planes| {
            let options = BuildOptions::DEFAULT.with_trials(planes);
            let tree = options.build(scene.polygons()).expect("within budget");
            tree.validate().expect("a valid tree");
            tree.len() as f64 / scene.len() as f64
        });
        let [none, one, four, more] = fragments;
        assert!(
            none == one && four < 0.995 * none && more < four,
            "{}: {fragments:?}",
            scene.name()
        );
    }
}

#[test]
fn trials_give_the_same_tree_on_any_number_of_threads() {
    let scene = scene::random_triangles(1500, 2);
    let options = BuildOptions::DEFAULT.with_trials(3);
    let [one, two, eight] = [1, 2, 8].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        Snapshot::of(&pool.install(|| options.build(scene.polygons())).expect("within budget"))
    });
    assert!(one == two && one == eight);
}

/// What trials cut does not count.
#[test]
fn a_budget_counts_the_tree_alone() {
    let scene = scene::random_triangles(400, 3);
    let options = BuildOptions::DEFAULT.with_trials(4);
    let len = options.build(scene.polygons()).expect("within budget").len();
    let options = options.with_max_fragments(len);
    assert_eq!(options.build(scene.polygons()).expect("within budget").len(), len);
    let error =
        options.with_max_fragments(len - 1).build(scene.polygons()).expect_err("over budget");
    assert_eq!(error.kind(), ErrorKind::OverBudget);
}

#[test]
fn trials_end_when_a_build_is_cancelled() {
    let scene = scene::random_triangles(400, 3);
    let options = BuildOptions::DEFAULT.with_trials(1000);
    for at in [1, 3, 9] {
        let mut calls = 0;
        let tree = options.build_with_progress(scene.polygons(), |_| {
            calls += 1;
            if calls < at { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert_eq!(tree.expect_err("cancelled").kind(), ErrorKind::Cancelled);
        assert_eq!(calls, at);
    }
}
