//! Checking a tree against what it promises.

mod cover;
mod fault;
mod shape;
mod sides;
#[cfg(test)]
mod tests;

use super::order::eye::Planes;
use super::order::layout::Schedule;
use super::{BspTree, Fragment};
use fault::Fault;
pub use fault::Invalid;

impl BspTree {
    /// Checks every invariant of the tree:
    ///
    /// - the sizes of subtrees add up, a leaf has at most one fragment, every plane separates
    ///   fragments, and planes and vertices refer to existing geometry;
    /// - each fragment lies on its side of every plane above it, as far as the tolerance allows, which is a
    ///   length; and fragments on a plane are in input order;
    /// - the fragments of each face cover it exactly once: glued back together along the cuts, from
    ///   the leaves up, they give the face with all of its corners, and the number of cuts is
    ///   [`Stats::splits`](crate::Stats::splits);
    /// - the data from which orders are written matches the nodes, and positions that are kept match
    ///   the vertices.
    ///
    /// All of this is decided exactly. A tree that the library built is always valid; this is for
    /// tests and fuzzers.
    ///
    /// Takes O(n · mean depth + n log² n) time for fragments of few vertices, and O(n) memory.
    ///
    /// # Errors
    ///
    /// The first fault found. The invariants are checked in the order above.
    pub fn validate(&self) -> Result<(), Invalid> {
        let visits = self.check_sizes()?;
        self.check_names(&visits)?;
        self.check_sides(&visits)?;
        self.check_cover(&visits)?;
        self.check_layout()
    }

    fn check_layout(&self) -> Result<(), Invalid> {
        let mut planes = Planes::default();
        let out_of_memory = |_| Invalid { node: 0, what: Fault::OutOfMemory };
        planes.fill(&self.faces, &self.nodes).map_err(out_of_memory)?;
        if self.planes != planes {
            return Err(Invalid { node: 0, what: Fault::RoundedPlanes });
        }
        if let Some(schedule) = &self.schedule {
            let expected = Schedule::new(&self.nodes, self.records.len() as u32);
            if *schedule != expected.map_err(out_of_memory)? {
                return Err(Invalid { node: 0, what: Fault::Schedule });
            }
        }
        self.check_positions()
    }

    /// Positions that are kept are those that are computed for the vertices.
    fn check_positions(&self) -> Result<(), Invalid> {
        let fault = Err(Invalid { node: 0, what: Fault::Positions });
        if !self.positions.is_empty() && self.positions.len() != self.vertices.len() {
            return fault;
        }
        let mut kept = self.positions.iter();
        let is_wrong = |fragment: Fragment<'_>| {
            let stored = fragment.stored().iter().zip(&mut kept);
            stored.into_iter().any(|(stored, &position)| {
                self.faces.position(fragment.face(), stored.symbol()) != position
            })
        };
        if self.fragments().any(is_wrong) { fault } else { Ok(()) }
    }
}
