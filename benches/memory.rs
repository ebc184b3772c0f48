//! Bytes of a finished tree, and the peak while it is built. Prints a table of RESULTS.md.

#![allow(missing_docs, reason = "a program")]
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "prints measurements")]

use binspace::BspTree;
use dhat::{HeapStats, Profiler};
use support::{Table, Target, against, check, print_head, scene, viewpoints};

#[global_allocator]
static COUNTING: dhat::Alloc = dhat::Alloc;

const SCENES: [&str; 12] = [
    "random:1000",
    "city:100000",
    "sphere:100000",
    "terrain:100000",
    "terrain:1000000",
    "bunny_4k.obj",
    "doom_map12_big.obj",
    "teapot_quads_32k.obj",
    "chessboard_63k.obj",
    "pool_table_29k.obj",
    "maple_tree_166k.obj",
    "showroom_big_cc0.obj",
];

fn main() {
    print_head("Memory", "cargo bench -p binspace-benches --bench memory");
    let table = Table::new(
        "Memory: the tree, and the peak while it is built",
        &[
            "scene",
            "fragments",
            "bytes / fragment",
            "target",
            "met",
            "peak / tree",
            "target",
            "met",
        ],
    );
    for name in SCENES {
        let Some(scene) = scene(name) else { continue };
        // Counts allocations from here on: the scene is not included.
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

        let each = built.curr_bytes as f64 / tree.len() as f64;
        let [each, most, met] = against(each, Target::AtMost(160.0));
        let peak = built.max_bytes as f64 / built.curr_bytes as f64;
        let [peak, peak_target, peak_met] = against(peak, Target::AtMost(2.5));
        let fragments = tree.len().to_string();
        table.row(&[name.to_owned(), fragments, each, most, met, peak, peak_target, peak_met]);
    }
}
