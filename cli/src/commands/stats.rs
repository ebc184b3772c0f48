//! `binspace stats`: the figures of trees.

use binspace::scene::Scene;
use binspace::{Heuristic, Stats};

use super::Outcome;
use crate::args::StatsArgs;
use crate::failure::Failure;
use crate::measure;
use crate::table::Table;
use crate::terminal::{HEAD, note, say, styled};
use crate::units::{bytes, count, time};
use crate::{job, scene_arg};

/// The figures of one tree.
struct Figures {
    heuristic: Heuristic,
    stats: Stats,
    build_seconds: f64,
    order_nanoseconds: f64,
}

/// Runs the command.
pub(crate) fn run(args: &StatsArgs) -> Result<Outcome, Failure> {
    let scene = scene_arg::load(&args.scene)?;
    let table = table();
    let mut failed = None;
    for (i, &heuristic) in args.heuristic.0.iter().enumerate() {
        let figures = match measure(args, &scene, heuristic) {
            Ok(figures) => figures,
            // Another heuristic may stay within the budget.
            Err(error) if error.is_over_budget() && args.heuristic.0.len() > 1 => {
                note(&format!("{heuristic}: {error}"));
                failed = Some(error);
                continue;
            }
            Err(error) => return Err(job::about(&scene, &error)),
        };
        if args.json {
            say(json(&figures))?;
        } else {
            if i == 0 {
                say(title(&scene, &figures.stats))?;
                say(styled(HEAD, table.head()))?;
            }
            say(row(&table, &figures))?;
        }
    }
    match failed {
        Some(error) => Err(job::about(&scene, &error)),
        None => Ok(Outcome::Done),
    }
}

fn measure(
    args: &StatsArgs,
    scene: &Scene,
    heuristic: Heuristic,
) -> Result<Figures, binspace::Error> {
    let (tree, seconds) = measure::timed_build(scene, &args.limits.options(heuristic))?;
    Ok(Figures {
        heuristic,
        stats: tree.stats(),
        build_seconds: seconds,
        order_nanoseconds: measure::order_nanoseconds(&tree, scene),
    })
}

fn title(scene: &Scene, stats: &Stats) -> String {
    format!(
        "{}: {}, {}; {} dropped, {} triangulated",
        styled(HEAD, scene.name()),
        count(stats.polygons, "polygon"),
        count(stats.faces, "face"),
        stats.dropped,
        stats.triangulated,
    )
}

fn table() -> Table {
    Table::new(&[
        ("heuristic", 15),
        ("fragments", 0),
        ("/face", 5),
        ("nodes", 8),
        ("splits", 8),
        ("depth", 6),
        ("mean", 6),
        ("build", 7),
        ("order", 7),
        ("memory", 7),
    ])
}

fn row(table: &Table, figures: &Figures) -> String {
    let Figures { heuristic, stats, .. } = figures;
    let per_face = stats.fragments as f64 / stats.faces.max(1) as f64;
    table.row(&[
        heuristic.to_string(),
        stats.fragments.to_string(),
        format!("{per_face:.2}"),
        stats.nodes.to_string(),
        stats.splits.to_string(),
        stats.depth_max.to_string(),
        format!("{:.1}", stats.depth_mean),
        time(figures.build_seconds),
        time(figures.order_nanoseconds * 1e-9),
        bytes(stats.bytes),
    ])
}

fn json(figures: &Figures) -> String {
    let stats = &figures.stats;
    format!(
        "{{\"heuristic\": \"{}\", \"polygons\": {}, \"faces\": {}, \"fragments\": {}, \
         \"nodes\": {}, \"depth_max\": {}, \"depth_mean\": {:?}, \"splits\": {}, \
         \"build_seconds\": {:?}, \"order_ns_per_fragment\": {:?}, \"bytes\": {}, \
         \"dropped\": {}, \"triangulated\": {}}}",
        figures.heuristic,
        stats.polygons,
        stats.faces,
        stats.fragments,
        stats.nodes,
        stats.depth_max,
        stats.depth_mean,
        stats.splits,
        figures.build_seconds,
        figures.order_nanoseconds,
        stats.bytes,
        stats.dropped,
        stats.triangulated,
    )
}
