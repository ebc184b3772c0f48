//! Shared code of the tables of measured figures: scenes by name, times, rows.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "prints measurements")]

use binspace::glam::{DQuat, DVec3, EulerRot};
use binspace::scene::{Builtin, Scene, random_triangles};
use binspace::{BspTree, Viewpoint};
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use nalgebra::Point3;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};
use std::{env, fs, thread};
use testkit::dice::Dice;
use testkit::shapes::fan;

/// The seed of every generated scene.
pub const SEED: u64 = 1;

/// Returns a scene by name: a built-in scene, a scene of this module, or a file of `benches/scenes`.
pub fn scene(name: &str) -> Scene {
    let count = |text: &str| text.parse().expect("a number");
    let round = |number: &str, height: f64| {
        let mut scene = Scene::new(name.to_owned(), DVec3::Z);
        fan(count(number) as usize, height).into_iter().for_each(|corners| scene.push(corners, 0));
        scene
    };
    match name.split_once(':') {
        Some(("triangles in cubes", number)) => triangles_in_cubes(count(number)),
        Some(("random quads", number)) => random_quads(count(number)),
        Some(("small triangles", number)) => small_triangles(count(number)),
        Some(("fan", number)) => round(number, 0.0),
        Some(("cone", number)) => round(number, 1.5),
        _ if is_file(name) => {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/files").join(name);
            let read = Scene::read_obj(&path);
            read.unwrap_or_else(|_| panic!("no {name}: run python3 benches/scenes/fetch.py")).0
        }
        _ => {
            let (scene, size) = Builtin::parse(name).expect("the name of a scene");
            scene.build(size, SEED)
        }
    }
}

/// Whether a scene of this name is read from a file.
pub fn is_file(name: &str) -> bool {
    name.ends_with(".obj")
}

/// The direction that points up in a scene.
pub fn up(name: &str) -> DVec3 {
    match is_file(name) && !name.starts_with("level") {
        true => DVec3::Y,
        false => DVec3::Z,
    }
}

/// Random triangles that shrink as their number grows, so that each meets about the same number of others.
/// Edges are 0.2 to 0.6 of the mean distance between neighbours.
pub fn small_triangles(count: u32) -> Scene {
    let shrink = 2.0 * f64::from(count).powf(-1.0 / 3.0);
    map(&random_triangles(count, SEED), format!("small triangles:{count}"), |[a, b, c]| {
        vec![a, a + (b - a) * shrink, a + (c - a) * shrink]
    })
}

/// Parallelograms anywhere in the unit cube, with edges between 0.1 and 0.3.
pub fn random_quads(count: u32) -> Scene {
    let name = format!("random quads:{count}");
    map(&random_triangles(count, SEED), name, |[a, b, c]| vec![a, b, b + (c - a), c])
}

/// Random rotated boxes that cross each other.
pub fn boxes(count: u32) -> Scene {
    let mut dice = Dice(SEED);
    let mut scene = Scene::new(format!("boxes:{count}"), DVec3::Z);
    for _ in 0..count {
        let centre = dice.point(-1.0, 1.0);
        let angles = dice.point(-3.0, 3.0);
        let turn = DQuat::from_euler(EulerRot::XYZ, angles.x, angles.y, angles.z);
        let half = dice.point(0.05, 0.3);
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let corner = |[u, v]: [f64; 2]| {
                    let mut corner = DVec3::splat(side);
                    corner[(axis + 1) % 3] = side * u;
                    corner[(axis + 2) % 3] = v;
                    centre + turn * (corner * half)
                };
                scene.push([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner), 0);
            }
        }
    }
    scene
}

/// Strips along both families of lines of z = x y: many planes contain one line, and many lines meet in one
/// point. `strips` must be a multiple of 4.
pub fn rulings(strips: i32) -> Scene {
    let half = strips / 4;
    let mut scene = Scene::new(format!("rulings:{strips}"), DVec3::Z);
    for i in -half..half {
        let along_x = [[i, -half, -half * i], [i, half, half * i]];
        let along_y = along_x.map(|[x, y, z]| [y, x, z]);
        let (flat, upright) = ((7 * i).rem_euclid(3) - 1, 1 + (5 * i).rem_euclid(6));
        for (line, arm) in [(along_x, [flat, 0, upright]), (along_y, [0, flat, upright])] {
            let [a, b] = line.map(|p| DVec3::from(p.map(f64::from)));
            let arm = DVec3::from(arm.map(f64::from));
            scene.push([a, b, b + arm, a + arm], 0);
        }
    }
    scene
}

/// Triangles anywhere in the unit cube, each with corners anywhere in a cube of side 0.3.
pub fn triangles_in_cubes(count: u32) -> Scene {
    let mut dice = Dice(SEED);
    let mut scene = Scene::new(format!("triangles in cubes:{count}"), DVec3::Z);
    for _ in 0..count {
        let centre = dice.point(0.0, 1.0);
        scene.push([(); 3].map(|()| centre + dice.point(-0.15, 0.15)), 0);
    }
    scene
}

/// A scene's polygons as fans of triangles. Fans of polygons that are not convex overlap themselves.
pub fn triangulated(scene: &Scene) -> Scene {
    let mut triangles = Scene::new(scene.name(), scene.up());
    for corners in scene.polygons() {
        for pair in corners.points()[1..].windows(2) {
            triangles.push([corners.points()[0], pair[0], pair[1]], 0);
        }
    }
    triangles
}

/// The box of a triangle, in `f32`, which most users of `bvh` would take.
#[derive(Clone)]
pub struct Boxed {
    bounds: Aabb<f32, 3>,
    node: usize,
}

impl Bounded<f32, 3> for Boxed {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.bounds
    }
}

impl BHShape<f32, 3> for Boxed {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// The boxes of triangles, for a hierarchy of `bvh`.
pub fn boxed(triangles: &Scene) -> Vec<Boxed> {
    let bounds = |points: &[DVec3]| {
        let points = points.iter().map(|p| Point3::from(p.as_vec3().to_array()));
        points.fold(Aabb::empty(), |bounds, point| bounds.grow(&point))
    };
    let boxes = triangles.polygons().map(|p| Boxed { bounds: bounds(p.points()), node: 0 });
    boxes.collect()
}

fn map(scene: &Scene, name: String, polygon: impl Fn([DVec3; 3]) -> Vec<DVec3>) -> Scene {
    let mut mapped = Scene::new(name, scene.up());
    for corners in scene.polygons() {
        let corners = <[DVec3; 3]>::try_from(corners.points()).expect("a triangle");
        mapped.push(polygon(corners), 0);
    }
    mapped
}

/// Work is repeated for at most this time, and at most this many times. More repetitions would give the same
/// shortest time.
const ENOUGH: (Duration, u32) = (Duration::from_secs(1), 200);

/// Runs a function at least three times. Returns the shortest time and the last result.
pub fn best<T>(run: impl FnMut() -> T) -> (Duration, T) {
    best_of(3, run)
}

/// Runs a function at least `at_least` times. Returns the shortest time and the last result.
pub fn best_of<T>(at_least: u32, mut run: impl FnMut() -> T) -> (Duration, T) {
    let start = Instant::now();
    let mut shortest = Duration::MAX;
    let mut times = 0;
    loop {
        let begin = Instant::now();
        let result = run();
        shortest = shortest.min(begin.elapsed());
        times += 1;
        if times >= at_least && start.elapsed() > ENOUGH.0 || times >= ENOUGH.1 {
            return (shortest, result);
        }
    }
}

/// The largest number of exact decisions to check a tree, which take some seconds.
const MOST_CHECKS: f64 = 3e8;

/// Panics if a tree is wrong. Every face must be in the tree. The tree must be valid, if this can be checked
/// in seconds.
pub fn check(tree: &BspTree, scene: &Scene) {
    let stats = tree.stats();
    if stats.depth_mean * (stats.fragments as f64) < MOST_CHECKS {
        assert_eq!(tree.validate(), Ok(()), "{}", scene.name());
    }
    assert_eq!(tree.preparation().polygons, scene.len(), "{}", scene.name());
    assert_eq!(stats.fragments, stats.faces + stats.splits, "{}", scene.name());
}

/// Eyes around and inside a scene.
pub fn viewpoints(scene: &Scene) -> Vec<Viewpoint> {
    let (low, high) = scene.bounds().expect("a scene with polygons");
    let at = |share: [f64; 3]| Viewpoint::Eye(low + (high - low) * DVec3::from(share));
    [[1.8, 0.4, 0.9], [-0.6, -0.7, 1.1], [0.5, 1.9, 0.2], [0.31, 0.47, 0.6], [0.7, 0.2, 0.9]]
        .map(at)
        .to_vec()
}

/// A table in Markdown. Each row is printed when it has been measured.
pub struct Table(Vec<usize>);

impl Table {
    /// Prints the head of the table. The first column is wide enough for names, and the others for figures.
    pub fn new(title: &str, columns: &[&str]) -> Self {
        println!("\n## {title}\n");
        let width =
            |(k, name): (usize, &&str)| name.chars().count().max(if k == 0 { 22 } else { 0 });
        let table = Self(columns.iter().enumerate().map(width).collect());
        table.row(columns);
        let rule = |(k, &width): (usize, &usize)| {
            let rule = "-".repeat(width - usize::from(k > 0));
            if k == 0 { rule } else { rule + ":" }
        };
        table.row(&table.0.iter().enumerate().map(rule).collect::<Vec<_>>());
        table
    }

    /// Prints a row.
    pub fn row<S: AsRef<str>>(&self, cells: &[S]) {
        assert_eq!(cells.len(), self.0.len());
        for (k, (cell, &width)) in cells.iter().zip(&self.0).enumerate() {
            let cell = cell.as_ref();
            if k == 0 { print!("| {cell:<width$} |") } else { print!(" {cell:>width$} |") }
        }
        println!();
    }
}

/// A ratio of times.
pub fn ratio(a: Duration, b: Duration) -> String {
    let ratio = a.as_secs_f64() / b.as_secs_f64();
    if ratio < 0.1 { format!("{ratio:.3}") } else { format!("{ratio:.2}") }
}

/// A pool of threads to measure in.
pub fn threads(count: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(count).build().expect("threads")
}

/// A time with three digits.
pub fn time(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    match seconds {
        s if s < 1e-3 => format!("{:.1} µs", s * 1e6),
        s if s < 1.0 => format!("{:.2} ms", s * 1e3),
        s => format!("{s:.2} s"),
    }
}

/// Prints the head of a document: the date, the commit and the machine.
pub fn print_head(title: &str, command: &str) {
    println!("# {title}\n");
    println!("- command: `{command}`");
    println!("- date: {}", said_by("date", &["-u", "+%Y-%m-%d %H:%M UTC"]));
    println!("- commit: {}", said_by("git", &["describe", "--always", "--abbrev=10", "--dirty"]));
    println!("- machine: {}", machine());
    println!("- compiler: {}", said_by("rustc", &["--version"]));
    println!("- generated scenes by seed {SEED}; shortest time of several, all in one run");
}

fn said_by(program: &str, arguments: &[&str]) -> String {
    let answer = Command::new(program).args(arguments).output();
    let said = answer.ok().filter(|answer| answer.status.success());
    said.and_then(|answer| String::from_utf8(answer.stdout).ok())
        .map_or("unknown".to_owned(), |text| text.trim().to_owned())
}

fn machine() -> String {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpuinfo.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let model = model.map_or("unknown processor", |(_, model)| model.trim());
    format!("{model}, {threads} threads, {} {}", env::consts::OS, env::consts::ARCH)
}

/// Returns whether the command line names this section, or names no section.
pub fn wanted(section: &str) -> bool {
    let mut named = env::args().skip(1).filter(|argument| !argument.starts_with('-')).peekable();
    named.peek().is_none() || named.any(|name| name == section)
}
