//! The command line.

use std::ffi::OsString;
use std::path::PathBuf;

use binspace::glam::DVec3;
use binspace::{BuildOptions, Heuristic};
use binspace_evidence::Family;
use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::camera::ViewArgs;
use crate::colours::Colouring;
use crate::cull::CullArgs;
use crate::examples;
use crate::pictures::Bright;
use crate::samples;
use crate::seams::Seams;
use crate::strokes::{EdgeChoice, Hidden};
use crate::values::{self, Heuristics};

/// Exact back-to-front orders of polygons from one BSP tree.
///
/// Without a command, builds trees of built-in scenes with every heuristic, paints their fragments
/// in order, compares every pixel with a depth buffer, and writes the pictures.
#[derive(Debug, Parser)]
#[command(name = "binspace", version, args_conflicts_with_subcommands = true)]
#[command(max_term_width = 100, after_help = examples::PROGRAM)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    #[command(flatten)]
    pub(crate) tour: TourArgs,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Build(BuildFileArgs),
    Order(OrderArgs),
    Verify(VerifyArgs),
    Stats(StatsArgs),
    Render(RenderArgs),
    Draw(DrawArgs),
    Page(PageArgs),
    Report(ReportArgs),
    Lecture(LectureArgs),
    /// List the built-in scenes
    Scenes,
}

#[derive(Args, Debug)]
pub(crate) struct TourArgs {
    /// Folder to write the pictures into; created if it does not exist
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out: PathBuf,
    /// Views of each scene to compare, around it and inside it
    #[arg(long, value_name = "N", default_value_t = 6)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) views: u32,
    /// Size of the pictures in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = values::size)]
    pub(crate) size: [u32; 2],
    /// Seed of the random views
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(crate) seed: u64,
}

/// Build a scene's tree and write it to a file
///
/// The file holds the tree and the scene: its polygons, colours and materials. Every command takes it
/// in place of the scene, and then builds nothing. The library reads the tree with `BspTree::read`.
#[derive(Args, Debug)]
#[command(after_help = examples::BUILD)]
pub(crate) struct BuildFileArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
    /// File to write, complete or not at all, such as scene.bsp; - for standard output. With --cells, a
    /// new folder
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Divide the scene into N cells, and build a tree of each, one after the other: for scenes too large
    /// for memory
    ///
    /// In memory are the vertices of the file, and then one cell. The folder has a file for each cell;
    /// `render`, `order` and `stats` take it in place of a scene, with one cell in memory at a time. It
    /// keeps no texture coordinates, normals or line numbers.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=500))]
    pub(crate) cells: Option<u32>,
}

/// Write a scene's fragments in paint order, one JSON object per line
///
/// Each line is `{"polygon": i, "vertices": [[x, y, z], …]}`: a convex fragment of the polygon of
/// the i-th `f` line of the file, counted from 0, in the file's coordinates. Back to front: no
/// fragment hides a later one. With several eyes, the whole order of the first comes first, and
/// each line begins with `"eye": k`, the number of its eye, counted from 0.
#[derive(Args, Debug)]
#[command(after_help = examples::ORDER)]
#[command(group(clap::ArgGroup::new("viewpoint").required(true).args(["eye", "direction"])))]
pub(crate) struct OrderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Position of the eye; may be repeated, for an order of each
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) eye: Vec<DVec3>,
    /// Direction of view, from infinitely far away
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) direction: Option<DVec3>,
    /// List the nearest fragment first
    #[arg(long)]
    pub(crate) front_to_back: bool,
    /// Add `"edges"`: for the edge from each vertex to the next the polygon's edge that it lies on,
    /// by the number of the corner where that begins; null where a cut or triangulation made it
    #[arg(long)]
    pub(crate) edges: bool,
    /// Add `"weights"`: for each vertex a list of [corner, weight], the polygon's corners that it
    /// lies between, to interpolate what they have; the weights of a vertex sum to 1
    #[arg(long)]
    pub(crate) weights: bool,
    #[command(flatten)]
    pub(crate) cull: CullArgs,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
    /// File to write, complete or not at all [default: standard output, as for -]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// Paint a scene in order and compare every pixel with a depth buffer
///
/// Prints a line for each view: the covered pixels; the contested ones, where the tolerance allows
/// either of two polygons in front; and the wrong ones (wrong order, holes and spills). The last
/// line is the total. The exit status is 1 if any pixel is wrong.
#[derive(Args, Debug)]
#[command(after_help = examples::VERIFY)]
pub(crate) struct VerifyArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Views to compare, alternately around the scene and inside it
    #[arg(long, value_name = "N", default_value_t = 8)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) views: u32,
    /// Size of the pictures in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = values::size)]
    pub(crate) size: [u32; 2],
    #[command(flatten)]
    pub(crate) up: UpArgs,
    #[command(flatten)]
    pub(crate) cull: CullArgs,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

/// Build trees of a scene and print their figures
#[derive(Args, Debug)]
#[command(after_help = examples::STATS)]
pub(crate) struct StatsArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// How to choose splitters: a heuristic, or all [default: auto]
    #[arg(long, value_name = "H", value_parser = values::heuristics)]
    pub(crate) heuristic: Option<Heuristics>,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// Print one JSON object per line for each heuristic
    #[arg(long)]
    pub(crate) json: bool,
}

/// Draw a scene as PNG or SVG
///
/// Without a camera, all of the scene is shown. Surfaces are darker the more obliquely they are
/// seen. Transparency shows in SVG and in the painter's PNG, but not in a depth buffer's picture. An
/// SVG has all fragments of the tree, the hidden ones too; `binspace draw` writes one path for each
/// polygon that shows.
#[derive(Args, Debug)]
#[command(after_help = examples::RENDER)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// File to write: .png, or .svg for the fragments themselves, in order; - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Format to write [default: by the file's name; png for standard output]
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub(crate) format: Option<Format>,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    /// Where the colours of polygons come from
    #[arg(long, value_name = "KIND", value_enum, default_value_t)]
    pub(crate) colours: Colouring,
    /// Samples each way in a pixel of a PNG: with more than 1, edges are smooth
    ///
    /// Each of the N x N samples is decided exactly; a pixel has the mean of their light.
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=i64::from(samples::MOST)))]
    pub(crate) samples: u32,
    #[command(flatten)]
    pub(crate) cull: CullArgs,
    #[command(flatten)]
    pub(crate) kind: KindArgs,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

/// Draw a view as SVG, PDF or PNG with one path for each polygon that shows, or as lines
///
/// Each polygon is drawn whole, before those that show in front of it; the few that cannot be put in
/// order, as each hides some of another, are cut to what shows of them. What is hidden is not in the
/// file. Coordinates are rounded by the picture's size: to fiftieths of a pixel from 480 pixels on, more
/// finely in smaller pictures.
/// `binspace render -o FILE.svg` writes all fragments of the tree instead, the hidden ones too, and
/// translucent ones as such.
///
/// A PDF has one page, with a point for each pixel. A PNG has in each pixel the colours that show there,
/// each by the exact area that it has of the pixel, and blended by their numbers as SVG viewers do; lines are
/// drawn over them by the area that they cover.
///
/// Translucent polygons are painted over what shows behind them.
#[derive(Args, Debug)]
#[command(after_help = examples::DRAW)]
pub(crate) struct DrawArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// File to write, complete or not at all: .svg, .pdf or .png; - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Format to write [default: by the file's name; svg for standard output]
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub(crate) format: Option<DrawFormat>,
    /// Draw lines alone, without filling polygons: by default the edges of `--edges creases`
    ///
    /// Polygons hide what lies behind them all the same, but for translucent ones without --opaque. Lines are
    /// black, a pixel wide, joined where they have common ends, and in an order in which a pen travels
    /// little between them.
    #[arg(long, conflicts_with = "colours")]
    pub(crate) lines: bool,
    /// Edges to draw as lines, over the filled polygons or, with --lines, alone: none, all,
    /// creases[=DEG] or silhouettes
    ///
    /// `silhouettes` are edges where a body turns away from the eye, and borders, which no other polygon
    /// has. `creases` are these, edges where two polygons meet at DEG degrees or more, 30 unless you say,
    /// and lines where polygons go through each other. `all` are these and all other edges of polygons.
    /// Lines of each kind have a class in an SVG: crossing, crease, border or silhouette. [default: none;
    /// creases with --lines]
    #[arg(long, value_name = "KIND", value_parser = EdgeChoice::parse)]
    pub(crate) edges: Option<EdgeChoice>,
    /// How to draw the hidden parts of these edges [default: none]
    ///
    /// With `layers` in an SVG, groups of class hidden that are behind more than one polygon have another
    /// class as well: layers-2, layers-3, or layers-4 for all others.
    #[arg(long, value_name = "STYLE", value_enum)]
    pub(crate) hidden: Option<Hidden>,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    /// Where the colours of polygons come from
    #[arg(long, value_name = "KIND", value_enum, default_value_t)]
    pub(crate) colours: Colouring,
    /// Draw translucent polygons as if they were opaque
    #[arg(long, conflicts_with = "translucent")]
    pub(crate) opaque: bool,
    /// Draw hidden polygons too, below those that hide them, each with its opacity
    ///
    /// Without it, what opaque polygons hide is left out. A polygon is one path, or, where it lies before and
    /// behind others in a circle, several. A PNG is the same with it and without.
    #[arg(long)]
    pub(crate) translucent: bool,
    /// What to do about seams: viewers blend the edges of each path with what is below it, so that the
    /// background shows between neighbours [default: trap]
    #[arg(long, value_name = "HOW", value_enum)]
    pub(crate) seams: Option<Seams>,
    /// Leave out polygons that show less than PX x PX pixels of area in all, and lines shorter than PX
    /// [default: 0.01]
    ///
    /// What is drawn behind them shows in their place, else the background: surfaces of such polygons
    /// vanish. Through cracks between the faces of a mesh some of those behind show, far narrower than
    /// any pixel, which the default leaves out. With 0, all that show are drawn. With --seams plus-lighter,
    /// regions so small are left out, and the background shows in their place.
    #[arg(long, value_name = "PX", value_parser = values::length)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) min_size: Option<f64>,
    /// Write the polygon of each path as `data-polygon="i"`, counted from 0 in the file's order, and the
    /// polygons of a region where several show as `data-polygons="i j …"`, front to back
    ///
    /// Paths of one material that follow one another are in a group `<g data-material="NAME">`. Lines have
    /// a path for each part of an edge, with `data-edge="k"`, the number of the polygon's corner where
    /// the edge begins, or `data-crosses="j"`, the polygon that goes through it there.
    #[arg(long)]
    pub(crate) ids: bool,
    /// Print the figures of the drawing as one JSON object
    ///
    /// `polygons` of the scene, `fragments` of its tree, polygons `visible`, `paths` written and how many
    /// of these are `clipped`, `runs` of edges and the `lines` that these are joined to, `bytes` of the
    /// file, and the time in seconds to build or read the tree and to draw.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) cull: CullArgs,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

/// Show what a course on visibility teaches, measured and judged, as one page
///
/// Pictures and graphs with a few sentences each, in the order of a course, in one HTML file that needs no
/// network. All figures come from the run, which takes a minute or two on two processors.
#[derive(Args, Debug)]
#[command(after_help = examples::LECTURE)]
pub(crate) struct LectureArgs {
    /// Folder to write index.html into; created if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "lecture")]
    pub(crate) output: PathBuf,
}

/// Write a page that stands alone, in which people turn the scene
///
/// The page has the tree, and paints its fragments in the tree's order, which is that of the library for every
/// eye. It shows the paint order step by step, the cuts, the depth of nodes and the figures of the
/// heuristic. It needs a browser, and no network.
#[derive(Args, Debug)]
#[command(after_help = examples::PAGE)]
pub(crate) struct PageArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// File to write, complete or not at all, such as scene.html; - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) up: UpArgs,
    #[command(flatten)]
    pub(crate) cull: CullArgs,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

/// Measure every way to decide visibility: speed against error
///
/// Trees with exact and with rounded decisions, Newell's algorithm, sorted centroids and depth
/// buffers paint families of scenes that grow harder step by step, and the scenes that you name.
/// Each pixel, vertex and piece is compared with exact truth. Writes report.md, plots as SVG, and
/// the figures as CSV; errors.csv is the same for the same seed on any machine. If the command is
/// interrupted, the results so far are kept. The exit status is 1 if the exact tree is wrong
/// anywhere, or is too large to be built.
#[derive(Args, Debug)]
#[command(after_help = examples::REPORT)]
pub(crate) struct ReportArgs {
    /// OBJ files, - for one on standard input, or built-in scenes to measure as well
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<OsString>,
    /// Folder to write into; created if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "report")]
    pub(crate) output: PathBuf,
    /// Fewer steps and smaller pictures: about a tenth of the time
    #[arg(long)]
    pub(crate) quick: bool,
    /// Seed of the families' scenes and of the random views
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Only this family, without growth; may be repeated
    ///
    /// One of angle, gap, offset, scale, sliver, nesting, lattice, boxes, cycle, penetration and
    /// depth-range.
    #[arg(long, value_name = "NAME")]
    pub(crate) family: Vec<Family>,
    /// Size of the pictures in pixels [default: 640x480; 160x120 if quick]
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    pub(crate) size: Option<[u32; 2]>,
}

/// What to draw instead of the painter's picture.
#[derive(Args, Debug)]
#[group(multiple = false)]
pub(crate) struct KindArgs {
    /// Draw what a depth buffer shows
    #[arg(long)]
    pub(crate) z_buffer: bool,
    /// Draw where the painter's and the depth buffer's pictures differ; exit status 1 if they do
    #[arg(long)]
    pub(crate) difference: bool,
    /// Draw the depth of every pixel: the nearer, the brighter; or, with --depth=far, the further
    #[arg(long, value_name = "BRIGHT", value_enum, require_equals = true)]
    #[arg(num_args = 0..=1, default_missing_value = "near")]
    pub(crate) depth: Option<Bright>,
}

/// The format of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DrawFormat {
    /// Paths and lines
    Svg,
    /// Paths and lines, on a page
    Pdf,
    /// Pixels
    Png,
}

/// The format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Pixels
    Png,
    /// Fragments as paths, in order
    Svg,
}

#[derive(Args, Debug)]
pub(crate) struct SceneArgs {
    /// An OBJ file, a file of `binspace build`, - for either on standard input, or a built-in scene
    /// such as sphere:100000; for render, order and stats also a folder of `binspace build --cells`
    ///
    /// A name that ends in .obj or .bsp or contains a path separator is a file. Any other is a built-in
    /// scene, with an optional size after a colon, or, if there is none of that name, a file.
    /// `binspace scenes` lists the built-in scenes.
    #[arg(value_name = "SCENE")]
    pub(crate) name: OsString,
    /// Seed of built-in scenes that are random, and of random views
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(crate) seed: u64,
}

#[derive(Args, Debug)]
pub(crate) struct UpArgs {
    /// Direction that points up: x, y, z, or X,Y,Z [default: the scene's up; y for files]
    #[arg(long, value_name = "AXIS", value_parser = values::up, allow_hyphen_values = true)]
    pub(crate) up: Option<DVec3>,
}

#[derive(Args, Debug)]
pub(crate) struct BuildArgs {
    /// How to choose splitters: first, random(SEED), fewest-splits, balanced,
    /// weighted(SPLITS,BALANCE,AXIAL), sampled(K), free-planes or auto [default: auto]
    #[arg(long, value_name = "H")]
    pub(crate) heuristic: Option<Heuristic>,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct LimitArgs {
    /// Coplanar tolerance, a length: points this near to a plane count as on it, and layers up to
    /// twice as far apart may be exchanged [default: four units in the last decimal that an OBJ file's
    /// coordinates need, but between 1e-9 and 1e-5 of the extent, the longest side of the scene's
    /// bounding box; at most 1/256 of the extent is used]
    #[arg(long, value_name = "T", value_parser = values::length, allow_hyphen_values = true)]
    pub(crate) tolerance: Option<f64>,
    /// Give up if there are more fragments than this [default: 33554432]
    #[arg(long, value_name = "N")]
    pub(crate) max_fragments: Option<usize>,
}

impl LimitArgs {
    /// The options to build with.
    pub(crate) fn options(self, heuristic: Heuristic) -> BuildOptions {
        let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        let options = self.max_fragments.map_or(options, |most| options.with_max_fragments(most));
        self.tolerance.map_or(options, |length| options.with_tolerance(length))
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        super::Cli::command().debug_assert();
    }

    #[test]
    fn the_help_names_the_defaults() {
        let command = super::Cli::command();
        let build = command.find_subcommand("build").unwrap();
        let help = |name: &str| {
            let option = build.get_arguments().find(|option| option.get_id() == name).unwrap();
            option.get_help().unwrap().to_string()
        };
        let default = super::BuildOptions::DEFAULT;
        assert!(help("max_fragments").contains(&format!("[default: {}]", default.max_fragments)));
        assert!(help("heuristic").contains(&format!("[default: {}]", default.heuristic)));
    }
}
