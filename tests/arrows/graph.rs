//! The files of a crate, and which imports which.

use crate::imports::{Imports, Named, imports};
use crate::methods::Added;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

/// Names of modules from the crate's root on.
type Names = Vec<String>;

pub(crate) struct Graph {
    files: Vec<File>,
    /// The file of each module that has one of its own.
    modules: BTreeMap<Names, usize>,
    /// The files that each file imports.
    imported: Vec<BTreeSet<usize>>,
}

struct File {
    path: PathBuf,
    text: String,
    module: Names,
    imports: Imports,
}

impl Graph {
    pub(crate) fn new(files: Vec<(PathBuf, String)>) -> Self {
        let file = |(path, text): (PathBuf, String)| File {
            module: module(&path),
            imports: imports(&text),
            path,
            text,
        };
        let files: Vec<File> = files.into_iter().map(file).collect();
        let module = |(at, file): (usize, &File)| (file.module.clone(), at);
        let modules = files.iter().enumerate().map(module).collect();
        let mut graph = Self { files, modules, imported: vec![] };
        graph.imported = (0..graph.files.len()).map(|file| graph.imports_of(file)).collect();
        for (file, child) in graph.calls_of_added() {
            graph.imported[file].insert(child);
        }
        graph
    }

    /// Each file whose methods of a type call methods that another file adds to that type, with that
    /// other file.
    fn calls_of_added(&self) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        let types: Vec<_> = (0..self.files.len()).flat_map(|file| self.added_by(file)).collect();
        for (child, home, added) in &types {
            let same = types.iter().filter(|(_, other, to)| other == home && to.to == added.to);
            for file in same.map(|(file, ..)| *file).chain([*home]) {
                let calls = &self.files[file].imports.own_calls;
                if file != *child && !calls.is_disjoint(&added.methods) {
                    found.push((file, *child));
                }
            }
        }
        found
    }

    /// What a file adds to types of other files: itself, and for each the file of the type.
    fn added_by(&self, child: usize) -> impl Iterator<Item = (usize, usize, &Added)> {
        let file = &self.files[child];
        file.imports.added.iter().filter_map(move |added| {
            let named = Named { path: vec![added.to.clone()], within: vec![] };
            let home = self.home(&self.absolute(file, &named)?, 0)?;
            (home != child).then_some((child, home, added))
        })
    }

    pub(crate) fn files(&self) -> impl Iterator<Item = (&Path, &str)> {
        self.files.iter().map(|file| (file.path.as_path(), file.text.as_str()))
    }

    pub(crate) fn text(&self, path: &Path) -> &str {
        self.files().find(|(own, _)| *own == path).expect("a file").1
    }

    /// Every import, as a file and another that it imports.
    pub(crate) fn arrows(&self) -> impl Iterator<Item = (&Path, &Path)> {
        let path = |file: usize| self.files[file].path.as_path();
        let of = move |(from, to): (usize, &'_ BTreeSet<usize>)| {
            to.iter().map(move |&to| (path(from), path(to))).collect::<Vec<_>>()
        };
        self.imported.iter().enumerate().flat_map(of)
    }

    /// The paths inside the crate that a file names, from the crate's root on.
    pub(crate) fn paths(&self, path: &Path) -> Vec<Names> {
        let file = self.files.iter().find(|file| file.path == path).expect("a file");
        let Imports { uses, paths, .. } = &file.imports;
        let all = uses.iter().map(|found| &found.named).chain(paths);
        all.filter_map(|named| self.absolute(file, named)).collect()
    }

    /// The shortest circle through each file that is on one, each circle once.
    pub(crate) fn circles(&self) -> Vec<String> {
        let circles = (0..self.files.len()).filter_map(|file| self.circle(file));
        let mut by_members: BTreeMap<BTreeSet<usize>, Vec<usize>> = BTreeMap::new();
        for circle in circles {
            by_members.entry(circle.iter().copied().collect()).or_insert(circle);
        }
        let path = |&file: &usize| self.files[file].path.display().to_string();
        by_members
            .values()
            .map(|circle| circle.iter().map(path).collect::<Vec<_>>().join(" → "))
            .collect()
    }

    /// The shortest circle from a file to itself.
    fn circle(&self, start: usize) -> Option<Vec<usize>> {
        let mut before = BTreeMap::new();
        let mut next = VecDeque::from([start]);
        while let Some(file) = next.pop_front() {
            for &to in &self.imported[file] {
                if before.contains_key(&to) {
                    continue;
                }
                before.insert(to, file);
                next.push_back(to);
            }
        }
        let mut circle = vec![start];
        let mut file = *before.get(&start)?;
        while file != start {
            circle.push(file);
            file = before[&file];
        }
        circle.push(start);
        circle.reverse();
        Some(circle)
    }

    fn imports_of(&self, own: usize) -> BTreeSet<usize> {
        let file = &self.files[own];
        let mut found = BTreeSet::new();
        for import in &file.imports.uses {
            let Some(path) = self.absolute(file, &import.named) else { continue };
            // A parent that hands on what its children define needs none of it.
            let is_handed_on = import.is_public && path.starts_with(&file.module);
            if !is_handed_on {
                found.extend(self.home(&path, 0));
            }
        }
        for named in &file.imports.paths {
            found.extend(self.absolute(file, named).and_then(|path| self.home(&path, 0)));
        }
        found.remove(&own);
        found
    }

    /// A path from the crate's root on; none if it leads out of the crate, or if it is a name of
    /// the file itself.
    fn absolute(&self, file: &File, Named { path, within }: &Named) -> Option<Names> {
        let mut module: Names = file.module.iter().chain(within).cloned().collect();
        let ups = path.iter().take_while(|part| *part == "super").count();
        let first = path[0].as_str();
        let rest = match first {
            "crate" => {
                module.clear();
                &path[1..]
            }
            "self" => &path[1..],
            "super" => {
                module.truncate(module.len().checked_sub(ups)?);
                &path[ups..]
            }
            // Modules of its own, and what it hands on and uses too. A word alone is no module.
            _ if within.is_empty() => {
                let is_child =
                    path.len() > 1 && file.imports.modules.iter().any(|own| own == first);
                let is_used = file.imports.uses.iter().any(|found| {
                    found.name == first
                        && found.named.path != *path
                        && found.named.within.is_empty()
                });
                (is_child || is_used).then_some(())?;
                &path[..]
            }
            _ => return None,
        };
        module.extend_from_slice(rest);
        Some(module)
    }

    /// The file that defines what a path leads to; none outside of the crate.
    fn home(&self, path: &[String], depth: usize) -> Option<usize> {
        assert!(depth < 32, "{path:?} leads nowhere");
        let mut at = *self.modules.get(&[][..])?;
        for (index, name) in path.iter().enumerate() {
            let inner = &path[..=index];
            let is_last = index + 1 == path.len();
            let module = self.modules.get(inner).copied();
            if let Some(module) = module.filter(|_| !is_last) {
                at = module;
                continue;
            }
            let file = &self.files[at];
            let used = file
                .imports
                .uses
                .iter()
                .find(|found| found.name == *name && found.named.within.is_empty());
            let Some(used) = used else { return module.or(Some(at)) };
            let mut target = self.absolute(file, &used.named)?;
            target.extend_from_slice(&path[index + 1..]);
            return self.home(&target, depth + 1);
        }
        Some(at)
    }
}

/// The module that a file is.
fn module(path: &Path) -> Names {
    let mut names: Names =
        path.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if names.last().is_some_and(|last| last == "mod" || last == "lib") {
        names.pop();
    }
    names
}

#[cfg(test)]
mod tests {
    use super::Graph;
    use std::path::PathBuf;

    fn graph(files: &[(&str, &str)]) -> Graph {
        let file = |&(path, text): &(&str, &str)| (PathBuf::from(path), text.to_owned());
        Graph::new(files.iter().map(file).collect())
    }

    fn arrows(files: &[(&str, &str)]) -> Vec<String> {
        let graph = graph(files);
        let arrows = graph.arrows();
        arrows.map(|(from, to)| format!("{} {}", from.display(), to.display())).collect()
    }

    const LIB: (&str, &str) = ("lib.rs", "mod a; mod b; pub use a::Item; pub use glam;");

    #[test]
    fn what_is_handed_on_is_imported_from_where_it_is_defined() {
        let a = ("a/mod.rs", "mod c; mod d; pub use c::Item; pub(crate) use d::item as other;");
        let of = |text| arrows(&[LIB, a, ("a/c.rs", ""), ("a/d.rs", ""), ("b.rs", text)]);
        assert_eq!(of("use crate::Item;"), ["b.rs a/c.rs"]);
        assert_eq!(of("use crate::a::{Item, other};"), ["b.rs a/c.rs", "b.rs a/d.rs"]);
        assert_eq!(
            of("fn f() -> crate::a::d::X { super::Item::new() }"),
            ["b.rs a/c.rs", "b.rs a/d.rs"]
        );
        assert_eq!(of("use crate::a; fn f() { a::other() }"), ["b.rs a/mod.rs", "b.rs a/d.rs"]);
        assert_eq!(of("use crate::a::Else;"), ["b.rs a/mod.rs"]);
        assert_eq!(of("use glam::X; use crate::glam::Y; // crate::Item"), [""; 0]);
    }

    #[test]
    fn circles_are_found_up_down_and_beside() {
        let circles = |c, d| graph(&[LIB, ("a.rs", c), ("a/d.rs", d), ("b.rs", "")]).circles();
        assert_eq!(circles("mod d; pub use d::X; struct Item;", "use super::Item;"), [""; 0]);
        assert_eq!(
            circles("mod d; use d::X; struct Item;", "use super::Item;"),
            ["a.rs → a/d.rs → a.rs"]
        );
        let handed_on = circles("mod d; pub use d::X; fn f(x: X) {}", "use super::Item;");
        assert_eq!(handed_on, ["a.rs → a/d.rs → a.rs"]);
        assert_eq!(circles("mod d; fn f() { d::X }", "use super::super::b::Y;"), [""; 0]);
        let adds = "use super::Item; impl Item { pub(super) fn f(&self) {} }";
        assert_eq!(circles("mod d; struct Item;", adds), [""; 0]);
        let calls = circles("mod d; struct Item; impl Item { fn g(&self) { self.f() } }", adds);
        assert_eq!(calls, ["a.rs → a/d.rs → a.rs"]);
        let b = ("b.rs", "use crate::a::d::X;");
        let three = [LIB, ("a.rs", "use crate::b::Z;"), ("a/d.rs", "use super::Y;"), b];
        assert_eq!(graph(&three).circles(), ["a.rs → b.rs → a/d.rs → a.rs"]);
        let tests = [LIB, ("a.rs", "#[cfg(test)]\nmod t { use crate::b::X; }"), b];
        assert_eq!(graph(&tests).circles(), [""; 0]);
    }
}
