//! The lecture: what a course on visibility teaches, shown, measured and judged.
//!
//! A chapter is a function that computes all it shows; `page` writes the chapters. What is computed is in the
//! evidence crate, with its tests.

mod antialias;
mod chapter;
mod culling;
mod page;
mod radiosity;
mod shadows;
mod translucent;
mod why;

pub(crate) use chapter::Chapter;
pub(crate) use page::write;

use crate::failure::Failure;

/// What makes a chapter.
type Make = fn(&mut Chapter) -> Result<(), Failure>;

/// The chapters in their order, by their titles.
const CHAPTERS: [(&str, Make); 5] = [
    ("Why order at all", why::fill),
    ("What need not be drawn", culling::fill),
    ("Translucent surfaces", translucent::fill),
    ("Anti-aliasing", antialias::fill),
    ("Shadows", shadows::fill),
];

/// How many chapters there are.
pub(crate) const COUNT: usize = CHAPTERS.len();

/// Makes the chapters, one after another.
pub(crate) fn chapters() -> impl Iterator<Item = Result<Chapter, Failure>> {
    CHAPTERS.iter().map(|&(title, fill)| {
        let mut chapter = Chapter::new(title);
        fill(&mut chapter)?;
        Ok(chapter)
    })
}
