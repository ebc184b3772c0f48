//! Measures fragments, depth, build time and order time of every heuristic on every scene, and of `auto` with
//! trials. Prints a table for each scene, and then the table of HEURISTICS.md.
//!
//! ```sh
//! cargo bench -p binspace-benches --bench heuristics
//! ```

#![allow(missing_docs, reason = "a program")]
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "prints measurements")]

use binspace::scene::Scene;
use binspace::{BspTree, BuildOptions, ErrorKind, Heuristic};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};
use support::{Table, best, best_of, check, is_file, print_head, scene, time, viewpoints};

const SCENES: [&str; 16] = [
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
    "bunny.obj",
    "spider.obj",
    "person.obj",
    "level.obj",
    "level_large.obj",
];

/// A build that takes longer is given up, and the table reports it.
const PATIENCE: Duration = Duration::from_secs(10);

fn main() {
    print_head("Heuristics", "cargo bench -p binspace-benches --bench heuristics");
    let mut measured = Vec::new();
    for name in SCENES {
        let scene = scene(name);
        let rows = measure(name, &scene);
        measured.push((name, rows));
    }
    let (files, built_in): (Vec<_>, Vec<_>) = measured.iter().partition(|(name, _)| is_file(name));
    summary("Heuristics on built-in scenes", &built_in);
    summary("Heuristics on real scenes", &files);
}

/// The name of the row that other rows are compared with.
const AUTO: &str = "auto";

/// Every heuristic, and `auto` with trials.
fn tried() -> Vec<(String, BuildOptions)> {
    let default = || BuildOptions::DEFAULT;
    let heuristics = Heuristic::ALL.iter().map(|&h| (h.to_string(), default().with_heuristic(h)));
    let trials = [2, 4, 8].map(|n| (format!("{AUTO}, {n} trials"), default().with_trials(n)));
    heuristics.chain(trials).collect()
}

struct Row {
    name: String,
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
    for (heuristic, options) in tried() {
        let (build, tree) = best_of(1, || build(&options, scene));
        let tree = match tree {
            Ok(tree) => tree,
            Err(why) => {
                let mut cells = [""; 7].map(str::to_owned);
                [cells[0], cells[5]] = [heuristic, why];
                table.row(&cells);
                continue;
            }
        };
        let order = time_order(&tree, scene);
        let stats = tree.stats();
        check(&tree, scene);
        table.row(&[
            heuristic.clone(),
            stats.fragments.to_string(),
            format!("{:.3}", stats.fragments as f64 / stats.faces as f64),
            stats.depth_max.to_string(),
            format!("{:.1}", stats.depth_mean),
            time(build),
            format!("{:.1} ns", order.as_secs_f64() * 1e9 / stats.fragments as f64),
        ]);
        rows.push(Row { name: heuristic, fragments: stats.fragments, build, order });
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

/// The columns of [`summary`]: a mean and two scenes for each of the three figures.
const COLUMNS: [&str; 10] = [
    "heuristic",
    "fragments",
    "               least",
    "                most",
    "build",
    "            shortest",
    "             longest",
    "order",
    "            shortest",
    "             longest",
];

/// The number of decimals of a figure, and the figure of a row.
type Figure = (usize, fn(&Row) -> f64);

/// Prints the figures of each heuristic, divided by the figures of `auto`: geometric means, and the scenes
/// with the smallest and the largest ratio. Scenes whose builds were given up are left out.
fn summary(title: &str, measured: &[&(&str, Vec<Row>)]) {
    let figures: [Figure; 3] = [
        (3, |row| row.fragments as f64),
        (2, |row| row.build.as_secs_f64()),
        (1, |row| row.order.as_secs_f64()),
    ];
    let table = Table::new(title, &COLUMNS);
    for (heuristic, _) in tried() {
        let mut cells = vec![heuristic.clone()];
        for (decimals, figure) in figures {
            let of = |rows: &[Row], by: &str| rows.iter().find(|row| row.name == by).map(figure);
            let ratios = measured
                .iter()
                .filter_map(|(name, rows)| Some((of(rows, &heuristic)? / of(rows, AUTO)?, *name)));
            let ratios: Vec<(f64, &str)> = ratios.collect();
            let mean =
                ratios.iter().map(|(ratio, _)| ratio.ln()).sum::<f64>() / ratios.len() as f64;
            cells.push(format!("{:.decimals$}", mean.exp()));
            let least = ratios.iter().min_by(|a, b| a.0.total_cmp(&b.0));
            let most = ratios.iter().max_by(|a, b| a.0.total_cmp(&b.0));
            for end in [least, most] {
                let cell = |(ratio, name): &(f64, &str)| format!("{ratio:.decimals$} {name}");
                cells.push(end.map_or_else(String::new, cell));
            }
        }
        table.row(&cells);
    }
}
