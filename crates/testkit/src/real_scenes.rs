//! The folder of real scenes. Tests that need them are ignored, and have `real_scenes` in their names, so
//! that `cargo test real_scenes -- --ignored` runs them.

use std::path::PathBuf;

/// Returns the folder that `BINSPACE_SCENES` names.
pub fn folder() -> PathBuf {
    let folder = std::env::var_os("BINSPACE_SCENES");
    PathBuf::from(folder.expect("BINSPACE_SCENES names the folder of real scenes"))
}
