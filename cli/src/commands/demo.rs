//! `binspace demo`: draws built-in scenes with every heuristic, and compares their
//! pictures with a depth buffer's.

use std::ops::AddAssign;
use std::path::Path;

use binspace::drawing::{VectorPicture, ViewOptions};
use binspace::paint::paint_tree;
use binspace::raster::{DepthImage, Rays, compare, zbuffer};
use binspace::scene::{Builtin, Scene};
use binspace::verify::check_orders;
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions, Heuristic};

use crate::Outcome;
use crate::args::DemoArgs;
use crate::camera::{self, FIELD_OF_VIEW};
use crate::colours::{BACKGROUND, Colouring, Colours};
use crate::cull::Cull;
use crate::drawn::{Style, add_drawing};
use crate::failure::Failure;
use crate::files::{NewFile, make_folder};
use crate::measure;
use crate::pictures::{Drawing, Kind};
use crate::progress::Progress;
use crate::seams::Seams;
use crate::table::Table;
use crate::terminal::{BAD, GOOD, HEAD, say, styled};
use crate::units::{count, time};
use crate::{job, png_file};

/// The scenes to show: the smallest that no order of whole polygons solves, a room, a mesh,
/// and triangles that cross. Small enough for the heuristics that weigh every plane.
const SCENES: [(Builtin, Option<u32>); 4] = [
    (Builtin::Newell, None),
    (Builtin::Cornell, None),
    (Builtin::Teapot, Some(5)),
    (Builtin::Random, Some(200)),
];

/// Totals over all pixels compared.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    covered: usize,
    contested: usize,
    wrong: usize,
    /// Views whose orders miss or repeat a fragment, or are not the same in all their forms.
    faulty_orders: usize,
}

impl AddAssign for Sum {
    fn add_assign(&mut self, other: Self) {
        self.covered += other.covered;
        self.contested += other.contested;
        self.wrong += other.wrong;
        self.faulty_orders += other.faulty_orders;
    }
}

/// A view of a scene with its depth-buffer picture.
struct View {
    camera: Camera,
    rays: Rays,
    truth: DepthImage,
}

/// Runs the command.
pub(crate) fn run(args: &DemoArgs) -> Result<Outcome, Failure> {
    make_folder(&args.output)?;
    let mut total = Sum::default();
    for (builtin, size) in SCENES {
        let scene = builtin.build(size, args.seed);
        total += show(args, builtin, &scene)?;
    }
    say("build: time to build the tree; order: time of an order, per fragment")?;
    say(format!("Wrote pictures of each scene into {}:", args.output.display()))?;
    let names = Kind::ALL.map(|kind| format!("…-{}.png", kind.name())).join(", ");
    say(format!("  {names}, ….svg"))?;
    say("  (a difference is dark where the painter is right; wrong pixels are bright)")?;
    say(format!(
        "Compared {} from {} of each scene with a depth buffer:",
        count(total.covered, "pixel"),
        count(args.views as usize, "view"),
    ))?;
    say(verdict(&total))?;
    Ok(if total.wrong + total.faulty_orders == 0 { Outcome::Done } else { Outcome::Differs })
}

fn verdict(total: &Sum) -> String {
    let (style, found) = match total.wrong {
        0 => (GOOD, "no pixel is wrong".to_owned()),
        1 => (BAD, "1 pixel is wrong".to_owned()),
        wrong => (BAD, format!("{wrong} pixels are wrong")),
    };
    let mut verdict = format!("  {}, {} contested", styled(style, found), total.contested);
    if total.faulty_orders > 0 {
        let faults = format!("the orders of {} are faulty", count(total.faulty_orders, "view"));
        verdict += &format!("; {}", styled(BAD, faults));
    }
    verdict
}

/// A scene's table and pictures.
fn show(args: &DemoArgs, builtin: Builtin, scene: &Scene) -> Result<Sum, Failure> {
    let title = format!("{}: {}", styled(HEAD, builtin), builtin.description());
    say(title)?;
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
    let mut total = Sum::default();
    let mut views = Vec::new();
    let mut auto = None;
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        let (tree, seconds) =
            measure::timed_build(scene, &options).map_err(|error| job::about(scene, &error))?;
        if views.is_empty() {
            views = make_views(args, scene, &tree)?;
        }
        let found = judge(&tree, &views, heuristic);
        say(row(&table, heuristic, (&tree, seconds), scene, &found))?;
        total += found;
        if heuristic == Heuristic::Auto {
            auto = Some(tree);
        }
    }
    if let (Some(tree), Some(view)) = (auto, views.first()) {
        write_pictures(&args.output, builtin, scene, &tree, &view.camera)?;
    }
    say("")?;
    Ok(total)
}

/// The views, the whole scene first. Trees of different heuristics have the same faces, so one depth buffer
/// suffices for all.
fn make_views(args: &DemoArgs, scene: &Scene, tree: &BspTree) -> Result<Vec<View>, Failure> {
    let count = args.views as usize;
    let mut cameras = vec![camera::whole(scene, None, FIELD_OF_VIEW, args.size, camera::MARGIN)?];
    cameras.extend(camera::around_and_inside(scene, None, count - 1, args.size, args.seed)?);
    let view = |camera: Camera| {
        let rays = Rays::new(&camera, tree.faces()).map_err(|e| camera::about(scene, &e))?;
        let truth = zbuffer(&rays, tree.faces());
        Ok(View { camera, rays, truth })
    };
    cameras.into_iter().map(view).collect()
}

fn judge(tree: &BspTree, views: &[View], heuristic: Heuristic) -> Sum {
    let progress = Progress::steps(format!("{heuristic}: view"), views.len() as u64);
    let mut sum = Sum::default();
    for view in views {
        let painted = paint_tree(tree, view.camera.viewpoint(), &view.rays);
        let found = compare(&view.rays, tree.faces(), &painted, view.truth.image());
        sum.covered += found.covered;
        sum.contested += found.contested;
        sum.wrong += found.wrong();
        sum.faulty_orders += usize::from(check_orders(tree, view.camera.viewpoint()).is_err());
        progress.step();
    }
    sum
}

fn row(
    table: &Table,
    heuristic: Heuristic,
    (tree, seconds): (&BspTree, f64),
    scene: &Scene,
    found: &Sum,
) -> String {
    let stats = tree.stats();
    let order = measure::order_nanoseconds(tree, scene) * 1e-9;
    table.row(&[
        heuristic.to_string(),
        stats.faces.to_string(),
        stats.fragments.to_string(),
        stats.depth_max.to_string(),
        time(seconds),
        time(order),
        found.wrong.to_string(),
    ])
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
    add_drawing(&mut picture, &drawn, &style);
    let file = NewFile::create(&folder.join(format!("{builtin}.svg")))?;
    file.write(|out| out.write_all(picture.to_svg().as_bytes()))
}

#[cfg(test)]
mod tests {
    use anstream::adapter::strip_str;

    use super::{Sum, verdict};

    #[test]
    fn whatever_is_wrong_is_told() {
        let mut sum = Sum { covered: 9, contested: 1, ..Sum::default() };
        let verdict = |sum: &Sum| strip_str(&verdict(sum)).to_string();
        assert_eq!(verdict(&sum), "  no pixel is wrong, 1 contested");
        sum.wrong = 2;
        assert_eq!(verdict(&sum), "  2 pixels are wrong, 1 contested");
        sum = Sum { faulty_orders: 1, ..Sum::default() };
        let expected = "  no pixel is wrong, 0 contested; the orders of 1 view are faulty";
        assert_eq!(verdict(&sum), expected);
    }
}
