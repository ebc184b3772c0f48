//! The command line.

mod common;
mod pictures;

use std::path::PathBuf;

use binspace::glam::DVec3;
use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::cull::CullArgs;
use crate::examples;
use crate::values::{self, Heuristics};

pub(crate) use common::{BuildArgs, LimitArgs, SceneArgs, UpArgs};
pub(crate) use pictures::{DrawArgs, DrawFormat, Format, KindArgs, RenderArgs};

/// Exact back-to-front orders of polygons from one BSP tree
#[derive(Debug, Parser)]
#[command(name = "binspace", version, max_term_width = 100, after_help = examples::PROGRAM)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Demo(DemoArgs),
    Order(OrderArgs),
    Verify(VerifyArgs),
    Stats(StatsArgs),
    Render(RenderArgs),
    Draw(DrawArgs),
    Page(PageArgs),
    Export(ExportArgs),
    Build(BuildFileArgs),
    /// List the built-in scenes
    Scenes,
}

/// Draw built-in scenes, and compare every pixel with a depth buffer
///
/// Builds trees of built-in scenes with every heuristic, paints their fragments in order, compares
/// every pixel with a depth buffer, and writes the pictures. The exit status is 1 if any pixel is
/// wrong.
#[derive(Args, Debug)]
#[command(after_help = examples::DEMO)]
pub(crate) struct DemoArgs {
    /// Folder to write the pictures into; created if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    pub(crate) output: PathBuf,
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
    /// In memory are the vertices of the OBJ file (files of other formats are read whole), and then one cell. The folder has a file for each cell;
    /// `render`, `order` and `stats` take it in place of a scene, with one cell in memory at a time. It
    /// keeps no texture coordinates, normals or line numbers.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=500))]
    pub(crate) cells: Option<u32>,
}

/// Write a scene's fragments in paint order, one JSON object per line
///
/// Each line is `{"polygon": i, "vertices": [[x, y, z], …]}`: a convex fragment of the i-th
/// polygon of the file, counted from 0 (in OBJ files, of the i-th `f` line), in the file's coordinates. Back to front: no
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
    /// How to choose splitters: a heuristic, as listed below, or all [default: auto]
    #[arg(long, value_name = "H", value_parser = values::heuristics)]
    pub(crate) heuristic: Option<Heuristics>,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// Print one JSON object per line for each heuristic
    #[arg(long)]
    pub(crate) json: bool,
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

/// Write a tree's fragments as triangles, for other programs
///
/// Where a cut ends on the edge of a neighbour, that has a vertex too (the mesh is welded), so closed
/// bodies stay closed. Each triangle keeps the colour of its polygon, and its number: OBJ files have a
/// group `polygon_7`, PLY files a property `polygon` of faces, GLB files an attribute `_POLYGON` of
/// vertices. GLB files have coordinates of 32 bits; the others have all digits.
#[derive(Args, Debug)]
#[command(after_help = examples::EXPORT)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// File to write, complete or not at all, such as scene.ply; - for standard output. The materials
    /// of scene.obj go into scene.mtl
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Format of the file [default: as it is named]
    #[arg(long, value_enum)]
    pub(crate) format: Option<ExportFormat>,
    /// Sort the triangles back to front for this eye
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) order: Option<DVec3>,
    /// Leave out the vertices that keep closed bodies closed
    #[arg(long)]
    pub(crate) unwelded: bool,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

/// A format of `binspace export`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportFormat {
    Obj,
    Ply,
    Glb,
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
        let default = binspace::BuildOptions::DEFAULT;
        assert!(help("max_fragments").contains(&format!("[default: {}]", default.max_fragments)));
        assert!(help("heuristic").contains(&format!("[default: {}]", default.heuristic)));
    }

    #[test]
    fn the_help_of_stats_names_all_heuristics_with_their_papers() {
        let help = super::examples::STATS;
        let (_, list) = help.split_once("Heuristics").unwrap();
        let names: Vec<String> = binspace::Heuristic::ALL.iter().map(|h| h.to_string()).collect();
        let starts: Vec<usize> = names
            .iter()
            .map(|name| {
                let name = name.split('(').next().unwrap();
                list.find(&format!("\n  {name}")).unwrap_or_else(|| panic!("{name} is missing"))
            })
            .collect();
        let ends = starts.iter().skip(1).copied().chain([list.len()]);
        for ((name, &start), end) in names.iter().zip(&starts).zip(ends) {
            let year = |words: &str| ["19", "20"].iter().any(|c| words.contains(&format!(" {c}")));
            assert!(year(&list[start..end]), "{name} has no paper");
        }
    }
}
