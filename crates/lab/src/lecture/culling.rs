//! Geometry that need not be drawn: overdraw, culling, portals.

mod city;
mod overdraw;
mod rooms;

use super::chapter::Chapter;
use binspace_cli::failure::Failure;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    overdraw::fill(chapter)?;
    city::fill(chapter)?;
    rooms::fill(chapter)
}
