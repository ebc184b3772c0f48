//! A build by two threads against one.

use binspace::BspTree;
use rayon::{ThreadPool, ThreadPoolBuilder};
use support::{Table, Target, against, best, check, scene, time, viewpoints};

const SCENES: [&str; 6] = [
    "terrain:100000",
    "sphere:100000",
    "city:100000",
    "chessboard_63k.obj",
    "maple_tree_166k.obj",
    "showroom_big_cc0.obj",
];

pub(crate) fn run() {
    let table = Table::new(
        "Threads",
        &["scene", "faces", "one thread", "two threads", "ratio", "target", "met"],
    );
    let pool = |threads| -> ThreadPool {
        ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
    };
    let (one, two) = (pool(1), pool(2));
    for name in SCENES {
        let Some(scene) = scene(name) else { continue };
        let build = || BspTree::build(scene.polygons()).expect("within budget");
        let (alone, by_one) = best(|| one.install(build));
        let (together, by_two) = best(|| two.install(build));
        check(&by_two, &scene);
        assert_same(&by_one, &by_two);
        for viewpoint in viewpoints(&scene) {
            let order = |tree: &BspTree| {
                let mut order = Vec::new();
                tree.back_to_front_into(viewpoint, &mut order);
                order
            };
            assert_eq!(order(&by_one), order(&by_two));
        }
        let [ratio, target, met] =
            against(alone.as_secs_f64() / together.as_secs_f64(), Target::AtLeast(1.7));
        table.row(&[
            name.to_owned(),
            by_two.stats().faces.to_string(),
            time(alone),
            time(together),
            ratio,
            target,
            met,
        ]);
    }
}

/// The same statistics, and the same fragments bit for bit in the same places.
fn assert_same(a: &BspTree, b: &BspTree) {
    assert_eq!(a.stats(), b.stats());
    assert_eq!(a.preparation(), b.preparation());
    for (a, b) in a.fragments().zip(b.fragments()) {
        assert_eq!(a.polygon(), b.polygon());
        assert!(a.vertices().eq(b.vertices()));
    }
}
