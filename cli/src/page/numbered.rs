//! Lists in which each thing is once.

use std::collections::HashMap;
use std::hash::Hash;

/// Distinct values, numbered in the order of their first occurrence.
#[derive(Debug)]
pub(super) struct Numbered<T> {
    numbers: HashMap<T, u32>,
    list: Vec<T>,
}

impl<T> Default for Numbered<T> {
    fn default() -> Self {
        Self { numbers: HashMap::new(), list: Vec::new() }
    }
}

impl<T: Copy + Eq + Hash> Numbered<T> {
    /// The number of a thing, which is added if it is new.
    pub(super) fn number(&mut self, thing: T) -> u32 {
        *self.numbers.entry(thing).or_insert_with(|| {
            self.list.push(thing);
            (self.list.len() - 1) as u32
        })
    }

    pub(super) fn list(&self) -> &[T] {
        &self.list
    }
}
