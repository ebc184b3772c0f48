//! `binspace stats`: the figures of trees.

use std::path::Path;
use std::time::Instant;

use binspace::scene::Scene;
use binspace::{BspTree, ErrorKind, Heuristic};
use serde_json::{Value, json};

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
struct Figures<'a> {
    tree: &'a BspTree,
    /// The heuristic; `None` for a tree from a file.
    heuristic: Option<Heuristic>,
    /// The number of the tree's cell.
    cell: Option<usize>,
    /// The time to build or to read the tree.
    build_seconds: f64,
    order_ns_per_fragment: f64,
}

impl<'a> Figures<'a> {
    /// The figures of a tree from a file.
    fn of(tree: &'a BspTree, scene: &Scene, build_seconds: f64) -> Self {
        let order_ns_per_fragment = order_nanoseconds(tree, scene);
        Self { tree, heuristic: None, cell: None, build_seconds, order_ns_per_fragment }
    }

    fn json(&self) -> Value {
        let (prepared, stats) = (self.tree.preparation(), self.tree.stats());
        let mut figures = json!({
            "heuristic": self.heuristic.map(|heuristic| heuristic.to_string()),
            "polygons": prepared.polygons,
            "faces": stats.faces,
            "fragments": stats.fragments,
            "nodes": stats.nodes,
            "depth_max": stats.depth_max,
            "depth_mean": stats.depth_mean,
            "splits": stats.splits,
            "build_seconds": self.build_seconds,
            "order_ns_per_fragment": self.order_ns_per_fragment,
            "bytes": stats.bytes,
            "dropped": prepared.dropped,
            "triangulated": prepared.triangulated,
            "duplicates": self.tree.duplicates(),
            "crossing": prepared.crossing,
            "tolerance": stats.tolerance,
            "flattened": prepared.flattened,
            "flattened_by": prepared.flattened_by,
            "bent": prepared.bent,
            "bent_by": prepared.bent_by,
            "nearly_coplanar": stats.nearly_coplanar,
            "nearly_coplanar_by": stats.nearly_coplanar_by,
        });
        if let Some(cell) = self.cell {
            figures["cell"] = cell.into();
        }
        figures
    }
}

/// Runs the command.
pub(crate) fn run(args: &StatsArgs) -> Result<Outcome, Failure> {
    let begin = Instant::now();
    if let Some(path) = cells::folder::named(&args.scene.name) {
        return of_cells(args, path);
    }
    let Loaded { scene, tree, .. } = scene_arg::load(&args.scene.name, args.scene.seed)?;
    if let Some(tree) = tree {
        let seconds = begin.elapsed().as_secs_f64();
        job::refuse_options(scene.name(), args.is_given)?;
        job::note_preparation(&scene, tree.faces(), tree.preparation());
        return show(args, &title(&scene, &tree), &Figures::of(&tree, &scene, seconds), true);
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
        let mut figures = Figures::of(&tree, &scene, seconds);
        figures.heuristic = Some(heuristic);
        show(args, &title(&scene, &tree), &figures, is_first)?;
        is_first = false;
    }
    match over_budget {
        0 => Ok(Outcome::Done),
        trees => Err(Failure::about(scene.name(), format!("{} over budget", count(trees, "tree")))),
    }
}

/// The figures of the trees in a folder.
fn of_cells(args: &StatsArgs, path: &Path) -> Result<Outcome, Failure> {
    let folder = Folder::open(path)?;
    job::refuse_options(path.display(), args.is_given)?;
    let cells = folder.partition.cells();
    let title = format!("{}: {}", styled(HEAD, folder.bounds.name()), count(cells, "cell"));
    for number in 0..cells {
        let begin = Instant::now();
        let cell = folder.cell(number)?;
        let seconds = begin.elapsed().as_secs_f64();
        let mut figures = Figures::of(&cell.tree, &cell.scene, seconds);
        figures.cell = Some(number);
        show(args, &title, &figures, number == 0)?;
    }
    Ok(Outcome::Done)
}

fn title(scene: &Scene, tree: &BspTree) -> String {
    let prepared = tree.preparation();
    format!(
        "{}: {}, {}; {} dropped, {} triangulated, {}",
        styled(HEAD, scene.name()),
        count(prepared.polygons, "polygon"),
        count(tree.faces().len(), "face"),
        prepared.dropped,
        prepared.triangulated,
        count(tree.duplicates(), "duplicate"),
    )
}

fn show(
    args: &StatsArgs,
    title: &str,
    figures: &Figures<'_>,
    is_first: bool,
) -> Result<Outcome, Failure> {
    if args.json {
        say(figures.json())?;
        return Ok(Outcome::Done);
    }
    let table = table();
    if is_first {
        say(title)?;
        say(styled(HEAD, table.head()))?;
    }
    say(row(&table, figures))?;
    Ok(Outcome::Done)
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

fn row(table: &Table, figures: &Figures<'_>) -> String {
    let stats = figures.tree.stats();
    let per_face = stats.fragments as f64 / stats.faces.max(1) as f64;
    table.row(&[
        match (figures.cell, figures.heuristic) {
            (Some(cell), _) => format!("cell {cell}"),
            (None, Some(heuristic)) => name(&heuristic.to_string()),
            (None, None) => "from a file".to_owned(),
        },
        stats.fragments.to_string(),
        format!("{per_face:.2}"),
        stats.nodes.to_string(),
        stats.depth_max.to_string(),
        three_digits(stats.depth_mean),
        time(figures.build_seconds),
        time(figures.order_ns_per_fragment * 1e-9),
        bytes(stats.bytes),
    ])
}

/// The name of a heuristic in the table, cut to the column's width. Default weights are left out.
fn name(heuristic: &str) -> String {
    if "weighted".parse::<Heuristic>().is_ok_and(|weighted| weighted.to_string() == heuristic) {
        return "weighted".to_owned();
    }
    if heuristic.chars().count() <= NAME {
        return heuristic.to_owned();
    }
    heuristic.chars().take(NAME - 1).chain(['…']).collect()
}
