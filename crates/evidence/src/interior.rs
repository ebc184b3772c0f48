//! A generated interior: rooms with doors, as in the example `level`.

use binspace::glam::DVec3;

#[path = "../../../examples/level/rooms.rs"]
mod generator;

/// The quads of `side`² rooms of 8 by 8 and a height of 3, with doors in most walls between them, and
/// a pillar or a crate in each. Up is z; the first corner is the origin.
pub fn rooms(side: usize) -> Vec<[DVec3; 4]> {
    generator::rooms(side).into_iter().map(|(_, quad)| quad).collect()
}
