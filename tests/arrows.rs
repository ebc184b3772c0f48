//! The layers of the library, read from its sources.

use std::fs;
use std::path::{Path, PathBuf};

/// Each layer with what it may import: arrows point to the left.
const LAYERS: [(&str, &[&str]); 10] = [
    ("error", &["geom"]),
    ("geom", &["error"]),
    ("random", &[]),
    ("bsp", &["error", "geom", "random"]),
    ("view", &["error", "geom", "random"]),
    ("scene", &["error", "geom", "random", "view"]),
    // The judge of the order knows nothing of trees, nor of where polygons come from.
    ("raster", &["error", "geom", "random", "view"]),
    ("measure", &["error", "geom", "view", "raster"]),
    ("verify", &["error", "geom", "bsp", "view", "scene", "raster"]),
    ("method", &["error", "geom", "random", "bsp", "view", "scene", "raster", "verify"]),
];

/// What stands at the crate's root, and where it comes from.
const ROOT: [(&str, &str); 15] = [
    ("Accuracy", "bsp"),
    ("BspTree", "bsp"),
    ("BuildOptions", "bsp"),
    ("Fragment", "bsp"),
    ("Heuristic", "bsp"),
    ("Invalid", "bsp"),
    ("Ordered", "bsp"),
    ("ParseHeuristicError", "bsp"),
    ("Partition", "bsp"),
    ("Progress", "bsp"),
    ("Stats", "bsp"),
    ("Error", "error"),
    ("Point", "geom"),
    ("Polygon", "geom"),
    ("Viewpoint", "geom"),
];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Every Rust file below a folder, with its text.
fn files(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut folders = vec![folder.to_path_buf()];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).expect("text");
                found.push((path, text));
            }
        }
    }
    found
}

/// The layer that a file belongs to: the first part of its path under `src`.
fn layer(path: &Path) -> String {
    let inside = path.strip_prefix(source()).expect("below src");
    let first = inside.iter().next().expect("a name").to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

/// The layers that a text names by `crate::`, comments left out.
fn imports(text: &str) -> Vec<String> {
    let code: String = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join(" ");
    let mut names = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        // `pub(crate)` is followed by no `::`; `$crate::` and a longer path are none of ours.
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &code[at + "crate::".len()..];
        let list = match rest.strip_prefix('{') {
            Some(group) => group.split('}').next().unwrap_or_default(),
            None => rest,
        };
        let items: Vec<&str> =
            if rest.starts_with('{') { list.split(',').collect() } else { vec![list] };
        for item in items {
            let end = |c: char| !c.is_alphanumeric() && c != '_';
            let name = item.trim().split(end).next().unwrap_or_default();
            if !name.is_empty() {
                names.push(name.to_owned());
            }
        }
    }
    let home = |name: String| {
        ROOT.iter().find(|(item, _)| *item == name).map_or(name, |(_, home)| (*home).to_owned())
    };
    names.into_iter().map(home).collect()
}

#[test]
fn imports_are_found_however_they_are_written() {
    let text = "use crate::geom::{Faces, Lattice};\nuse crate::{\n    BspTree,\n    view::Camera,\n};\n\
                fn f() -> crate::Error {} // crate::raster\npub(crate) use other_crate::bsp;";
    assert_eq!(imports(text), ["geom", "bsp", "view", "error"]);
}

#[test]
fn arrows_point_one_way() {
    let mut checked = 0;
    for (path, text) in files(&source()) {
        let own = layer(&path);
        if own == "lib" {
            continue;
        }
        let Some((_, allowed)) = LAYERS.iter().find(|(name, _)| *name == own) else {
            panic!("{own} is no layer: {}", path.display());
        };
        for import in imports(&text) {
            let fits = import == own || allowed.contains(&import.as_str());
            assert!(fits, "{} imports {import}", path.display());
            checked += 1;
        }
    }
    assert!(checked > 20, "only {checked} imports found");
}

#[test]
fn no_file_is_longer_than_450_lines() {
    for (path, text) in files(&source()) {
        let lines = text.lines().count();
        assert!(lines <= 450, "{} has {lines} lines", path.display());
    }
}
