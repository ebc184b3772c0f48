//! Reading OBJ files: what is kept, what is refused, and that nothing panics.

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

use binspace::scene::{ObjError, ObjReport, Scene};
use std::path::Path;

fn read(text: impl AsRef<[u8]>) -> Result<(Scene, ObjReport), ObjError> {
    Scene::from_obj("test.obj", text.as_ref(), |_| None)
}

fn read_with(text: &str, libraries: &[(&str, &str)]) -> (Scene, ObjReport) {
    let find = |path: &Path| {
        let found = libraries.iter().find(|(name, _)| Path::new(name) == path);
        found.map(|(_, content)| content.as_bytes().to_vec())
    };
    Scene::from_obj("test.obj", text.as_bytes(), find).expect(text)
}

fn sides(scene: &Scene) -> Vec<usize> {
    scene.polygons().map(|polygon| polygon.len()).collect()
}

/// Five corners; the last stands apart.
const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 5\n";

fn with_corners(rest: &str) -> String {
    format!("{CORNERS}{rest}\n")
}
