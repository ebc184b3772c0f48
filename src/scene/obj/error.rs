//! Why an OBJ file cannot be read.

use std::fmt;

use crate::input::MAX_CORNERS;

/// Why an OBJ file cannot be read. The message names the file, the line and the face where they are
/// known, and says what to do.
#[derive(Debug)]
pub struct ObjError {
    file: String,
    line: Option<usize>,
    face: Option<usize>,
    kind: Kind,
}

#[derive(Debug)]
pub(super) enum Kind {
    Read(std::io::Error),
    Encoding(&'static str),
    ZeroByte,
    NoFace,
    TooManyFaces,
    TooManyCorners,
    FewCoordinates(usize),
    Coordinate(String),
    NotFinite(String),
    Index(String),
    ZeroIndex,
    OutOfRange { index: String, vertices: usize },
    Reader(String),
}

impl Kind {
    pub(super) fn at(self, line: Option<usize>, face: Option<usize>) -> ObjError {
        ObjError { file: String::new(), line, face, kind: self }
    }
}

impl ObjError {
    /// The line at fault, counted from 1.
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// The face at fault: the number of its `f` line among the `f` lines, counted from 0.
    pub fn face(&self) -> Option<usize> {
        self.face
    }

    pub(super) fn in_file(mut self, file: &str) -> Self {
        file.clone_into(&mut self.file);
        self
    }
}

impl fmt::Display for ObjError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        if let Some(face) = self.face {
            write!(f, ", face {face} (from 0)")?;
        }
        write!(f, ": {}", self.kind)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => write!(f, "cannot be read: {error}"),
            Self::Encoding(name) => {
                write!(f, "wrong encoding: this is {name}; save it as UTF-8")
            }
            Self::ZeroByte => write!(
                f,
                "wrong encoding: a zero byte, so this is UTF-16, UTF-32 or not text; save it as \
                 UTF-8"
            ),
            Self::NoFace => write!(f, "no faces: there must be at least one `f` line"),
            Self::TooManyFaces => write!(f, "more than {} faces; divide the file", u32::MAX),
            Self::TooManyCorners => {
                write!(f, "more than {MAX_CORNERS} corners; divide the polygon")
            }
            Self::FewCoordinates(found) => {
                write!(f, "{found} coordinates; a `v` line must give x, y and z")
            }
            Self::Coordinate(token) => write!(f, "the coordinate {token:?} is not a number"),
            Self::NotFinite(token) => {
                write!(f, "the coordinate {token:?} is not finite; remove the vertex or correct it")
            }
            Self::Index(token) => {
                write!(
                    f,
                    "{token:?} does not name a vertex; write whole numbers such as 3, 3/1 or -1"
                )
            }
            Self::ZeroIndex => write!(f, "vertex 0 does not exist; the first is 1"),
            Self::OutOfRange { index, vertices } => {
                write!(f, "vertex {index} does not exist; there are {vertices} `v` lines")
            }
            Self::Reader(problem) => write!(f, "tobj cannot read it: {problem}"),
        }
    }
}

impl std::error::Error for ObjError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.kind {
            Kind::Read(error) => Some(error),
            _ => None,
        }
    }
}
