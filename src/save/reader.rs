//! Reads numbers and lists. Memory grows with what was read, not with what a length claims.

use std::io::Read;

use crc32fast::Hasher;

use super::{Kind, LoadError, MAGIC};

/// How many bytes are read at once. Smaller: more calls; larger: it leaves the processor's cache.
const CHUNK: usize = 1 << 16;

/// Reads a file.
#[derive(Debug)]
pub(crate) struct Reader<R> {
    input: R,
    sum: Hasher,
    chunk: Vec<u8>,
}

impl<R: Read> Reader<R> {
    /// Begins with a file, which must be of this kind and version.
    pub(crate) fn new(input: R, kind: Kind) -> Result<Self, LoadError> {
        let mut reader = Self { input, sum: Hasher::new(), chunk: vec![0; CHUNK] };
        if reader.get::<8>("first bytes")? != MAGIC {
            return Err(LoadError::foreign());
        }
        let (name, version) = (reader.get("first bytes")?, reader.u32("first bytes")?);
        if name != kind.name {
            return Err(LoadError::other_kind(name, kind.name));
        }
        if version != kind.version {
            return Err(LoadError::version(version, kind.version));
        }
        Ok(reader)
    }

    /// Reads some bytes of what is called `what`.
    fn get<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], LoadError> {
        let mut bytes = [0; N];
        self.input.read_exact(&mut bytes).map_err(|error| LoadError::of_reading(error, what))?;
        self.sum.update(&bytes);
        Ok(bytes)
    }

    pub(crate) fn u32(&mut self, what: &'static str) -> Result<u32, LoadError> {
        self.get(what).map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self, what: &'static str) -> Result<u64, LoadError> {
        self.get(what).map(u64::from_le_bytes)
    }

    pub(crate) fn f64(&mut self, what: &'static str) -> Result<f64, LoadError> {
        self.get(what).map(f64::from_le_bytes)
    }

    /// A number of things, which must not be above a limit.
    pub(crate) fn count(&mut self, what: &'static str, limit: usize) -> Result<usize, LoadError> {
        let (found, limit) = (self.u64(what)?, limit as u64);
        if found > limit {
            return Err(LoadError::too_many(what, found, limit));
        }
        // It fits, as the limit did.
        Ok(found as usize)
    }

    /// Reads a list: how many items there are, which must not be above a limit, and the items, each
    /// from `N` bytes.
    pub(crate) fn list<T, const N: usize>(
        &mut self,
        what: &'static str,
        limit: usize,
        item: impl FnMut(&[u8; N]) -> T,
    ) -> Result<Vec<T>, LoadError> {
        let len = self.count(what, limit)?;
        self.items(what, len, item)
    }

    /// Reads the items of a list, each from `N` bytes, given how many there are.
    pub(crate) fn items<T, const N: usize>(
        &mut self,
        what: &'static str,
        len: usize,
        mut item: impl FnMut(&[u8; N]) -> T,
    ) -> Result<Vec<T>, LoadError> {
        let mut items = Vec::new();
        let most = (CHUNK / N).max(1);
        while items.len() < len {
            let some = most.min(len - items.len());
            // At most twice what has been read, so that a false length cannot ask for much.
            if items.capacity() - items.len() < some {
                let room = len.min(2 * items.len() + most) - items.len();
                items.try_reserve_exact(room).map_err(|_| LoadError::out_of_memory())?;
            }
            let bytes = &mut self.chunk[..some * N];
            self.input.read_exact(bytes).map_err(|error| LoadError::of_reading(error, what))?;
            self.sum.update(bytes);
            // A closure around it is inlined; `&mut item` in its place was called for each item.
            #[expect(clippy::redundant_closure, reason = "see above")]
            items.extend(bytes.as_chunks::<N>().0.iter().map(|bytes| item(bytes)));
        }
        Ok(items)
    }

    /// Compares the checksum. What was read before may be false until then.
    pub(crate) fn finish(mut self) -> Result<(), LoadError> {
        let found = self.sum.clone().finalize();
        let expected = self.u32("checksum")?;
        if found == expected { Ok(()) } else { Err(LoadError::checksum(found, expected)) }
    }
}

/// The `u32` that begins at a place among some bytes.
#[inline]
pub(crate) fn u32_at<const N: usize>(bytes: &[u8; N], at: usize) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}

/// The `u64` that begins at a place among some bytes.
#[inline]
pub(crate) fn u64_at<const N: usize>(bytes: &[u8; N], at: usize) -> u64 {
    u64::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}
