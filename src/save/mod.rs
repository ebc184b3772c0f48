//! Files: how numbers and lists are written and read back, whatever they are of.
//!
//! A file is little-endian. It begins with the eight bytes `binspace`, four that say of what it is,
//! such as `tree`, and the version as `u32`. It ends with a `u32`, the CRC-32 (as of gzip and PNG) of
//! all bytes before. In between are numbers, and lists: their length as `u64`, then the items.
//! Another file may follow directly.

mod error;
mod reader;
mod writer;

pub use error::LoadError;
pub(crate) use error::invalid;
pub(crate) use reader::{Reader, u32_at, u64_at};
pub(crate) use writer::Writer;

/// What every file begins with.
const MAGIC: [u8; 8] = *b"binspace";

/// What a file holds, and the version of its layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    /// Four letters.
    pub(crate) name: [u8; 4],
    pub(crate) version: u32,
}
