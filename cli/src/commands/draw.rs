//! `binspace draw`: a view as a vector picture with one path a polygon.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

use binspace::drawing::{Shown, VisibilityMap};
use binspace::raster::Rays;
use binspace::scene::Scene;
use serde::Serialize;

use super::Outcome;
use crate::args::DrawArgs;
use crate::backs::note_backs;
use crate::colours::Colours;
use crate::cull::Cull;
use crate::drawn_svg::{self, Style};
use crate::failure::Failure;
use crate::files::{Output, STANDARD};
use crate::progress::Progress;
use crate::terminal::say;
use crate::upright::note_z_up;
use crate::{camera, job};

/// Runs the command.
pub(crate) fn run(args: &DrawArgs) -> Result<Outcome, Failure> {
    check_output(args)?;
    let output = Output::open(Some(&args.output))?;
    let (scene, tree, tree_seconds) = job::timed_scene_and_tree(&args.scene, &args.build)?;
    note_z_up(&scene, &args.view.up);
    let camera = camera::asked(&args.view, &scene)?;
    if args.cull.cull == Cull::None {
        note_backs(&scene, &tree, &camera);
    }
    let rays = Rays::new(&camera, tree.faces()).map_err(|error| camera::about(&scene, &error))?;
    let progress = Progress::spinner("drawing");
    let start = Instant::now();
    let about = |error| job::about(&scene, &error);
    let map = VisibilityMap::of(&tree, args.cull.cull.rays(rays)).map_err(about)?;
    let shown: Vec<Shown> = map.polygons().collect();
    let colours = Colours::new(&scene, args.colours);
    if !args.opaque {
        refuse_translucent(&scene, &colours, &shown)?;
    }
    let drawing = map.drawing().map_err(about)?;
    let draw_seconds = start.elapsed().as_secs_f64();
    let mut is_small = vec![false; scene.len()];
    for shown in &shown {
        // Areas of specks are rounded, to below 0 as well.
        is_small[shown.polygon] = shown.area.max(0.0) < args.min_size * args.min_size;
    }
    let paths: Vec<_> = drawing.paths().filter(|path| !is_small[path.polygon()]).collect();
    let style = Style { scene: &scene, camera: &camera, colours: &colours, ids: args.ids };
    let mut bytes = 0;
    output.write(|out| {
        let mut counted = Counted { out, bytes: 0 };
        drawn_svg::write(&mut counted, &paths, &style)?;
        bytes = counted.bytes;
        Ok(())
    })?;
    drop(progress);
    if args.json {
        let figures = Figures {
            polygons: scene.len(),
            fragments: tree.len(),
            visible: shown.len(),
            paths: paths.len(),
            cut_out: paths.iter().filter(|path| path.is_cut_out()).count(),
            bytes,
            tree_seconds,
            draw_seconds,
        };
        say(serde_json::to_string(&figures).map_err(|error| Failure::about(scene.name(), error))?)?;
    }
    Ok(Outcome::Done)
}

/// The figures of a drawing.
#[derive(Serialize)]
struct Figures {
    polygons: usize,
    fragments: usize,
    visible: usize,
    paths: usize,
    cut_out: usize,
    bytes: u64,
    /// To build the tree, or to read it.
    tree_seconds: f64,
    /// For the map and the paths, without writing them.
    draw_seconds: f64,
}

/// Counts what is written.
struct Counted<'a> {
    out: &'a mut dyn Write,
    bytes: u64,
}

impl Write for Counted<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// An error if the output is not to be an SVG, or not the only one on standard output.
fn check_output(args: &DrawArgs) -> Result<(), Failure> {
    let path: &Path = &args.output;
    let is_standard = path == Path::new(STANDARD);
    if is_standard && args.json {
        let problem = "the drawing and the figures of --json cannot both go there: name a file";
        return Err(Failure::about("standard output", problem));
    }
    let is_svg =
        path.extension().and_then(OsStr::to_str).is_some_and(|ext| ext.eq_ignore_ascii_case("svg"));
    if is_standard || is_svg {
        return Ok(());
    }
    Err(Failure::about(path.display(), "drawings are SVG: name a file that ends in .svg, or -"))
}

/// An error if something shows through a polygon that shows.
///
/// Where only opaque polygons show, what is behind them does not matter.
fn refuse_translucent(
    scene: &Scene,
    colours: &Colours<'_>,
    shown: &[Shown],
) -> Result<(), Failure> {
    let is_translucent = |shown: &&Shown| colours.opacity(shown.polygon) < 1.0;
    let Some(&Shown { polygon, .. }) = shown.iter().find(is_translucent) else { return Ok(()) };
    let line = scene.line(polygon).map_or(String::new(), |line| format!(" (line {line})"));
    let problem = format!(
        "face {polygon}{line}, counted from 0, shows with opacity {}, but drawings are opaque: give \
         `--opaque` to draw all faces as if they were, or use `binspace render` for an SVG of all \
         fragments",
        colours.opacity(polygon) + 0.0,
    );
    Err(Failure::about(scene.name(), problem))
}
