//! Whether there is memory for a scene.

use std::hint::black_box;

use crate::failure::Failure;
use crate::units::{bytes, count};

/// What a scene and its tree take for each polygon, with room to spare: some 480 bytes were measured
/// where nothing is cut. Smaller: a program that ends without a word; larger: scenes refused that
/// would fit.
const BYTES_EACH: usize = 800;

/// An error if the system has no memory for a scene of so many polygons, as it would end the
/// program if the scene were built.
pub(crate) fn check(scene: &str, polygons: usize) -> Result<(), Failure> {
    let needed = polygons.saturating_mul(BYTES_EACH);
    // Asked for and given back; none of it is touched.
    let mut room = Vec::<u8>::new();
    let result = room.try_reserve_exact(needed);
    black_box(&mut room);
    result.map_err(|_| {
        let polygons = count(polygons, "polygon");
        let problem = format!("no memory for {polygons}: about {} are needed", bytes(needed));
        Failure::about(scene, problem)
    })
}
