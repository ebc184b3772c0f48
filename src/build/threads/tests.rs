//! Jobs after one of them failed.

use std::ops::ControlFlow;

use crate::{BuildOptions, Heuristic};

/// The depth that the sets on one side stay below, and that on the other side does not.
const MOST: usize = 100;
/// How many squares there are on the side that needs no more depth.
const MANY: u32 = 1 << 15;

/// A square at a place along the x axis.
fn square(x: f64) -> [[f64; 3]; 4] {
    [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(y, z)| [x, y, z])
}

/// By the planes of the first ones, the squares in front become a list, and those behind a tree without
/// long branches.
fn squares() -> impl Iterator<Item = [[f64; 3]; 4]> {
    let list = (1..2000).map(f64::from);
    // As often from each half, each quarter, and so on.
    let tree = (0..MANY).map(|k| -1.0 - f64::from(k.reverse_bits() >> 17));
    std::iter::once(0.0).chain(list).chain(tree).map(square)
}

/// One thread: the front first, then the job behind.
#[test]
fn after_an_error_the_other_jobs_do_not_run_to_their_end() {
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_max_depth(MOST);
    let mut done = 0;
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let tree = one.install(|| {
        options.build_with_progress(squares(), |progress| {
            done = done.max(progress.done);
            ControlFlow::Continue(())
        })
    });
    let error = tree.unwrap_err();
    assert!(error.is_over_budget() && !error.is_cancelled(), "{error}");
    assert!(done < 1000, "{done} faces were stored after the error");
    // The job behind is large enough to be heard of.
    let mut calls = 0;
    let behind = squares().filter(|square| square[0][0] < 0.0);
    let tree = options.build_with_progress(behind, |_| {
        calls += 1;
        ControlFlow::Continue(())
    });
    assert!(calls > 5 && tree.unwrap().stats().depth_max < MOST, "{calls}");
}

/// Whichever job fails, and however many stop because of it, the error is that of the first.
#[test]
fn what_an_error_has_stopped_does_not_hide_it() {
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_max_depth(MOST);
    for threads in [1, 2, 4] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        for mirrored in [1.0, -1.0] {
            let squares = squares().map(|square| square.map(|[x, y, z]| [mirrored * x, y, z]));
            let error = pool.install(|| options.build(squares).unwrap_err());
            assert!(error.is_over_budget(), "{threads} threads, {mirrored}: {error}");
        }
    }
}
