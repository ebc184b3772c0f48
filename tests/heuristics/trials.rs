//! Trees whose small sets were divided after trials of subtrees.

use binspace::{BuildOptions, ErrorKind};
use testkit::judge::judge;
use testkit::prelude::*;
use testkit::snapshot::Snapshot;

#[test]
fn trees_are_exact_after_trials() {
    let strategy = (hard::scene(), 2..10_usize);
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

/// The more planes are tried, the fewer fragments: not in every scene, but in these.
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

/// Enough triangles for several jobs, small enough to cross only a few others.
#[test]
fn trials_give_the_same_tree_on_any_number_of_threads() {
    let triangles: Vec<[DVec3; 3]> = scene::random_triangles(6000, 2)
        .polygons()
        .map(|polygon| {
            let [a, b, c] = [0, 1, 2].map(|i| polygon.points()[i]);
            [a, a + 0.2 * (b - a), a + 0.2 * (c - a)]
        })
        .collect();
    let build = |planes: usize, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let options = BuildOptions::DEFAULT.with_trials(planes);
        pool.install(|| options.build(&triangles)).expect("within budget")
    };
    let one = build(3, 1);
    assert!(one.len() > 9000 && one.len() < build(0, 1).len(), "{}", one.len());
    for threads in [2, 8] {
        assert!(Snapshot::of(&one) == Snapshot::of(&build(3, threads)), "{threads}");
    }
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
fn trials_report_their_work_and_can_be_cancelled() {
    let scene = scene::random_triangles(400, 3);
    let calls = |planes: usize, most: usize| {
        let mut calls = 0;
        let options = BuildOptions::DEFAULT.with_trials(planes);
        let tree = options.build_with_progress(scene.polygons(), |_| {
            calls += 1;
            if calls < most { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        (calls, tree.map_err(|error| error.kind()).err())
    };
    let [(few, none), (many, done)] = [0, 64].map(|planes| calls(planes, usize::MAX));
    assert!(none.is_none() && done.is_none() && many > 4 * few, "{few} {many}");
    for at in [2 * few, many / 2] {
        assert_eq!(calls(64, at), (at, Some(ErrorKind::Cancelled)));
    }
}
