//! Which file imports which, read from the sources: layers point one way, and no files import each
//! other in a circle.
//!
//! A file with methods of a type also needs another that adds methods to it, if they call those.

mod graph;
mod imports;
mod judge;
mod methods;
mod tokens;

use graph::Graph;
use std::fs;
use std::path::{Path, PathBuf};

/// What every layer may import.
const GROUND: [&str; 10] = [
    "bits",
    "error",
    "frustum",
    "input",
    "memory",
    "parallel_map",
    "random",
    "ray",
    "save",
    "viewpoint",
];

/// The layers that are built on the ground, each with those before it that it may import.
const LAYERS: &[(&str, &[&str])] = &[
    ("exact", &[]),
    ("faces", &["exact"]),
    ("partition", &["exact", "faces"]),
    ("tree", &["exact", "faces"]),
    ("build", &["exact", "faces", "partition", "tree"]),
    ("layers", &["faces", "tree", "build"]),
    ("overlay", &["exact", "faces", "tree", "build"]),
    ("query", &["exact", "tree"]),
    ("view", &[]),
    ("scene", &[]),
    // The judge of the order knows nothing of trees, nor of where polygons come from.
    ("raster", &["exact", "view"]),
    ("paint", &["exact", "tree", "raster"]),
    ("verify", &["exact", "tree", "view", "raster", "paint"]),
    ("occlusion", &["tree", "raster", "paint"]),
    ("drawing", &["exact", "tree", "build", "overlay", "raster"]),
    // Pages of text.
    ("guide", &[]),
];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn evidence() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/evidence/src")
}

/// Every Rust file below a folder, by its path inside, with its text; sorted.
fn files(folder: &Path) -> Vec<(PathBuf, String)> {
    let (mut folders, mut found) = (vec![folder.to_path_buf()], Vec::new());
    while let Some(inner) = folders.pop() {
        for entry in fs::read_dir(inner).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).expect("text");
                found.push((path.strip_prefix(folder).expect("inside").to_path_buf(), text));
            }
        }
    }
    found.sort();
    found
}

/// Whether a file is of the library itself, and no test of it.
fn is_own(path: &Path) -> bool {
    path.iter().all(|part| part != "tests" && part != "tests.rs")
}

fn graph(folder: &Path) -> Graph {
    let files = files(folder).into_iter().filter(|(path, _)| is_own(path));
    let graph = Graph::new(files.collect());
    assert!(graph.arrows().count() > 20, "too few imports are found");
    graph
}

/// What is wrong with an import, if anything is.
fn fault(from: &Path, to: &Path) -> Option<String> {
    let [own, other] = [from, to].map(layer);
    let may = match LAYERS.iter().find(|(name, _)| *name == own) {
        Some((_, may)) => *may,
        None if GROUND.contains(&own.as_str()) => &[],
        None => return Some(format!("{own} is no layer: {}", from.display())),
    };
    let is_allowed =
        own == other || GROUND.contains(&other.as_str()) || may.contains(&other.as_str());
    (!is_allowed).then(|| format!("{} imports {}", from.display(), to.display()))
}

/// The layer that a file belongs to: the first part of its path.
fn layer(path: &Path) -> String {
    let first = path.iter().next().expect("a name").to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

#[test]
fn layers_import_those_before_them() {
    for (at, (name, may)) in LAYERS.iter().enumerate() {
        for other in *may {
            assert!(LAYERS[..at].iter().any(|(before, _)| before == other), "{name} → {other}");
        }
    }
}

#[test]
fn a_wrong_arrow_is_a_fault() {
    let fault = |from: &str, to: &str| fault(Path::new(from), Path::new(to)).is_some();
    assert!(!fault("build/threads.rs", "tree/node.rs") && !fault("build/threads.rs", "error.rs"));
    assert!(!fault("error.rs", "input.rs") && !fault("exact/int.rs", "exact/plane.rs"));
    assert!(fault("tree/node.rs", "build/threads.rs") && fault("error.rs", "exact/int.rs"));
    assert!(fault("other.rs", "error.rs") && fault("tree/node.rs", "lib.rs"));
}

#[test]
fn arrows_point_one_way() {
    let faults: Vec<String> = (graph(&source()).arrows())
        .filter(|(from, _)| *from != Path::new("lib.rs"))
        .filter_map(|(from, to)| fault(from, to))
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let circles = [source(), evidence()].map(|folder| graph(&folder).circles());
    assert!(circles.iter().all(Vec::is_empty), "{}", circles.concat().join("\n"));
}

#[test]
fn the_judge_borrows_no_arithmetic() {
    let graph = graph(&source());
    let predicates: Vec<String> =
        ["exact/vertex.rs", "exact/barycentric.rs", "exact/rounded_vertex.rs", "exact/along.rs"]
            .iter()
            .flat_map(|file| judge::methods_of_faces(graph.text(Path::new(file))))
            .collect();
    assert!(predicates.len() >= 5, "{predicates:?}");
    let mut checked = 0;
    for (path, text) in graph.files().filter(|(path, _)| path.starts_with("raster")) {
        let mut found = judge::calls(text, &predicates);
        found.extend(judge::foreign(graph.paths(path)));
        assert!(found.is_empty(), "{} takes {found:?} from exact", path.display());
        checked += 1;
    }
    assert!(checked > 10, "only {checked} files found");
}

#[test]
fn no_file_is_longer_than_450_lines() {
    for folder in [source(), evidence()] {
        for (path, text) in files(&folder) {
            let lines = text.lines().count();
            assert!(lines <= 450, "{} has {lines} lines", path.display());
        }
    }
}
