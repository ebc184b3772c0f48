//! Measures the bytes of a finished tree, the peak while it is built, and the bytes that peers keep. Prints a
//! table of figures.md.

#![allow(missing_docs, reason = "a program")]

use binspace::BspTree;
use binspace::scene::Scene;
use bvh::bvh::Bvh;
use dhat::{HeapStats, Profiler};
use euclid::default::Point3D;
use plane_split::BspSplitter;
use std::thread;
use support::{Table, boxed, check, print_head, scene, triangulated, viewpoints};

#[global_allocator]
static COUNTING: dhat::Alloc = dhat::Alloc;

const SCENES: [&str; 11] = [
    "random:1000",
    "city:10000",
    "sphere:10000",
    "city:100000",
    "sphere:100000",
    "terrain:100000",
    "bunny.obj",
    "spider.obj",
    "dragon_large.obj",
    "engine.obj",
    "level_large.obj",
];
/// The largest sphere for `plane-split`. Its time is quadratic in the polygons of a sphere, it accepts only
/// quads and triangles, and its recursion is as deep as its tree.
const MOST_SPLIT: usize = 11_000;
const THEIR_STACK: usize = 4 << 30;

fn main() {
    print_head("Memory", "cargo bench -p binspace-benches --bench memory");
    let table = Table::new(
        "Memory",
        &[
            "scene",
            "polygons",
            "fragments",
            "bytes a fragment",
            "peak ÷ tree",
            "bytes a polygon",
            "plane-split, a polygon",
            "bvh, a polygon",
        ],
    );
    for name in SCENES {
        let scene = scene(name);
        // Allocations are counted from here on, so the scene is not included.
        let profiler = Profiler::builder().testing().build();
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        let built = HeapStats::get();
        let viewpoints = viewpoints(&scene);
        let mut order = Vec::new();
        let before = HeapStats::get().total_blocks;
        for &viewpoint in &viewpoints {
            tree.back_to_front_into(viewpoint, &mut order);
            let blocks = HeapStats::get().total_blocks - before;
            assert_eq!(blocks, 1, "only the first order allocates");
        }
        drop(profiler);
        check(&tree, &scene);
        assert_eq!(order.len(), tree.len());

        let each = |bytes: usize, count: usize| format!("{:.0}", bytes as f64 / count as f64);
        let can_split = scene.len() < MOST_SPLIT && scene.polygons().all(|p| p.points().len() < 5);
        let split = can_split.then(|| each(bytes_of_splitter(&scene), scene.len()));
        table.row(&[
            name.to_owned(),
            scene.len().to_string(),
            tree.len().to_string(),
            each(built.curr_bytes, tree.len()),
            format!("{:.2}", built.max_bytes as f64 / built.curr_bytes as f64),
            each(built.curr_bytes, scene.len()),
            split.unwrap_or("–".to_owned()),
            each(bytes_of_hierarchy(&scene), scene.len()),
        ]);
    }
}

/// The bytes that the result of a function keeps.
fn bytes_of<T>(make: impl FnOnce() -> T) -> usize {
    let _profiler = Profiler::builder().testing().build();
    let kept = make();
    let bytes = HeapStats::get().curr_bytes;
    drop(kept);
    bytes
}

fn bytes_of_splitter(scene: &Scene) -> usize {
    let work = || {
        bytes_of(|| {
            let mut splitter = BspSplitter::<usize>::new();
            for (number, corners) in scene.polygons().enumerate() {
                let points = corners.points();
                let point = |k: usize| Point3D::from(points[k % points.len()].to_array());
                let points = [0, 1, 2, 3].map(point);
                // Polygons without an area have no plane.
                if let Some(polygon) = plane_split::Polygon::from_points(points, number) {
                    splitter.add(polygon);
                }
            }
            splitter
        })
    };
    thread::scope(|scope| {
        let thread = thread::Builder::new().stack_size(THEIR_STACK).spawn_scoped(scope, work);
        thread.expect("a thread").join().expect("plane-split does not panic here")
    })
}

/// A hierarchy of boxes in `f32`, with the boxes of its triangles and without their corners.
fn bytes_of_hierarchy(scene: &Scene) -> usize {
    let triangles = triangulated(scene);
    bytes_of(|| {
        let mut shapes = boxed(&triangles);
        (Bvh::build(&mut shapes), shapes)
    })
}
