//! Reads and writes the parts that all kinds of files share: the head, numbers, lists and the checksum.
//!
//! [`BspTree::write`](crate::BspTree::write) documents these parts in a table. Another file may follow
//! directly.

use std::io::{self, Read, Write};

use crc32fast::Hasher;

use crate::error::{self, Error, FileFault, Problem};

/// The first bytes of every file.
const MAGIC: [u8; 8] = *b"binspace";

/// The kind of a file, and the version of its layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    /// Four letters.
    pub(crate) name: [u8; 4],
    pub(crate) version: u32,
}

/// The number of bytes read or written at once. Too small: more calls. Too large: the buffer leaves the
/// processor's cache.
const CHUNK: usize = 1 << 16;

/// Reads a file.
#[derive(Debug)]
pub(crate) struct Reader<R> {
    input: R,
    sum: Hasher,
    chunk: Vec<u8>,
}

impl<R: Read> Reader<R> {
    /// Reads the head of a file, which must be of this kind and version.
    pub(crate) fn new(input: R, kind: Kind) -> Result<Self, Error> {
        let mut reader = Self { input, sum: Hasher::new(), chunk: vec![0; CHUNK] };
        if reader.bytes::<8>("first bytes")? != MAGIC {
            return Err(refused("it is not a binspace file (bad magic)".to_owned()));
        }
        let (name, version) = (reader.bytes("first bytes")?, reader.u32("first bytes")?);
        if name != kind.name {
            let [found, expected] = [&name, &kind.name].map(|name| name.escape_ascii());
            return Err(refused(format!(
                "it contains a \"{found}\", but a \"{expected}\" is expected"
            )));
        }
        if version != kind.version {
            return Err(refused(format!(
                "its layout is version {version}, but this version of binspace reads only \
                 version {}: write it again, from the polygons",
                kind.version
            )));
        }
        Ok(reader)
    }

    /// Reads bytes. Errors call these bytes `what`.
    pub(crate) fn bytes<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], Error> {
        let mut bytes = [0; N];
        self.input.read_exact(&mut bytes).map_err(|error| failed(error, what))?;
        self.sum.update(&bytes);
        Ok(bytes)
    }

    pub(crate) fn u32(&mut self, what: &'static str) -> Result<u32, Error> {
        self.bytes(what).map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self, what: &'static str) -> Result<u64, Error> {
        self.bytes(what).map(u64::from_le_bytes)
    }

    pub(crate) fn f64(&mut self, what: &'static str) -> Result<f64, Error> {
        self.bytes(what).map(f64::from_le_bytes)
    }

    /// Reads a number of items, which must not be above a limit.
    pub(crate) fn count(&mut self, what: &'static str, limit: usize) -> Result<usize, Error> {
        let (found, limit) = (self.u64(what)?, limit as u64);
        if found > limit {
            return Err(too_many(what, found, limit));
        }
        // The number fits, because it is at most the limit.
        Ok(found as usize)
    }

    /// Reads a list: the number of items, which must not be above a limit, and the items, each from `N`
    /// bytes.
    pub(crate) fn list<T, const N: usize>(
        &mut self,
        what: &'static str,
        limit: usize,
        item: impl FnMut(&[u8; N]) -> T,
    ) -> Result<Vec<T>, Error> {
        let len = self.count(what, limit)?;
        self.items(what, len, item)
    }

    /// Reads the items of a list, each from `N` bytes, given the number of items.
    pub(crate) fn items<T, const N: usize>(
        &mut self,
        what: &'static str,
        len: usize,
        mut item: impl FnMut(&[u8; N]) -> T,
    ) -> Result<Vec<T>, Error> {
        let mut items = Vec::new();
        let most = (CHUNK / N).max(1);
        while items.len() < len {
            let some = most.min(len - items.len());
            // Reserves room for about twice the items read so far, so that a false length cannot reserve much
            // memory.
            if items.capacity() - items.len() < some {
                let room = len.min(2 * items.len() + most) - items.len();
                items.try_reserve_exact(room).map_err(|_| Error::out_of_memory())?;
            }
            let bytes = &mut self.chunk[..some * N];
            self.input.read_exact(bytes).map_err(|error| failed(error, what))?;
            self.sum.update(bytes);
            // The compiler inlines this closure. Without it, the compiler made a call for each item.
            #[expect(clippy::redundant_closure, reason = "see above")]
            items.extend(bytes.as_chunks::<N>().0.iter().map(|bytes| item(bytes)));
        }
        Ok(items)
    }

    /// Compares the checksum. Before this call, all data read may be damaged.
    pub(crate) fn finish(mut self) -> Result<(), Error> {
        let found = self.sum.clone().finalize();
        let expected = self.u32("checksum")?;
        if found == expected {
            return Ok(());
        }
        Err(refused(format!(
            "it is damaged: its checksum is {found:08x}, but it stores {expected:08x}"
        )))
    }
}

/// The `u32` that begins at byte `at`.
#[inline]
pub(crate) fn u32_at<const N: usize>(bytes: &[u8; N], at: usize) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}

/// The `u64` that begins at byte `at`.
#[inline]
pub(crate) fn u64_at<const N: usize>(bytes: &[u8; N], at: usize) -> u64 {
    u64::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}

/// Writes a file.
#[derive(Debug)]
pub(crate) struct Writer<W> {
    output: W,
    sum: Hasher,
    /// Bytes not written yet, up to about [`CHUNK`].
    waiting: Vec<u8>,
}

impl<W: Write> Writer<W> {
    /// Writes the head of a file.
    pub(crate) fn new(output: W, kind: Kind) -> io::Result<Self> {
        let mut writer = Self { output, sum: Hasher::new(), waiting: Vec::new() };
        writer.put(MAGIC)?;
        writer.put(kind.name)?;
        writer.u32(kind.version)?;
        Ok(writer)
    }

    /// Writes bytes.
    #[inline]
    pub(crate) fn put<const N: usize>(&mut self, bytes: [u8; N]) -> io::Result<()> {
        self.waiting.extend_from_slice(&bytes);
        if self.waiting.len() >= CHUNK { self.flush() } else { Ok(()) }
    }

    #[inline]
    pub(crate) fn u32(&mut self, value: u32) -> io::Result<()> {
        self.put(value.to_le_bytes())
    }

    #[inline]
    pub(crate) fn u64(&mut self, value: u64) -> io::Result<()> {
        self.put(value.to_le_bytes())
    }

    #[inline]
    pub(crate) fn f64(&mut self, value: f64) -> io::Result<()> {
        self.put(value.to_le_bytes())
    }

    /// Writes a list: the number of items, and each item by `write`.
    pub(crate) fn list<T>(
        &mut self,
        items: impl ExactSizeIterator<Item = T>,
        write: impl FnMut(&mut Self, T) -> io::Result<()>,
    ) -> io::Result<()> {
        self.u64(items.len() as u64)?;
        self.items(items, write)
    }

    /// Writes the items of a list, but not the number of items, which follows from earlier data.
    pub(crate) fn items<T>(
        &mut self,
        mut items: impl Iterator<Item = T>,
        mut write: impl FnMut(&mut Self, T) -> io::Result<()>,
    ) -> io::Result<()> {
        items.try_for_each(|item| write(self, item))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.sum.update(&self.waiting);
        self.output.write_all(&self.waiting)?;
        self.waiting.clear();
        Ok(())
    }

    /// Writes the remaining bytes and the checksum.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        self.flush()?;
        let sum = self.sum.clone().finalize();
        self.output.write_all(&sum.to_le_bytes())?;
        self.output.flush()
    }
}

/// The error of an invalid item, given its number.
pub(crate) fn invalid(what: &'static str, number: usize, fault: &'static str) -> Error {
    refused(format!("it was not written by binspace: {what} {number} {fault}"))
}

/// The error of an invalid part that is not an item of a list.
pub(crate) fn damaged(what: &'static str, fault: &'static str) -> Error {
    refused(format!("it was not written by binspace: its {what} {fault}"))
}

pub(crate) fn too_many(what: &'static str, found: u64, limit: u64) -> Error {
    refused(format!("it has {found} {what}, above the limit of {limit}: it is damaged"))
}

fn refused(problem: impl Into<Problem>) -> Error {
    let problem = problem.into();
    error::Kind::File(FileFault { name: String::new(), line: None, problem }).error()
}

/// Converts an error of the reader. Truncated data and lack of memory have separate errors.
fn failed(error: io::Error, what: &'static str) -> Error {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => {
            refused(format!("it is truncated within its {what}, or damaged before that"))
        }
        io::ErrorKind::OutOfMemory => Error::out_of_memory(),
        _ => refused(error),
    }
}
