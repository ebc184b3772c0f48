//! `binspace verify`: every pixel of a tree's pictures against a depth buffer.

use binspace::raster::Comparison;
use binspace::scene::Scene;
use binspace::verify;
use binspace::view::{Camera, Projection};

use super::Outcome;
use crate::args::VerifyArgs;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::table::Table;
use crate::terminal::{BAD, GOOD, HEAD, note, say, styled};
use crate::units::count;
use crate::{camera, job};

/// Runs the command.
pub(crate) fn run(args: &VerifyArgs) -> Result<Outcome, Failure> {
    let (scene, tree) = job::scene_and_tree(&args.scene, &args.build)?;
    let (views, up) = (args.views as usize, args.up.up);
    let cameras = camera::around_and_inside(&scene, up, views, args.size, args.scene.seed)?;
    say(format!(
        "{}: {}, {}, {}",
        styled(HEAD, scene.name()),
        count(scene.len(), "polygon"),
        count(tree.faces().len(), "face"),
        count(tree.len(), "fragment"),
    ))?;
    let table = table(views * args.size[0] as usize * args.size[1] as usize);
    say(styled(HEAD, table.head()))?;
    let progress = Progress::steps("view", args.views.into());
    let mut total = Comparison::default();
    for (i, camera) in cameras.iter().enumerate() {
        let seen = verify(&tree, camera).map_err(|error| camera::about(&scene, &error))?;
        progress.step();
        let place = if is_inside(camera, &scene) { "inside" } else { "around" };
        let line = row(&table, [&(i + 1).to_string(), place], &seen.comparison);
        progress.suspend(|| say(line))?;
        if seen.comparison.wrong() > 0 {
            progress.suspend(|| note(&reproduce(args, i + 1, camera)));
        }
        add(&mut total, &seen.comparison);
    }
    drop(progress);
    say(row(&table, ["total", ""], &total))?;
    Ok(if total.wrong() == 0 { Outcome::Done } else { Outcome::Differs })
}

fn table(pixels: usize) -> Table {
    let width = pixels.to_string().len();
    Table::new(&[
        ("view", 5),
        ("from", 6),
        ("covered", width),
        ("contested", 0),
        ("wrong order", 0),
        ("holes", 0),
        ("spills", 0),
        ("verdict", 0),
    ])
}

fn row(table: &Table, [view, place]: [&str; 2], found: &Comparison) -> String {
    let verdict = if found.wrong() == 0 { "right" } else { "wrong" };
    let counts = [found.covered, found.contested, found.wrong_order, found.holes, found.spills];
    let mut cells = vec![view.to_owned(), place.to_owned()];
    cells.extend(counts.map(|number| number.to_string()));
    cells.push(verdict.to_owned());
    let line = table.row(&cells);
    let (figures, verdict) = line.split_at(line.len() - verdict.len());
    let style = if found.wrong() == 0 { GOOD } else { BAD };
    format!("{figures}{}", styled(style, verdict))
}

fn add(total: &mut Comparison, found: &Comparison) {
    total.covered += found.covered;
    total.contested += found.contested;
    total.wrong_order += found.wrong_order;
    total.holes += found.holes;
    total.spills += found.spills;
}

fn is_inside(camera: &Camera, scene: &Scene) -> bool {
    let Projection::Perspective { eye, .. } = *camera.projection() else {
        return false;
    };
    scene.bounds().is_some_and(|(low, high)| eye.cmpge(low).all() && eye.cmple(high).all())
}

/// The command that draws what is wrong in a view.
fn reproduce(args: &VerifyArgs, view: usize, camera: &Camera) -> String {
    let (eye, fov) = match *camera.projection() {
        Projection::Perspective { eye, half_height } => (eye, 2.0 * half_height.atan()),
        Projection::Parallel { centre, .. } => (centre, camera::FIELD_OF_VIEW),
    };
    let [target, up] = [eye + camera.forward(), camera.up()];
    let vector = |v: binspace::glam::DVec3| format!("{:?},{:?},{:?}", v.x, v.y, v.z);
    format!(
        "view {view} is wrong; to see where:\n  binspace render {} --seed {} --difference \
         -o difference.png --size {}x{} --heuristic '{}' --fov {} --eye={} --target={} --up={}",
        args.scene.name.to_string_lossy(),
        args.scene.seed,
        args.size[0],
        args.size[1],
        args.build.heuristic,
        fov.to_degrees(),
        vector(eye),
        vector(target),
        vector(up),
    )
}
