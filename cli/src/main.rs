//! The program `binspace`: orders, checks, measures and draws scenes of polygons.

mod args;
mod camera;
mod colours;
mod commands;
mod examples;
mod failure;
mod files;
mod framing;
mod job;
mod measure;
mod memory;
mod pictures;
mod png_file;
mod progress;
mod scene_arg;
mod svg;
mod table;
mod terminal;
mod unfinished;
mod units;
mod values;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};
use commands::Outcome;
use failure::Failure;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let result = match &cli.command {
        None => commands::tour::run(&cli.tour),
        Some(Command::Order(args)) => commands::order::run(args),
        Some(Command::Verify(args)) => commands::verify::run(args),
        Some(Command::Stats(args)) => commands::stats::run(args),
        Some(Command::Render(args)) => commands::render::run(args),
        Some(Command::Report(args)) => commands::report::run(args),
        Some(Command::Scenes) => commands::scenes::run(),
    };
    match result {
        // Whoever reads the output has seen enough.
        Ok(Outcome::Done) | Err(Failure::ClosedPipe) => ExitCode::SUCCESS,
        Ok(Outcome::Differs) => ExitCode::from(1),
        Err(Failure::Message(message)) => {
            terminal::error(&message);
            ExitCode::from(2)
        }
    }
}
