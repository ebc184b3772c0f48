//! Checks that there is memory for a scene, and sets the exit status for when there is not.

use std::hint::black_box;

use crate::failure::Failure;
use crate::units::{bytes, count};

/// Memory that a scene and its tree take per polygon, with a margin: some 480 bytes were measured for scenes
/// in which nothing is cut. Too small: the program ends without a message. Too large: the program refuses
/// scenes that would fit.
const BYTES_EACH: usize = 800;

/// The memory that reading a file takes, per byte of the file. For files of triangles 4 to 9 bytes were
/// measured. Faces of many corners take up to 24 bytes, because a corner of two bytes becomes three coordinates
/// and perhaps a colour; if there is too little memory for the corners of an OBJ file, the library returns an
/// error. Too large: files that would fit are refused. Too small: the program reads for a while, and then ends
/// with a number of bytes instead of a message that names the file.
const READING: usize = 6;

/// From now on, the program ends with exit status 2 if memory runs out.
///
/// The standard library then prints the requested size, and aborts.
pub(crate) fn fail_when_exhausted() {
    #[cfg(unix)]
    {
        use signal_hook::{consts::SIGABRT, flag::register_conditional_shutdown};
        use std::sync::atomic::AtomicBool;

        static ALWAYS: AtomicBool = AtomicBool::new(true);
        // If this fails, the signal determines the exit status.
        let _ = register_conditional_shutdown(SIGABRT, 2, &ALWAYS);
    }
}

/// Returns an error if there is too little memory for a scene with this many polygons: building it would
/// end the program.
pub(crate) fn check(scene: &str, polygons: usize) -> Result<(), Failure> {
    let needed = polygons.saturating_mul(BYTES_EACH);
    find_room(needed).ok_or_else(|| lacking(scene, &count(polygons, "polygon"), needed))
}

/// Returns an error if there is too little memory to read a file of `size` bytes.
pub(crate) fn check_file(name: &str, size: u64) -> Result<(), Failure> {
    let size = usize::try_from(size).unwrap_or(usize::MAX);
    let needed = size.saturating_mul(READING);
    find_room(needed).ok_or_else(|| lacking(name, &format!("a file of {}", bytes(size)), needed))
}

/// Allocates memory and frees it, without writing to it.
fn find_room(needed: usize) -> Option<()> {
    let mut room = Vec::<u8>::new();
    let result = room.try_reserve_exact(needed);
    black_box(&mut room);
    result.ok()
}

fn lacking(scene: &str, what: &str, needed: usize) -> Failure {
    Failure::about(scene, format!("too little memory for {what}: about {} needed", bytes(needed)))
}
