//! The program `binspace`: orders, checks, measures and draws scenes of polygons.
//!
//! The public modules are also used by `binspace-lab`.

mod args;
mod backs;
mod blended;
pub mod camera;
mod cells;
pub mod colours;
mod commands;
mod coverage;
mod cull;
mod drawn;
mod dxf;
pub mod failure;
pub mod files;
mod format;
mod formats;
mod framing;
mod ink;
pub mod job;
mod measure;
mod memory;
mod page;
pub mod pictures;
pub mod png_file;
pub mod progress;
mod samples;
mod saved_file;
pub mod scene_arg;
mod shading;
mod signals;
mod strokes;
mod table;
pub mod terminal;
pub mod units;
mod upright;
pub mod values;

use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;

use args::{Cli, Command};
use failure::Failure;

/// The outcome of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The command has done its work.
    Done,
    /// An image differs from the expected image.
    Differs,
}

/// The program `binspace`.
pub fn main() -> ExitCode {
    program(run)
}

/// Reads the command line, runs a command, and reports failures. Without a command, prints help. The exit
/// status is 1 if an image differs, and 2 after a failure.
pub fn program<Arguments: Parser>(
    run: impl FnOnce(&Arguments) -> Result<Outcome, Failure>,
) -> ExitCode {
    memory::fail_when_exhausted();
    let arguments = values::with_joined_vectors(std::env::args_os());
    let result = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => run(&arguments),
        Err(answer) if answer.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            terminal::say(answer.render().ansi()).map(|()| Outcome::Done)
        }
        Err(answer) => print(&answer),
    };
    terminal::print_remarks();
    match result {
        // The reader of the output has closed it: not an error.
        Ok(Outcome::Done) | Err(Failure::ClosedPipe) => ExitCode::SUCCESS,
        Ok(Outcome::Differs) => ExitCode::from(1),
        Err(Failure::Usage) => ExitCode::from(2),
        Err(Failure::Message(message)) => {
            terminal::error(&message);
            ExitCode::from(2)
        }
    }
}

fn run(cli: &Cli) -> Result<Outcome, Failure> {
    cli.general.apply()?;
    match &cli.command {
        Command::Demo(args) => commands::demo::run(args),
        Command::Order(args) => commands::order::run(args),
        Command::Verify(args) => commands::verify::run(args),
        Command::Stats(args) => commands::stats::run(args),
        Command::Render(args) => commands::render::run(args),
        Command::Draw(args) => commands::draw::run(args),
        Command::Page(args) => commands::page::run(args),
        Command::Export(args) => commands::export::run(args),
        Command::Build(args) => commands::build::run(args),
        Command::Scenes => commands::scenes::run(),
        Command::Generate { folder } => args::generate(folder).map(|()| Outcome::Done),
    }
}

/// Prints help, the version, or an error in the command line.
fn print(answer: &clap::Error) -> Result<Outcome, Failure> {
    let printed = answer.print().and_then(|()| io::stdout().flush());
    match printed {
        // If standard error fails, there is nowhere left to report it.
        _ if answer.use_stderr() => Err(Failure::Usage),
        Ok(()) => Ok(Outcome::Done),
        Err(error) => Err(Failure::of_output(&error)),
    }
}
