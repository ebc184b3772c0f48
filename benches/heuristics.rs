//! Every heuristic on every scene: pieces, depth, build, order; and the loss of the default against the best.
//! Prints the tables of HEURISTICS.md.
//!
//! ```sh
//! BINSPACE_SCENES=… cargo bench -p binspace-benches --bench heuristics
//! ```

#![allow(missing_docs, reason = "a program")]
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "it prints what it measures")]

use binspace::scene::Scene;
use binspace::{BspTree, BuildOptions, ErrorKind, Heuristic};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};
use support::{Table, best, best_of, check, print_head, scene, time, viewpoints};

const SCENES: [&str; 25] = [
    "newell",
    "crossing",
    "cornell",
    "teapot:8",
    "teapot:32",
    "terrain:10000",
    "sphere:10000",
    "city:10000",
    "random:1000",
    "chain:10000",
    "layers",
    "cornell_box.obj",
    "spider_1k.obj",
    "forklift_1k.obj",
    "doom_e1m1.obj",
    "suzanne_2k.obj",
    "teapot_quads_2k.obj",
    "bunny_4k.obj",
    "doom_map12_big.obj",
    "bed_21k.obj",
    "pool_table_29k.obj",
    "teapot_quads_32k.obj",
    "chessboard_63k.obj",
    "maple_tree_166k.obj",
    "showroom_big_cc0.obj",
];

/// A build that takes longer is given up, and said so.
const PATIENCE: Duration = Duration::from_secs(30);

fn main() {
    print_head("Heuristics", "cargo bench -p binspace-benches --bench heuristics");
    let mut losses = Vec::new();
    for name in SCENES {
        let Some(scene) = scene(name) else { continue };
        let rows = measure(name, &scene);
        losses.push((name, rows));
    }
    summary(&losses);
}

struct Row {
    heuristic: Heuristic,
    fragments: usize,
    build: Duration,
    order: Duration,
}

fn measure(name: &str, scene: &Scene) -> Vec<Row> {
    let table = Table::new(
        name,
        &[
            "heuristic",
            " fragments",
            "per face",
            "depth",
            "  mean",
            "     build",
            "order / fragment",
        ],
    );
    let mut rows = Vec::new();
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        let (build, tree) = best_of(1, || build(&options, scene));
        let tree = match tree {
            Ok(tree) => tree,
            Err(why) => {
                let mut cells = [""; 7].map(str::to_owned);
                [cells[0], cells[5]] = [heuristic.to_string(), why];
                table.row(&cells);
                continue;
            }
        };
        let order = time_order(&tree, scene);
        let stats = tree.stats();
        check(&tree, scene);
        table.row(&[
            heuristic.to_string(),
            stats.fragments.to_string(),
            format!("{:.3}", stats.fragments as f64 / stats.faces as f64),
            stats.depth_max.to_string(),
            format!("{:.1}", stats.depth_mean),
            time(build),
            format!("{:.1} ns", order.as_secs_f64() * 1e9 / stats.fragments as f64),
        ]);
        rows.push(Row { heuristic, fragments: stats.fragments, build, order });
    }
    rows
}

fn build(options: &BuildOptions, scene: &Scene) -> Result<BspTree, String> {
    let begin = Instant::now();
    let progress = |_| {
        let late = begin.elapsed() > PATIENCE;
        if late { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    options.build_with_progress(scene.polygons(), progress).map_err(|error| {
        if error.kind() == ErrorKind::Cancelled {
            format!("over {} s", PATIENCE.as_secs())
        } else {
            "over budget".to_owned()
        }
    })
}

/// The mean over viewpoints of the shortest times.
fn time_order(tree: &BspTree, scene: &Scene) -> Duration {
    let viewpoints = viewpoints(scene);
    let mut order = Vec::new();
    let mut sum = Duration::ZERO;
    for &viewpoint in &viewpoints {
        tree.back_to_front_into(viewpoint, &mut order);
        sum += best(|| tree.back_to_front_into(viewpoint, &mut order)).0;
        order.sort_unstable();
        assert!(order.iter().copied().eq(0..tree.len() as u32));
    }
    sum / viewpoints.len() as u32
}

/// On each scene, `auto` against the best of all in each respect.
fn summary(measured: &[(&str, Vec<Row>)]) {
    let table = Table::new(
        "What `auto` loses against the best of all on each scene",
        &["scene", "fragments", "fewest by", "build", "fastest by", "order", "fastest by"],
    );
    for (name, rows) in measured {
        let Some(auto) = rows.iter().find(|row| row.heuristic == Heuristic::Auto) else { continue };
        let mut cells = vec![(*name).to_owned()];
        let figures: [fn(&Row) -> f64; 3] = [
            |row| row.fragments as f64,
            |row| row.build.as_secs_f64(),
            |row| row.order.as_secs_f64(),
        ];
        for figure in figures {
            let best = rows.iter().min_by(|a, b| figure(a).total_cmp(&figure(b))).unwrap_or(auto);
            cells.push(format!("{:.2}", figure(auto) / figure(best)));
            let winner = if figure(best) < figure(auto) { best.heuristic } else { auto.heuristic };
            cells.push(winner.to_string());
        }
        table.row(&cells);
    }
}
