//! Progress of maps, of their queries, and of drawings; and their cancellation.

use binspace::overlay::{Overlay, Shapes};
use binspace::{Error, ErrorKind, Progress};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use testkit::prelude::*;

/// Many crossing triangles in a view, and lines and points between them.
struct View {
    tree: BspTree,
    camera: Camera,
    overlay: Overlay,
}

fn view(triangles: u32) -> View {
    let scene = Builtin::Random.build(Some(triangles), 3);
    let tree = BspTree::build(scene.polygons()).unwrap();
    let (low, high) = scene.bounds().unwrap();
    let camera = Camera::looking_at_all([low, high], scene.up(), [400, 300]).unwrap();
    let mut dice = Dice(5);
    let mut point = || low + dice.point(0.0, 1.0) * (high - low);
    let lines: Vec<Vec<DVec3>> = (0..3 * triangles).map(|_| vec![point(), point()]).collect();
    let points: Vec<DVec3> = (0..8 * triangles).map(|_| point()).collect();
    let mut overlay = Overlay::new(&tree);
    overlay.replace_with(&tree, Shapes::NONE.with_lines(&lines).with_points(points)).unwrap();
    View { tree, camera, overlay }
}

fn mixed(polygon: usize) -> f64 {
    if polygon.is_multiple_of(2) { 0.5 } else { 1.0 }
}

/// Records the progress of an operation, and cancels it.
#[derive(Default)]
struct Listener {
    heard: Mutex<Vec<Progress>>,
    /// The call that cancels.
    last: AtomicUsize,
}

impl Listener {
    fn hear(&self, progress: Progress) -> ControlFlow<()> {
        let mut heard = self.heard.lock().unwrap();
        heard.push(progress);
        match heard.len() < self.last.load(Ordering::Relaxed) {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    }

    /// Starts again, and cancels at this call.
    fn cancel_at(&self, call: usize) {
        self.heard.lock().unwrap().clear();
        self.last.store(call, Ordering::Relaxed);
    }

    /// The progress recorded since then.
    fn heard(&self) -> Vec<Progress> {
        self.heard.lock().unwrap().clone()
    }
}

/// A query of a map: an answer as text, so that answers can be compared.
type Question = (&'static str, fn(&VisibilityMap<'_>, &Overlay) -> Result<String, Error>);

const QUESTIONS: [Question; 10] = [
    ("drawing", |map, _| Ok(format!("{:?}", map.drawing()?))),
    ("edges", |map, _| Ok(format!("{:?}", map.edges(Hidden::Keep)?))),
    ("edges in layers", |map, _| Ok(format!("{:?}", map.edges(Hidden::Count)?))),
    ("crossings", |map, _| Ok(format!("{:?}", map.crossings(Hidden::Skip)?))),
    ("crossings with hidden", |map, _| Ok(format!("{:?}", map.crossings(Hidden::Keep)?))),
    ("crossings in layers", |map, _| Ok(format!("{:?}", map.crossings(Hidden::Count)?))),
    ("lines", |map, overlay| Ok(format!("{:?}", map.lines(overlay, Hidden::Keep)?))),
    ("lines in layers", |map, overlay| Ok(format!("{:?}", map.lines(overlay, Hidden::Count)?))),
    ("markers", |map, overlay| Ok(format!("{:?}", map.markers(overlay)?))),
    ("regions", |map, _| Ok(format!("{:?}", map.regions()?))),
];

/// Makes a map or a drawing, as text.
type Making = (&'static str, fn(&View, &ViewOptions<'_>) -> Result<String, Error>);

fn cells(tree: &BspTree, camera: &Camera, options: &ViewOptions<'_>) -> Result<String, Error> {
    Ok(format!("{:?}", tree.visibility(camera, options)?.cells().collect::<Vec<_>>()))
}

const MAKINGS: [Making; 4] = [
    ("map", |View { tree, camera, .. }, options| cells(tree, camera, options)),
    ("map with opacities", |View { tree, camera, .. }, options| {
        let opacities = with_opacities(tree, mixed).opacities;
        cells(tree, camera, &options.clone().with_opacities(opacities))
    }),
    ("translucent", |View { tree, camera, .. }, options| {
        Ok(format!("{:?}", Drawing::translucent(tree, camera, options, None)?))
    }),
    ("translucent with an overlay", |View { tree, camera, overlay }, options| {
        Ok(format!("{:?}", Drawing::translucent(tree, camera, options, Some(overlay))?))
    }),
];

/// Checks all calls of an operation: progress never decreases, and only the last call reports completion.
fn check_calls(name: &str, heard: &[Progress]) {
    enough!(heard.len() > 3; "{name}: {heard:?}");
    let done = heard.iter().map(|progress| progress.done);
    assert!(heard.iter().all(|progress| progress.total == heard[0].total), "{name}: {heard:?}");
    assert!(heard[0].done == 0 && done.clone().is_sorted(), "{name}: {heard:?}");
    let total = heard[0].total;
    assert!(heard.last().unwrap().done == total, "{name}: {heard:?}");
    assert_eq!(done.clone().filter(|&done| done == total).count(), 1, "{name}: {heard:?}");
    assert!(done.filter(|&done| 0 < done && done < total).count() > 1, "{name}: {heard:?}");
}

/// Checks all calls of an operation, and cancels it at the first, at some in between, and at the last: there
/// is no further call.
fn check(name: &str, listener: &Listener, operation: impl Fn() -> Result<String, Error>) -> String {
    listener.cancel_at(usize::MAX);
    let found = operation().unwrap();
    let heard = listener.heard();
    check_calls(name, &heard);
    let calls = heard.len();
    for last in [1, 2, calls / 4, calls / 2, calls - 1, calls] {
        listener.cancel_at(last);
        let error = operation().unwrap_err();
        assert!(error.kind() == ErrorKind::Cancelled, "{name}: {error}");
        assert!(listener.heard() == heard[..last], "{name}: {last} of {calls}");
    }
    found
}

/// Runs on one thread, so that two runs have the same calls.
fn alone<T: Send>(act: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(act)
}

#[test]
fn maps_and_drawings_report_progress_and_can_be_cancelled() {
    let (view, listener) = (view(220), Listener::default());
    let hear = |progress| listener.hear(progress);
    let heard = ViewOptions::DEFAULT.with_progress(&hear);
    alone(|| {
        for (name, make) in MAKINGS {
            let found = check(name, &listener, || make(&view, &heard));
            assert!(found == make(&view, &ViewOptions::DEFAULT).unwrap(), "{name}");
        }
    });
}

/// A map keeps its callback. After a cancelled query, the map can still be queried.
#[test]
fn queries_of_a_map_report_progress_and_can_be_cancelled() {
    let (view, listener) = (view(260), Listener::default());
    let View { tree, camera, overlay } = &view;
    listener.cancel_at(usize::MAX);
    let hear = |progress| listener.hear(progress);
    let maps = |options: ViewOptions<'static>| {
        let silent = tree.visibility(camera, &options).unwrap();
        (silent, tree.visibility(camera, &options.with_progress(&hear)).unwrap())
    };
    let opaque = maps(ViewOptions::DEFAULT);
    let translucent = maps(with_opacities(tree, mixed));
    alone(|| {
        for (silent, map) in [&opaque, &translucent] {
            for (name, ask) in QUESTIONS {
                let found = check(name, &listener, || ask(map, overlay));
                assert!(found == ask(silent, overlay).unwrap(), "{name}");
            }
        }
    });
}

/// On several threads, calls come one at a time and in order, and no call comes after the call that cancels.
#[test]
fn threads_report_in_order() {
    let (view, listener) = (view(330), Listener::default());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
    let hear = |progress| listener.hear(progress);
    let options = ViewOptions::DEFAULT.with_progress(&hear);
    pool.install(|| {
        for (name, make) in MAKINGS {
            listener.cancel_at(usize::MAX);
            make(&view, &options).unwrap();
            let heard = listener.heard();
            check_calls(name, &heard);
            listener.cancel_at(heard.len() / 2);
            let error = make(&view, &options).unwrap_err();
            assert!(
                error.kind() == ErrorKind::Cancelled && listener.heard().len() == heard.len() / 2,
                "{name}"
            );
        }
    });
}

/// Two discs with `corners` corners each, which cross.
fn discs(corners: u32) -> View {
    let disc = |tilt: f64| -> Vec<DVec3> {
        let corner = |i: u32| {
            let (sin, cos) = (f64::from(i) / f64::from(corners) * std::f64::consts::TAU).sin_cos();
            DVec3::new(cos, sin, tilt * sin)
        };
        (0..corners).map(corner).collect()
    };
    let tree = BspTree::build([disc(0.0), disc(0.3)]).unwrap();
    let eye = DVec3::new(0.4, -0.7, 3.0);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.9, [400, 300]).unwrap();
    let overlay = Overlay::new(&tree);
    View { tree, camera, overlay }
}

/// If a face of many corners cuts a cell, the work is proportional to the corners of the cell so far. This
/// work is reported and can be cancelled.
#[test]
fn work_at_many_corners_polls_for_cancellation() {
    let calls = [512, 1024].map(|corners| {
        let (View { tree, camera, overlay }, listener) = (discs(corners), Listener::default());
        listener.cancel_at(usize::MAX);
        alone(|| {
            let hear = |progress| listener.hear(progress);
            let map = tree.visibility(&camera, &ViewOptions::DEFAULT.with_progress(&hear)).unwrap();
            let mut calls = vec![listener.heard().len()];
            for (name, ask) in QUESTIONS {
                if ["drawing", "crossings with hidden"].contains(&name) {
                    listener.cancel_at(usize::MAX);
                    ask(&map, &overlay).unwrap();
                    calls.push(listener.heard().len());
                }
            }
            calls
        })
    });
    let grows = |(of_few, of_many): (&usize, &usize)| *of_many >= 2 * of_few;
    assert!(calls[0].iter().zip(&calls[1]).all(grows) && calls[0].len() == 3, "{calls:?}");
}
