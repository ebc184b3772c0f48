//! `binspace verify`: compares every pixel of a tree's pictures with a depth buffer.

use binspace::raster::Comparison;
use binspace::verify::{Verification, verify, verify_fronts};
use binspace::view::{Camera, Projection};
use serde_json::{Value, json};

use crate::Outcome;
use crate::args::VerifyArgs;
use crate::camera;
use crate::cull::Cull;
use crate::failure::Failure;
use crate::job::{self, Made};
use crate::progress::Progress;
use crate::table::Table;
use crate::terminal::{BAD, GOOD, HEAD, note, say, styled};
use crate::units::count;
use crate::upright::note_up;

/// Runs the command.
pub(crate) fn run(args: &VerifyArgs) -> Result<Outcome, Failure> {
    let Made { scene, tree, .. } = job::make(&args.scene, &args.build)?;
    note_up(&scene, &args.up);
    let (views, up) = (args.views as usize, args.up.given());
    let cameras = camera::around_and_inside(&scene, up, views, args.size, args.scene.seed)?;
    let table = table(views * args.size[0] as usize * args.size[1] as usize);
    if !args.json {
        say(format!(
            "{}: {}, {}, {}",
            styled(HEAD, scene.name()),
            count(scene.len(), "polygon"),
            count(tree.faces().len(), "face"),
            count(tree.len(), "fragment"),
        ))?;
        say(styled(HEAD, table.head()))?;
    }
    let show = |view: Option<usize>, place, found: &Comparison, is_right| {
        if args.json {
            return say(json(view, place, found, is_right));
        }
        let name = view.map_or("total".to_owned(), |view| view.to_string());
        say(row(&table, [&name, place], found, is_right))
    };
    let progress = Progress::steps("view", args.views.into());
    let mut total = Comparison::default();
    let mut all_right = true;
    let verify = if args.cull.cull == Cull::Back { verify_fronts } else { verify };
    for (number, camera) in (1..).zip(&cameras) {
        let seen = verify(&tree, camera).map_err(|error| camera::about(&scene, &error))?;
        progress.step();
        let place = if camera::is_inside(camera, &scene) { "inside" } else { "around" };
        let is_right = seen.is_right();
        progress.suspend(|| show(Some(number), place, &seen.comparison, is_right))?;
        for fault in unseen_faults(&seen) {
            progress.suspend(|| note(&format!("view {number} is wrong: {fault}")));
        }
        if seen.comparison.wrong() > 0 {
            let view = reproduce(args, camera);
            let advice = "run `binspace render --difference` with the options of this command and";
            progress.suspend(|| note(&format!("to see view {number}, {advice}:\n  {view}")));
        }
        add(&mut total, &seen.comparison);
        all_right &= is_right;
    }
    drop(progress);
    show(None, "", &total, all_right)?;
    Ok(if all_right { Outcome::Done } else { Outcome::Differs })
}

/// The figures of a view, or of all views, as a JSON object.
fn json(view: Option<usize>, from: &str, found: &Comparison, is_right: bool) -> Value {
    json!({
        "view": view,
        "from": view.map(|_| from),
        "covered": found.covered,
        "contested": found.contested,
        "wrong_order": found.wrong_order,
        "holes": found.holes,
        "spills": found.spills,
        "is_right": is_right,
    })
}

/// The faults of a view, without faults of the picture painted back to front, as phrases.
pub(crate) fn unseen_faults(seen: &Verification) -> Vec<String> {
    let mut faults = Vec::new();
    let wrong = seen.front_to_back.wrong();
    if wrong > 0 && seen.front_to_back != seen.comparison {
        faults.push(format!("{} if painted front to back", count(wrong, "wrong pixel")));
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

/// Adds the figures of a view to the figures of other views.
pub(super) fn add(total: &mut Comparison, found: &Comparison) {
    total.covered += found.covered;
    total.contested += found.contested;
    total.wrong_order += found.wrong_order;
    total.holes += found.holes;
    total.spills += found.spills;
}

/// The options of `binspace render` that show a view.
fn reproduce(args: &VerifyArgs, camera: &Camera) -> String {
    let (eye, fov) = match *camera.projection() {
        Projection::Perspective { eye, half_height } => (eye, 2.0 * half_height.atan()),
        Projection::Parallel { centre, .. } => (centre, camera::FIELD_OF_VIEW),
    };
    let [eye, target, up] = [eye, eye + camera.forward(), camera.up()]
        .map(|v| format!("{:?},{:?},{:?}", v.x, v.y, v.z));
    let ([width, height], fov) = (args.size, fov.to_degrees());
    format!("--size={width}x{height} --fov={fov:?} --eye={eye} --target={target} --up={up}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Cli, Command};
    use clap::Parser;

    fn parse(command: &str) -> Command {
        Cli::try_parse_from(command.split_whitespace()).unwrap().command
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
            "2 wrong pixels if painted front to back",
            "a polygon is painted more than once or not at all in 1 pixel",
        ];
        assert_eq!(unseen_faults(&seen), told);
        assert!(!seen.is_right());
    }

    #[test]
    fn the_options_that_show_a_wrong_view_show_that_view() {
        let command = "binspace verify random:30 --seed 7 --size 200x100";
        let Command::Verify(args) = parse(command) else { panic!("another command") };
        let scene = crate::scene_arg::load(&args.scene.name, args.scene.seed).unwrap().scene;
        let views = camera::around_and_inside(&scene, None, 4, args.size, 7).unwrap();
        for view in views {
            let options = reproduce(&args, &view);
            let Command::Render(again) =
                parse(&format!("binspace render random:30 -o a {options}"))
            else {
                panic!("another command")
            };
            let camera = camera::asked(&again.view, &scene, None).unwrap();
            assert_eq!((camera.viewpoint(), camera.size()), (view.viewpoint(), view.size()));
            assert!((camera.forward() - view.forward()).length() < 1e-12);
            assert!((camera.up() - view.up()).length() < 1e-12);
            assert!((camera.pixel_size()[1] / view.pixel_size()[1] - 1.0).abs() < 1e-12);
        }
    }
}
