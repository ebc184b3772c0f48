//! The command line.

mod common;
mod examples;
mod generated;
mod pictures;

use std::path::PathBuf;

use binspace::glam::DVec3;
use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::cull::CullArgs;
use crate::values::{self, Heuristics};

pub(crate) use common::{BuildArgs, GeneralArgs, IsGiven, LimitArgs, SceneArgs, UpArgs};
pub(crate) use generated::generate;
pub(crate) use pictures::{DrawArgs, DrawFormat, KindArgs, RenderArgs};

/// Order, check and draw polygons exactly, with one BSP tree for all views
#[derive(Debug, Parser)]
#[command(name = "binspace", version, max_term_width = 100, after_help = examples::PROGRAM)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
    #[command(flatten)]
    pub(crate) general: GeneralArgs,
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
    /// Write shell completions and manual pages into DIR
    #[command(hide = true)]
    Generate {
        /// Output folder; `completions` and `man` are created in it
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
}

/// Draw built-in scenes and compare every pixel with a depth buffer
#[derive(Args, Debug)]
#[command(after_help = examples::DEMO)]
pub(crate) struct DemoArgs {
    /// Folder for the pictures; created if it is missing
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    pub(crate) output: PathBuf,
    /// Number of views to compare, around each scene and inside it
    #[arg(long, value_name = "N", default_value_t = 6)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) views: u32,
    /// Size of the pictures in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = values::size)]
    pub(crate) size: [u32; 2],
    /// Seed of random scenes and views
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(crate) seed: u64,
}

/// Build a scene's tree and store both in a file that every command accepts as SCENE
#[derive(Args, Debug)]
#[command(after_help = examples::BUILD)]
pub(crate) struct BuildFileArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// File to write, such as scene.bsp; - for standard output; with --cells, a new folder
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Divide a scene larger than memory into N cells; order, stats and render accept the folder
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=500))]
    pub(crate) cells: Option<u32>,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

/// Write a scene's fragments in painting order, one JSON object per line
#[derive(Args, Debug)]
#[command(after_help = examples::ORDER)]
#[command(group(clap::ArgGroup::new("viewpoint").required(true).args(["eye", "direction"])))]
pub(crate) struct OrderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Position of the eye; repeat the option for more eyes
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) eye: Vec<DVec3>,
    /// Direction of view, for an eye infinitely far away
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) direction: Option<DVec3>,
    /// List the nearest fragment first
    #[arg(long)]
    pub(crate) front_to_back: bool,
    /// Add the number of the polygon's edge on which each edge lies
    #[arg(long)]
    pub(crate) edges: bool,
    /// Add weights of the polygon's corners for each vertex, to interpolate attributes
    #[arg(long)]
    pub(crate) weights: bool,
    #[command(flatten)]
    pub(crate) cull: CullArgs,
    /// File to write; - for standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

/// Paint a scene in order and compare every pixel with a depth buffer
#[derive(Args, Debug)]
#[command(after_help = examples::VERIFY)]
pub(crate) struct VerifyArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Number of views to compare, alternately around the scene and inside it
    #[arg(long, value_name = "N", default_value_t = 8)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) views: u32,
    /// Size of the pictures in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = values::size)]
    pub(crate) size: [u32; 2],
    /// Print a JSON object for each view and one for the total
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) up: UpArgs,
    #[command(flatten)]
    pub(crate) cull: CullArgs,
    #[command(flatten)]
    pub(crate) build: BuildArgs,
}

/// Build trees of a scene and print their sizes and times
#[derive(Args, Debug)]
#[command(after_help = examples::STATS)]
pub(crate) struct StatsArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Print a JSON object for each tree
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) is_given: IsGiven,
    /// Heuristic to choose splitting planes: a name from below, or all
    #[arg(long, value_name = "H", default_value = "auto", value_parser = values::heuristics)]
    #[arg(help_heading = "Tree")]
    pub(crate) heuristic: Heuristics,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

/// Write a page for a browser, in which readers turn the scene
#[derive(Args, Debug)]
#[command(after_help = examples::PAGE)]
pub(crate) struct PageArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// File to write, such as scene.html; - for standard output
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
#[derive(Args, Debug)]
#[command(after_help = examples::EXPORT)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// File to write: .obj (and .mtl), .ply or .glb; - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// File format [default: by the file's name; obj for standard output]
    #[arg(long, value_enum, hide_short_help = true)]
    pub(crate) format: Option<ExportFormat>,
    /// Sort the triangles back to front for this eye
    #[arg(long, value_name = "X,Y,Z", value_parser = values::point, allow_hyphen_values = true)]
    pub(crate) order: Option<DVec3>,
    /// Leave T-junctions between fragments open: fewer triangles, but cracks
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
