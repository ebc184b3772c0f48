//! The part of the tree that leads to the overlay's pieces, the small trees in its cells, and where both are
//! found in an order.

use std::cmp::Ordering;
use std::ops::Range;

use glam::Vec4;

use crate::build::piece::Piece;
use crate::error::Error;
use crate::exact::{Faces, PlaneId, Vertex};
use crate::progress::Watch;
use crate::tree::order::eye::rounded;
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
    /// What it is: see [`InsertionTree::part`].
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
pub(super) struct InsertionTree {
    root: SlotSide,
    pub(super) branches: Vec<Branch>,
    pub(super) groups: Vec<Group>,
    /// The sides that a small tree's nodes are still to be hung on.
    open: Vec<Place>,
}

impl InsertionTree {
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
    pub(super) fn group(&mut self, pieces: Range<u32>) -> SlotSide {
        let len = pieces.len() as u32;
        if len == 0 {
            return SlotSide::still(0);
        }
        self.groups.push(Group { first: pieces.start, len });
        SlotSide { slot: GROUP | (self.groups.len() as u32 - 1), len }
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
    pub(super) fn push(&mut self, place: Place, branch: Branch) -> u32 {
        let slot = self.branches.len() as u32;
        self.branches.push(branch);
        // Its length is not known before all that hangs on it is.
        self.hang(place, SlotSide { slot, len: 0 });
        slot
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
    pub(super) fn graft(&mut self, place: Place, faces: &Faces, tree: &Parts, mut first: u32) {
        self.open.clear();
        self.open.push(place);
        let mut take = |len: u32| {
            let start = first;
            first += len;
            start..first
        };
        for node in &tree.nodes {
            let Some(place) = self.open.pop() else { return };
            // Fragments are numbered in this order: on the plane, front leaf, back leaf, the rest.
            let pieces = self.group(take(node.own));
            let mut side = |skeleton: &mut Self, child| match child {
                RawChild::Leaf(len) => skeleton.group(take(len)),
                RawChild::Node => SlotSide::still(0),
            };
            let (front, back) = (side(self, node.front), side(self, node.back));
            let plane = node.plane;
            let rounded = rounded(faces, plane);
            let branch = Branch { rounded, plane, own: 0, pieces, front, back };
            let number = self.push(place, branch);
            // Nodes stand depth first, the front before the back.
            self.open.reserve(2);
            if node.back == RawChild::Node {
                self.open.push(Place::Back(number));
            }
            if node.front == RawChild::Node {
                self.open.push(Place::Front(number));
            }
        }
    }
}

impl Branch {
    fn len(&self) -> u32 {
        self.own + self.pieces.len + self.front.len + self.back.len
    }
}

/// For each point, a segment that it is an end of, if there is one.
///
/// A mark on a curve is to be painted over the curve. If a plane came between the two segments that
/// meet at the mark, one of them would come later than the mark. The plane of the one that ends there
/// has the next one on it as well (see `third_corner`), and the point.
#[derive(Debug, Default)]
pub(super) struct Anchors {
    /// The points, sorted by where they are, with their numbers.
    points: Vec<([f64; 3], u32)>,
    /// The different places of points, sorted, and a segment that has an end there.
    places: Vec<([f64; 3], Option<u32>)>,
    /// For each point the number of its place.
    place_of: Vec<u32>,
    /// The first point's face.
    first: u32,
}

/// Lattice coordinates have one form of 0, so equal places are equal in this order.
fn order(a: &[f64; 3], b: &[f64; 3]) -> Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
}

impl Anchors {
    /// Finds the segments of all points. Of the segments that meet where many points are, each is looked
    /// at once, not once for each point.
    pub(super) fn fill(&mut self, faces: &Faces, watch: &Watch<'_>) -> Result<(), Error> {
        self.find_places(faces);
        if self.places.is_empty() {
            return Ok(());
        }
        // Beginnings first, so that a segment that ends at a point is preferred.
        for end in [0, 1] {
            for face in self.first - faces.thin.segments as u32..self.first {
                watch.work(1)?;
                let corner = faces.corners(face)[end];
                if let Ok(at) = self.places.binary_search_by(|(place, _)| order(place, &corner)) {
                    self.places[at].1 = Some(face);
                }
            }
        }
        Ok(())
    }

    /// Lists the places of the points.
    fn find_places(&mut self, faces: &Faces) {
        let Self { points, places, place_of, first } = self;
        let count = faces.thin.points;
        *first = (faces.len() - count) as u32;
        points.clear();
        places.clear();
        place_of.clear();
        points.reserve(count);
        points.extend((0..count as u32).map(|number| (faces.corners(*first + number)[0], number)));
        points.sort_unstable_by(|(a, _), (b, _)| order(a, b));
        places.reserve(count);
        place_of.reserve(count);
        place_of.resize(count, 0);
        for &(at, number) in &*points {
            if places.last().is_none_or(|&(last, _)| last != at) {
                places.push((at, None));
            }
            place_of[number as usize] = places.len() as u32 - 1;
        }
    }

    /// Where the points begin in a set of pieces, which is in the order of faces.
    pub(super) fn points<'p>(&self, pieces: &'p [Piece]) -> &'p [Piece] {
        &pieces[pieces.partition_point(|piece| piece.face < self.first)..]
    }

    /// The segment of a point, if the piece of it that ends there is in the same set.
    pub(super) fn segment(&self, point: &Piece, pieces: &[Piece], arena: &[Vertex]) -> Option<u32> {
        let place = self.place_of[(point.face - self.first) as usize];
        let face = self.places[place as usize].1?;
        let start = pieces.partition_point(|piece| piece.face < face);
        let mut parts = pieces[start..].iter().take_while(|piece| piece.face == face);
        let ends = |piece: &Piece| piece.cut_vertices(arena).unwrap_or_default();
        let touches = |piece: &Piece| ends(piece).iter().any(|end| end.position() == point.min);
        parts.any(touches).then_some(face)
    }
}
