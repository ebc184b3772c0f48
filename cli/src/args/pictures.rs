//! The arguments of commands that make pictures.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{BuildArgs, SceneArgs};
use crate::camera::ViewArgs;
use crate::colours::Colouring;
use crate::cull::CullArgs;
use crate::examples;
use crate::pictures::Bright;
use crate::samples;
use crate::seams::Seams;
use crate::strokes::{EdgeChoice, Hidden};
use crate::values;

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

/// Draw a view as SVG, PDF, TikZ, DXF or PNG with one path for each polygon that shows, or as lines
///
/// Each polygon is drawn whole, before those that show in front of it; the few that cannot be put in
/// order, as each hides some of another, are cut to what shows of them. What is hidden is not in the
/// file. Coordinates are rounded by the picture's size: to fiftieths of a pixel from 480 pixels on, more
/// finely in smaller pictures.
/// `binspace render -o FILE.svg` writes all fragments of the tree instead, the hidden ones too, and
/// translucent ones as such.
///
/// A PDF has one page, with a point for each pixel. A TEX file has TikZ: it compiles by itself, and by `\input`
/// in a document. A DXF has lines alone, as with --lines. A PNG has in each pixel the colours that show there,
/// each by the exact area that it has of the pixel, and blended by their numbers as SVG viewers do; lines are
/// drawn over them by the area that they cover.
///
/// Translucent polygons are painted over what shows behind them.
#[derive(Args, Debug)]
#[command(after_help = examples::DRAW)]
pub(crate) struct DrawArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// File to write, complete or not at all: .svg, .pdf, .tex, .dxf or .png; - for standard
    /// output
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

/// The format of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DrawFormat {
    /// Paths and lines
    Svg,
    /// Paths and lines, on a page
    Pdf,
    /// Paths and lines, as TikZ for LaTeX
    Tex,
    /// Lines for CAD programs, with a layer for each kind
    Dxf,
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
