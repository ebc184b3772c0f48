//! Compares a build on one thread and on two threads with a build of the `bvh` crate by its surface area
//! heuristic, on two threads. `bvh` gets the same polygons as triangles. The boxes of `bvh` are computed
//! beforehand, in `f32` as most of its users would.

use binspace::BspTree;
use binspace::scene::Scene;
use bvh::bvh::{Bvh, rayon_executor};
use std::time::Duration;
use support::{Table, best, boxed, check, ratio, scene, threads, time, triangulated};

const SCENES: [&str; 13] = [
    "random:1000",
    "terrain:100000",
    "sphere:100000",
    "city:100000",
    "terrain:1000000",
    "bunny.obj",
    "spider.obj",
    "person.obj",
    "dragon.obj",
    "dragon_large.obj",
    "engine.obj",
    "level.obj",
    "level_large.obj",
];

pub(crate) fn run() {
    let table = Table::new(
        "Build",
        &[
            "scene",
            "polygons",
            "fragments",
            "fragments a polygon",
            "one thread",
            "two threads",
            "one ÷ two",
            "bvh",
            "bvh ÷ ours",
        ],
    );
    let (one, two) = (threads(1), threads(2));
    for name in SCENES {
        let scene = scene(name);
        let build = || BspTree::build(scene.polygons()).expect("within budget");
        let (alone, by_one) = one.install(|| best(build));
        let (together, by_two) = two.install(|| best(build));
        check(&by_two, &scene);
        assert_same(&by_one, &by_two);
        let hierarchy = two.install(|| hierarchy(&scene));
        table.row(&[
            name.to_owned(),
            scene.len().to_string(),
            by_two.len().to_string(),
            format!("{:.2}", by_two.len() as f64 / scene.len() as f64),
            time(alone),
            time(together),
            ratio(alone, together),
            time(hierarchy),
            ratio(hierarchy, together),
        ]);
    }
}

/// Asserts that two trees have the same statistics and, bit for bit, the same fragments in the same places.
fn assert_same(a: &BspTree, b: &BspTree) {
    assert_eq!(a.stats(), b.stats());
    for (a, b) in a.fragments().zip(b.fragments()) {
        assert_eq!(a.polygon(), b.polygon());
        assert!(a.vertices().eq(b.vertices()));
    }
}

/// The shortest time to build a hierarchy of boxes.
fn hierarchy(scene: &Scene) -> Duration {
    let mut boxes = boxed(&triangulated(scene));
    let (shortest, hierarchy) = best(|| Bvh::build_with_executor(&mut boxes, rayon_executor));
    assert_eq!(hierarchy.nodes.len(), 2 * boxes.len() - 1);
    shortest
}
