//! `binspace-lab lecture`: the content of a course on visibility, as one page.
//!
//! A chapter is a function that computes all its content; `page` writes the chapters. The computations are in
//! the evidence crate, with its tests.

mod antialias;
mod chapter;
mod culling;
mod curve;
mod curved;
mod depth;
mod filling;
mod newell;
mod page;
mod painter;
mod plan;
mod precision;
mod radiosity;
mod shadow_pieces;
mod shadows;
mod shot;
mod translucent;
mod trees;
mod why;

use binspace_cli::Outcome;
use binspace_cli::failure::Failure;
use binspace_cli::files::{NewFile, make_folder};
use binspace_cli::progress::Progress;
use binspace_cli::terminal::say;

use crate::args::LectureArgs;
use chapter::Chapter;

/// The function that fills a chapter.
type Make = fn(&mut Chapter) -> Result<(), Failure>;

/// The chapters in their order, by their titles.
const CHAPTERS: [(&str, Make); 10] = [
    ("Why order at all", why::fill),
    ("The painter's algorithm and who hides whom", painter::fill),
    ("Newell, Newell and Sancha", newell::fill),
    ("Binary space partition trees", trees::fill),
    ("Depth buffers", depth::fill),
    ("Precision", precision::fill),
    ("What need not be drawn", culling::fill),
    ("Translucent surfaces", translucent::fill),
    ("Anti-aliasing", antialias::fill),
    ("Shadows", shadows::fill),
];

/// Runs the command.
pub(crate) fn run(args: &LectureArgs) -> Result<Outcome, Failure> {
    make_folder(&args.output)?;
    let path = args.output.join("index.html");
    let file = NewFile::create(&path)?;
    let progress = Progress::steps("chapter", CHAPTERS.len() as u64);
    let mut chapters = Vec::new();
    for (title, fill) in CHAPTERS {
        let mut chapter = Chapter::new(title);
        fill(&mut chapter)?;
        chapters.push(chapter);
        progress.step();
    }
    drop(progress);
    file.write(|out| page::write(out, &chapters))?;
    say(format!("Wrote {}", path.display()))?;
    Ok(Outcome::Done)
}
