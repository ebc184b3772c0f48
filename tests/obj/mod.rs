//! Reading OBJ files: kept and refused data, and that nothing panics.

mod attributes;
mod errors;
mod faces;
mod far;
mod far_numbers;
mod materials;
mod noise;
#[cfg(unix)]
mod not_regular;
mod precision;
mod real_scenes;
mod stream;

use binspace::scene::ObjReport;
use std::fs;
use std::path::{Path, PathBuf};
use testkit::prelude::*;

fn read(text: impl AsRef<[u8]>) -> Result<(Scene, ObjReport), binspace::Error> {
    Scene::from_obj("test.obj", text.as_ref(), |_| None)
}

fn read_with(text: &str, libraries: &[(&str, &str)]) -> (Scene, ObjReport) {
    let find = |path: &Path| {
        let found = libraries.iter().find(|(name, _)| Path::new(name) == path);
        found.map(|(_, content)| content.as_bytes().to_vec())
    };
    Scene::from_obj("test.obj", text.as_bytes(), find).expect(text)
}

/// An empty folder for one test.
fn folder(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A file in such a folder.
fn file(test: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let path = folder(test).join("s.obj");
    fs::write(&path, text).unwrap();
    path
}

fn sides(scene: &Scene) -> Vec<usize> {
    scene.polygons().map(|polygon| polygon.points().len()).collect()
}

/// Five corners; the last is separate.
const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 5\n";

fn with_corners(rest: &str) -> String {
    format!("{CORNERS}{rest}\n")
}
