//! Measures the time to build a tree and to list an order.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use binspace::scene::Scene;
use binspace::view::views;
use binspace::{BspTree, BuildOptions, Error, Viewpoint};

use crate::progress::Progress;

/// The time during which a short measurement is repeated. Too small: the clock's resolution spoils the
/// figures of small trees. Too large: the command takes longer.
const LONG_ENOUGH: Duration = Duration::from_millis(20);

/// Builds a tree of a scene.
pub(crate) fn build(scene: &Scene, options: &BuildOptions) -> Result<BspTree, Error> {
    build_shown(scene, options, &Progress::share(format!("building {}", options.heuristic)))
}

fn build_shown(scene: &Scene, options: &BuildOptions, shown: &Progress) -> Result<BspTree, Error> {
    options.build_with_progress(scene.polygons(), |progress| {
        shown.set(progress.done, progress.total);
        ControlFlow::Continue(())
    })
}

/// Builds a tree of a scene, and returns the seconds that the build took: the median, if there was time for
/// several builds.
pub(crate) fn timed_build(scene: &Scene, options: &BuildOptions) -> Result<(BspTree, f64), Error> {
    let progress = Progress::share(format!("building {}", options.heuristic));
    let begin = Instant::now();
    let mut seconds = Vec::new();
    loop {
        let start = Instant::now();
        let tree = build_shown(scene, options, &progress)?;
        seconds.push(start.elapsed().as_secs_f64());
        if begin.elapsed() >= LONG_ENOUGH {
            return Ok((tree, median(&mut seconds)));
        }
    }
}

fn median(seconds: &mut [f64]) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

/// The nanoseconds per fragment that an order takes, as a list of indices in a reused buffer: the
/// median over rounds of several viewpoints. 0 without fragments.
pub(crate) fn order_nanoseconds(tree: &BspTree, scene: &Scene) -> f64 {
    let _progress = Progress::spinner("measuring the time of orders");
    let viewpoints = viewpoints(scene);
    let mut order = Vec::new();
    // A round has at least this many fragments, so that the clock's resolution does not matter.
    let repeats = 20_000 / (tree.len() * viewpoints.len()).max(1) + 1;
    let mut round = || {
        let start = Instant::now();
        for _ in 0..repeats {
            for &viewpoint in &viewpoints {
                tree.back_to_front_into(viewpoint, &mut order);
                std::hint::black_box(&order);
            }
        }
        start.elapsed().as_secs_f64()
    };
    round();
    let start = Instant::now();
    let mut seconds = Vec::new();
    while seconds.len() < 3 || start.elapsed() < LONG_ENOUGH {
        seconds.push(round());
    }
    let fragments = repeats * viewpoints.len() * tree.len();
    if fragments == 0 { 0.0 } else { median(&mut seconds) * 1e9 / fragments as f64 }
}

/// Eyes around the scene and inside it.
fn viewpoints(scene: &Scene) -> Vec<Viewpoint> {
    let cameras = scene
        .bounds()
        .and_then(|(low, high)| views([low, high], scene.up(), 6, [640, 480], 1).ok())
        .unwrap_or_default();
    let eyes = cameras.iter().map(binspace::view::Camera::viewpoint);
    // Around a scene as large as the largest floats, positions overflow: they are left out.
    eyes.chain([Viewpoint::direction([1.0, 2.0, -3.0])]).collect()
}
