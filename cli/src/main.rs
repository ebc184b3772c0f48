//! The program `binspace`.

use std::process::ExitCode;

fn main() -> ExitCode {
    binspace_cli::main()
}
