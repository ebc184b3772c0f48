//! The lecture: what a course on visibility teaches, shown, measured and judged.
//!
//! A chapter is a function that computes all it shows; `page` writes the chapters. What is computed is in the
//! evidence crate, with its tests.

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

pub(crate) use chapter::Chapter;
pub(crate) use page::write;

use crate::failure::Failure;

/// What makes a chapter.
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
