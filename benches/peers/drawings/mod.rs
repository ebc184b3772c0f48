//! Drawings of one view: the number of paths, and the time against building the tree. On the same triangles,
//! also `gl2ps`, which makes vector pictures of OpenGL drawings. The camera is outside and sees the whole
//! scene in 1600×1200 pixels.
//!
//! Times of one thread are its running time. Only the gain of a second thread is measured by the clock.
//!
//! Drawings are filled at the centres of pixels in floats and compared with the tree's order painted by
//! integers. Centres nearer than 4·10⁻⁵ of a pixel to an outline are not judged.

pub(crate) mod gl2ps;
mod translucent;

use binspace::BspTree;
use binspace::drawing::{Drawing, ViewOptions};
use binspace::scene::Scene;
use binspace::view::Camera;
use rayon::ThreadPool;
use std::fs;
use std::time::{Duration, Instant};
use support::{Table, best, check, is_file, ratio, scene, threads, time, up};
use testkit::fill::{self, Score};

const SIZE: [u32; 2] = [1600, 1200];
/// Work is repeated for this long, for the mean of its times.
const ENOUGH: Duration = Duration::from_secs(1);

const SCENES: [&str; 14] = [
    "triangles in cubes:1500",
    "triangles in cubes:5000",
    "random:1500",
    "terrain:10000",
    "terrain:100000",
    "sphere:10000",
    "city:10000",
    "cone:10000",
    "bunny.obj",
    "spider.obj",
    "person.obj",
    "dragon.obj",
    "level.obj",
    "level_large.obj",
];
/// The largest number of fragments of a drawing with nothing hidden. These drawings take most of the time of
/// this section; larger ones would take minutes.
const MOST_TRANSLUCENT: usize = 50_000;

pub(crate) fn run() {
    let pools = [1, 2].map(threads);
    let mut times = Vec::new();
    let mut nothing_hidden = Vec::new();
    let table = Table::new(
        "Drawings",
        &["scene", "polygons", "fragments", "visible", "paths", "clipped", "pixels", "wrong"],
    );
    for name in SCENES {
        let scene = scene(name);
        let build = || BspTree::build(scene.polygons()).expect("within budget");
        let (building, tree) = cpu_time(|| pools[0].install(build));
        check(&tree, &scene);
        let camera = camera(&scene, name);
        table.row(&judged(&tree, &camera, &scene, name));
        times.push(timed(&tree, &camera, name, building, &pools));
        if tree.len() < MOST_TRANSLUCENT {
            nothing_hidden.push(translucent::row(&tree, &camera, name, building));
        }
    }
    let columns =
        ["scene", "tree", "drawing", "drawing ÷ tree", "one thread", "two threads", "two ÷ one"];
    let table = Table::new("Time of drawings", &columns);
    times.iter().for_each(|row| table.row(row));
    translucent::print(&nothing_hidden);
}

/// The times of a drawing on one thread and on two. It panics if the drawings differ.
fn timed(
    tree: &BspTree,
    camera: &Camera,
    name: &str,
    building: Duration,
    pools: &[ThreadPool; 2],
) -> Vec<String> {
    let draw = || drawn(tree, camera);
    let (drawing, _) = cpu_time(|| pools[0].install(draw));
    let [(alone, by_one), (together, by_two)] =
        pools.each_ref().map(|pool| pool.install(|| best(draw)));
    assert_same(&by_one, &by_two);
    let [ratio, gain] = [ratio(drawing, building), ratio(together, alone)];
    let [building, drawing, alone, together] = [building, drawing, alone, together].map(time);
    vec![name.to_owned(), building, drawing, ratio, alone, together, gain]
}

/// The time for which threads of this program ran, the mean of some runs. Unlike the clock, it does not count
/// the work of others on a shared machine. Where the system does not report it, the clock is used.
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

/// A camera outside the scene that sees all of it.
fn camera(scene: &Scene, name: &str) -> Camera {
    let (low, high) = scene.bounds().expect("polygons");
    Camera::looking_at_all([low, high], up(name), SIZE).expect("a camera")
}

/// The map, the order and the paths.
fn drawn(tree: &BspTree, camera: &Camera) -> Drawing {
    tree.visibility(camera, &ViewOptions::DEFAULT).expect("memory").drawing().expect("memory")
}

/// A drawing's figures. It panics if a pixel is wrong, in the drawing or in the map, or if there is not
/// exactly one path for each visible polygon.
fn judged(tree: &BspTree, camera: &Camera, scene: &Scene, name: &str) -> [String; 8] {
    let map = tree.visibility(camera, &ViewOptions::DEFAULT).expect("memory");
    let visible = map.polygons().count();
    let mut score = Score::default();
    // In real scenes, some polygons lie within the tolerance of each other. There the tree's order decides
    // which one is visible, not the ray.
    let check = if is_file(name) { fill::check } else { fill::check_with_rays };
    check(tree, camera, &mut score).unwrap_or_else(|fault| panic!("{name}: {fault}"));
    assert_eq!(score.paths, visible, "{name}");
    // For each pixel, the drawing and the map are judged.
    assert!(score.unsure * 50 < score.pixels, "{name}: {score:?}");
    [
        name.to_owned(),
        scene.len().to_string(),
        tree.len().to_string(),
        visible.to_string(),
        score.paths.to_string(),
        score.clipped.to_string(),
        score.pixels.to_string(),
        "0".to_owned(),
    ]
}

/// Asserts that two drawings have the same paths, bit for bit.
fn assert_same(a: &Drawing, b: &Drawing) {
    assert_eq!(a.paths().len(), b.paths().len());
    for (a, b) in a.paths().zip(b.paths()) {
        assert_eq!(a.polygon(), b.polygon());
        assert!(a.outlines().eq(b.outlines()));
    }
}
