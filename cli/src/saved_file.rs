//! Files of `binspace build`: a tree, followed by its scene.

use std::io::{self, Read, Write};
use std::path::Path;

use binspace::scene::Scene;
use binspace::{BspTree, Error};

use crate::failure::Failure;
use crate::files::open_existing;
use crate::progress::Progress;

/// The magic bytes of such a file.
pub(crate) const BEGINNING: &[u8] = b"binspace";

/// Writes a file.
pub(crate) fn write(mut out: &mut dyn Write, scene: &Scene, tree: &BspTree) -> io::Result<()> {
    tree.write(&mut out)?;
    scene.write(&mut out)
}

/// Reads a file by its name.
pub(crate) fn open(path: &Path) -> Result<(Scene, BspTree), Failure> {
    let name = path.display().to_string();
    let _progress = Progress::spinner(format!("reading {name}"));
    read(&name, io::BufReader::new(open_existing(path)?))
}

/// Reads a file; `name` is the file's name in messages.
pub(crate) fn read(name: &str, mut input: impl Read) -> Result<(Scene, BspTree), Failure> {
    let (scene, tree) = read_pair(name, &mut input)?;
    let more = input.read(&mut [0]).map_err(|error| Failure::about(name, error))?;
    if more > 0 {
        let problem = if tree.is_of_cell() {
            "this is one cell of a divided scene: name the folder"
        } else {
            "data after the end of the scene: build the file again"
        };
        return Err(Failure::about(name, problem));
    }
    Ok((scene, tree))
}

/// Reads a tree and its scene, with more data behind.
pub(crate) fn read_pair(name: &str, mut input: impl Read) -> Result<(Scene, BspTree), Failure> {
    let about = |error: Error| Failure::about(name, error);
    let tree = BspTree::read(&mut input).map_err(about)?;
    let scene = Scene::read(&mut input)
        .map_err(|error| Failure::about(name, format!("in the scene after the tree: {error}")))?;
    if !belong_together(&tree, &scene) {
        return Err(Failure::about(
            name,
            "its tree belongs to another scene: build the file again",
        ));
    }
    Ok((scene, tree))
}

/// Whether a tree fits a scene: they have the same number of polygons, and the tree uses only corners of the
/// scene's polygons.
fn belong_together(tree: &BspTree, scene: &Scene) -> bool {
    let faces = tree.faces();
    let has_corners = |face: u32| {
        let corners = scene.polygon(faces.polygon(face)).len();
        (0..faces.corners(face).len() as u32)
            .all(|k| (faces.corner_number(face, k) as usize) < corners)
    };
    tree.preparation().polygons == scene.len() && (0..faces.len() as u32).all(has_corners)
}
