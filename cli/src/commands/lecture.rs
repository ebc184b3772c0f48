//! `binspace lecture`: what a course on visibility teaches, as one page.

use super::Outcome;
use crate::args::LectureArgs;
use crate::failure::Failure;
use crate::files::{NewFile, make_folder};
use crate::lecture;
use crate::progress::Progress;
use crate::terminal::say;

/// Runs the command.
pub(crate) fn run(args: &LectureArgs) -> Result<Outcome, Failure> {
    make_folder(&args.output)?;
    let path = args.output.join("index.html");
    let file = NewFile::create(&path)?;
    let progress = Progress::steps("chapter", lecture::COUNT as u64);
    let mut chapters = Vec::new();
    for chapter in lecture::chapters() {
        chapters.push(chapter?);
        progress.step();
    }
    drop(progress);
    file.write(|out| lecture::write(out, &chapters))?;
    say(format!("Wrote {}", path.display()))?;
    Ok(Outcome::Done)
}
