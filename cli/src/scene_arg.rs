//! Loads a scene by its name on the command line: a file, standard input or a built-in scene.

use std::ffi::OsStr;
use std::fs;
use std::io::{self, IsTerminal, Read};
use std::path::{Path, PathBuf};

use binspace::scene::{Builtin, ObjReport, Scene};
use binspace::{BspTree, Error};

use crate::failure::Failure;
use crate::files::{STANDARD, open_existing};
use crate::formats::{self, Kind, MeshKind};
use crate::memory;
use crate::progress::Progress;
use crate::saved_file;
use crate::terminal::{note, remark};

/// A scene under the name that the user gave, and the scene's tree if the file holds a tree.
#[derive(Debug)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    pub(crate) tree: Option<BspTree>,
    /// The scene's name in a file of `binspace build`.
    pub(crate) stored_name: String,
}

impl From<Scene> for Loaded {
    fn from(scene: Scene) -> Self {
        Self { stored_name: stored_name(&scene), scene, tree: None }
    }
}

impl Loaded {
    /// The content of a file of `binspace build`, under the name that the user gave.
    pub(crate) fn saved(name: &str, (scene, tree): (Scene, BspTree)) -> Self {
        let stored_name = stored_name(&scene);
        Self { scene: scene.with_name(name), tree: Some(tree), stored_name }
    }
}

/// The name without folders: other people may read the file.
fn stored_name(scene: &Scene) -> String {
    let name = Path::new(scene.name()).file_name();
    name.map_or_else(|| scene.name().into(), OsStr::to_string_lossy).into_owned()
}

/// The number of bytes requested at a time from standard input.
const CHUNK: usize = 1 << 20;
/// The endings of file names.
const ENDINGS: [&str; 7] = ["obj", "bsp", "stl", "ply", "off", "glb", "gltf"];

/// The scene that a name means.
#[derive(Debug, PartialEq)]
pub(crate) enum Source {
    StandardInput,
    File(PathBuf),
    Builtin(Builtin, Option<u32>),
}

/// Reads or generates the scene on the command line, and notes the omitted data. The seed is used by random
/// built-in scenes.
pub fn load(asked: &OsStr, seed: u64) -> Result<Loaded, Failure> {
    let name = asked.to_string_lossy();
    match source(asked)? {
        Source::StandardInput => standard_input(),
        Source::Builtin(scene, size) => {
            memory::check(&name, scene.polygons(size))?;
            let _progress = Progress::spinner(format!("generating {name}"));
            Ok(scene.build(size, seed).into())
        }
        Source::File(path) if path.is_dir() => {
            let problem = "this is a folder: only `render`, `order` and `stats` accept folders of \
                           `binspace build --cells`; name the scene from which it was built";
            Err(Failure::about(name, problem))
        }
        Source::File(path) => match kind(&path) {
            (Kind::Saved, _) => Ok(Loaded::saved(&name, saved_file::open(&path)?)),
            (Kind::Other(kind), _) => Err(formats::refused(&name, kind)),
            (Kind::Mesh(kind), _) => Ok(mesh(kind, &path)?.into()),
            (Kind::Obj, beginning) => Ok(obj(&path, &beginning)?.into()),
        },
    }
}

/// The kind of a file, and its first bytes. A file that is not regular can be read only once, and is taken
/// for an OBJ file.
pub(crate) fn kind(path: &Path) -> (Kind, Vec<u8>) {
    if path.extension().is_some_and(|ext| ext.eq_ignore_ascii_case("bsp")) {
        return (Kind::Saved, Vec::new());
    }
    let beginning = || {
        let length = path.metadata().ok().filter(fs::Metadata::is_file)?.len();
        let mut bytes = Vec::new();
        let file = fs::File::open(path).ok()?;
        file.take(formats::BEGINNING as u64).read_to_end(&mut bytes).ok()?;
        Some((Kind::of(&bytes, length, path), bytes))
    };
    beginning().unwrap_or((Kind::Obj, Vec::new()))
}

/// Reads a file that is neither an OBJ file nor a file of `binspace build`.
fn mesh(kind: MeshKind, path: &Path) -> Result<Scene, Failure> {
    let name = path.display().to_string();
    let unreadable = |error| Failure::about(&name, format!("cannot be read: {error}"));
    let mut file = open_existing(path)?;
    memory::check_file(&name, file.metadata().map_err(unreadable)?.len())?;
    let _progress = Progress::spinner(format!("reading {name}"));
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    checked(kind.read(&name, &bytes, path.parent())?)
}

fn obj(path: &Path, beginning: &[u8]) -> Result<Scene, Failure> {
    let name = path.display().to_string();
    if let Ok(file) = path.metadata() {
        memory::check_file(&name, file.len())?;
    }
    let _progress = Progress::spinner(format!("reading {name}"));
    of_obj(&name, beginning, Scene::read_obj(path))
}

/// The scene of an OBJ file, with a note on the omitted data.
fn of_obj(
    name: &str,
    beginning: &[u8],
    read: Result<(Scene, ObjReport), Error>,
) -> Result<Scene, Failure> {
    let (scene, mut report) =
        read.map_err(|error| formats::not_obj(name, beginning, error.to_string()))?;
    // Degenerate faces are among the faces without area, which are named once the tree is built.
    report.degenerate_faces = 0;
    if !report.is_clean() {
        remark(name, &report, &report);
    }
    checked(scene)
}

/// A scene, if there is memory for its tree.
fn checked(scene: Scene) -> Result<Scene, Failure> {
    memory::check(scene.name(), scene.len())?;
    Ok(scene)
}

/// Reads a file of any kind from standard input, and notes the omitted data.
fn standard_input() -> Result<Loaded, Failure> {
    if io::stdin().is_terminal() {
        note("reading a scene from the terminal; Ctrl-D ends it");
    }
    let name = "standard input";
    let _progress = Progress::spinner(format!("reading {name}"));
    let bytes = standard_input_bytes(name)?;
    let beginning = &bytes[..bytes.len().min(formats::BEGINNING)];
    match Kind::of(beginning, bytes.len() as u64, Path::new("")) {
        Kind::Saved => Ok(Loaded::saved(name, saved_file::read(name, &bytes[..])?)),
        Kind::Other(kind) => Err(formats::refused(name, kind)),
        Kind::Mesh(kind) => Ok(checked(kind.read(name, &bytes, None)?)?.into()),
        Kind::Obj => {
            let mut read = Scene::from_obj(name, &bytes, |_| None);
            if let Ok((_, report)) = &mut read {
                note_libraries(name, report);
            }
            Ok(of_obj(name, beginning, read)?.into())
        }
    }
}

/// Notes that material libraries are not found if a scene comes from standard input. This note replaces the
/// notes on missing materials.
fn note_libraries(name: &str, report: &mut ObjReport) {
    let mut libraries = std::mem::take(&mut report.missing_libraries);
    libraries.append(&mut report.outside_libraries);
    if !libraries.is_empty() {
        report.missing_materials.clear();
        let full = format!(
            "all polygons are grey, because standard input has no folder with material libraries: \
             name the file to use {}",
            libraries.join(", ")
        );
        remark(name, "grey, without material libraries", full);
    }
}

/// All bytes of standard input. Too little memory for the bytes, or for the scene in them, is an error as
/// soon as it is detected.
fn standard_input_bytes(name: &str) -> Result<Vec<u8>, Failure> {
    let mut bytes: Vec<u8> = Vec::new();
    let mut input = io::stdin().lock();
    loop {
        let problem = |_| Failure::about(name, "too little memory to read the scene");
        bytes.try_reserve(CHUNK).map_err(problem)?;
        // Fits the existing buffer, so that reading itself allocates nothing.
        let read = input.by_ref().take(CHUNK as u64).read_to_end(&mut bytes);
        if read.map_err(|error| Failure::about(name, format!("cannot be read: {error}")))? == 0 {
            return Ok(bytes);
        }
        memory::check_file(name, bytes.len() as u64)?;
    }
}

pub(crate) fn source(name: &OsStr) -> Result<Source, Failure> {
    if name == STANDARD {
        return Ok(Source::StandardInput);
    }
    let path = Path::new(name);
    let file = || Ok(Source::File(path.to_owned()));
    let is_named = path
        .extension()
        .is_some_and(|ext| ENDINGS.iter().any(|known| ext.eq_ignore_ascii_case(known)));
    let Some(text) = name.to_str().filter(|_| !is_named) else {
        return file();
    };
    if text.contains(std::path::is_separator) {
        return file();
    }
    match Builtin::parse(text) {
        Ok((scene, size)) => Ok(Source::Builtin(scene, size)),
        Err(_) if path.exists() => file(),
        Err(error) if is_like_builtin(text) => Err(Failure::Message(error.to_string())),
        Err(error) => Err(Failure::Message(format!("{error}; and there is no file {text:?}"))),
    }
}

/// Whether the part before the colon names a built-in scene.
fn is_like_builtin(text: &str) -> bool {
    text.split(':').next().is_some_and(|name| name.parse::<Builtin>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_from_built_in_scenes() {
        let builtin = |text: &str| {
            let (scene, size) = Builtin::parse(text).unwrap();
            Source::Builtin(scene, size)
        };
        assert_eq!(source("teapot:3".as_ref()).unwrap(), builtin("teapot:3"));
        assert_eq!(source("sphere".as_ref()).unwrap(), builtin("sphere"));
        assert_eq!(source("-".as_ref()).unwrap(), Source::StandardInput);
        for text in ["./-", "teapot.obj", "./teapot", "a/teapot:3", "SPHERE.OBJ", "teapot.bsp"] {
            assert_eq!(source(text.as_ref()).unwrap(), Source::File(text.into()), "{text}");
        }
    }

    #[test]
    fn other_names_are_errors_that_help() {
        let message = |text: &str| match source(text.as_ref()) {
            Err(Failure::Message(message)) => message,
            other => panic!("{text}: {other:?}"),
        };
        assert!(
            message("teapto").contains("teapot") && message("teapto").contains("there is no file")
        );
        assert!(message("teapot:x").contains("\"x\" is not a size"));
        assert!(message("newell:3").contains("one size"));
        assert!(message("").contains("no built-in scene"));
    }
}
