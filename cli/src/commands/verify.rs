//! `binspace verify`: compares every pixel of a tree's pictures with a depth buffer.

use binspace::glam::DVec3;
use binspace::raster::Comparison;
use binspace::verify::{Verification, verify, verify_fronts};
use binspace::view::{Camera, Projection};

use crate::Outcome;
use crate::args::VerifyArgs;
use crate::cull::Cull;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::table::Table;
use crate::terminal::{BAD, GOOD, HEAD, note, say, styled};
use crate::units::count;
use crate::upright::note_z_up;
use crate::{camera, job};

/// Runs the command.
pub(crate) fn run(args: &VerifyArgs) -> Result<Outcome, Failure> {
    let (scene, tree) = job::scene_and_tree(&args.scene, &args.build)?;
    note_z_up(&scene, &args.up);
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
    let mut all_right = true;
    let verify = if args.cull.cull == Cull::Back { verify_fronts } else { verify };
    for (i, camera) in cameras.iter().enumerate() {
        let seen = verify(&tree, camera).map_err(|error| camera::about(&scene, &error))?;
        progress.step();
        let place = if camera::is_inside(camera, &scene) { "inside" } else { "around" };
        let line = row(&table, [&(i + 1).to_string(), place], &seen.comparison, seen.is_right());
        progress.suspend(|| say(line))?;
        for fault in unseen_faults(&seen) {
            progress.suspend(|| note(&format!("view {} is wrong: {fault}", i + 1)));
        }
        if seen.comparison.wrong() > 0 {
            progress.suspend(|| {
                note(&format!("view {} is wrong; see where:\n  {}", i + 1, reproduce(args, camera)))
            });
        }
        add(&mut total, &seen.comparison);
        all_right &= seen.is_right();
    }
    drop(progress);
    say(row(&table, ["total", ""], &total, all_right))?;
    Ok(if all_right { Outcome::Done } else { Outcome::Differs })
}

/// The faults of a view, without faults of the picture painted back to front, as phrases.
pub(crate) fn unseen_faults(seen: &Verification) -> Vec<String> {
    let mut faults = Vec::new();
    let wrong = seen.front_to_back.wrong();
    if wrong > 0 && seen.front_to_back != seen.comparison {
        faults.push(format!("{}, painted front to back", count(wrong, "wrong pixel")));
    }
    if seen.miscounted > 0 {
        let pixels = count(seen.miscounted, "pixel");
        faults.push(format!("a polygon is painted more than once or not at all in {pixels}"));
    }
    faults.extend(seen.orders.as_ref().err().map(ToString::to_string));
    faults
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

fn row(table: &Table, [view, place]: [&str; 2], found: &Comparison, is_right: bool) -> String {
    let verdict = if is_right { "right" } else { "wrong" };
    let counts = [found.covered, found.contested, found.wrong_order, found.holes, found.spills];
    let mut cells = vec![view.to_owned(), place.to_owned()];
    cells.extend(counts.map(|number| number.to_string()));
    cells.push(verdict.to_owned());
    let line = table.row(&cells);
    let (figures, verdict) = line.split_at(line.len() - verdict.len());
    let style = if is_right { GOOD } else { BAD };
    format!("{figures}{}", styled(style, verdict))
}

fn add(total: &mut Comparison, found: &Comparison) {
    total.covered += found.covered;
    total.contested += found.contested;
    total.wrong_order += found.wrong_order;
    total.holes += found.holes;
    total.spills += found.spills;
}

/// The command that draws the wrong pixels of a view.
fn reproduce(args: &VerifyArgs, camera: &Camera) -> String {
    let (eye, fov) = match *camera.projection() {
        Projection::Perspective { eye, half_height } => (eye, 2.0 * half_height.atan()),
        Projection::Parallel { centre, .. } => (centre, camera::FIELD_OF_VIEW),
    };
    let vector = |v: DVec3| format!("{:?},{:?},{:?}", v.x, v.y, v.z);
    let (build, limits) = (&args.build, &args.build.limits);
    // Options that were given alone: trees in files take none.
    let heuristic = build.heuristic.map_or(String::new(), |h| format!(" --heuristic='{h}'"));
    let tolerance = limits.tolerance.map_or(String::new(), |t| format!(" --tolerance={t:?}"));
    let most = limits.max_fragments.map_or(String::new(), |n| format!(" --max-fragments={n}"));
    let cull = if args.cull.cull == Cull::Back { " --cull=back" } else { "" };
    format!(
        "binspace render '{}' --difference -o difference.png --seed={}{heuristic}{tolerance}{most}{cull} \
         --size={}x{} --fov={:?} --eye={} --target={} --up={}",
        args.scene.name.to_string_lossy(),
        args.scene.seed,
        args.size[0],
        args.size[1],
        fov.to_degrees(),
        vector(eye),
        vector(eye + camera.forward()),
        vector(camera.up()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Cli, Command};
    use clap::Parser;

    fn parse(command: &str) -> Command {
        // As a shell does with these quotes.
        let words = command.split_whitespace().map(|word| word.replace('\'', ""));
        Cli::try_parse_from(words).unwrap().command
    }

    #[test]
    fn a_wrong_view_is_called_wrong() {
        let mut found = Comparison::default();
        (found.covered, found.contested) = (9, 1);
        let row = |right| row(&table(100), ["1", "inside"], &found, right);
        assert!(row(true).contains("right"));
        assert!(row(false).contains("wrong"));
        found.spills = 1;
        let mut total = found.clone();
        add(&mut total, &found);
        assert_eq!((total.covered, total.contested, total.wrong()), (18, 2, 2));
    }

    #[test]
    fn faults_that_the_painted_picture_does_not_show_are_told() {
        let scene = binspace::scene::crossing(2);
        let tree = binspace::BspTree::build(scene.polygons()).unwrap();
        let view = &camera::around_and_inside(&scene, None, 1, [40, 30], 0).unwrap()[0];
        let mut seen = verify(&tree, view).unwrap();
        assert_eq!(unseen_faults(&seen), [""; 0]);
        seen.front_to_back.holes = 2;
        seen.miscounted = 1;
        let told = [
            "2 wrong pixels, painted front to back",
            "a polygon is painted more than once or not at all in 1 pixel",
        ];
        assert_eq!(unseen_faults(&seen), told);
        assert!(!seen.is_right());
    }

    #[test]
    fn the_command_that_shows_a_wrong_view_shows_that_view() {
        let command = "binspace verify random:30 --seed 7 --heuristic sampled(3) --tolerance 1e-7 \
                       --cull back";
        let Command::Verify(args) = parse(command) else { panic!("another command") };
        let scene = crate::scene_arg::load(&args.scene.name, args.scene.seed).unwrap().scene;
        let views = camera::around_and_inside(&scene, None, 4, args.size, 7).unwrap();
        for view in views {
            let Command::Render(again) = parse(&reproduce(&args, &view)) else {
                panic!("another command")
            };
            assert_eq!(again.build.heuristic, args.build.heuristic);
            assert_eq!(again.build.limits.tolerance, Some(1e-7));
            assert_eq!(again.cull.cull, Cull::Back);
            let camera = camera::asked(&again.view, &scene).unwrap();
            assert_eq!((camera.viewpoint(), camera.size()), (view.viewpoint(), view.size()));
            assert!((camera.forward() - view.forward()).length() < 1e-12);
            assert!((camera.up() - view.up()).length() < 1e-12);
            assert!((camera.pixel_size()[1] / view.pixel_size()[1] - 1.0).abs() < 1e-12);
        }
    }
}
