//! The program as its users run it: the real binary, its files, its exit status.

mod lecture;
mod report;
mod report_names;
#[path = "../../../../cli/tests/program/run.rs"]
mod run;

/// The program that [`run`] runs.
const PROGRAM: &str = env!("CARGO_BIN_EXE_binspace-lab");
