//! The part of the tree that leads to the overlay's pieces, and the small trees in its cells.

use std::ops::Range;

use glam::Vec4;

use crate::error::Error;
use crate::exact::{Faces, PlaneId};
use crate::memory::reserve;
use crate::tree::order::planes::rounded;
use crate::tree::parts::{Parts, RawChild};

/// Pieces that need no plane between them: one, or coplanar ones in input order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    /// The first of their numbers in the overlay.
    pub(super) first: u32,
    pub(super) len: u32,
}

/// What is on one side of a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlotSide {
    /// What it is: see [`Skeleton::part`].
    pub(super) slot: u32,
    /// How many fragments and pieces it has.
    pub(super) len: u32,
}

/// Marks a slot, while the skeleton grows, as that of a group.
const GROUP: u32 = 1 << 31;
/// The slot, while the skeleton grows, of what has no pieces.
const STILL: u32 = u32::MAX;

impl SlotSide {
    /// So many fragments of the tree, and no piece.
    pub(super) fn still(len: usize) -> Self {
        Self { slot: STILL, len: len as u32 }
    }
}

/// What a slot stands for.
pub(super) enum SlotContent {
    /// Fragments of the tree, and no piece.
    Still,
    Pieces(Group),
    /// More of the skeleton, by its number.
    Branch(u32),
}

/// A plane with pieces on it or around it: of a node of the tree, of the fragment in a leaf, or of a
/// small tree in a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    pub(super) rounded: Vec4,
    pub(super) plane: PlaneId,
    /// How many fragments of the tree lie on the plane.
    pub(super) own: u32,
    /// The pieces on the plane, which come after those fragments.
    pub(super) pieces: SlotSide,
    pub(super) front: SlotSide,
    pub(super) back: SlotSide,
}

/// Where a part hangs.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    Root,
    Front(u32),
    Back(u32),
}

/// The skeleton of an overlay. Branches come after those that they hang on.
#[derive(Debug)]
pub(super) struct Skeleton {
    root: SlotSide,
    pub(super) branches: Vec<Branch>,
    pub(super) groups: Vec<Group>,
    /// The sides that a small tree's nodes are still to be hung on.
    open: Vec<Place>,
}

impl Skeleton {
    /// That of an overlay of nothing on a tree of so many fragments.
    pub(super) fn new(fragments: usize) -> Self {
        let root = SlotSide { slot: 0, len: fragments as u32 };
        Self { root, branches: vec![], groups: vec![], open: vec![] }
    }

    /// Removes all branches; `fragments` is how many the tree has.
    pub(super) fn clear(&mut self, fragments: usize) {
        self.root = SlotSide { slot: 0, len: fragments as u32 };
        self.branches.clear();
        self.groups.clear();
    }

    /// All of it.
    pub(super) fn root(&self) -> SlotSide {
        self.root
    }

    /// How many slots there are: those of branches, those of groups, and a last one for what has no
    /// pieces.
    pub(super) fn slots(&self) -> usize {
        self.branches.len() + self.groups.len() + 1
    }

    /// What a slot stands for.
    pub(super) fn part(&self, slot: u32) -> SlotContent {
        let slot = slot as usize;
        match slot.checked_sub(self.branches.len()) {
            None => SlotContent::Branch(slot as u32),
            Some(group) => self
                .groups
                .get(group)
                .map_or(SlotContent::Still, |&group| SlotContent::Pieces(group)),
        }
    }

    /// A side of these pieces alone.
    pub(super) fn group(&mut self, pieces: Range<u32>) -> Result<SlotSide, Error> {
        let len = pieces.len() as u32;
        if len == 0 {
            return Ok(SlotSide::still(0));
        }
        reserve(&mut self.groups, 1)?;
        self.groups.push(Group { first: pieces.start, len });
        Ok(SlotSide { slot: GROUP | (self.groups.len() as u32 - 1), len })
    }

    /// Hangs something where it belongs.
    pub(super) fn hang(&mut self, place: Place, side: SlotSide) {
        match place {
            Place::Root => self.root = side,
            Place::Front(branch) => self.branches[branch as usize].front = side,
            Place::Back(branch) => self.branches[branch as usize].back = side,
        }
    }

    /// Adds a branch, hangs it, and gives its number.
    pub(super) fn push(&mut self, place: Place, branch: Branch) -> Result<u32, Error> {
        reserve(&mut self.branches, 1)?;
        let slot = self.branches.len() as u32;
        self.branches.push(branch);
        // Its length is not known before all that hangs on it is.
        self.hang(place, SlotSide { slot, len: 0 });
        Ok(slot)
    }

    /// Numbers the slots, and computes the lengths of all sides.
    pub(super) fn finish(&mut self) {
        let (groups, last) = (self.branches.len() as u32, self.slots() as u32 - 1);
        let number = |side: &mut SlotSide| {
            if side.slot == STILL {
                side.slot = last;
            } else if side.slot & GROUP != 0 {
                side.slot = groups + (side.slot & !GROUP);
            }
        };
        // From the last to the first, so that the lengths of what hangs on a branch are known.
        for i in (0..self.branches.len()).rev() {
            let Branch { mut pieces, mut front, mut back, .. } = self.branches[i];
            number(&mut pieces);
            for side in [&mut front, &mut back] {
                match self.branches.get(side.slot as usize) {
                    Some(child) => side.len = child.len(),
                    None => number(side),
                }
            }
            let branch = &mut self.branches[i];
            (branch.pieces, branch.front, branch.back) = (pieces, front, back);
        }
        match self.branches.first() {
            Some(first) => self.root.len = first.len(),
            None => number(&mut self.root),
        }
    }

    /// Hangs the small tree of a cell, whose fragments are to be the pieces from `first` on.
    pub(super) fn graft(
        &mut self,
        place: Place,
        faces: &Faces,
        tree: &Parts,
        mut first: u32,
    ) -> Result<(), Error> {
        self.open.clear();
        reserve(&mut self.open, 1)?;
        self.open.push(place);
        let mut take = |len: u32| {
            let start = first;
            first += len;
            start..first
        };
        for node in &tree.nodes {
            let Some(place) = self.open.pop() else { return Ok(()) };
            // Fragments are numbered in this order: on the plane, front leaf, back leaf, the rest.
            let pieces = self.group(take(node.own))?;
            let mut side = |skeleton: &mut Self, child| match child {
                RawChild::Leaf(len) => skeleton.group(take(len)),
                RawChild::Node => Ok(SlotSide::still(0)),
            };
            let (front, back) = (side(self, node.front)?, side(self, node.back)?);
            let plane = node.plane;
            let rounded = rounded(faces, plane);
            let branch = Branch { rounded, plane, own: 0, pieces, front, back };
            let number = self.push(place, branch)?;
            // Nodes stand depth first, the front before the back.
            reserve(&mut self.open, 2)?;
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

impl Branch {
    fn len(&self) -> u32 {
        self.own + self.pieces.len + self.front.len + self.back.len
    }
}
