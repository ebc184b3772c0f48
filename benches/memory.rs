//! Measures the bytes of a finished tree, the peak while it is built, and the bytes that peers keep. Prints a
//! table of figures.md.

#![allow(missing_docs, reason = "a program")]

use binspace::BspTree;
use binspace::scene::Scene;
use bvh::bvh::Bvh;
use euclid::default::Point3D;
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use plane_split::BspSplitter;
use stats_alloc::{Region, StatsAlloc};
use std::alloc::System;
use std::thread;
use support::{Table, boxed, check, print_head, scene, triangulated, viewpoints};

static COUNTING: StatsAlloc<System> = StatsAlloc::system();

#[global_allocator]
static MEASURING: PeakMemAlloc<&StatsAlloc<System>> = PeakMemAlloc::new(&COUNTING);

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
        MEASURING.reset_peak_memory();
        let (tree, bytes) = kept(|| BspTree::build(scene.polygons()).expect("within budget"));
        let most = MEASURING.get_peak_memory();
        let viewpoints = viewpoints(&scene);
        let mut order = Vec::new();
        let region = Region::new(&COUNTING);
        for &viewpoint in &viewpoints {
            tree.back_to_front_into(viewpoint, &mut order);
            let change = region.change();
            let blocks = change.allocations + change.reallocations;
            assert_eq!(blocks, 1, "only the first order allocates");
        }
        check(&tree, &scene);
        assert_eq!(order.len(), tree.len());

        let each = |bytes: usize, count: usize| format!("{:.0}", bytes as f64 / count as f64);
        let can_split = scene.len() < MOST_SPLIT && scene.polygons().all(|p| p.points().len() < 5);
        let split = can_split.then(|| each(bytes_of_splitter(&scene), scene.len()));
        table.row(&[
            name.to_owned(),
            scene.len().to_string(),
            tree.len().to_string(),
            each(bytes, tree.len()),
            format!("{:.2}", most as f64 / bytes as f64),
            each(bytes, scene.len()),
            split.unwrap_or("–".to_owned()),
            each(bytes_of_hierarchy(&scene), scene.len()),
        ]);
    }
}

/// The result of a function, and the bytes that it keeps.
fn kept<T>(make: impl FnOnce() -> T) -> (T, usize) {
    let region = Region::new(&COUNTING);
    let result = make();
    let change = region.change();
    (result, change.bytes_allocated - change.bytes_deallocated)
}

fn bytes_of<T>(make: impl FnOnce() -> T) -> usize {
    kept(make).1
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
