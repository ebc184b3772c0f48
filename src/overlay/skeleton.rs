//! The part of the tree that leads to the overlay's pieces, and the small trees in its cells.

use std::ops::Range;

use glam::Vec4;

use crate::error::Error;
use crate::exact::{ExactStored, Faces, PlaneId};
use crate::memory::reserve;
use crate::tree::BspTree;
use crate::tree::order::planes::rounded;
use crate::tree::parts::{RawChild, Parts, Record};

/// What is on one side of a plane.
#[derive(Clone, Copy, Debug)]
pub(super) enum Part {
    /// So many fragments of the tree, and no piece.
    Static(u32),
    /// Pieces that need no plane, by their numbers in the overlay: at most one, or coplanar ones.
    Pieces { first: u32, len: u32 },
    /// More of the skeleton.
    Branch(u32),
}

impl Default for Part {
    fn default() -> Self {
        Self::Static(0)
    }
}

/// A plane with pieces on it or around it: of a node of the tree, of the fragment in a leaf, or of a
/// small tree in a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    pub(super) plane: PlaneId,
    pub(super) rounded: Vec4,
    /// How many fragments of the tree lie on the plane.
    pub(super) own: u32,
    /// The pieces on the plane, which come after those fragments.
    pub(super) first: u32,
    pub(super) len: u32,
    pub(super) front: Part,
    pub(super) back: Part,
}

/// Where a part hangs.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    Root,
    Front(u32),
    Back(u32),
}

/// The skeleton of an overlay.
#[derive(Debug, Default)]
pub(super) struct Skeleton {
    pub(super) root: Part,
    pub(super) branches: Vec<Branch>,
    /// The sides that a small tree's nodes are still to be hung on.
    open: Vec<Place>,
}

impl Skeleton {
    /// That of an overlay of nothing.
    pub(super) fn of_tree(tree: &BspTree) -> Self {
        Self { root: Part::Static(tree.len() as u32), ..Self::default() }
    }

    /// Removes all branches; `fragments` is how many the tree has.
    pub(super) fn clear(&mut self, fragments: usize) {
        self.root = Part::Static(fragments as u32);
        self.branches.clear();
    }

    /// Hangs a part where it belongs.
    pub(super) fn hang(&mut self, place: Place, part: Part) {
        match place {
            Place::Root => self.root = part,
            Place::Front(branch) => self.branches[branch as usize].front = part,
            Place::Back(branch) => self.branches[branch as usize].back = part,
        }
    }

    /// Adds a branch, and gives its number.
    pub(super) fn push(&mut self, branch: Branch) -> Result<u32, Error> {
        reserve(&mut self.branches, 1)?;
        self.branches.push(branch);
        Ok(self.branches.len() as u32 - 1)
    }

    /// Hangs the small tree of a cell, whose fragments are to be the pieces from `first` on.
    pub(super) fn graft(
        &mut self,
        place: Place,
        faces: &Faces,
        tree: &Parts<ExactStored>,
        mut first: u32,
    ) -> Result<(), Error> {
        self.open.clear();
        self.open.push(place);
        for node in &tree.nodes {
            let own = node.own;
            let mut branch = Branch {
                plane: node.plane,
                rounded: rounded(faces, node.plane),
                own: 0,
                first,
                len: own,
                front: Part::default(),
                back: Part::default(),
            };
            first += own;
            // Fragments are numbered in this order: on the plane, front leaf, back leaf, the rest.
            for (side, child) in [(&mut branch.front, node.front), (&mut branch.back, node.back)] {
                if let RawChild::Leaf(len) = child {
                    *side = Part::Pieces { first, len };
                    first += len;
                }
            }
            let number = self.push(branch)?;
            let Some(place) = self.open.pop() else { return Ok(()) };
            self.hang(place, Part::Branch(number));
            // Nodes stand depth first, the front before the back.
            if node.back == RawChild::Node {
                self.open.push(Place::Back(number));
            }
            if node.front == RawChild::Node {
                self.open.push(Place::Front(number));
            }
        }
        Ok(())
    }
}

/// Appends the fragments of a small tree to the overlay's pieces.
pub(super) fn append(
    pieces: &mut Parts<ExactStored>,
    tree: &Parts<ExactStored>,
) -> Result<Range<u32>, Error> {
    let first = pieces.records.len() as u32;
    let shift = pieces.vertices.len() as u32;
    reserve(&mut pieces.records, tree.records.len())?;
    let moved = |record: &Record| Record { vertices: record.vertices + shift, ..*record };
    pieces.records.extend(tree.records.iter().map(moved));
    reserve(&mut pieces.vertices, tree.vertices.len())?;
    pieces.vertices.extend_from_slice(&tree.vertices);
    reserve(&mut pieces.positions, tree.positions.len())?;
    pieces.positions.extend_from_slice(&tree.positions);
    Ok(first..pieces.records.len() as u32)
}
