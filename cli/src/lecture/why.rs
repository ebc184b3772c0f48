//! Why surfaces have to be ordered: what is seen without.

use super::chapter::Chapter;
use crate::failure::Failure;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "A picture shows, in each pixel, the surface that is nearest along the ray through it. Drawn in the \
         order in which a file happens to list them, polygons cover one another at random.",
    );
    Ok(())
}
