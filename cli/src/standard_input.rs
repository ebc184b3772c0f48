//! A scene on standard input.

use std::io::{self, IsTerminal, Read};
use std::path::Path;

use binspace::scene::Scene;

use crate::failure::Failure;
use crate::formats::{self, Kind};
use crate::memory;
use crate::progress::Progress;
use crate::saved_file;
use crate::scene_arg::Loaded;
use crate::terminal::{note, remark};

/// The name in messages.
const NAME: &str = "standard input";
/// The number of bytes requested at a time.
const CHUNK: usize = 1 << 20;

/// Reads a file of any kind from standard input, and notes the omitted data.
pub(crate) fn scene() -> Result<Loaded, Failure> {
    if io::stdin().is_terminal() {
        note("reading a scene from the terminal, up to an end of file (Ctrl-D)");
    }
    let progress = Progress::spinner(format!("reading {NAME}"));
    let bytes = bytes()?;
    let beginning = &bytes[..bytes.len().min(formats::BEGINNING)];
    match Kind::of(beginning, bytes.len() as u64, Path::new("")) {
        Kind::Saved => return Ok(Loaded::saved(NAME, saved_file::read(NAME, &bytes[..])?)),
        Kind::Other(kind) => return Err(formats::refused(NAME, kind)),
        Kind::Mesh(kind) => {
            let scene = kind.read(NAME, &bytes, None)?;
            memory::check(NAME, scene.len())?;
            return Ok(scene.into());
        }
        Kind::Obj => {}
    }
    let (scene, mut report) = Scene::from_obj(NAME, &bytes, |_| None)
        .map_err(|error| formats::not_obj(NAME, beginning, error.to_string()))?;
    drop(progress);
    memory::check(NAME, scene.len())?;
    let mut libraries = std::mem::take(&mut report.missing_libraries);
    libraries.append(&mut report.outside_libraries);
    if !libraries.is_empty() {
        // Without libraries no material is defined: one note is enough.
        report.missing_materials.clear();
        let full = format!(
            "it has no folder to find material libraries in, so all is grey; name the file to have \
             the colours of {}",
            libraries.join(", ")
        );
        remark(NAME, "grey without its material libraries", full);
    }
    // They are among the faces without area, which are named once the tree is built.
    report.degenerate_faces = 0;
    if !report.is_clean() {
        remark(NAME, &report, &report);
    }
    Ok(scene.into())
}

/// All of standard input. Too little memory for it, or for the scene in it, is an error as soon as it
/// shows.
fn bytes() -> Result<Vec<u8>, Failure> {
    let mut bytes: Vec<u8> = Vec::new();
    let mut input = io::stdin().lock();
    loop {
        let problem = |_| Failure::about(NAME, "too little memory to read it");
        bytes.try_reserve(CHUNK).map_err(problem)?;
        // Fits the existing buffer, so that reading itself allocates nothing.
        let read = input.by_ref().take(CHUNK as u64).read_to_end(&mut bytes);
        if read.map_err(|error| Failure::about(NAME, format!("cannot be read: {error}")))? == 0 {
            return Ok(bytes);
        }
        memory::check_file(NAME, bytes.len() as u64)?;
    }
}
