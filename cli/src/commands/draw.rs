//! `binspace draw`: a view as a vector picture with one path a polygon, and lines.

use std::collections::HashSet;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use binspace::drawing::{Drawing, VectorPicture, ViewOptions, VisibilityMap};
use binspace::scene::Scene;
use binspace::{BspTree, Error};
use serde::Serialize;

use crate::Outcome;
use crate::args::{DrawArgs, DrawFormat};
use crate::backs::note_backs;
use crate::colours::Colours;
use crate::cull::Cull;
use crate::drawn::{Style, add_drawing, add_regions, add_strokes, blank};
use crate::failure::Failure;
use crate::files::{Output, STANDARD};
use crate::format::{about_output, format};
use crate::progress::Progress;
use crate::seams::Seams;
use crate::strokes::{EdgeChoice, Hidden, Strokes, strokes};
use crate::terminal::{note, say};
use crate::upright::note_z_up;
use crate::{camera, coverage, dxf, ink, job, png_file};

/// The default side of the square, in pixels, that a polygon has to show.
const MIN_SIZE: f64 = 0.01;
/// The longest side of a PDF's page, in points, by the standard (ISO 32000-1, annex C).
const LONGEST: u32 = 14_400;

/// Runs the command.
pub(crate) fn run(args: &DrawArgs) -> Result<Outcome, Failure> {
    let format = format(&args.output, args.format)?;
    let lines = args.lines || format == DrawFormat::Dxf;
    let edges = edges(args, lines);
    check(args, format, lines, edges).map_err(|problem| about_output(&args.output, &problem))?;
    let output = Output::open(Some(&args.output))?;
    if matches!(format, DrawFormat::Pdf | DrawFormat::Png) && output.is_terminal() {
        let problem = "a PDF or PNG is not for a terminal: pipe it, or name a file";
        return Err(about_output(&args.output, problem));
    }
    let (scene, tree, tree_seconds) = job::timed_scene_and_tree(&args.scene, &args.build)?;
    note_z_up(&scene, &args.view.up);
    let camera = camera::asked(&args.view, &scene)?;
    if args.cull.cull == Cull::None {
        note_backs(&scene, &tree, &camera);
    }
    let colours = Colours::new(&scene, args.colours);
    let is_opaque = args.opaque || !colours.are_translucent();
    if !args.opaque {
        check_opacities(&scene, &colours)?;
    }
    let seams = args.seams.unwrap_or_default();
    let style = Style {
        scene: &scene,
        camera: &camera,
        colours: &colours,
        ids: args.ids,
        is_opaque,
        seams,
    };
    let bar = Mutex::default();
    let go_on = |progress| go_on(&bar, progress);
    let view =
        View { args, lines, style, bar: &bar, options: options(args, format, &style, &go_on) };
    let mut figures = Figures {
        polygons: scene.len(),
        fragments: tree.len(),
        tree_seconds,
        ..Figures::default()
    };
    let start = Instant::now();
    let about = |error| job::about(&scene, &error);
    // Where nothing is hidden, only lines and regions need the map.
    let needs_map = !args.translucent
        || format == DrawFormat::Png
        || seams == Seams::PlusLighter
        || edges != EdgeChoice::None;
    let map = needs_map.then(|| view.map(&tree)).transpose().map_err(about)?;
    if let (DrawFormat::Png, Some(map)) = (format, &map) {
        figures.visible = map.polygons().count();
        let mut pixels = match is_opaque {
            _ if lines => coverage::blank(camera.size()),
            true => coverage::picture(map, |polygon| style.fill(polygon)),
            false => {
                view.show(Some("dividing the picture"));
                coverage::blended(camera.size(), &map.regions().map_err(about)?, &style)
            }
        };
        let strokes = view.strokes(Some(map), edges).map_err(about)?;
        figures.count(&strokes);
        ink::draw(&mut pixels, camera.size(), &strokes);
        figures.draw_seconds = start.elapsed().as_secs_f64();
        view.show(None);
        let write = |out: &mut dyn Write| png_file::write(out, camera.size(), &pixels);
        figures.bytes = output.write_counted(write)?;
    } else {
        let strokes = view.strokes(map.as_ref(), edges).map_err(about)?;
        figures.count(&strokes);
        let mut picture = blank(&camera);
        view.fill(&mut picture, &tree, map.as_ref(), start, &mut figures).map_err(about)?;
        add_strokes(&mut picture, &strokes, args.ids);
        view.show(None);
        figures.bytes = output.write_counted(|out| match format {
            DrawFormat::Dxf => dxf::write(out, camera.size(), &strokes),
            DrawFormat::Pdf => out.write_all(&picture.to_pdf()),
            DrawFormat::Tex => out.write_all(picture.to_tikz().as_bytes()),
            _ => out.write_all(picture.to_svg().as_bytes()),
        })?;
    }
    if figures.visible == 0 {
        note(&format!("{}: the picture shows nothing of it", scene.name()));
    }
    if args.json {
        say(serde_json::to_string(&figures).map_err(|error| Failure::about(scene.name(), error))?)?;
    }
    Ok(Outcome::Done)
}

/// The content of the drawing, and its style.
struct View<'a> {
    args: &'a DrawArgs,
    /// Whether lines alone are drawn.
    lines: bool,
    style: Style<'a>,
    /// The progress bar of the step that is being done, if one is shown.
    bar: &'a Mutex<Option<Progress>>,
    options: ViewOptions<'a>,
}

/// The progress of a step.
fn go_on(bar: &Mutex<Option<Progress>>, progress: binspace::Progress) -> ControlFlow<()> {
    if let Some(bar) = &*bar.lock().unwrap_or_else(PoisonError::into_inner) {
        bar.set(progress.done, progress.total);
    }
    ControlFlow::Continue(())
}

fn options<'a>(
    args: &DrawArgs,
    format: DrawFormat,
    style: &Style<'_>,
    progress: &'a (dyn Fn(binspace::Progress) -> ControlFlow<()> + Sync),
) -> ViewOptions<'a> {
    // In a PNG, many small parts together may cover a pixel.
    let least = if format == DrawFormat::Png { 0.0 } else { min_size(args) };
    let opacities = (0..style.scene.len()).map(|polygon| f64::from(style.opacity(polygon)));
    let options = ViewOptions::DEFAULT
        .with_opacities(opacities.collect())
        .with_least_area(least * least)
        .with_progress(progress);
    if args.cull.cull == Cull::Back { options.with_front_faces_only() } else { options }
}

/// The least visible size to be drawn: the side of a square for a polygon, a length for a line.
fn min_size(args: &DrawArgs) -> f64 {
    args.min_size.unwrap_or(MIN_SIZE)
}

impl<'a> View<'a> {
    /// Shows the next step, if it takes long.
    fn show(&self, phase: Option<&'static str>) {
        *self.bar.lock().unwrap_or_else(PoisonError::into_inner) = phase.map(Progress::share);
    }

    fn map<'t>(&self, tree: &'t BspTree) -> Result<VisibilityMap<'t>, Error>
    where
        'a: 't,
    {
        self.show(Some("finding what shows"));
        tree.visibility(self.style.camera, &self.options)
    }

    /// Adds the filled paths, counted, to a picture; none if only lines are drawn.
    fn fill(
        &self,
        picture: &mut VectorPicture,
        tree: &BspTree,
        map: Option<&VisibilityMap<'_>>,
        start: Instant,
        figures: &mut Figures,
    ) -> Result<(), Error> {
        let Self { args, style, .. } = self;
        figures.visible = map.map_or(0, |map| map.polygons().count());
        figures.draw_seconds = start.elapsed().as_secs_f64();
        if self.lines {
            return Ok(());
        }
        self.show(Some("drawing"));
        let drawing = match map {
            Some(map) if style.seams == Seams::PlusLighter => {
                let regions = map.regions()?;
                figures.paths = regions.len();
                figures.draw_seconds = start.elapsed().as_secs_f64();
                add_regions(picture, &regions, style);
                return Ok(());
            }
            Some(map) if !args.translucent => map.drawing()?,
            _ => Drawing::translucent(tree, style.camera, &self.options, None)?,
        };
        figures.draw_seconds = start.elapsed().as_secs_f64();
        let paths: Vec<_> = drawing.paths().collect();
        figures.paths = paths.len();
        figures.clipped = paths.iter().filter(|path| path.is_clipped()).count();
        if args.translucent {
            let drawn = paths.iter().map(|path| path.polygon());
            figures.visible = drawn.collect::<HashSet<usize>>().len();
        }
        add_drawing(picture, &drawing, style);
        Ok(())
    }

    fn strokes(
        &self,
        map: Option<&VisibilityMap<'_>>,
        edges: EdgeChoice,
    ) -> Result<Vec<Strokes>, Error> {
        let Some(map) = map.filter(|_| edges != EdgeChoice::None) else { return Ok(vec![]) };
        self.show(Some("finding lines"));
        let hidden = self.args.hidden.unwrap_or(Hidden::None).into();
        let mut runs = map.edges(hidden)?;
        if edges != EdgeChoice::Silhouettes {
            runs.append(&mut map.crossings(hidden)?);
        }
        strokes(&runs, edges, min_size(self.args))
    }
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

/// The edges that are drawn. By default they are the edges of a line drawing that are seen best.
fn edges(args: &DrawArgs, lines: bool) -> EdgeChoice {
    let default = if lines { EdgeChoice::DEFAULT } else { EdgeChoice::None };
    args.edges.unwrap_or(default)
}

/// An error if options do not fit together.
fn check(
    args: &DrawArgs,
    format: DrawFormat,
    lines: bool,
    edges: EdgeChoice,
) -> Result<(), String> {
    let has_lines = edges != EdgeChoice::None;
    let longest = args.view.size[0].max(args.view.size[1]);
    let problem = if args.json && args.output == Path::new(STANDARD) {
        "the drawing and the figures of --json cannot both go there: name a file"
    } else if lines && !has_lines {
        "a DXF, and --lines, have no polygons: with `--edges none` there is nothing to draw"
    } else if matches!(args.hidden, Some(Hidden::Dashed | Hidden::Layers)) && !has_lines {
        "--hidden is for lines: add --lines, or --edges for lines over the polygons"
    } else if args.seams.is_some() && lines {
        "a DXF, and --lines, have no polygons and no seams: leave out --seams"
    } else if args.seams.is_some() && format == DrawFormat::Png {
        "--seams is for SVG, PDF and TikZ: pixels of a PNG have no seams"
    } else if args.seams == Some(Seams::PlusLighter) && format != DrawFormat::Svg {
        "only an SVG can add colours up: give `--seams trap` or none, or write .svg"
    } else if args.translucent && lines {
        "a DXF, and --lines, have no polygons: leave out --translucent"
    } else if args.translucent
        && args.min_size.is_some()
        && !has_lines
        && args.seams != Some(Seams::PlusLighter)
    {
        "with --translucent nothing is hidden, so --min-size leaves nothing out"
    } else if format != DrawFormat::Svg && args.ids {
        "--ids is for SVG: other formats have no place for names"
    } else if format == DrawFormat::Png && args.min_size.is_some() && !has_lines {
        "--min-size is for vectors and lines: a PNG has of each polygon just what it shows"
    } else if matches!(format, DrawFormat::Pdf | DrawFormat::Tex) && longest > LONGEST {
        return Err(format!(
            "a page of a PDF or of TeX has at most {LONGEST} points each way, one for each pixel: give a \
             smaller --size"
        ));
    } else {
        return Ok(());
    };
    Err(problem.to_owned())
}

/// An error if the opacity of a polygon is not a number from 0 to 1, as it may be in a saved file.
fn check_opacities(scene: &Scene, colours: &Colours<'_>) -> Result<(), Failure> {
    let is_wrong = |&polygon: &usize| !(0.0..=1.0).contains(&colours.opacity(polygon));
    let Some(polygon) = (0..scene.len()).find(is_wrong) else { return Ok(()) };
    let line = scene.line(polygon).map_or(String::new(), |line| format!(" (line {line})"));
    let problem = format!(
        "face {polygon}{line}, counted from 0, has opacity {}: expected a number from 0 to 1; \
         `--opaque` draws all faces as if they were opaque",
        colours.opacity(polygon),
    );
    Err(Failure::about(scene.name(), problem))
}
