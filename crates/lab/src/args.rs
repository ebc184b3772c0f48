//! The command line.

use std::ffi::OsString;
use std::path::PathBuf;

use binspace_cli::values;
use binspace_evidence::Family;
use clap::{Args, Parser, Subcommand};

/// A course on visibility as a page, and a report that compares methods to decide visibility
#[derive(Debug, Parser)]
#[command(name = "binspace-lab", version, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Lecture(LectureArgs),
    Report(ReportArgs),
}

/// Write the subjects of a course on visibility as one page
///
/// The page has pictures, graphs and short texts in the order of a course. The page is one HTML file that
/// needs no network. All figures come from the run, which takes less than half a minute on two processors.
#[derive(Args, Debug)]
#[command(after_help = LECTURE)]
pub(crate) struct LectureArgs {
    /// Folder to write index.html into; created if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "lecture")]
    pub(crate) output: PathBuf,
}

/// Compare the speed and the errors of methods to decide visibility
///
/// The methods are trees with exact and with rounded decisions, Newell's algorithm, sorted centroids and
/// depth buffers. The methods paint families of scenes that become harder step by step, and the scenes that
/// you name. Each pixel, vertex and piece is compared with an exact result. Writes report.md, plots as SVG,
/// and figures as CSV; errors.csv is the same for the same seed on any machine. If the command is
/// interrupted, the results so far are kept. The exit status is 1 if the exact tree is wrong anywhere, or is
/// too large to be built.
#[derive(Args, Debug)]
#[command(after_help = REPORT)]
pub(crate) struct ReportArgs {
    /// Scenes to measure as well: OBJ files, built-in scenes, or - for an OBJ file on standard input
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
    /// Measure only this family, and leave out culling and growth; may be repeated
    ///
    /// One of angle, gap, offset, scale, sliver, nesting, lattice, boxes, cycle, penetration and
    /// depth-range.
    #[arg(long, value_name = "NAME")]
    pub(crate) family: Vec<Family>,
    /// Size of the pictures in pixels [default: 640x480; 160x120 if quick]
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    pub(crate) size: Option<[u32; 2]>,
}

const LECTURE: &str = "\
Examples:
  binspace-lab lecture
  binspace-lab lecture -o course && xdg-open course/index.html";

const REPORT: &str = "\
Examples:
  binspace-lab report
  binspace-lab report --quick -o quick
  binspace-lab report scene.obj teapot:16 --seed 7
  binspace-lab report --family gap --family sliver --size 640x480";

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        super::Cli::command().debug_assert();
    }
}
