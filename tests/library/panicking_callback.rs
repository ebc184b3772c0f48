//! After a progress callback has panicked, the same operation does not call it again.

use binspace::Progress;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use testkit::prelude::*;

/// Runs a call on several threads with a callback that panics at one of its calls, and returns the number
/// of calls.
fn calls_until_panic(
    at: usize,
    call: impl FnOnce(&(dyn Fn(Progress) -> ControlFlow<()> + Sync)) + Send,
) -> usize {
    let calls = AtomicUsize::new(0);
    let callback = |_: Progress| {
        let before = calls.fetch_add(1, Ordering::SeqCst);
        assert!(before != at, "the caller's fault");
        ControlFlow::Continue(())
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().expect("threads");
    let run = || pool.install(|| call(&callback));
    let panic = catch_unwind(AssertUnwindSafe(run)).expect_err("the callback's panic");
    let message = panic.downcast_ref::<&str>().expect("a message");
    assert_eq!(*message, "the caller's fault");
    calls.into_inner()
}

#[test]
fn after_a_panic_in_its_callback_a_build_stops() {
    let scene = scene::random_triangles(3000, 1);
    for at in [0, 1, 5, 20, 60] {
        let calls = calls_until_panic(at, |callback| {
            let _ = BuildOptions::DEFAULT.build_with_progress(scene.polygons(), callback);
        });
        assert_eq!(calls, at + 1, "it was called again");
    }
}

#[test]
fn after_a_panic_in_its_callback_a_drawing_stops() {
    let scene = scene::random_triangles(1500, 2);
    let tree = BspTree::build(scene.polygons()).expect("within budget");
    let (low, high) = scene.bounds().expect("corners");
    let (eye, middle) = (high + (high - low), (low + high) * 0.5);
    let camera = Camera::perspective(eye, middle, DVec3::Z, 0.6, [400, 300]).expect("a camera");
    for at in [0, 1, 5, 20] {
        let calls = calls_until_panic(at, |callback| {
            let _ = tree.visibility(&camera, &ViewOptions::DEFAULT.with_progress(&callback));
        });
        assert_eq!(calls, at + 1, "it was called again by a map");
        let calls = calls_until_panic(at, |callback| {
            let options = ViewOptions::DEFAULT.with_progress(&callback);
            let _ = Drawing::translucent(&tree, &camera, &options, None);
        });
        assert_eq!(calls, at + 1, "it was called again by a drawing");
    }
}

/// The next operation of a map that keeps its callback starts from the beginning.
#[test]
fn a_map_goes_on_after_a_panic_in_its_callback() {
    let tree = BspTree::build(scene::city(200, 1).polygons()).expect("within budget");
    let (eye, target) = (DVec3::new(30.0, 40.0, 50.0), DVec3::new(5.0, 5.0, 0.0));
    let camera = Camera::perspective(eye, target, DVec3::Z, 0.6, [64, 48]).expect("a camera");
    let (is_bad, calls) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let hear = |_: Progress| {
        calls.fetch_add(1, Ordering::SeqCst);
        assert!(is_bad.load(Ordering::SeqCst) == 0, "the caller's fault");
        ControlFlow::Continue(())
    };
    let map = tree.visibility(&camera, &ViewOptions::DEFAULT.with_progress(&hear));
    let map = map.expect("within memory");
    let expected = tree
        .visibility(&camera, &ViewOptions::DEFAULT)
        .and_then(|map| map.edges(Hidden::Keep))
        .expect("edges");
    is_bad.store(1, Ordering::SeqCst);
    let before = calls.load(Ordering::SeqCst);
    assert!(catch_unwind(AssertUnwindSafe(|| map.edges(Hidden::Keep))).is_err());
    assert_eq!(calls.load(Ordering::SeqCst), before + 1);
    is_bad.store(0, Ordering::SeqCst);
    assert_eq!(map.edges(Hidden::Keep).expect("edges"), expected);
    assert!(calls.load(Ordering::SeqCst) > before + 2);
}
