//! The library's modules, which are the files and folders of `src`, have no import cycle.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The text of a module's files, without comments and without the tests at the end of each file.
fn text_of(path: &Path) -> String {
    if path.file_stem().is_some_and(|name| name == "tests") {
        return String::new();
    }
    if path.is_dir() {
        let entries = fs::read_dir(path).expect("a folder").map(|entry| entry.expect("one").path());
        return entries.map(|path| text_of(&path)).collect();
    }
    let text = fs::read_to_string(path).expect("text");
    let (text, _) = text.split_once("#[cfg(test)]\nmod ").unwrap_or((&text, ""));
    text.lines().filter(|line| !line.trim_start().starts_with("//")).collect()
}

/// The names that follow `crate::`, alone or in braces.
fn imports(text: &str) -> impl Iterator<Item = &str> {
    text.split("crate::").skip(1).flat_map(|rest| {
        let of_group = rest.strip_prefix('{').map_or("", |group| group.split("};").next().unwrap());
        let of_group = of_group.split([',', '{', '}', ' ']).map(|path| path.split("::").next());
        of_group.flatten().chain(rest.split(|c: char| !c.is_alphanumeric() && c != '_').take(1))
    })
}

#[test]
fn modules_import_one_way() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src");
    let mut texts: BTreeMap<String, String> = BTreeMap::new();
    for entry in fs::read_dir(source).expect("the sources") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        texts.entry(name).or_default().push_str(&text_of(&path));
    }
    texts.remove("lib");
    let mut left: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (name, text) in &texts {
        let named = imports(text).filter(|&other| other != name && texts.contains_key(other));
        left.insert(name, named.collect());
    }
    assert!(left.values().map(BTreeSet::len).sum::<usize>() > 20, "too few imports are found");
    // Modules that import no other module are removed repeatedly, until no module is left.
    while let Some(name) = left.iter().find(|(_, of)| of.is_empty()).map(|(&name, _)| name) {
        left.remove(name);
        left.values_mut().for_each(|of| _ = of.remove(name));
    }
    assert!(left.is_empty(), "these modules import each other in a circle: {left:#?}");
}
