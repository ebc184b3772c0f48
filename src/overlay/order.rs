//! One order of a tree's fragments and an overlay's pieces, and the planes that determine the places of the
//! pieces in this order.

use std::hint::select_unpredictable;
use std::iter::FusedIterator;
use std::ops::Range;
use std::vec;

use glam::Vec4;
use smallvec::{SmallVec, smallvec};

use super::Overlay;
use super::replace::Shape;
use crate::error::Error;
use crate::exact::{Faces, PlaneId};
use crate::tree::culling::{Cull, Subtree};
use crate::tree::order::eye::{View, rounded};
use crate::tree::parts::{Parts, RawChild};
use crate::tree::{BspTree, Culling, Order};
use crate::viewpoint::Viewpoint;

/// The planes of the tree that lead to the overlay's pieces, and the planes of the small trees in the tree's
/// cells. A branch is stored after the branch that it is attached to.
#[derive(Debug)]
pub(super) struct InsertionTree {
    root: SlotSide,
    pub(super) branches: Vec<Branch>,
    /// Ranges of the overlay's pieces that need no plane between them: a single piece, or coplanar pieces in
    /// input order.
    groups: Vec<Range<u32>>,
}

/// A plane with pieces on the plane or around it: the plane of a node of the tree, of the fragment in a leaf,
/// or of a small tree in a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    pub(super) rounded: Vec4,
    pub(super) plane: PlaneId,
    /// The number of fragments of the tree that lie on the plane.
    pub(super) own: u32,
    /// The pieces on the plane. In the order, these pieces follow the fragments on the plane.
    pub(super) pieces: SlotSide,
    pub(super) front: SlotSide,
    pub(super) back: SlotSide,
}

/// The fragments and pieces on one side of a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlotSide {
    /// The place where an order stores the side's beginning. While the tree grows: 2k for branch k, 2k + 1
    /// for group k, both counted from 1.
    slot: u32,
    /// The number of fragments and pieces on the side.
    len: u32,
}

/// The slot of sides without pieces, whose beginning is never read.
const EMPTY: u32 = 0;
/// A group's slot modulo 2, while the tree grows.
const GROUP: u32 = 1;

impl SlotSide {
    /// A side with fragments of the tree and no piece.
    pub(super) fn empty(fragments: usize) -> Self {
        Self { slot: EMPTY, len: fragments as u32 }
    }
}

impl Branch {
    fn len(&self) -> u32 {
        self.own + self.pieces.len + self.front.len + self.back.len
    }
}

/// The place where a branch or a group is attached.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    Root,
    Front(u32),
    Back(u32),
}

impl InsertionTree {
    /// The insertion tree of an empty overlay. `fragments` is the number of the tree's fragments.
    pub(super) fn new(fragments: usize) -> Self {
        Self { root: SlotSide::empty(fragments), branches: vec![], groups: vec![] }
    }

    /// Removes all branches; `fragments` is the number of the tree's fragments.
    pub(super) fn clear(&mut self, fragments: usize) {
        self.root = SlotSide::empty(fragments);
        self.branches.clear();
        self.groups.clear();
    }

    /// A side that consists of the given pieces alone.
    pub(super) fn group(&mut self, pieces: Range<u32>) -> SlotSide {
        if pieces.is_empty() {
            return SlotSide::empty(0);
        }
        let len = pieces.len() as u32;
        self.groups.push(pieces);
        SlotSide { slot: 2 * self.groups.len() as u32 + GROUP, len }
    }

    /// Puts a side in its place.
    pub(super) fn attach(&mut self, place: Place, side: SlotSide) {
        match place {
            Place::Root => self.root = side,
            Place::Front(branch) => self.branches[branch as usize].front = side,
            Place::Back(branch) => self.branches[branch as usize].back = side,
        }
    }

    /// Adds a branch, attaches it, and returns its number.
    pub(super) fn push(&mut self, place: Place, branch: Branch) -> u32 {
        let number = self.branches.len() as u32;
        self.branches.push(branch);
        // The length of the branch is unknown until the lengths of its sides are known.
        self.attach(place, SlotSide { slot: 2 * (number + 1), len: 0 });
        number
    }

    /// Attaches the small tree of a cell, whose fragments are the pieces from `next` on.
    pub(super) fn attach_tree(&mut self, place: Place, faces: &Faces, tree: &Parts, mut next: u32) {
        let mut open: SmallVec<[Place; 32]> = smallvec![place];
        for node in &tree.nodes {
            let Some(place) = open.pop() else { return };
            let leaf = |child| match child {
                RawChild::Leaf(len) => len,
                RawChild::Node => 0,
            };
            // Fragments are numbered in this order: on the plane, front leaf, back leaf, nodes below.
            let [pieces, front, back] = [node.own, leaf(node.front), leaf(node.back)].map(|len| {
                next += len;
                self.group(next - len..next)
            });
            let plane = node.plane;
            let rounded = rounded(faces, plane);
            let number = self.push(place, Branch { rounded, plane, own: 0, pieces, front, back });
            // Nodes are stored depth first, the front before the back.
            if node.back == RawChild::Node {
                open.push(Place::Back(number));
            }
            if node.front == RawChild::Node {
                open.push(Place::Front(number));
            }
        }
    }

    /// Computes the lengths of all sides, and numbers the slots: first the slot of sides without pieces, then
    /// the slots of branches, then the slots of groups.
    pub(super) fn finish(&mut self) {
        // From the last to the first, so that the lengths of all branches below are known.
        for i in (0..self.branches.len()).rev() {
            let branch = self.branches[i];
            let sides = [branch.pieces, branch.front, branch.back];
            let [pieces, front, back] = sides.map(|side| self.finished(side));
            self.branches[i] = Branch { pieces, front, back, ..branch };
        }
        self.root = self.finished(self.root);
    }

    fn finished(&self, side: SlotSide) -> SlotSide {
        let number = side.slot / 2;
        match side.slot % 2 {
            _ if side.slot == EMPTY => side,
            GROUP => SlotSide { slot: (self.branches.len() as u32) + number, ..side },
            _ => SlotSide { slot: number, len: self.branches[number as usize - 1].len() },
        }
    }

    /// The number of slots.
    fn slots(&self) -> usize {
        1 + self.branches.len() + self.groups.len()
    }

    /// Writes the beginning of each slot in the order of fragments and pieces.
    ///
    /// The loop has no branch on the eye's side, because no processor can predict such a branch.
    fn write_begins(&self, faces: &Faces, view: &View, begins: &mut [u32]) {
        begins[self.root.slot as usize] = 0;
        for (i, branch) in self.branches.iter().enumerate() {
            let &Branch { plane, rounded, own, pieces, front, back } = branch;
            let is_in_front = view.is_in_front_of(faces, plane, rounded);
            let begin = begins[i + 1];
            let on_plane = own + pieces.len;
            // The order is: far side, own fragments, near side. The far side is the back if the eye is in
            // front.
            let to_front = select_unpredictable(is_in_front, back.len + on_plane, 0);
            let to_back = select_unpredictable(is_in_front, 0, front.len + on_plane);
            let to_pieces = own + select_unpredictable(is_in_front, back.len, front.len);
            begins[front.slot as usize] = begin + to_front;
            begins[back.slot as usize] = begin + to_back;
            begins[pieces.slot as usize] = begin + to_pieces;
        }
    }
}

/// The order of a tree's [fragments](BspTree#contents) and an overlay's [pieces](Overlay#contents) for one
/// viewpoint: [`Overlay::order`].
///
/// The order is back to front; [`front_to_back`](Self::front_to_back) reverses it. To read the order, write
/// it as a list of numbers ([`write_into`](Self::write_into)), or iterate over its [`Shape`]s.
#[derive(Clone, Copy, Debug)]
#[must_use = "an order is written or iterated over"]
pub struct OverlayOrder<'a> {
    overlay: &'a Overlay,
    order: Order<'a>,
}

impl Overlay {
    /// Returns the order of the tree's fragments and the overlay's pieces for a viewpoint.
    ///
    /// # Errors
    ///
    /// If the tree is neither the tree that the overlay was made for nor a clone of it.
    pub fn order<'a>(
        &'a self,
        tree: &'a BspTree,
        viewpoint: Viewpoint,
    ) -> Result<OverlayOrder<'a>, Error> {
        self.expect(tree)?;
        Ok(OverlayOrder { overlay: self, order: tree.order(viewpoint) })
    }

    /// Returns whether no plane that determines the order lies between two viewpoints. If so, both viewpoints
    /// have the same order of fragments and pieces, until the next [`replace`](Self::replace).
    /// [`BspTree::same_order`] states the rules.
    ///
    /// [Culled](OverlayOrder::culled) orders may differ even then: write a culled order again whenever the
    /// camera moves.
    ///
    /// Takes O(p) for p planes of the tree and of the overlay, and stops at the first plane between the two
    /// viewpoints.
    ///
    /// # Errors
    ///
    /// If the tree is neither the tree that the overlay was made for nor a clone of it.
    pub fn same_order(
        &self,
        tree: &BspTree,
        one: Viewpoint,
        other: Viewpoint,
    ) -> Result<bool, Error> {
        self.expect(tree)?;
        let views = [one, other].map(|viewpoint| View::new(tree, viewpoint));
        let is_same = |&Branch { plane, rounded, .. }: &Branch| {
            let [one, other] =
                views.each_ref().map(|view| view.is_in_front_of(&self.faces, plane, rounded));
            one == other
        };
        Ok(tree.same_order(one, other) && self.insertions.branches.iter().all(is_same))
    }
}

impl<'a> OverlayOrder<'a> {
    /// Reverses the order: front to back.
    pub fn front_to_back(self) -> Self {
        Self { order: self.order.front_to_back(), ..self }
    }

    /// Leaves out the fragments and pieces that are outside the frustum of `culling`, or that are not seen
    /// from the side that `culling` selects. Lines and points have no sides, so they are left out only if
    /// they are outside the frustum. The remaining shapes keep their order.
    pub fn culled(self, culling: &'a Culling) -> Self {
        Self { order: self.order.culled(culling), ..self }
    }

    /// Replaces a buffer's contents by the numbers of the fragments and pieces. Numbers below the tree's
    /// [`len`](BspTree::len) are fragments of the tree; the other numbers are [shapes](Overlay::shape).
    ///
    /// | order | time | memory |
    /// |---|---|---|
    /// | not culled | the time of [`BspTree::back_to_front_into`], plus a copy of the list, plus one comparison with the eye for each plane on the way from the tree's root to a piece | the buffer, also as working space; once it is large enough, nothing is allocated |
    /// | culled | the time of the tree's [culled order](crate::Order::write_into), plus the time for all planes on the way from the tree's root to a piece; the first culled order after a [`replace`](Overlay::replace) also computes the bounding boxes of the pieces | allocates working space |
    /// | of an empty overlay | the time of the tree's order | as for the tree's order |
    pub fn write_into(self, numbers: &mut Vec<u32>) {
        let Self { overlay, order } = self;
        if overlay.is_empty() {
            return order.write_into(numbers);
        }
        let Order { tree, viewpoint, is_front_to_back, culling } = order;
        match culling {
            Some(culling) => {
                numbers.clear();
                overlay.write_culled(&Cull::new(tree, viewpoint, culling), numbers);
            }
            None => {
                tree.back_to_front_into(viewpoint, numbers);
                overlay.insert(&View::new(tree, viewpoint), numbers);
            }
        }
        if is_front_to_back {
            numbers.reverse();
        }
    }
}

impl<'a> IntoIterator for OverlayOrder<'a> {
    type Item = Shape<'a>;
    type IntoIter = Overlaid<'a>;

    fn into_iter(self) -> Overlaid<'a> {
        let Self { overlay, order: Order { tree, .. } } = self;
        let mut numbers = vec![];
        self.write_into(&mut numbers);
        Overlaid { overlay, tree, numbers: numbers.into_iter() }
    }
}

/// An iterator over the fragments and pieces of an [`OverlayOrder`]. The whole order is written when the
/// iterator is made.
#[derive(Clone, Debug)]
pub struct Overlaid<'a> {
    overlay: &'a Overlay,
    tree: &'a BspTree,
    numbers: vec::IntoIter<u32>,
}

impl<'a> Iterator for Overlaid<'a> {
    type Item = Shape<'a>;

    fn next(&mut self) -> Option<Shape<'a>> {
        let number = self.numbers.next()?;
        let shape = self.overlay.shape(number);
        Some(shape.unwrap_or_else(|| Shape::Fragment(self.tree.fragment(number))))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.numbers.size_hint()
    }
}

impl ExactSizeIterator for Overlaid<'_> {}
impl FusedIterator for Overlaid<'_> {}

/// The number of places of an order in a word of marks.
const WORD: usize = u32::BITS as usize;

impl Overlay {
    /// Appends the drawn fragments and pieces to an order.
    fn write_culled(&self, cull: &Cull<'_>, order: &mut Vec<u32>) {
        let InsertionTree { root, branches, groups } = &self.insertions;
        // With each side, the tree's part on that side; cells and leaves have no nodes.
        let (mut pending, mut subtrees) = (vec![(*root, cull.whole())], vec![]);
        while let Some((side, subtree)) = pending.pop() {
            let Some(slot) = (side.slot as usize).checked_sub(1) else {
                cull.write_subtree(subtree, &mut subtrees, order);
                continue;
            };
            let Some(branch) = branches.get(slot) else {
                let group = groups[slot - branches.len()].clone();
                let numbers = group.map(|piece| self.base.fragments as u32 + piece);
                order.extend(numbers.filter(|&number| self.shows(cull, number)));
                continue;
            };
            let end = subtree.fragments.end;
            let nothing = Subtree { nodes: 0..0, fragments: end..end };
            let [front, own, back] = match subtree.nodes.is_empty() {
                true => [nothing.clone(), subtree, nothing.clone()],
                false => cull.divide(&subtree),
            };
            let own_side = SlotSide::empty(own.fragments.len());
            let [front, back] = [(branch.front, front), (branch.back, back)];
            let is_in_front = cull.view.is_in_front_of(&self.faces, branch.plane, branch.rounded);
            let (far, near) = if is_in_front { (back, front) } else { (front, back) };
            // A stack: the last part is processed first.
            let parts = [near, (branch.pieces, nothing), (own_side, own), far];
            pending.extend(parts.into_iter().filter(|(side, _)| side.len > 0));
        }
    }

    /// Whether a piece is drawn. Lines and points have no sides.
    fn shows(&self, cull: &Cull<'_>, number: u32) -> bool {
        let piece = number - self.base.fragments as u32;
        let face = self.pieces.records[piece as usize].face;
        let plane = || self.faces.plane(PlaneId::face(face));
        cull.shows_box(&self.boxes().get(0, piece))
            && (face as usize >= self.faces.first_thin() || cull.shows_plane(plane))
    }

    /// Inserts the pieces into the tree's order.
    ///
    /// Every side of a branch stores its number of fragments and pieces. So the beginning of a side is known
    /// before the side is read, as in the tree's own order.
    fn insert(&self, view: &View, order: &mut Vec<u32>) {
        let (fragments, pieces) = (order.len(), self.len());
        let all = fragments + pieces;
        let (slots, words) = (self.insertions.slots(), all.div_ceil(WORD));
        // One buffer for everything, supplied by the caller, so that a frame allocates nothing.
        order.resize(all + slots + 2 * words + 2 * pieces, 0);
        let (order_itself, rest) = order.split_at_mut(all);
        let (begins, rest) = rest.split_at_mut(slots);
        let (marks, rest) = rest.split_at_mut(words);
        let (before, rest) = rest.split_at_mut(words);
        let (places, numbers) = rest.split_at_mut(pieces);
        self.insertions.write_begins(&self.faces, view, begins);
        // Sorts the pieces by their places: marks the places, and counts the marks before each word.
        let begins = &begins[1 + self.insertions.branches.len()..];
        let pieces = self.insertions.groups.iter().zip(begins);
        let pieces = pieces.flat_map(|(group, &begin)| (begin..).zip(group.clone()));
        for (place, _) in pieces.clone() {
            marks[place as usize / WORD] |= 1 << (place as usize % WORD);
        }
        let mut count = 0;
        for (before, mark) in before.iter_mut().zip(&*marks) {
            *before = count;
            count += mark.count_ones();
        }
        for (place, piece) in pieces {
            let word = place as usize / WORD;
            let lower = marks[word] & !(u32::MAX << (place as usize % WORD));
            let rank = (before[word] + lower.count_ones()) as usize;
            (places[rank], numbers[rank]) = (place, fragments as u32 + piece);
        }
        // Backwards, so that each fragment moves to its final place at once.
        let mut end = fragments;
        for (rank, (&place, &number)) in places.iter().zip(&*numbers).enumerate().rev() {
            let (place, start) = (place as usize, place as usize - rank);
            order_itself.copy_within(start..end, place + 1);
            order_itself[place] = number;
            end = start;
        }
        order.truncate(all);
    }
}
