//! Inputs that a fuzz target once failed on, and a few to start from, replayed.

use std::path::Path;
use testkit::enough;
use testkit::targets;

/// Runs a target on every file of its folder; the file's name says what it is about.
fn replay(target: &str, run: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/regressions").join(target);
    let mut count = 0;
    for entry in std::fs::read_dir(&folder).expect("the folder of regressions") {
        let path = entry.expect("an entry").path();
        let bytes = std::fs::read(&path).expect("a readable file");
        let outcome = std::panic::catch_unwind(|| run(&bytes));
        assert!(outcome.is_ok(), "fails on {}", path.display());
        count += 1;
    }
    enough!(count > 0; "nothing in {}", folder.display());
}

#[test]
fn split_regressions_pass() {
    replay("split", targets::split::run);
}

#[test]
fn tree_regressions_pass() {
    replay("tree", targets::tree::run);
}

#[test]
fn cells_regressions_pass() {
    replay("cells", targets::cells::run);
}

#[test]
fn faces_regressions_pass() {
    replay("faces", targets::faces::run);
}

#[test]
fn large_regressions_pass() {
    replay("large", targets::large::run);
}

#[test]
fn saved_regressions_pass() {
    replay("saved", targets::saved::run);
}

#[test]
fn query_regressions_pass() {
    replay("query", targets::query::run);
}

#[test]
fn drawing_regressions_pass() {
    replay("drawing", targets::drawing::run);
}

#[test]
fn obj_regressions_pass() {
    replay("obj", targets::obj::run);
}
