//! Completions of shells and manual pages.

use std::path::Path;

use clap::{Command, CommandFactory, ValueEnum};
use clap_complete::Shell;

use super::Cli;
use crate::failure::Failure;
use crate::files::make_folder;

/// Writes completions of all shells into the folder `completions` of a folder, and manual pages into `man`.
pub(crate) fn generate(folder: &Path) -> Result<(), Failure> {
    let [completions, man] = ["completions", "man"].map(|name| folder.join(name));
    make_folder(&completions)?;
    make_folder(&man)?;
    let unwritable = |error| Failure::about(folder.display(), error);
    for &shell in Shell::value_variants() {
        clap_complete::generate_to(shell, &mut Cli::command(), "binspace", &completions)
            .map_err(unwritable)?;
    }
    // Manual pages omit the text of options that the short help hides.
    let show = |command: Command| command.mut_args(|option| option.hide_short_help(false));
    let command = show(Cli::command().mut_subcommands(show));
    clap_mangen::generate_to(command, &man).map_err(unwritable)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::fs;

    use super::*;

    #[test]
    fn the_files_of_the_package_are_current() {
        let made = tempfile::tempdir().unwrap();
        generate(made.path()).unwrap();
        let files = |folder: &Path| -> BTreeMap<_, _> {
            let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap());
            files.map(|file| (file.file_name(), fs::read_to_string(file.path()).unwrap())).collect()
        };
        for folder in ["completions", "man"] {
            let [kept, made] = [Path::new(env!("CARGO_MANIFEST_DIR")), made.path()]
                .map(|at| files(&at.join(folder)));
            assert!(!made.is_empty());
            assert!(kept == made, "run `cargo run -p binspace-cli -- generate cli`");
        }
    }
}
