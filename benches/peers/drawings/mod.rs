//! Drawings of one view: the number of paths, and their time, against building the tree; and `gl2ps`, which
//! makes vector pictures of OpenGL drawings, on the same triangles. The whole scene is seen from around it,
//! in 1600×1200 pixels.
//!
//! Times of one thread are its running time; only the gain of a second one is by the clock.
//!
//! Drawings are filled at the centres of pixels in floats and compared with the tree's order painted by
//! integers. Centres nearer than 4·10⁻⁵ of a pixel to an outline are not judged.

pub(crate) mod gl2ps;
mod translucent;

use binspace::BspTree;
use binspace::drawing::{Drawing, ViewOptions};
use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::view::Camera;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::fs;
use std::time::{Duration, Instant};
use support::{Table, Target, against, best, check, time, triangles_in_cubes};
use testkit::fill::{self, Score};

const SIZE: [u32; 2] = [1600, 1200];
/// Work is repeated for this long, for the mean of its times.
const ENOUGH: Duration = Duration::from_secs(1);

/// A scene, and its targets.
struct Goal {
    scene: &'static str,
    /// The direction that points up in it.
    up: DVec3,
    /// Whether no path may be clipped.
    is_whole: bool,
    /// The time of a drawing ÷ that to build the tree.
    time: Option<f64>,
    /// Pieces ÷ polygons where nothing is hidden.
    pieces: Option<f64>,
}

const fn goal(scene: &'static str, time: Option<f64>, pieces: Option<f64>) -> Goal {
    Goal { scene, up: DVec3::Z, is_whole: false, time, pieces }
}

/// Scans, and scenes of similar simplicity.
const fn scan(scene: &'static str, up: DVec3) -> Goal {
    Goal { scene, up, is_whole: true, time: Some(0.9), pieces: Some(1.0) }
}

/// Game levels.
const fn level(scene: &'static str) -> Goal {
    Goal { is_whole: true, ..goal(scene, None, Some(1.0)) }
}

/// Models in parts that penetrate each other.
const fn model(scene: &'static str, up: DVec3) -> Goal {
    Goal { up, ..goal(scene, None, Some(1.15)) }
}

const GOALS: [Goal; 16] = [
    goal("triangles in cubes:1500", None, None),
    goal("triangles in cubes:5000", Some(0.6), None),
    goal("random:1500", None, None),
    goal("random:5000", Some(0.6), None),
    scan("terrain:10000", DVec3::Z),
    scan("sphere:10000", DVec3::Z),
    model("city:10000", DVec3::Z),
    scan("bunny_4k.obj", DVec3::Y),
    level("doom_e1m1.obj"),
    level("doom_map12_big.obj"),
    goal("chessboard_63k.obj", Some(0.9), Some(1.05)),
    model("suzanne_2k.obj", DVec3::Y),
    model("teapot_quads_2k.obj", DVec3::Z),
    model("spider_1k.obj", DVec3::Y),
    model("forklift_1k.obj", DVec3::Z),
    model("pool_table_29k.obj", DVec3::Z),
];

pub(crate) fn run() {
    let pools = [1, 2].map(threads);
    let mut times = Vec::new();
    let mut nothing_hidden = Vec::new();
    let table = Table::new(
        "Drawings of one view: a path for each polygon that shows",
        &[
            "scene",
            "polygons",
            "fragments",
            "visible",
            "paths",
            "clipped",
            "target",
            "met",
            "pixels judged",
            "wrong",
        ],
    );
    for goal in GOALS {
        let Some(scene) = scene(goal.scene) else { continue };
        let build = || BspTree::build(scene.polygons()).expect("within budget");
        let (building, tree) = cpu_time(|| pools[0].install(build));
        check(&tree, &scene);
        let camera = camera(&scene, goal.up);
        table.row(&judged(&tree, &camera, &scene, &goal));
        times.push(timed(&tree, &camera, &goal, building, &pools));
        nothing_hidden.push(translucent::row(&tree, &camera, &goal, building));
    }
    print_times(&times);
    translucent::print(&nothing_hidden);
}

/// The times of a drawing on one thread and on two. It panics if the drawings differ.
fn timed(
    tree: &BspTree,
    camera: &Camera,
    goal: &Goal,
    building: Duration,
    pools: &[ThreadPool; 2],
) -> Vec<String> {
    let draw = || drawn(tree, camera);
    let (drawing, _) = cpu_time(|| pools[0].install(draw));
    let [(alone, by_one), (together, by_two)] =
        pools.each_ref().map(|pool| pool.install(|| best(draw)));
    assert_same(&by_one, &by_two);
    let mut row = vec![goal.scene.to_owned(), time(building), time(drawing)];
    row.extend(maybe_against(drawing.as_secs_f64() / building.as_secs_f64(), goal.time));
    row.extend([time(alone), time(together)]);
    let speedup = alone.as_secs_f64() / together.as_secs_f64();
    row.extend(against(speedup, Target::AtLeast(1.7)));
    row
}

fn print_times(rows: &[Vec<String>]) {
    let table = Table::new(
        "Drawings of one view: time, against building the tree",
        &[
            "scene",
            "tree",
            "drawing",
            "ratio",
            "target",
            "met",
            "one thread",
            "two threads",
            "ratio",
            "target",
            "met",
        ],
    );
    rows.iter().for_each(|row| table.row(row));
}

/// The time for which threads of this program ran, the mean of some runs. Unlike the clock, it does not count
/// the work of others on a shared machine. Where the system does not report it, by the clock.
fn cpu_time<T>(mut run: impl FnMut() -> T) -> (Duration, T) {
    let begin = Instant::now();
    let before = ran();
    let mut runs = 0;
    loop {
        let result = run();
        runs += 1;
        if begin.elapsed() > ENOUGH {
            let taken = ran().zip(before).map(|(after, before)| after - before);
            return (taken.unwrap_or(begin.elapsed()) / runs, result);
        }
    }
}

/// The time for which the existing threads have run, if the system reports it.
fn ran() -> Option<Duration> {
    let mut sum = 0;
    for thread in fs::read_dir("/proc/self/task").ok()? {
        let said = fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        sum += said.split(' ').next()?.parse::<u64>().ok()?;
    }
    Some(Duration::from_nanos(sum))
}

fn threads(count: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(count).build().expect("threads")
}

/// A scene by name; scenes of triangles in cubes are not built in.
fn scene(name: &str) -> Option<Scene> {
    match name.strip_prefix("triangles in cubes:") {
        Some(count) => Some(triangles_in_cubes(count.parse().expect("a number"))),
        None => support::scene(name),
    }
}

fn camera(scene: &Scene, up: DVec3) -> Camera {
    let (low, high) = scene.bounds().expect("polygons");
    Camera::looking_at_all([low, high], up, SIZE).expect("a camera")
}

/// The map, the order and the paths.
fn drawn(tree: &BspTree, camera: &Camera) -> Drawing {
    tree.visibility(camera, &ViewOptions::DEFAULT).expect("memory").drawing().expect("memory")
}

/// A drawing's figures. It panics if a pixel is wrong, in the drawing or in the map, or if there is not
/// exactly one path for each polygon that shows.
fn judged(tree: &BspTree, camera: &Camera, scene: &Scene, goal: &Goal) -> [String; 10] {
    let map = tree.visibility(camera, &ViewOptions::DEFAULT).expect("memory");
    let visible = map.polygons().count();
    let mut score = Score::default();
    let mut checked = fill::check(tree, camera, &mut score);
    // In real scenes, polygons lie within the tolerance of one another: there the tree's order decides the
    // visible one, not the ray.
    if !goal.scene.ends_with(".obj") {
        checked = checked.and_then(|()| fill::check_rays(tree, camera, &mut score));
    }
    checked.unwrap_or_else(|fault| panic!("{}: {fault}", goal.scene));
    assert_eq!(score.paths, visible, "{}", goal.scene);
    // For each pixel, the drawing and the map are judged.
    assert!(score.unsure * 50 < score.pixels, "{}: {score:?}", goal.scene);
    let (target, met) = match (goal.is_whole, score.clipped) {
        (false, _) => ("–", "–"),
        (true, 0) => ("0", "yes"),
        (true, _) => ("0", "no"),
    };
    [
        goal.scene.to_owned(),
        scene.len().to_string(),
        tree.len().to_string(),
        visible.to_string(),
        score.paths.to_string(),
        score.clipped.to_string(),
        target.to_owned(),
        met.to_owned(),
        score.pixels.to_string(),
        "0".to_owned(),
    ]
}

/// As [`against`], if there is something to reach.
fn maybe_against(measured: f64, limit: Option<f64>) -> [String; 3] {
    match limit {
        Some(limit) => against(measured, Target::AtMost(limit)),
        None => [format!("{measured:.2}"), "–".to_owned(), "–".to_owned()],
    }
}

/// The same paths, bit for bit.
fn assert_same(a: &Drawing, b: &Drawing) {
    assert_eq!(a.paths().len(), b.paths().len());
    for (a, b) in a.paths().zip(b.paths()) {
        assert_eq!(a.polygon(), b.polygon());
        assert!(a.outlines().eq(b.outlines()));
    }
}
