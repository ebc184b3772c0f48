//! Builds that report their progress, and can be cancelled.

use binspace::{Error, ErrorKind, Progress};
use testkit::prelude::*;
use testkit::snapshot::Snapshot;

const BY: [Heuristic; 3] =
    [Heuristic::Auto, Heuristic::FreePlanes, Heuristic::Sampled { candidates: 4 }];

/// Builds with four threads, if the feature `parallel` is on, until call number `stop`.
fn build(
    scene: &Scene,
    heuristic: Heuristic,
    stop: usize,
) -> (Result<BspTree, Error>, Vec<Progress>) {
    let mut heard = Vec::new();
    let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
    let go = || {
        options.build_with_progress(scene.polygons(), |progress| {
            heard.push(progress);
            if heard.len() < stop { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        })
    };
    let tree = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap().install(go);
    (tree, heard)
}

/// The first call of the build itself, after the calls of the preparation.
fn first_of_the_build(heard: &[Progress]) -> usize {
    let total = heard[heard.len() - 1].total;
    heard.iter().position(|progress| progress.done > 0 && progress.total == total).unwrap()
}

#[test]
fn progress_never_falls_and_ends_at_the_total() {
    for scene in [scene::random_triangles(600, 3), scene::city(5000, 3), scene::sphere(5000)] {
        for heuristic in BY {
            let (tree, heard) = build(&scene, heuristic, usize::MAX);
            let faces = tree.unwrap().faces().len();
            let last = heard[heard.len() - 1];
            assert_eq!((last.done, last.total), (faces, faces), "{heuristic}");
            assert!(heard.windows(2).all(|pair| pair[0].done <= pair[1].done), "{heuristic}");
            assert!(heard.iter().all(|progress| progress.done <= progress.total), "{heuristic}");
            let built = &heard[first_of_the_build(&heard)..];
            assert!(built.iter().all(|progress| progress.total == faces), "{heuristic}");
            let between = built.iter().filter(|progress| progress.done < faces).count();
            enough!(between > 3; "{} by {heuristic}: {heard:?}", scene.name());
        }
    }
}

#[test]
fn a_build_that_is_watched_gives_the_same_tree() {
    for scene in [scene::city(8000, 1), scene::random_triangles(1000, 2)] {
        for heuristic in BY {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
            let plain = options.build(scene.polygons()).unwrap();
            let (watched, _) = build(&scene, heuristic, usize::MAX);
            assert!(Snapshot::of(&plain) == Snapshot::of(&watched.unwrap()), "{heuristic}");
        }
    }
}

#[test]
fn a_build_is_cancelled_from_the_first_call_before_it_reads_its_polygons() {
    let mut read = 0;
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let polygons = (0..1_000_000).map(|_| square).inspect(|_| read += 1);
    let mut calls = 0;
    let result = BuildOptions::DEFAULT.build_with_progress(polygons, |_| {
        calls += 1;
        ControlFlow::Break(())
    });
    let error = result.expect_err("cancelled");
    assert!(error.kind() == ErrorKind::Cancelled, "{error}");
    assert_eq!((calls, error.to_string().as_str()), (1, "cancelled by the progress callback"));
    assert!(read <= 1, "{read}");
}

#[test]
fn a_cancelled_build_makes_no_more_reports() {
    let scene = scene::city(8000, 3);
    for heuristic in BY {
        let (_, all) = build(&scene, heuristic, usize::MAX);
        let start = first_of_the_build(&all);
        for stop in [2, start, (start + all.len()) / 2] {
            let (result, heard) = build(&scene, heuristic, stop);
            let error = result.expect_err("cancelled");
            assert!(error.kind() == ErrorKind::Cancelled, "{heuristic}, call {stop}: {error}");
            assert_eq!(heard.len(), stop, "{heuristic}");
        }
    }
}

#[test]
fn the_last_call_can_cancel_too() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let result = BuildOptions::DEFAULT.build_with_progress([square], |progress| {
        if progress.done > 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(result.expect_err("cancelled").kind() == ErrorKind::Cancelled);
}

#[test]
fn nothing_to_build_is_done_at_once() {
    let scene = Scene::new("nothing", binspace::glam::DVec3::Y);
    let (tree, heard) = build(&scene, Heuristic::Auto, usize::MAX);
    assert!(tree.unwrap().is_empty());
    assert!(heard.iter().all(|progress| (progress.done, progress.total) == (0, 0)), "{heard:?}");
}

#[test]
fn more_polygons_than_fragments_allowed_are_noticed_before_they_are_all_read() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let options = BuildOptions::DEFAULT.with_max_fragments(1000);
    let mut read = 0;
    let endless = std::iter::repeat(square).inspect(|_| read += 1);
    let error = options.build(endless).expect_err("endless");
    assert!(
        error.kind() == ErrorKind::OverBudget && error.to_string().contains("1000 polygons"),
        "{error}"
    );
    assert_eq!(read, 1001);
    assert_eq!(options.build(std::iter::repeat_n(square, 1000)).unwrap().len(), 1000);
}

/// A callback that waits for other work of the pool may run a part of the same build, which calls the
/// callback again on the same stack.
#[test]
fn a_callback_may_do_other_work_of_the_pool() {
    use std::sync::mpsc;
    use std::time::Duration;

    let (ended, end) = mpsc::channel();
    std::thread::spawn(move || {
        let scene = scene::city(20_000, 1);
        let (mut jobs, mut last) = (0, 0);
        let build = || {
            BuildOptions::DEFAULT.build_with_progress(scene.polygons(), |progress| {
                let did_other_work = rayon::yield_now() == Some(rayon::Yield::Executed);
                jobs += usize::from(did_other_work);
                last = progress.done;
                ControlFlow::Continue(())
            })
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let tree = pool.install(build).unwrap();
        ended.send((jobs, last, tree.faces().len())).unwrap();
    });
    let (jobs, last, faces) = end.recv_timeout(Duration::from_secs(100)).expect("it hangs");
    enough!(jobs > 0; "no part of the build was done within the callback");
    assert_eq!(last, faces);
}
