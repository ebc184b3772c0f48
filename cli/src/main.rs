//! The program `binspace`: orders, checks, measures and draws scenes of polygons.

mod args;
mod backs;
mod camera;
mod cells;
mod chart;
mod colours;
mod commands;
mod coverage;
mod cull;
mod drawn;
mod examples;
mod failure;
mod files;
mod format;
mod framing;
mod ink;
mod job;
mod lecture;
mod measure;
mod memory;
mod page;
mod pictures;
mod png_file;
mod progress;
mod samples;
mod saved_file;
mod scene_arg;
mod seams;
mod shading;
mod signals;
mod standard_input;
mod strokes;
mod svg;
mod table;
mod terminal;
mod unfinished;
mod units;
mod upright;
mod values;

use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};
use commands::Outcome;
use failure::Failure;

fn main() -> ExitCode {
    memory::fail_when_exhausted();
    let result = match Cli::try_parse() {
        Ok(cli) => run(&cli),
        Err(answer) => print(&answer),
    };
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
    match &cli.command {
        None => commands::tour::run(&cli.tour),
        Some(Command::Build(args)) => commands::build::run(args),
        Some(Command::Order(args)) => commands::order::run(args),
        Some(Command::Verify(args)) => commands::verify::run(args),
        Some(Command::Stats(args)) => commands::stats::run(args),
        Some(Command::Render(args)) => commands::render::run(args),
        Some(Command::Draw(args)) => commands::draw::run(args),
        Some(Command::Page(args)) => commands::page::run(args),
        Some(Command::Report(args)) => commands::report::run(args),
        Some(Command::Lecture(args)) => commands::lecture::run(args),
        Some(Command::Scenes) => commands::scenes::run(),
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
