//! Properties held against many cases, and loops over scenes: how many, one place decides.

use proptest::prelude::*;
use proptest::test_runner::{FileFailurePersistence, TestCaseError, TestRunner};
use std::cell::RefCell;
use std::path::Path;
use std::sync::LazyLock;

/// By how much scenes, rays and cases are multiplied: `BINSPACE_EFFORT`, 1 without it.
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

/// Options for a property: this many cases times the effort. Failing cases are kept in
/// `tests/proptest-regressions`, in a file named after the source file, and come first.
pub fn cases(count: usize, source: &'static str) -> ProptestConfig {
    let path = Path::new(source);
    let stem = match path.file_stem().expect("a source file") {
        name if name == "mod" => path.parent().and_then(Path::file_name).expect("a folder"),
        name => name,
    };
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/proptest-regressions");
    let file = Path::new(folder).join(stem).with_extension("txt");
    let kept: &'static str = file.to_string_lossy().into_owned().leak();
    ProptestConfig {
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(kept))),
        source_file: Some(source),
        ..ProptestConfig::with_cases((count * effort()) as u32)
    }
}

/// Holds a property against this many cases, times the effort, and gives back what they counted.
pub fn tally<S: Strategy, T: Default>(
    source: &'static str,
    count: usize,
    strategy: S,
    property: impl Fn(&mut T, S::Value) -> Result<(), TestCaseError>,
) -> T {
    let total = RefCell::new(T::default());
    let result = TestRunner::new(cases(count, source))
        .run(&strategy, |value| property(&mut total.borrow_mut(), value));
    if let Err(error) = result {
        panic!("{error}");
    }
    total.into_inner()
}
