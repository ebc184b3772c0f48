//! The files of scenes besides OBJ, and which kind of file something is.

mod gltf;
mod mesh;
mod off;
mod other;
mod ply;
mod stl;
#[cfg(test)]
mod tests;
mod text;

use std::borrow::Cow;
use std::path::Path;

use binspace::scene::Scene;

use crate::failure::Failure;
use crate::saved_file;
use crate::terminal::remark;

/// The number of leading bytes by which a file's kind is detected. Too small: the first line of an OBJ file
/// may be behind a long comment.
pub(crate) const BEGINNING: usize = 1 << 16;
/// The supported formats.
const READ: &str =
    "binspace reads OBJ, STL, PLY, OFF and glTF 2.0 files, and files of `binspace build`";

/// The kind of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// A file of `binspace build`.
    Saved,
    /// Any other file.
    Obj,
    Mesh(MeshKind),
    /// A file of a kind that is not read; the text names the kind.
    Other(&'static str),
}

/// A file that this module reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MeshKind {
    Stl,
    BinaryStl,
    Ply,
    Off,
    Gltf,
}

impl Kind {
    /// The kind of a file of `length` bytes, by its first bytes. The file's name counts only for binary STL
    /// files, of which nothing but the length is certain.
    pub(crate) fn of(beginning: &[u8], length: u64, name: &Path) -> Self {
        let is_named_stl = name.extension().is_some_and(|ext| ext.eq_ignore_ascii_case("stl"));
        if beginning.starts_with(saved_file::BEGINNING) {
            Self::Saved
        } else if stl::is_binary(beginning, length) {
            Self::Mesh(MeshKind::BinaryStl)
        } else if stl::is_text(beginning) {
            Self::Mesh(MeshKind::Stl)
        } else if ply::is_ply(beginning) {
            Self::Mesh(MeshKind::Ply)
        } else if off::is_off(beginning) {
            Self::Mesh(MeshKind::Off)
        } else if gltf::is_gltf(beginning) {
            Self::Mesh(MeshKind::Gltf)
        } else if length == 0 {
            Self::Other("an empty file")
        } else if let Some(name) = other::name(&narrowed(beginning), length) {
            Self::Other(name)
        } else if is_named_stl && beginning.contains(&0) {
            Self::Mesh(MeshKind::BinaryStl)
        } else {
            Self::Obj
        }
    }
}

impl MeshKind {
    /// Reads a file, and notes the omitted data. Other files to which this file refers are in `folder`.
    pub(crate) fn read(
        self,
        name: &str,
        bytes: &[u8],
        folder: Option<&Path>,
    ) -> Result<Scene, Failure> {
        let read = match self {
            Self::Stl => stl::text(name, bytes),
            Self::BinaryStl => stl::binary(name, bytes),
            Self::Ply => ply::read(name, bytes),
            Self::Off => off::read(name, bytes),
            Self::Gltf => {
                let gltf::Read { scene, left_out } = gltf::read(name, bytes, folder)?;
                if !left_out.is_empty() {
                    let left_out = left_out.join("; ");
                    remark(name, &left_out, &left_out);
                }
                return Ok(scene);
            }
        };
        let scene = read.map_err(|problem| Failure::about(name, problem))?;
        if scene.is_empty() {
            return Err(Failure::about(name, "no faces"));
        }
        Ok(scene)
    }
}

/// The error for a file that is not read.
pub(crate) fn refused(name: &str, kind: &str) -> Failure {
    Failure::about(name, format!("this is {kind}; {READ}"))
}

/// The error of an OBJ file, or an unknown format.
pub(crate) fn not_obj(name: &str, beginning: &[u8], problem: String) -> Failure {
    let text = narrowed(beginning);
    if beginning.is_empty() || other::is_like_obj(&text) {
        return Failure::Message(problem);
    }
    let what = if text.is_empty() || text.contains(&0) { "binary file" } else { "text file" };
    Failure::about(name, format!("unknown kind of {what}; {READ}"))
}

/// The letters of a UTF-16 text, with ASCII letters as in UTF-8; other bytes are not changed.
fn narrowed(beginning: &[u8]) -> Cow<'_, [u8]> {
    let marks: [&[u8]; 2] = [b"\xff\xfe", b"\xfe\xff"];
    let text = marks.iter().find_map(|mark| beginning.strip_prefix(*mark)).unwrap_or(beginning);
    // Every other byte of such letters is 0.
    let some = &text[..text.len().min(64)];
    let is_zero = |start: usize| some.iter().skip(start).step_by(2).all(|&byte| byte == 0);
    if some.len() > 1 && (is_zero(0) || is_zero(1)) {
        return text.iter().copied().filter(|&byte| byte != 0).collect();
    }
    Cow::Borrowed(beginning)
}
