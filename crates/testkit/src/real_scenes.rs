//! Where real scenes are.

use std::io::Write;
use std::path::PathBuf;

/// The folder that `BINSPACE_SCENES` names; without it, says what is skipped, also where the output of
/// tests that pass is not shown.
pub fn folder(what: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("BINSPACE_SCENES").map(PathBuf::from);
    if folder.is_none() {
        let reason = "BINSPACE_SCENES does not name the folder of real scenes";
        let _ = writeln!(std::io::stderr().lock(), "skipped: {what}: {reason}");
    }
    folder
}
