//! Trees and scenes that are written and read back, and wrong files.

mod damage;
mod forged;
mod refused;
mod same;
mod scenes;
mod threads;
mod values;

use testkit::prelude::*;
use testkit::saved::{bytes, seal};

/// A tree's file, which is changed in places.
#[derive(Clone)]
struct File(Vec<u8>);

impl File {
    fn of(tree: &BspTree) -> Self {
        Self(bytes(tree))
    }

    fn get(&self, at: usize) -> u32 {
        u32::from_le_bytes(self.0[at..at + 4].try_into().expect("four"))
    }

    /// The length of a list.
    fn len(&self, at: usize) -> usize {
        u64::from_le_bytes(self.0[at..at + 8].try_into().expect("eight")) as usize
    }

    fn put(&mut self, at: usize, value: u32) {
        self.put_bytes(at, &value.to_le_bytes());
    }

    fn put_bytes(&mut self, at: usize, bytes: &[u8]) {
        self.0[at..at + bytes.len()].copy_from_slice(bytes);
    }

    /// The tree read with the right checksum.
    fn read(&self) -> Result<BspTree, String> {
        let mut bytes = self.0.clone();
        seal(&mut bytes);
        BspTree::read(&bytes[..]).map_err(|error| error.to_string())
    }

    /// The error message of reading the file; empty if a tree is read.
    fn message(&self) -> String {
        self.read().err().unwrap_or_default()
    }

    #[track_caller]
    fn refused(&self, says: &str) {
        let message = self.read().expect_err(says);
        assert!(message.contains(says), "{message:?}, not {says:?}");
    }
}
