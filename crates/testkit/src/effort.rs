//! The effort of tests, which only this module decides.
//!
//! `BINSPACE_EFFORT=10 cargo test` tries ten times as many scenes, rays and cases.

use proptest::test_runner::{Config, FileFailurePersistence};
use std::ops::Range;
use std::path::Path;
use std::sync::LazyLock;

/// Returns the effort: `BINSPACE_EFFORT`, and 1 without it.
pub fn effort() -> usize {
    static EFFORT: LazyLock<usize> = LazyLock::new(|| match std::env::var("BINSPACE_EFFORT") {
        Ok(text) => match text.parse() {
            Ok(effort @ 1..) => effort,
            _ => panic!("BINSPACE_EFFORT is a whole number from 1, not {text:?}"),
        },
        Err(_) => 1,
    });
    *EFFORT
}

/// Returns a number of scenes, rays or rounds, times the effort.
pub fn times(count: usize) -> usize {
    count * effort()
}

/// Returns the seeds of a number of scenes, times the effort.
pub fn seeds(count: u64) -> Range<u64> {
    0..count * effort() as u64
}

/// Returns the options of a property test: `count` cases, times the effort. Failing cases are kept in
/// `tests/proptest-regressions`, in a file named after the source file, and are tried first.
pub fn cases(count: usize, source: &'static str) -> Config {
    let path = Path::new(source);
    let stem = match path.file_stem().expect("a source file") {
        name if name == "mod" => path.parent().and_then(Path::file_name).expect("a folder"),
        name => name,
    };
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/proptest-regressions");
    let file = Path::new(folder).join(stem).with_extension("txt");
    let kept: &'static str = file.to_string_lossy().into_owned().leak();
    Config {
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(kept))),
        source_file: Some(source),
        ..Config::with_cases(times(count) as u32)
    }
}
