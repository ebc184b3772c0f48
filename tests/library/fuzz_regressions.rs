//! Replays inputs on which a fuzz target once failed, and some seeds.

use std::path::Path;
use testkit::prelude::*;
use testkit::targets;

type Target = (&'static str, fn(&[u8]));

const TARGETS: [Target; 9] = [
    ("split", targets::split::run),
    ("tree", targets::tree::run),
    ("cells", targets::cells::run),
    ("faces", targets::faces::run),
    ("large", targets::large::run),
    ("saved", targets::saved::run),
    ("query", targets::query::run),
    ("drawing", targets::drawing::run),
    ("obj", targets::obj::run),
];

/// Runs each target on every file of its folder; the file's name describes it.
#[test]
fn regressions_of_every_target_pass() {
    let folders = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/regressions");
    let entries = |folder: &Path| std::fs::read_dir(folder).expect("a folder of regressions");
    assert_eq!(entries(&folders).count(), TARGETS.len(), "a folder of each target");
    for (target, run) in TARGETS {
        let mut count = 0;
        for entry in entries(&folders.join(target)) {
            let path = entry.expect("an entry").path();
            let bytes = std::fs::read(&path).expect("a readable file");
            let outcome = std::panic::catch_unwind(|| run(&bytes));
            assert!(outcome.is_ok(), "fails on {}", path.display());
            count += 1;
        }
        enough!(count > 0; "nothing for {target}");
    }
}
