//! The error of reading a file.

use std::fmt;
use std::io;

/// Why a file could not be read.
///
/// Its message says what is wrong with the file, and what to do. After an error, nothing is known of
/// how much was read.
#[derive(Debug)]
pub struct LoadError {
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Io(io::Error),
    Short { what: &'static str },
    Foreign,
    Content { found: [u8; 4], expected: [u8; 4] },
    Version { found: u32, expected: u32 },
    TooMany { what: &'static str, found: u64, limit: u64 },
    Checksum { found: u32, expected: u32 },
    OutOfMemory,
    Invalid { what: &'static str, number: Option<usize>, fault: &'static str },
}

/// The error of a thing of which there are several, given its number, that is not as it must be.
pub(crate) fn invalid(what: &'static str, number: usize, fault: &'static str) -> LoadError {
    LoadError { kind: Kind::Invalid { what, number: Some(number), fault } }
}

impl LoadError {
    /// Ends of data and lack of memory are told from other failures to read.
    pub(super) fn of_reading(error: io::Error, what: &'static str) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => Self { kind: Kind::Short { what } },
            io::ErrorKind::OutOfMemory => Self::out_of_memory(),
            _ => Self { kind: Kind::Io(error) },
        }
    }

    pub(super) fn foreign() -> Self {
        Self { kind: Kind::Foreign }
    }

    pub(super) fn other_kind(found: [u8; 4], expected: [u8; 4]) -> Self {
        Self { kind: Kind::Content { found, expected } }
    }

    pub(super) fn version(found: u32, expected: u32) -> Self {
        Self { kind: Kind::Version { found, expected } }
    }

    pub(crate) fn too_many(what: &'static str, found: u64, limit: u64) -> Self {
        Self { kind: Kind::TooMany { what, found, limit } }
    }

    pub(super) fn checksum(found: u32, expected: u32) -> Self {
        Self { kind: Kind::Checksum { found, expected } }
    }

    pub(crate) fn out_of_memory() -> Self {
        Self { kind: Kind::OutOfMemory }
    }

    /// The error of a thing of which there is one.
    pub(crate) fn of(what: &'static str, fault: &'static str) -> Self {
        Self { kind: Kind::Invalid { what, number: None, fault } }
    }

    /// Whether memory ran out. (The file itself may be right.)
    pub const fn is_out_of_memory(&self) -> bool {
        matches!(self.kind, Kind::OutOfMemory)
    }

    /// Whether reading itself failed; then [`source`](std::error::Error::source) is the reason.
    pub const fn is_io(&self) -> bool {
        matches!(self.kind, Kind::Io(_))
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            Kind::Io(error) => write!(f, "cannot be read: {error}"),
            Kind::Short { what } => {
                write!(f, "it ends within its {what}: it is cut short, or damaged before that")
            }
            Kind::Foreign => f.write_str("it is no file of binspace: it begins with other bytes"),
            Kind::Content { found, expected } => {
                let [found, expected] = [found, expected].map(|name| name.escape_ascii());
                write!(f, "it holds a \"{found}\" where a \"{expected}\" is expected")
            }
            Kind::Version { found, expected } => write!(
                f,
                "its layout is version {found}, but this version of binspace reads version \
                 {expected} alone: write it again, from the polygons"
            ),
            Kind::TooMany { what, found, limit } => {
                write!(
                    f,
                    "it claims to have {found} {what}, but {limit} is the most: it is damaged"
                )
            }
            Kind::Checksum { found, expected } => write!(
                f,
                "it is damaged: its bytes have the checksum {found:08x}, but it says {expected:08x}"
            ),
            Kind::OutOfMemory => f.write_str("out of memory"),
            Kind::Invalid { what, number: Some(number), fault } => {
                write!(f, "it was not written by binspace: {what} {number} {fault}")
            }
            Kind::Invalid { what, number: None, fault } => {
                write!(f, "it was not written by binspace: its {what} {fault}")
            }
        }
    }
}

impl std::error::Error for LoadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.kind {
            Kind::Io(error) => Some(error),
            _ => None,
        }
    }
}
