//! The arguments of commands that make pictures.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{BuildArgs, SceneArgs, examples};
use crate::camera::ViewArgs;
use crate::colours::Colouring;
use crate::cull::CullArgs;
use crate::drawn::Seams;
use crate::pictures::Bright;
use crate::samples;
use crate::strokes::{EdgeChoice, Hidden};
use crate::values::{self, Background};

/// Draw a scene as pixels, in a PNG
#[derive(Args, Debug)]
#[command(after_help = examples::RENDER)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// PNG file to write; - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// Antialias: N x N samples per pixel
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = "Look")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=i64::from(samples::MOST)))]
    pub(crate) samples: u32,
    #[command(flatten)]
    pub(crate) kind: KindArgs,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Look")]
pub(crate) struct LookArgs {
    /// Colour by material or by polygon
    #[arg(long, alias = "colors", value_name = "BY", value_enum, default_value_t)]
    #[arg(hide_possible_values = true)]
    pub(crate) colours: Colouring,
    #[command(flatten)]
    pub(crate) cull: CullArgs,
}

/// Draw a scene as vectors (SVG, PDF, TikZ, DXF): one path per visible polygon, or lines
#[derive(Args, Debug)]
#[command(after_help = examples::DRAW)]
pub(crate) struct DrawArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// File format [default: by the file's name; svg for standard output]
    #[arg(long, value_name = "FORMAT", value_enum, hide_short_help = true)]
    pub(crate) format: Option<DrawFormat>,
    /// Write polygon numbers, edge numbers and material names into the SVG
    #[arg(long, hide_short_help = true)]
    pub(crate) ids: bool,
    /// Print statistics of the drawing as a JSON object
    #[arg(long, hide_short_help = true)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    /// Millimetres of paper per unit of the scene; needs --view or --direction
    #[arg(long, value_name = "MM", value_parser = values::positive, help_heading = "View")]
    #[arg(allow_negative_numbers = true)]
    #[arg(requires = "parallel", conflicts_with = "size", hide_short_help = true)]
    pub(crate) scale: Option<f64>,
    #[command(flatten)]
    pub(crate) lines: LineArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    #[command(flatten)]
    pub(crate) fill: FillArgs,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Lines")]
pub(crate) struct LineArgs {
    /// Draw only lines; polygons still hide the lines behind them
    #[arg(long = "lines", conflicts_with = "colours")]
    pub(crate) alone: bool,
    /// Edges to draw: none, all, creases[=DEG] or silhouettes [default: none; creases with --lines,
    /// --hidden or a DXF]
    #[arg(long, value_name = "KIND", value_parser = EdgeChoice::parse)]
    pub(crate) edges: Option<EdgeChoice>,
    /// Hidden edges: none, dashed or layers (dashed by depth)
    #[arg(long, value_name = "STYLE", value_enum, default_value_t, hide_possible_values = true)]
    pub(crate) hidden: Hidden,
    /// Width of lines in pixels
    #[arg(long, value_name = "PX", default_value = "1", value_parser = values::line_width)]
    #[arg(allow_negative_numbers = true)]
    pub(crate) line_width: f64,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Look")]
pub(crate) struct FillArgs {
    /// Colour behind the scene, such as #ffeecc, or none
    #[arg(long, value_name = "COLOUR", default_value = "white", value_parser = values::background)]
    pub(crate) background: Background,
    /// Ignore opacities: draw all polygons as opaque
    #[arg(long, hide_short_help = true)]
    pub(crate) opaque: bool,
    /// Draw hidden polygons too, under the polygons in front of them
    #[arg(long)]
    pub(crate) translucent: bool,
    /// How to avoid light seams between adjacent polygons
    #[arg(long, value_name = "HOW", value_enum, default_value_t, hide_short_help = true)]
    pub(crate) seams: Seams,
    /// Omit polygons with less visible area than PX x PX pixels, and lines shorter than PX [default:
    /// 0.01; 0 in a PNG]
    #[arg(long, value_name = "PX", value_parser = values::length)]
    #[arg(allow_hyphen_values = true, hide_short_help = true)]
    pub(crate) min_size: Option<f64>,
}

/// The format of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DrawFormat {
    Svg,
    Pdf,
    Tex,
    Dxf,
    Png,
}

/// What to draw instead of the painter's picture.
#[derive(Args, Debug)]
#[group(multiple = false)]
#[command(next_help_heading = "Other pictures")]
pub(crate) struct KindArgs {
    /// Draw with a depth buffer
    #[arg(long)]
    pub(crate) z_buffer: bool,
    /// Draw where painter and depth buffer differ; exit status 1 if they do
    #[arg(long)]
    pub(crate) difference: bool,
    /// Draw depths: near is bright; with --depth=far, far is bright
    #[arg(long, value_name = "BRIGHT", value_enum, require_equals = true)]
    #[arg(num_args = 0..=1, default_missing_value = "near", hide_possible_values = true)]
    pub(crate) depth: Option<Bright>,
}
