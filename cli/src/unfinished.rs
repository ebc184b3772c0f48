//! Files that are still being written, under names of their own; none is left behind.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The files that are there now. Whoever makes, moves or removes one holds this meanwhile.
static FILES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// So many names are tried where others of this process, or left by one that was killed, are taken.
const TRIES: u32 = 1000;

fn files() -> MutexGuard<'static, Vec<PathBuf>> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes a new file in the folder of another, by a short name, as the other's may be as long as
/// names can be.
pub(crate) fn create_beside(target: &Path) -> io::Result<(File, PathBuf)> {
    remove_on_signals();
    let mut files = files();
    for number in 0..TRIES {
        let name = format!(".binspace-{}-{number}.part", std::process::id());
        let path = target.with_file_name(OsString::from(name));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => {
                files.push(path.clone());
                return Ok((file, path));
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

/// Puts a finished file in its place.
pub(crate) fn place(path: &Path, target: &Path) -> io::Result<()> {
    let mut files = files();
    fs::rename(path, target)?;
    files.retain(|file| file != path);
    Ok(())
}

/// Removes a file that will not be finished.
pub(crate) fn remove(path: &Path) {
    let mut files = files();
    // Not there, or not to be removed: there is nothing more to do about it.
    let _ = fs::remove_file(path);
    files.retain(|file| file != path);
}

/// From now on, SIGINT and SIGTERM remove the files before they end the program as they would.
#[cfg(unix)]
fn remove_on_signals() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    static START: std::sync::Once = std::sync::Once::new();
    START.call_once(|| {
        // Without it a file may be left behind, but none is half written.
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else { return };
        std::thread::spawn(move || {
            for signal in signals.forever() {
                let files = files();
                for path in files.iter() {
                    let _ = fs::remove_file(path);
                }
                // Ends the program; while it does, no file is made.
                let _ = signal_hook::low_level::emulate_default_handler(signal);
            }
        });
    });
}

#[cfg(not(unix))]
fn remove_on_signals() {}
