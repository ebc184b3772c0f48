//! Writes numbers and lists, and the checksum of all.

use std::io::{self, Write};

use crc32fast::Hasher;

use super::{Kind, MAGIC};

/// How many bytes are written at once. Smaller: more calls; larger: it leaves the processor's cache.
const CHUNK: usize = 1 << 16;

/// Writes a file.
#[derive(Debug)]
pub(crate) struct Writer<W> {
    output: W,
    sum: Hasher,
    /// What is still to be written, up to about [`CHUNK`] bytes.
    waiting: Vec<u8>,
}

impl<W: Write> Writer<W> {
    /// Begins a file.
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

    /// Writes a list: how many items there are, and each as `write` does.
    pub(crate) fn list<T>(
        &mut self,
        items: impl ExactSizeIterator<Item = T>,
        write: impl FnMut(&mut Self, T) -> io::Result<()>,
    ) -> io::Result<()> {
        self.u64(items.len() as u64)?;
        self.items(items, write)
    }

    /// Writes the items of a list alone, whose number follows from what was written before.
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

    /// Writes what is left, and the checksum.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        self.flush()?;
        let sum = self.sum.clone().finalize();
        self.output.write_all(&sum.to_le_bytes())?;
        self.output.flush()
    }
}
