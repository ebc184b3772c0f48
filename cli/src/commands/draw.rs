//! `binspace draw`: a view as a vector picture with one path per polygon, and lines.

use std::collections::HashSet;
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
use crate::colours::{BACKGROUND, Colours};
use crate::cull::Cull;
use crate::drawn::{Seams, Style, add_drawing, add_regions, add_strokes};
use crate::failure::Failure;
use crate::files::{Output, STANDARD, about_output};
use crate::format::format;
use crate::job::{self, Made};
use crate::progress::Progress;
use crate::strokes::{EdgeChoice, Hidden, Strokes, strokes};
use crate::terminal::{remark, say};
use crate::upright::note_up;
use crate::{blended, camera, coverage, dxf, ink, png_file};

/// The default side of the square, in pixels, that a polygon has to show in a vector picture.
const MIN_SIZE: f64 = 0.01;
/// The longest side of a PDF's page, in points, by the standard (ISO 32000-1, annex C).
const LONGEST: u32 = 14_400;
/// Millimetres in an inch.
const INCH: f64 = 25.4;

/// Runs the command.
pub(crate) fn run(args: &DrawArgs) -> Result<Outcome, Failure> {
    let format = format(&args.output, args.format)?;
    let lines = args.lines.alone || format == DrawFormat::Dxf;
    let about_output = |problem: &str| about_output(&args.output, problem);
    check(args, format, lines).map_err(about_output)?;
    let edges = args.lines.edges.unwrap_or(match args.lines.hidden {
        Hidden::None if !lines => EdgeChoice::None,
        _ => EdgeChoice::DEFAULT,
    });
    if args.scale.is_none() {
        check_page(format, args.view.size).map_err(|problem| about_output(&problem))?;
    }
    let output = match format {
        DrawFormat::Pdf | DrawFormat::Png => {
            Output::open_binary(&args.output, &args.scene, "a PDF or PNG")?
        }
        _ => Output::open(&args.output, &args.scene)?,
    };
    let Made { scene, tree, seconds: tree_seconds, .. } = job::make(&args.scene, &args.build)?;
    note_up(&scene, &args.view.up);
    let scale = args.scale.map(|scale| scale * pixels_in_inch(format) / INCH);
    let camera = camera::asked(&args.view, &scene, scale)?;
    let size = camera.size();
    check_page(format, size).map_err(|problem| about_output(&problem))?;
    if args.look.cull.cull == Cull::None {
        note_backs(&scene, &tree, &camera);
    }
    let colours = Colours::new(&scene, args.look.colours);
    let is_opaque = args.fill.opaque || !colours.are_translucent();
    if !args.fill.opaque {
        check_opacities(&scene, &colours)?;
    }
    let (ids, seams, width) = (args.ids, args.fill.seams, args.lines.line_width);
    let style = Style { scene: &scene, camera: &camera, colours: &colours, ids, is_opaque, seams };
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
    let needs_map = !args.fill.translucent
        || format == DrawFormat::Png
        || seams == Seams::PlusLighter
        || edges != EdgeChoice::None;
    let map = needs_map.then(|| view.map(&tree)).transpose().map_err(about)?;
    let mut file = Vec::new();
    if let (DrawFormat::Png, Some(map)) = (format, &map) {
        figures.visible = map.polygons().count();
        let background = args.fill.background.0.unwrap_or(BACKGROUND);
        view.show(Some(Progress::spinner("drawing")));
        let mut pixels = match is_opaque {
            _ if lines => coverage::blank(size, background),
            true => coverage::picture(map, background, |polygon| style.fill(polygon)),
            false => {
                view.show(Some(Progress::share("drawing")));
                blended::picture(map, background, &style, &|done, total| {
                    if let Some(bar) = &*bar.lock().unwrap_or_else(PoisonError::into_inner) {
                        bar.set(done, total);
                    }
                })
            }
        };
        let strokes = view.strokes(Some(map), edges, format).map_err(about)?;
        figures.count(&strokes);
        view.show(Some(Progress::spinner("drawing")));
        ink::draw(&mut pixels, size, &strokes, width);
        figures.draw_seconds = start.elapsed().as_secs_f64();
        view.show(Some(Progress::spinner("writing")));
        png_file::write(&mut file, size, &pixels).map_err(|e| Failure::about(scene.name(), e))?;
    } else {
        let strokes = view.strokes(map.as_ref(), edges, format).map_err(about)?;
        figures.count(&strokes);
        let mut picture = VectorPicture::new(size);
        if let Some(colour) = args.fill.background.0 {
            picture = picture.with_background(colour);
        }
        view.fill(&mut picture, &tree, map.as_ref(), start, &mut figures).map_err(about)?;
        add_strokes(&mut picture, &strokes, width, ids);
        view.show(Some(Progress::spinner("writing")));
        file = match format {
            DrawFormat::Dxf => dxf::written(size, &strokes),
            DrawFormat::Pdf => picture.to_pdf(),
            DrawFormat::Tex => picture.to_tikz().into_bytes(),
            DrawFormat::Svg | DrawFormat::Png => picture.to_svg().into_bytes(),
        };
    }
    figures.bytes = file.len();
    output.write(|out| out.write_all(&file))?;
    view.show(None);
    if figures.visible == 0 {
        let nothing = "no polygon is visible in the picture";
        remark(scene.name(), nothing, nothing);
    }
    if args.json {
        say(serde_json::to_string(&figures).map_err(|error| Failure::about(scene.name(), error))?)?;
    }
    Ok(Outcome::Done)
}

/// The pixels of a picture in an inch of paper: points in PDF and TeX, millimetres in DXF, and otherwise the pixels
/// of CSS.
fn pixels_in_inch(format: DrawFormat) -> f64 {
    match format {
        DrawFormat::Pdf | DrawFormat::Tex => 72.0,
        DrawFormat::Dxf => INCH,
        DrawFormat::Svg | DrawFormat::Png => 96.0,
    }
}

/// The content of the drawing, and its style.
struct View<'a> {
    args: &'a DrawArgs,
    /// Whether lines alone are drawn.
    lines: bool,
    style: Style<'a>,
    /// The progress bar of the current step, if a bar is shown.
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
    let least = min_size(args, format);
    let opacities = (0..style.scene.len()).map(|polygon| f64::from(style.opacity(polygon)));
    let options = ViewOptions::DEFAULT
        .with_opacities(opacities.collect())
        .with_least_area(least * least)
        .with_progress(progress);
    if args.look.cull.cull == Cull::Back { options.with_front_faces_only() } else { options }
}

/// The least visible size to be drawn: the side of a square for a polygon, a length for a line.
fn min_size(args: &DrawArgs, format: DrawFormat) -> f64 {
    // In a PNG, many small parts together may cover a pixel.
    let default = if format == DrawFormat::Png { 0.0 } else { MIN_SIZE };
    args.fill.min_size.unwrap_or(default)
}

impl<'a> View<'a> {
    /// Shows the next step, if it takes long.
    fn show(&self, step: Option<Progress>) {
        *self.bar.lock().unwrap_or_else(PoisonError::into_inner) = step;
    }

    fn map<'t>(&self, tree: &'t BspTree) -> Result<VisibilityMap<'t>, Error>
    where
        'a: 't,
    {
        self.show(Some(Progress::share("finding visible polygons")));
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
        self.show(Some(Progress::share("drawing")));
        let drawing = match map {
            Some(map) if style.seams == Seams::PlusLighter => {
                let regions = map.regions()?;
                figures.paths = regions.len();
                figures.draw_seconds = start.elapsed().as_secs_f64();
                add_regions(picture, &regions, style);
                return Ok(());
            }
            Some(map) if !args.fill.translucent => map.drawing()?,
            _ => Drawing::translucent(tree, style.camera, &self.options, None)?,
        };
        figures.draw_seconds = start.elapsed().as_secs_f64();
        let paths: Vec<_> = drawing.paths().collect();
        figures.paths = paths.len();
        figures.clipped = paths.iter().filter(|path| path.is_clipped()).count();
        if args.fill.translucent {
            let drawn = paths.iter().map(|path| path.polygon());
            figures.visible = drawn.collect::<HashSet<usize>>().len();
        }
        self.show(Some(Progress::share("joining paths")));
        add_drawing(picture, &drawing, style, self.options.progress)
    }

    fn strokes(
        &self,
        map: Option<&VisibilityMap<'_>>,
        edges: EdgeChoice,
        format: DrawFormat,
    ) -> Result<Vec<Strokes>, Error> {
        let Some(map) = map.filter(|_| edges != EdgeChoice::None) else { return Ok(vec![]) };
        self.show(Some(Progress::share("finding lines")));
        let hidden = self.args.lines.hidden.into();
        let mut runs = map.edges(hidden)?;
        if edges != EdgeChoice::Silhouettes {
            runs.append(&mut map.crossings(hidden)?);
        }
        strokes(&runs, edges, min_size(self.args, format))
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
    /// The number of drawn parts of edges, and the number of lines into which the parts are joined.
    runs: usize,
    lines: usize,
    bytes: usize,
    /// Seconds to build or to read the tree.
    tree_seconds: f64,
    /// Seconds for the map and the paths, without writing.
    draw_seconds: f64,
}

impl Figures {
    fn count(&mut self, strokes: &[Strokes]) {
        let lines = strokes.iter().flat_map(|strokes| &strokes.lines);
        self.lines = lines.clone().count();
        self.runs = lines.map(|line| line.segments.len()).sum();
    }
}

/// Returns an error if options do not fit together.
fn check(args: &DrawArgs, format: DrawFormat, lines: bool) -> Result<(), &'static str> {
    let is_png = format == DrawFormat::Png;
    if args.json && args.output == Path::new(STANDARD) {
        Err("the drawing and the object of --json cannot both go there: name a file")
    } else if lines && args.lines.edges == Some(EdgeChoice::None) {
        Err("--lines and DXF need edges to draw: choose other --edges than none")
    } else if args.fill.seams == Seams::PlusLighter
        && !lines
        && matches!(format, DrawFormat::Pdf | DrawFormat::Tex)
    {
        Err("`--seams plus-lighter` works only in an SVG: use `--seams trap`, or write .svg")
    } else if args.fill.seams == Seams::PlusLighter
        && !lines
        && format == DrawFormat::Svg
        && args.fill.translucent
    {
        Err("`--seams plus-lighter` draws translucent polygons, but no hidden ones: omit \
             --translucent, or use `--seams trap`")
    } else if format != DrawFormat::Svg && args.ids {
        Err("--ids works only in an SVG: omit --ids, or write .svg")
    } else if is_png && args.fill.background.0.is_none() {
        Err("a PNG needs a background: choose a colour, or write .svg or .pdf")
    } else {
        Ok(())
    }
}

/// Returns an error if a page of the format has no such size.
fn check_page(format: DrawFormat, [width, height]: [u32; 2]) -> Result<(), String> {
    if matches!(format, DrawFormat::Pdf | DrawFormat::Tex) && width.max(height) > LONGEST {
        return Err(format!(
            "pages of PDF and TeX are at most {LONGEST} points wide and high, not {width} x {height}: \
             use a smaller --size or --scale"
        ));
    }
    Ok(())
}

/// Returns an error if the opacity of a polygon is not a number from 0 to 1. Saved files may contain such an
/// opacity.
fn check_opacities(scene: &Scene, colours: &Colours<'_>) -> Result<(), Failure> {
    let is_wrong = |&polygon: &usize| !(0.0..=1.0).contains(&colours.opacity(polygon));
    let Some(polygon) = (0..scene.len()).find(is_wrong) else { return Ok(()) };
    let line = scene.line(polygon).map_or(String::new(), |line| format!(", line {line}"));
    let problem = format!(
        "face {polygon} (from 0{line}) has opacity {}, which is not from 0 to 1; `--opaque` ignores \
         opacities",
        colours.opacity(polygon),
    );
    Err(Failure::about(scene.name(), problem))
}
