//! `binspace stats`: the figures of trees.

use std::path::Path;
use std::time::Instant;

use binspace::scene::Scene;
use binspace::{BspTree, ErrorKind, Heuristic, Preparation, Stats};
use serde::Serialize;

use crate::Outcome;
use crate::args::StatsArgs;
use crate::cells::folder::Folder;
use crate::failure::Failure;
use crate::measure::{order_nanoseconds, timed_build};
use crate::scene_arg::Loaded;
use crate::table::Table;
use crate::terminal::{HEAD, note, remark, say, styled};
use crate::units::{bytes, count, three_digits, time};
use crate::values::Heuristics;
use crate::{cells, job, scene_arg};

/// The width of the table's column of heuristics, in characters.
const NAME: usize = 13;

/// The figures of one tree.
struct Figures {
    /// `None` for a tree from a file.
    heuristic: Option<Heuristic>,
    /// The number of its cell.
    cell: Option<usize>,
    prepared: Preparation,
    duplicates: usize,
    stats: Stats,
    /// The time to build the tree, or to read it.
    build_seconds: f64,
    order_nanoseconds: f64,
}

/// Runs the command.
pub(crate) fn run(args: &StatsArgs) -> Result<Outcome, Failure> {
    let begin = Instant::now();
    if let Some(path) = cells::folder::named(&args.scene.name) {
        return of_cells(args, path);
    }
    let Loaded { scene, tree, .. } = scene_arg::load(&args.scene.name, args.scene.seed)?;
    if let Some(tree) = tree {
        return of_file(args, &scene, &tree, begin.elapsed().as_secs_f64());
    }
    let (mut over_budget, mut is_first) = (0, true);
    let Heuristics(heuristics) = &args.heuristic;
    for &heuristic in heuristics {
        let (tree, seconds) = match timed_build(&scene, &args.limits.options(heuristic)) {
            Ok(built) => built,
            // Another heuristic may stay within the budget.
            Err(error) if error.kind() == ErrorKind::OverBudget && heuristics.len() > 1 => {
                note(&format!("{heuristic}: {error}"));
                over_budget += 1;
                continue;
            }
            Err(error) => return Err(job::about(&scene, &error)),
        };
        if is_first {
            job::note_tolerance(&scene, &args.limits, &tree);
            job::note_preparation(&scene, tree.faces(), tree.preparation());
            if tree.is_empty() {
                remark(scene.name(), job::NOTHING_LEFT, job::NOTHING_LEFT);
            }
        }
        let figures = Figures {
            heuristic: Some(heuristic),
            cell: None,
            prepared: *tree.preparation(),
            duplicates: tree.duplicates(),
            stats: tree.stats(),
            build_seconds: seconds,
            order_nanoseconds: order_nanoseconds(&tree, &scene),
        };
        show(args, &scene, &figures, is_first)?;
        is_first = false;
    }
    match over_budget {
        0 => Ok(Outcome::Done),
        trees => Err(Failure::about(scene.name(), format!("{} over budget", count(trees, "tree")))),
    }
}

/// The figures of a tree that was read from a file.
fn of_file(
    args: &StatsArgs,
    scene: &Scene,
    tree: &BspTree,
    seconds: f64,
) -> Result<Outcome, Failure> {
    job::refuse_options(scene.name(), args.is_given)?;
    job::note_preparation(scene, tree.faces(), tree.preparation());
    let figures = Figures {
        heuristic: None,
        cell: None,
        prepared: *tree.preparation(),
        duplicates: tree.duplicates(),
        stats: tree.stats(),
        build_seconds: seconds,
        order_nanoseconds: order_nanoseconds(tree, scene),
    };
    show(args, scene, &figures, true)?;
    Ok(Outcome::Done)
}

/// The figures of the trees in a folder.
fn of_cells(args: &StatsArgs, path: &Path) -> Result<Outcome, Failure> {
    let folder = Folder::open(path)?;
    job::refuse_options(path.display(), args.is_given)?;
    for number in 0..folder.partition.cells() {
        let begin = Instant::now();
        let cell = folder.cell(number)?;
        let figures = Figures {
            heuristic: None,
            cell: Some(number),
            prepared: *cell.tree.preparation(),
            duplicates: cell.tree.duplicates(),
            stats: cell.tree.stats(),
            build_seconds: begin.elapsed().as_secs_f64(),
            order_nanoseconds: order_nanoseconds(&cell.tree, &cell.scene),
        };
        if args.json {
            say(json(&figures)?)?;
            continue;
        }
        let table = table();
        if number == 0 {
            say(format!(
                "{}: {}",
                styled(HEAD, folder.bounds.name()),
                count(folder.partition.cells(), "cell")
            ))?;
            say(styled(HEAD, table.head()))?;
        }
        say(row(&table, &figures))?;
    }
    Ok(Outcome::Done)
}

fn show(args: &StatsArgs, scene: &Scene, figures: &Figures, is_first: bool) -> Result<(), Failure> {
    if args.json {
        return say(json(figures)?);
    }
    let table = table();
    if is_first {
        say(title(scene, figures))?;
        say(styled(HEAD, table.head()))?;
    }
    say(row(&table, figures))
}

fn title(scene: &Scene, Figures { prepared, duplicates, stats, .. }: &Figures) -> String {
    format!(
        "{}: {}, {}; {} dropped, {} triangulated, {}",
        styled(HEAD, scene.name()),
        count(prepared.polygons, "polygon"),
        count(stats.faces, "face"),
        prepared.dropped,
        prepared.triangulated,
        count(*duplicates, "duplicate"),
    )
}

fn table() -> Table {
    // 80 columns with the gaps between. Splits are omitted: they are fragments minus faces.
    Table::new(&[
        ("heuristic", NAME),
        ("fragments", 0),
        ("/face", 5),
        ("nodes", 7),
        ("depth", 5),
        ("mean", 4),
        ("build", 7),
        ("order", 7),
        ("memory", 7),
    ])
}

fn row(table: &Table, figures: &Figures) -> String {
    let Figures { heuristic, stats, .. } = figures;
    let per_face = stats.fragments as f64 / stats.faces.max(1) as f64;
    table.row(&[
        match (figures.cell, heuristic) {
            (Some(cell), _) => format!("cell {cell}"),
            (None, Some(heuristic)) => name(*heuristic),
            (None, None) => "from a file".to_owned(),
        },
        stats.fragments.to_string(),
        format!("{per_face:.2}"),
        stats.nodes.to_string(),
        stats.depth_max.to_string(),
        three_digits(stats.depth_mean),
        time(figures.build_seconds),
        time(figures.order_nanoseconds * 1e-9),
        bytes(stats.bytes),
    ])
}

/// The name of a heuristic in the table: `weighted` with its default weights is written without them.
fn name(heuristic: Heuristic) -> String {
    let name = match heuristic {
        _ if "weighted".parse() == Ok(heuristic) => "weighted".to_owned(),
        other => other.to_string(),
    };
    if name.chars().count() <= NAME {
        return name;
    }
    name.chars().take(NAME - 1).chain(['…']).collect()
}

/// The figures of a tree as a JSON object.
#[derive(Serialize)]
struct Line {
    heuristic: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cell: Option<usize>,
    polygons: usize,
    faces: usize,
    fragments: usize,
    nodes: usize,
    depth_max: usize,
    depth_mean: f64,
    splits: usize,
    build_seconds: f64,
    order_ns_per_fragment: f64,
    bytes: usize,
    dropped: usize,
    triangulated: usize,
    duplicates: usize,
    crossing: usize,
    tolerance: f64,
    flattened: usize,
    flattened_by: f64,
    bent: usize,
    bent_by: f64,
    nearly_coplanar: usize,
    nearly_coplanar_by: f64,
}

fn json(figures: &Figures) -> Result<String, Failure> {
    let Figures { prepared, stats, .. } = figures;
    let line = Line {
        heuristic: figures.heuristic.map(|heuristic| heuristic.to_string()),
        cell: figures.cell,
        polygons: prepared.polygons,
        faces: stats.faces,
        fragments: stats.fragments,
        nodes: stats.nodes,
        depth_max: stats.depth_max,
        depth_mean: stats.depth_mean,
        splits: stats.splits,
        build_seconds: figures.build_seconds,
        order_ns_per_fragment: figures.order_nanoseconds,
        bytes: stats.bytes,
        dropped: prepared.dropped,
        triangulated: prepared.triangulated,
        duplicates: figures.duplicates,
        crossing: prepared.crossing,
        tolerance: stats.tolerance,
        flattened: prepared.flattened,
        flattened_by: prepared.flattened_by,
        bent: prepared.bent,
        bent_by: prepared.bent_by,
        nearly_coplanar: stats.nearly_coplanar,
        nearly_coplanar_by: stats.nearly_coplanar_by,
    };
    serde_json::to_string(&line).map_err(|error| Failure::of_output(&error.into()))
}
