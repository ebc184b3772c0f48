//! Reading a tree from a file, with all checks, against building the tree.

use binspace::BspTree;
use std::time::{Duration, Instant};
use support::{Table, best, check, ratio, scene, threads, time, viewpoints};

const SCENES: [&str; 7] = [
    "terrain:100000",
    "sphere:100000",
    "city:100000",
    "random:1000",
    "dragon_large.obj",
    "engine.obj",
    "level_large.obj",
];

pub(crate) fn run() {
    let table = Table::new(
        "Saved trees",
        &[
            "scene",
            "fragments",
            "build",
            "write",
            "read",
            "bytes a fragment",
            "in memory",
            "read ÷ build",
        ],
    );
    let one = threads(1);
    for name in SCENES {
        let scene = scene(name);
        let build = || BspTree::build(scene.polygons()).expect("within budget");
        let (building, tree) = one.install(|| best(build));
        check(&tree, &scene);
        let (mut file, begin) = (Vec::new(), Instant::now());
        tree.write(&mut file).expect("memory");
        let writing = begin.elapsed();
        let mut reading = Duration::MAX;
        for _ in 0..5 {
            let begin = Instant::now();
            let again = BspTree::read(&file[..]).expect("a file that was written");
            reading = reading.min(begin.elapsed());
            assert_same(&tree, &again);
            check(&again, &scene);
            for viewpoint in viewpoints(&scene) {
                assert_eq!(order(&tree, viewpoint), order(&again, viewpoint));
            }
        }
        let each = |bytes: usize| format!("{:.1}", bytes as f64 / tree.len() as f64);
        table.row(&[
            name.to_owned(),
            tree.len().to_string(),
            time(building),
            time(writing),
            time(reading),
            each(file.len()),
            each(tree.memory_usage()),
            ratio(reading, building),
        ]);
    }
}

fn order(tree: &BspTree, viewpoint: binspace::Viewpoint) -> Vec<u32> {
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    order
}

/// Asserts that two trees have the same statistics and, bit for bit, the same fragments in the same places.
fn assert_same(a: &BspTree, b: &BspTree) {
    assert_eq!(a.stats(), b.stats());
    assert_eq!(a.preparation(), b.preparation());
    for (a, b) in a.fragments().zip(b.fragments()) {
        assert_eq!(a.polygon(), b.polygon());
        assert!(a.vertices().eq(b.vertices()));
    }
}
