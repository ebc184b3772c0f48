//! Every source file is compiled by some target: a test file that no `mod` names would never run.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Folders whose files must all be reached.
const FOLDERS: [&str; 7] = ["src", "tests", "crates", "benches", "cli", "fuzz", "distributed/src"];

/// Where packages are; what their manifests name, and what cargo finds by itself, is compiled.
const PACKAGES: [&str; 7] =
    ["", "benches", "cli", "crates/evidence", "distributed", "fuzz", "tests/alone"];

fn package() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every Rust file below a folder, if there is the folder.
fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let (mut folders, mut found) = (vec![folder.to_path_buf()], BTreeSet::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                // What is built is nobody's source.
                if !path.ends_with("target") {
                    folders.push(path);
                }
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.insert(path);
            }
        }
    }
    found
}

/// The roots of a package's targets: what its manifest names, and what cargo finds by itself,
/// unless the manifest forbids it.
fn roots(package: &Path, manifest: &str) -> Vec<PathBuf> {
    let value =
        |line: &str| Some(line.strip_prefix("path = \"")?.strip_suffix(".rs\"")?.to_owned());
    let named = manifest.lines().filter_map(value).map(|path| package.join(path + ".rs"));
    let mut found: Vec<PathBuf> = named.collect();
    let mains = [("build.rs", "build"), ("src/lib.rs", "autolib"), ("src/main.rs", "autobins")];
    for (main, key) in mains {
        found.extend((!forbids(manifest, key)).then(|| package.join(main)));
    }
    for (folder, key) in [("tests", "autotests"), ("benches", "autobenches")] {
        if forbids(manifest, key) {
            continue;
        }
        for entry in fs::read_dir(package.join(folder)).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            let is_source = path.extension().is_some_and(|extension| extension == "rs");
            found.push(if is_source { path } else { path.join("main.rs") });
        }
    }
    found.retain(|root| root.exists());
    found
}

fn forbids(manifest: &str, key: &str) -> bool {
    manifest.lines().any(|line| line == format!("{key} = false"))
}

/// The modules that a file declares in files of their own, each with its `#[path]`, if it has one.
fn modules(text: &str) -> Vec<(String, Option<String>)> {
    let (mut found, mut path) = (Vec::new(), None);
    for line in text.lines().map(str::trim) {
        if let Some(rest) = line.strip_prefix("#[path = \"") {
            path = rest.strip_suffix("\"]").map(str::to_owned);
            continue;
        }
        let mut item = line.split("//").next().unwrap_or_default().trim();
        if item.starts_with("pub") {
            item = item.split_once(' ').map_or("", |(_, rest)| rest);
        }
        let name = item.strip_prefix("mod ").and_then(|rest| rest.strip_suffix(';'));
        // Not what a text in quotes says.
        let is_name = |name: &&str| name.chars().all(|c| c.is_alphanumeric() || c == '_');
        if let Some(name) = name.filter(is_name) {
            found.push((name.trim().to_owned(), path.take()));
        } else if !line.starts_with('#') {
            path = None;
        }
    }
    found
}

/// The file of a module that another file declares.
fn home(declaring: &Path, is_root: bool, (name, path): (String, Option<String>)) -> PathBuf {
    let folder = declaring.parent().expect("a folder");
    if let Some(path) = path {
        return plain(&folder.join(path));
    }
    let is_folder_s = is_root || declaring.file_name().is_some_and(|name| name == "mod.rs");
    let inside = if is_folder_s { folder.to_path_buf() } else { declaring.with_extension("") };
    let [file, nested] = [inside.join(format!("{name}.rs")), inside.join(name).join("mod.rs")];
    if nested.exists() { nested } else { file }
}

/// A path without `..`.
fn plain(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut plain, part| {
        match part {
            Component::ParentDir => drop(plain.pop()),
            part => plain.push(part),
        }
        plain
    })
}

/// All files that some root of a package reaches.
fn compiled() -> BTreeSet<PathBuf> {
    let mut reached = BTreeSet::new();
    for package in PACKAGES.map(|folder| package().join(folder)) {
        let manifest = fs::read_to_string(package.join("Cargo.toml")).expect("a manifest");
        let roots = roots(&package, &manifest);
        assert!(!roots.is_empty(), "{} has no targets", package.display());
        let mut next: Vec<(PathBuf, bool)> = roots.into_iter().map(|root| (root, true)).collect();
        while let Some((file, is_root)) = next.pop() {
            let text = fs::read_to_string(&file);
            let text = text.unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            reached.insert(file.clone());
            for module in modules(&text) {
                let home = home(&file, is_root, module);
                if !reached.contains(&home) {
                    next.push((home, false));
                }
            }
        }
    }
    reached
}

#[test]
fn declarations_are_found_however_they_are_written() {
    let text = "mod a;\npub(crate) mod b; // b\n#[cfg(test)]\n#[path = \"../c/mod.rs\"]\n\
                #[allow(dead_code)]\npub mod c;\nmod inline {\n    mod d;\n}\n// mod e;\n";
    let found = modules(text);
    let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["a", "b", "c", "d"]);
    let paths: Vec<Option<&str>> = found.iter().map(|(_, path)| path.as_deref()).collect();
    assert_eq!(paths, [None, None, Some("../c/mod.rs"), None]);
    let package = package().join("tests");
    let home = |file: &str, module: usize| {
        let home = home(&package.join(file), file.ends_with("main.rs"), found[module].clone());
        home.strip_prefix(&package).expect("below the tests").to_path_buf()
    };
    assert_eq!(home("tree/main.rs", 2), Path::new("c/mod.rs"));
    assert_eq!(home("tree/main.rs", 0), Path::new("tree/a.rs"));
    assert_eq!(home("tree/b.rs", 0), Path::new("tree/b/a.rs"));
}

#[test]
fn roots_are_those_that_cargo_compiles() {
    let inside = |folder: &str, manifest: &str| -> BTreeSet<String> {
        let folder = package().join(folder);
        let roots = roots(&folder, manifest).into_iter();
        let inside = |root: PathBuf| root.strip_prefix(&folder).map(|r| r.display().to_string());
        roots.map(|root| inside(root).expect("below the folder")).collect()
    };
    let benches = inside("benches", "autobenches = false\nbuild = false\npath = \"order.rs\"\n");
    assert_eq!(benches.into_iter().collect::<Vec<_>>(), ["order.rs"]);
    let own = inside("", "autobenches = false\n");
    assert!(own.contains("src/lib.rs") && own.contains("tests/compiled.rs"));
    assert!(own.contains("tests/tree/main.rs") && !own.contains("src/main.rs"));
    assert!(own.iter().all(|root| !root.starts_with("benches")));
    let fewer = inside("", "autotests = false\n");
    assert!(fewer.iter().all(|root| !root.starts_with("tests")));
    assert!(inside("cli", "").contains("build.rs"));
}

#[test]
fn every_source_file_is_compiled_by_some_target() {
    let (reached, mut count) = (compiled(), 0);
    for folder in FOLDERS.map(|folder| package().join(folder)) {
        for file in files(&folder) {
            assert!(reached.contains(&file), "no target compiles {}", file.display());
            count += 1;
        }
    }
    assert!(count > 200, "only {count} files");
}

/// A package that no one names here would not be looked at.
#[test]
fn every_package_is_known() {
    let mut folders = vec![package()];
    let mut found = BTreeSet::new();
    while let Some(folder) = folders.pop() {
        if folder.join("Cargo.toml").exists() {
            let inside = folder.strip_prefix(package()).expect("below the package");
            found.insert(inside.display().to_string());
        }
        let entries =
            fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let is_source = |path: &PathBuf| {
            let name = path.file_name().expect("a name").to_string_lossy();
            path.is_dir() && name != "target" && !name.starts_with('.')
        };
        folders.extend(entries.filter(is_source));
    }
    assert_eq!(found, PACKAGES.map(String::from).into());
}

/// Cases that proptest found fail again for everybody only if they are in the repository.
#[test]
fn cases_that_proptest_found_are_not_ignored() {
    let ignored = package().join(".gitignore");
    // A package without its repository has none.
    let lines = fs::read_to_string(ignored).unwrap_or_default();
    assert!(!lines.contains("proptest"), "{lines}");
}
