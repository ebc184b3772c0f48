//! A level of rooms with doors, as in the example `level`, which keeps the generator: examples stand
//! alone.

#[path = "../../../examples/level/rooms.rs"]
#[allow(dead_code, reason = "the example uses more of it")]
mod generator;

use binspace::glam::DVec3;

/// The side of a room and its height.
pub const ROOM: f64 = generator::ROOM;
pub const HEIGHT: f64 = generator::HEIGHT;

/// The quads of `side`² rooms; up is z.
pub fn rooms(side: usize) -> Vec<[DVec3; 4]> {
    generator::rooms(side).into_iter().map(|(_, quad)| quad).collect()
}
