//! Pages in a headless browser. These tests are ignored, as they need Chromium: `cargo test in_browser --
//! --ignored` runs them.

mod deeds;
mod orders;
mod pictures;
mod turn;

use std::fs;

use binspace::BspTree;

use crate::run::Folder;

/// A page, and its tree.
pub(crate) fn page_and_tree(folder: &Folder, scene: &str) -> (String, BspTree) {
    folder.run(&format!("build {scene} -o s.bsp")).good();
    folder.run("page s.bsp -o s.html").good();
    let tree = BspTree::read(fs::File::open(folder.path("s.bsp")).unwrap()).unwrap();
    (fs::read_to_string(folder.path("s.html")).unwrap(), tree)
}
