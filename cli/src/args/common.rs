//! The common arguments of several commands.

use std::ffi::OsString;

use binspace::glam::DVec3;
use binspace::{BuildOptions, Heuristic};
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use crate::failure::Failure;
use crate::terminal::{Notes, set_notes};
use crate::values::{self, Up};

#[derive(Args, Debug)]
pub(crate) struct SceneArgs {
    /// File (OBJ, STL, PLY, OFF, glTF, .bsp), - for standard input, or a built-in scene
    #[arg(value_name = "SCENE")]
    pub(crate) name: OsString,
    /// Seed of random built-in scenes and of random views
    #[arg(long, value_name = "S", default_value_t = 1, hide_short_help = true)]
    pub(crate) seed: u64,
}

#[derive(Args, Debug)]
pub(crate) struct UpArgs {
    /// Direction that points up: auto, x, y, z, -x or X,Y,Z
    #[arg(long, value_name = "AXIS", value_parser = values::up, allow_hyphen_values = true)]
    #[arg(default_value = "auto")]
    up: Up,
}

impl UpArgs {
    /// The direction that the user has given.
    pub(crate) fn given(&self) -> Option<DVec3> {
        self.up.0
    }
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Tree")]
pub(crate) struct BuildArgs {
    #[command(flatten)]
    pub(crate) is_given: IsGiven,
    /// Heuristic to choose splitting planes: see `binspace stats -h`
    #[arg(long, value_name = "H", default_value_t)]
    pub(crate) heuristic: Heuristic,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

#[derive(Args, Clone, Copy, Debug)]
#[command(next_help_heading = "Tree")]
pub(crate) struct LimitArgs {
    /// Points this close to a plane lie on it [default: by the input's precision]
    #[arg(long, value_name = "T", value_parser = values::length, allow_hyphen_values = true)]
    pub(crate) tolerance: Option<f64>,
    /// Stop with an error if the tree needs more fragments
    #[arg(long, value_name = "N", default_value_t = BuildOptions::DEFAULT.max_fragments)]
    #[arg(hide_short_help = true)]
    pub(crate) max_fragments: usize,
}

impl LimitArgs {
    /// The options to build with.
    pub(crate) fn options(self, heuristic: Heuristic) -> BuildOptions {
        let options =
            BuildOptions::DEFAULT.with_heuristic(heuristic).with_max_fragments(self.max_fragments);
        self.tolerance.map_or(options.clone(), |length| options.with_tolerance(length))
    }
}

/// Whether the user has given a build option, even with its default value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IsGiven(pub(crate) bool);

impl FromArgMatches for IsGiven {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let is_given = |name| matches.value_source(name) == Some(ValueSource::CommandLine);
        Ok(Self(["heuristic", "tolerance", "max_fragments"].into_iter().any(is_given)))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for IsGiven {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

/// The largest number of threads. Too large: a mistyped number makes threads until memory ends.
const MOST_THREADS: i64 = 1024;

/// The options of all commands.
#[derive(Args, Debug)]
#[command(next_help_heading = "General")]
pub(crate) struct GeneralArgs {
    /// Number of threads [default: one per processor]
    #[arg(long, value_name = "N", global = true, hide_short_help = true)]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    threads: Option<u16>,
    /// Print errors only: no notes, no progress
    #[arg(long, global = true, conflicts_with = "notes", hide_short_help = true)]
    quiet: bool,
    /// Print each note in full, on its own line
    #[arg(long, global = true, hide_short_help = true)]
    notes: bool,
}

impl GeneralArgs {
    /// Sets the number of threads, and which notes are printed.
    pub(crate) fn apply(&self) -> Result<(), Failure> {
        set_notes(match self {
            Self { quiet: true, .. } => Notes::None,
            Self { notes: true, .. } => Notes::Each,
            _ => Notes::Brief,
        });
        let Some(threads) = self.threads else { return Ok(()) };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
        pool.build_global().map_err(|error| Failure::about("--threads", error))
    }
}
