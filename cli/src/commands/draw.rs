//! `binspace draw`: a view as a vector picture with one path a polygon, and lines.

use std::collections::HashSet;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use binspace::drawing::{Drawing, Shown, VisibilityMap};
use binspace::raster::Rays;
use binspace::scene::Scene;
use binspace::view::Camera;
use binspace::{BspTree, Error};
use serde::Serialize;

use super::Outcome;
use crate::args::{DrawArgs, DrawFormat};
use crate::backs::note_backs;
use crate::colours::Colours;
use crate::cull::Cull;
use crate::drawn::{Drawn, Style, filled};
use crate::failure::Failure;
use crate::files::{Output, STANDARD};
use crate::format::{about_output, format};
use crate::progress::Progress;
use crate::shading::shaded;
use crate::strokes::{EdgeChoice, Hidden, Strokes, strokes};
use crate::terminal::say;
use crate::upright::note_z_up;
use crate::{camera, coverage, drawn_pdf, drawn_svg, ink, job, png_file};

/// The side of the square, in pixels, that a polygon has to show, unless the user says.
const MIN_SIZE: f64 = 0.01;

/// Runs the command.
pub(crate) fn run(args: &DrawArgs) -> Result<Outcome, Failure> {
    let format = format(&args.output, args.format)?;
    let edges = edges(args);
    check(args, format, edges).map_err(|problem| about_output(&args.output, &problem))?;
    let output = Output::open(Some(&args.output))?;
    if format != DrawFormat::Svg && output.is_terminal() {
        let problem = "a PDF or PNG is not for a terminal: pipe it, or name a file";
        return Err(about_output(&args.output, problem));
    }
    let (scene, tree, tree_seconds) = job::timed_scene_and_tree(&args.scene, &args.build)?;
    note_z_up(&scene, &args.view.up);
    let camera = camera::asked(&args.view, &scene)?;
    if args.cull.cull == Cull::None {
        note_backs(&scene, &tree, &camera);
    }
    let rays = Rays::new(&camera, tree.faces()).map_err(|error| camera::about(&scene, &error))?;
    let rays = args.cull.cull.rays(rays);
    let colours = Colours::new(&scene, args.colours);
    let view = View { args, scene: &scene, camera: &camera, colours: &colours };
    let mut figures = Figures {
        polygons: scene.len(),
        fragments: tree.len(),
        tree_seconds,
        ..Figures::default()
    };
    let start = Instant::now();
    let about = |error| job::about(&scene, &error);
    // A translucent drawing needs the map for its lines alone.
    let needs_map = !args.translucent || edges != EdgeChoice::None;
    let map = needs_map.then(|| view.map(&tree, rays.clone())).transpose().map_err(about)?;
    let shown: Vec<Shown> = map.iter().flat_map(VisibilityMap::polygons).collect();
    figures.visible = shown.len();
    if !args.opaque && !args.translucent {
        refuse_translucent(&scene, &colours, &shown)?;
    }
    if let (DrawFormat::Png, Some(map)) = (format, &map) {
        let mut pixels = match args.lines {
            true => coverage::blank(camera.size()),
            false => coverage::picture(map, |polygon| view.colour(polygon)),
        };
        let strokes = view.strokes(Some(map), edges).map_err(about)?;
        figures.count(&strokes);
        ink::draw(&mut pixels, camera.size(), &strokes);
        figures.draw_seconds = start.elapsed().as_secs_f64();
        let write = |out: &mut dyn Write| png_file::write(out, camera.size(), &pixels);
        figures.bytes = output.write_counted(write)?;
    } else {
        let drawing = view.drawing(&tree, rays, map.as_ref()).map_err(about)?;
        let strokes = view.strokes(map.as_ref(), edges).map_err(about)?;
        figures.draw_seconds = start.elapsed().as_secs_f64();
        let drawn = view.drawn(drawing.as_ref(), &shown, strokes, &mut figures);
        figures.bytes = output.write_counted(|out| match format {
            DrawFormat::Pdf => drawn_pdf::write(out, &drawn),
            _ => drawn_svg::write(out, &drawn),
        })?;
    }
    if args.json {
        say(serde_json::to_string(&figures).map_err(|error| Failure::about(scene.name(), error))?)?;
    }
    Ok(Outcome::Done)
}

/// What is drawn, and how.
struct View<'a> {
    args: &'a DrawArgs,
    scene: &'a Scene,
    camera: &'a Camera,
    colours: &'a Colours<'a>,
}

impl<'a> View<'a> {
    fn colour(&self, polygon: usize) -> [u8; 3] {
        shaded(self.colours.rgb(polygon), self.scene.polygon(polygon), self.camera)
    }

    fn min_size(&self) -> f64 {
        self.args.min_size.unwrap_or(MIN_SIZE)
    }

    fn map<'t>(&self, tree: &'t BspTree, rays: Rays) -> Result<VisibilityMap<'t>, Error> {
        let bar = Progress::share("finding what shows");
        VisibilityMap::of_with_progress(tree, rays, |progress| shown_by(&bar, progress))
    }

    /// The filled paths; `None` if there are to be lines alone.
    fn drawing(
        &self,
        tree: &BspTree,
        rays: Rays,
        map: Option<&VisibilityMap<'_>>,
    ) -> Result<Option<Drawing>, Error> {
        let bar = Progress::share("drawing");
        let progress = |progress| shown_by(&bar, progress);
        match map {
            _ if self.args.lines => Ok(None),
            _ if self.args.translucent => {
                Drawing::translucent_with_progress(tree, rays, progress).map(Some)
            }
            map => map.map(|map| map.drawing_with_progress(progress)).transpose(),
        }
    }

    fn strokes(
        &self,
        map: Option<&VisibilityMap<'_>>,
        edges: EdgeChoice,
    ) -> Result<Vec<Strokes>, Error> {
        let Some(map) = map.filter(|_| edges != EdgeChoice::None) else { return Ok(vec![]) };
        let hidden = self.args.hidden.unwrap_or(Hidden::None);
        let mut runs = match hidden {
            Hidden::Layers => map.edges_in_layers()?,
            _ => map.edges()?,
        };
        if edges != EdgeChoice::Silhouettes {
            runs.append(&mut map.crossings()?);
        }
        strokes(&runs, edges, hidden, self.min_size())
    }

    /// The paths and lines that are written, counted.
    fn drawn(
        &self,
        drawing: Option<&Drawing>,
        shown: &[Shown],
        strokes: Vec<Strokes>,
        figures: &mut Figures,
    ) -> Drawn<'a> {
        let &Self { args, scene, camera, colours } = self;
        let mut is_small = vec![false; scene.len()];
        for shown in shown.iter().filter(|_| !args.translucent) {
            // Areas of specks are rounded, to below 0 as well.
            is_small[shown.polygon] = shown.area.max(0.0) < self.min_size() * self.min_size();
        }
        let paths = drawing.into_iter().flat_map(Drawing::paths);
        let paths: Vec<_> = paths.filter(|path| !is_small[path.polygon()]).collect();
        figures.paths = paths.len();
        figures.clipped = paths.iter().filter(|path| path.is_clipped()).count();
        if args.translucent {
            let drawn = paths.iter().map(|path| path.polygon());
            figures.visible = drawn.collect::<HashSet<usize>>().len();
        }
        figures.count(&strokes);
        let is_translucent = args.translucent;
        let style = Style { scene, camera, colours, ids: args.ids, is_translucent };
        Drawn { size: camera.size(), fills: filled(&paths, &style), strokes, ids: args.ids }
    }
}

/// Goes on, and shows how far it is.
fn shown_by(bar: &Progress, progress: binspace::Progress) -> ControlFlow<()> {
    bar.set(progress.done, progress.total);
    ControlFlow::Continue(())
}

/// The figures of a drawing.
#[derive(Default, Serialize)]
struct Figures {
    polygons: usize,
    fragments: usize,
    visible: usize,
    paths: usize,
    clipped: usize,
    /// Parts of edges that are drawn, and the lines that they are joined to.
    runs: usize,
    lines: usize,
    bytes: u64,
    /// To build the tree, or to read it.
    tree_seconds: f64,
    /// For the map and the paths, without writing them.
    draw_seconds: f64,
}

impl Figures {
    fn count(&mut self, strokes: &[Strokes]) {
        let lines = strokes.iter().flat_map(|strokes| &strokes.lines);
        self.lines = lines.clone().count();
        self.runs = lines.map(|line| line.segments.len()).sum();
    }
}

/// Which edges are drawn: those of a line drawing that are seen best, unless the user says.
fn edges(args: &DrawArgs) -> EdgeChoice {
    let default = if args.lines { EdgeChoice::DEFAULT } else { EdgeChoice::None };
    args.edges.unwrap_or(default)
}

/// An error if options do not fit together.
fn check(args: &DrawArgs, format: DrawFormat, edges: EdgeChoice) -> Result<(), String> {
    let has_lines = edges != EdgeChoice::None;
    let longest = args.view.size[0].max(args.view.size[1]);
    let problem = if args.json && args.output == Path::new(STANDARD) {
        "the drawing and the figures of --json cannot both go there: name a file"
    } else if args.lines && !has_lines {
        "with --lines and `--edges none` there is nothing to draw: choose other edges"
    } else if matches!(args.hidden, Some(Hidden::Dashed | Hidden::Layers)) && !has_lines {
        "--hidden is for lines: add --lines, or --edges for lines over the polygons"
    } else if format == DrawFormat::Png && args.translucent {
        "a PNG is made of what shows: write .svg or .pdf, or use `binspace render` for a picture of \
         translucent polygons"
    } else if args.translucent && args.lines {
        "--lines draws no polygons, so that none is translucent: leave out one of the two"
    } else if args.translucent && args.min_size.is_some() && !has_lines {
        "with --translucent nothing is hidden, so --min-size leaves nothing out"
    } else if format != DrawFormat::Svg && args.ids {
        "--ids is for SVG: other formats have no place for names"
    } else if format == DrawFormat::Png && args.min_size.is_some() && !has_lines {
        "--min-size is for SVG, PDF and lines: a PNG has of each polygon just what it shows"
    } else if format == DrawFormat::Pdf && longest > drawn_pdf::LONGEST {
        return Err(format!(
            "a page of a PDF has at most {} points each way, one for each pixel: give a smaller --size",
            drawn_pdf::LONGEST
        ));
    } else {
        return Ok(());
    };
    Err(problem.to_owned())
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
        "face {polygon}{line}, counted from 0, shows with opacity {}: give `--translucent` to draw \
         all faces with their opacities, nothing hidden, or `--opaque` to draw them as if they were \
         opaque",
        colours.opacity(polygon) + 0.0,
    );
    Err(Failure::about(scene.name(), problem))
}
