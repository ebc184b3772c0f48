//! The program `binspace-lab`: a course on visibility as a page, and a report that compares methods to decide
//! visibility.

mod args;
mod chart;
mod lecture;
mod report;

use std::process::ExitCode;

use binspace_cli::failure::Failure;
use binspace_cli::{Outcome, program};

use args::{Cli, Command};

fn main() -> ExitCode {
    program(|cli: &Cli| -> Result<Outcome, Failure> {
        match &cli.command {
            Command::Lecture(args) => lecture::run(args),
            Command::Report(args) => report::run(args),
        }
    })
}
