//! `binspace demo`: draws built-in scenes with every heuristic, and compares the pictures with a depth
//! buffer's pictures.

use std::path::Path;

use binspace::drawing::{VectorPicture, ViewOptions};
use binspace::raster::Comparison;
use binspace::scene::{Builtin, Scene};
use binspace::verify::verify;
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions, Heuristic};

use super::verify::{add, unseen_faults};
use crate::Outcome;
use crate::args::DemoArgs;
use crate::colours::{BACKGROUND, Colouring, Colours};
use crate::cull::Cull;
use crate::drawn::{Seams, Style, add_drawing};
use crate::failure::Failure;
use crate::files::{NewFile, make_folder};
use crate::measure;
use crate::pictures::{Drawing, Kind};
use crate::progress::Progress;
use crate::table::Table;
use crate::terminal::{BAD, GOOD, HEAD, note, say, styled};
use crate::units::{count, time};
use crate::{camera, job, png_file};

/// The scenes to show: the smallest that no order of whole polygons solves, a room, a mesh,
/// and triangles that cross. Small enough for the heuristics that weigh every plane.
const SCENES: [(Builtin, Option<u32>); 4] = [
    (Builtin::Newell, None),
    (Builtin::Cornell, None),
    (Builtin::Teapot, Some(5)),
    (Builtin::Random, Some(200)),
];

/// Runs the command.
pub(crate) fn run(args: &DemoArgs) -> Result<Outcome, Failure> {
    make_folder(&args.output)?;
    let mut total = Comparison::default();
    let mut all_right = true;
    for (builtin, size) in SCENES {
        let scene = builtin.build(size, args.seed);
        all_right &= show(args, builtin, &scene, &mut total)?;
    }
    say("build: time to build the tree; order: time per fragment to list an order")?;
    say(format!("Wrote pictures of each scene into {}:", args.output.display()))?;
    let names = Kind::ALL.map(|kind| format!("…-{}.png", kind.name())).join(", ");
    say(format!("  {names}, ….svg"))?;
    say("  (a difference is dark where the painter is right; wrong pixels are bright)")?;
    say(format!(
        "Compared {} in {} of each scene with a depth buffer:",
        count(total.covered, "pixel"),
        count(args.views as usize, "view"),
    ))?;
    say(verdict(&total, all_right))?;
    Ok(if all_right { Outcome::Done } else { Outcome::Differs })
}

fn verdict(total: &Comparison, all_right: bool) -> String {
    let found = match total.wrong() {
        0 if !all_right => "no pixel is wrong, but orders are: see the notes".to_owned(),
        0 => "no pixel is wrong".to_owned(),
        1 => "1 pixel is wrong".to_owned(),
        wrong => format!("{wrong} pixels are wrong"),
    };
    let style = if all_right { GOOD } else { BAD };
    format!("  {}, {} contested", styled(style, found), total.contested)
}

/// Prints a scene's table, and writes its pictures. Returns whether all pixels and orders are right.
fn show(
    args: &DemoArgs,
    builtin: Builtin,
    scene: &Scene,
    total: &mut Comparison,
) -> Result<bool, Failure> {
    let mut all_right = true;
    say(format!("{}: {}", styled(HEAD, builtin), builtin.description()))?;
    let table = Table::new(&[
        ("heuristic", 15),
        ("faces", 6),
        ("fragments", 0),
        ("depth", 0),
        ("build", 7),
        ("order", 7),
        ("wrong pixels", 0),
    ]);
    say(styled(HEAD, table.head()))?;
    // The whole scene first.
    let (fov, size, others) = (camera::FIELD_OF_VIEW, args.size, args.views as usize - 1);
    let mut views = vec![camera::whole(scene, None, fov, size, camera::MARGIN)?];
    views.extend(camera::around_and_inside(scene, None, others, size, args.seed)?);
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        let (tree, seconds) =
            measure::timed_build(scene, &options).map_err(|error| job::about(scene, &error))?;
        let progress = Progress::steps(format!("{heuristic}: view"), views.len() as u64);
        let mut found = Comparison::default();
        for view in &views {
            let seen = verify(&tree, view).map_err(|error| camera::about(scene, &error))?;
            add(&mut found, &seen.comparison);
            for fault in unseen_faults(&seen) {
                progress.suspend(|| note(&format!("{builtin}, {heuristic}: {fault}")));
            }
            all_right &= seen.is_right();
            progress.step();
        }
        drop(progress);
        let (stats, order) = (tree.stats(), measure::order_nanoseconds(&tree, scene) * 1e-9);
        say(table.row(&[
            heuristic.to_string(),
            stats.faces.to_string(),
            stats.fragments.to_string(),
            stats.depth_max.to_string(),
            time(seconds),
            time(order),
            found.wrong().to_string(),
        ]))?;
        add(total, &found);
        if heuristic == Heuristic::Auto {
            write_pictures(&args.output, builtin, scene, &tree, &views[0])?;
        }
    }
    say("")?;
    Ok(all_right)
}

fn write_pictures(
    folder: &Path,
    builtin: Builtin,
    scene: &Scene,
    tree: &BspTree,
    camera: &Camera,
) -> Result<(), Failure> {
    let colours = Colours::new(scene, Colouring::Material);
    let drawing = Drawing { tree, camera, colours: &colours, cull: Cull::None, samples: 1 };
    for kind in Kind::ALL {
        let (pixels, _) = drawing.draw(kind).map_err(|error| camera::about(scene, &error))?;
        let file = NewFile::create(&folder.join(format!("{builtin}-{}.png", kind.name())))?;
        file.write(|out| png_file::write(out, camera.size(), &pixels))?;
    }
    let seams = Seams::default();
    let style = Style { scene, camera, colours: &colours, ids: false, is_opaque: false, seams };
    let map = tree.visibility(camera, &ViewOptions::DEFAULT);
    let drawn = map.and_then(|map| map.drawing()).map_err(|error| job::about(scene, &error))?;
    let mut picture = VectorPicture::new(camera.size()).with_background(BACKGROUND);
    add_drawing(&mut picture, &drawn, &style, None).map_err(|error| job::about(scene, &error))?;
    let file = NewFile::create(&folder.join(format!("{builtin}.svg")))?;
    file.write(|out| out.write_all(picture.to_svg().as_bytes()))
}

#[cfg(test)]
mod tests {
    use anstream::adapter::strip_str;

    use super::*;

    #[test]
    fn wrong_pixels_and_orders_are_reported() {
        let mut total = Comparison::default();
        (total.covered, total.contested) = (9, 1);
        let verdict = |total: &Comparison, right| strip_str(&verdict(total, right)).to_string();
        assert_eq!(verdict(&total, true), "  no pixel is wrong, 1 contested");
        let orders = "  no pixel is wrong, but orders are: see the notes, 1 contested";
        assert_eq!(verdict(&total, false), orders);
        total.holes = 2;
        assert_eq!(verdict(&total, false), "  2 pixels are wrong, 1 contested");
    }
}
