//! Union-find: disjoint sets of numbers.

use std::cell::Cell;

use crate::Error;
use crate::memory::reserve;

/// Disjoint sets of numbers, each named by its least number (Galler and Fischer 1964).
pub(crate) struct Union {
    /// For each number, a smaller number of the same set. The least number refers to itself.
    up: Vec<Cell<u32>>,
}

impl Union {
    /// Creates a set for each number below `len`.
    ///
    /// # Errors
    ///
    /// If there is not enough memory.
    pub(crate) fn new(len: u32) -> Result<Self, Error> {
        let mut up = Vec::new();
        reserve(&mut up, len as usize)?;
        up.extend((0..len).map(Cell::new));
        Ok(Self { up })
    }

    /// The least number of a number's set.
    ///
    /// Path halving links every number on the path to the next number but one, so only the first call walks
    /// all of a long chain. O(log n) on average (Tarjan and van Leeuwen 1984).
    pub(crate) fn root(&self, mut node: u32) -> u32 {
        loop {
            let up = self.up[node as usize].get();
            if up == node {
                return node;
            }
            let next = self.up[up as usize].get();
            self.up[node as usize].set(next);
            node = next;
        }
    }

    pub(crate) fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.up[a.max(b) as usize].set(a.min(b));
    }
}

#[cfg(test)]
mod tests {
    use super::Union;

    /// Nodes united from the last to the first are one chain, which every node would walk in full.
    #[test]
    fn a_long_chain_is_not_walked_by_every_node() {
        const COUNT: u32 = 100_000;
        let mut union = Union::new(COUNT).expect("memory");
        (1..COUNT).rev().for_each(|node| union.unite(node, node - 1));
        let mut steps = 0_usize;
        for node in (0..COUNT).rev() {
            let mut at = node;
            while union.up[at as usize].get() != at {
                (at, steps) = (union.up[at as usize].get(), steps + 1);
                assert!(steps < 20 * COUNT as usize, "after {} nodes", COUNT - node);
            }
            assert_eq!(union.root(node), 0);
        }
    }

    #[test]
    fn the_least_names_a_set() {
        let mut union = Union::new(9).expect("memory");
        for (a, b) in [(8, 5), (3, 5), (7, 6), (6, 7), (2, 8)] {
            union.unite(a, b);
        }
        let roots: Vec<u32> = (0..9).map(|node| union.root(node)).collect();
        assert_eq!(roots, [0, 1, 2, 2, 4, 2, 6, 6, 2]);
    }
}
