//! Files on disk, opened so that nothing waits without an end and no device fills the memory.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Bytes read at once from a device or a pipe.
const CHUNK: u64 = 1 << 16;

/// The bytes of a file; of a device or a pipe, at most up to the first zero byte and the chunk that it is
/// in: no text has one, and some devices have no end.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    if fs::metadata(path).is_ok_and(|found| found.is_file() || found.is_dir()) {
        return fs::read(path);
    }
    if is_named_pipe(path) {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "it is a named pipe: redirect it to standard input",
        ));
    }
    let (mut file, mut bytes) = (File::open(path)?, Vec::new());
    loop {
        let before = bytes.len();
        file.by_ref().take(CHUNK).read_to_end(&mut bytes)?;
        if bytes.len() == before || bytes[before..].contains(&0) {
            return Ok(bytes);
        }
    }
}

/// Opens a regular file; anything else is an error.
///
/// # Errors
///
/// Those of opening, and that it is none.
pub fn open_regular(path: &Path) -> io::Result<File> {
    // Before it is opened: that alone may wait for somebody to write to a pipe.
    let found = fs::metadata(path)?;
    // Opening a folder fails, or reading from it does, by an error that says so.
    if !found.is_file() && !found.is_dir() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
    }
    File::open(path)
}

/// Whether a path leads to a named pipe. (Pipes without a name, as behind `/dev/stdin`, have a writer.)
#[cfg(unix)]
fn is_named_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;

    // Where `/dev/fd` has links, those to pipes without a name lead nowhere; elsewhere it has files.
    let target = path.canonicalize().ok().filter(|target| !target.starts_with("/dev"));
    let found = target.and_then(|target| target.metadata().ok());
    found.is_some_and(|found| found.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_named_pipe(_: &Path) -> bool {
    false
}
