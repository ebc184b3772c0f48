//! One order of a tree's fragments and an overlay's pieces: items one by one, or numbers in a list.

use std::hint::select_unpredictable;
use std::iter::FusedIterator;
use std::ops::Range;

use smallvec::{SmallVec, smallvec};

use super::Overlay;
use super::replace::Shape;
use super::skeleton::{Branch, Group, SlotContent, SlotSide};
use crate::error::Error;
use crate::tree::order::eye::View;
use crate::tree::{BspTree, Ordered};
use crate::viewpoint::Viewpoint;

/// What comes next in an order.
enum Step {
    /// So many fragments of the tree, in the tree's order.
    Fragments(u32),
    /// Pieces, by their numbers in the overlay.
    Pieces(Range<u32>),
}

/// The steps of an order.
#[derive(Clone, Debug)]
struct Steps<'a> {
    overlay: &'a Overlay,
    view: View,
    near_first: bool,
    stack: SmallVec<[SlotSide; 64]>,
}

impl<'a> Steps<'a> {
    fn new(overlay: &'a Overlay, view: View, near_first: bool) -> Self {
        Self { overlay, view, near_first, stack: smallvec![overlay.skeleton.root()] }
    }

    fn next(&mut self) -> Option<Step> {
        loop {
            let SlotSide { slot, len } = self.stack.pop()?;
            match self.overlay.skeleton.part(slot) {
                _ if len == 0 => {}
                SlotContent::Still => return Some(Step::Fragments(len)),
                SlotContent::Pieces(Group { first, len }) => {
                    return Some(Step::Pieces(first..first + len));
                }
                SlotContent::Branch(number) => self.open(number),
            }
        }
    }

    fn open(&mut self, number: u32) {
        let skeleton = &self.overlay.skeleton;
        let &Branch { plane, rounded, own, pieces, front, back } =
            &skeleton.branches[number as usize];
        let is_in_front = self.view.is_in_front_of(&self.overlay.faces, plane, rounded);
        let (far, near) = if is_in_front { (back, front) } else { (front, back) };
        let own = SlotSide { slot: skeleton.slots() as u32 - 1, len: own };
        let mut parts = [far, own, pieces, near];
        // What comes first goes on top.
        if !self.near_first {
            parts.reverse();
        }
        self.stack.extend(parts);
    }
}

/// The fragments of a tree and the pieces of an overlay in the order of a viewpoint:
/// [`Overlay::back_to_front`] and [`Overlay::front_to_back`].
#[derive(Clone, Debug)]
pub struct Overlaid<'a> {
    fragments: Ordered<'a>,
    /// How many of them come before the next piece.
    ahead: u32,
    pieces: Range<u32>,
    steps: Steps<'a>,
    left: usize,
}

impl<'a> Overlaid<'a> {
    fn new(overlay: &'a Overlay, tree: &'a BspTree, viewpoint: Viewpoint, near: bool) -> Self {
        let fragments =
            if near { tree.front_to_back(viewpoint) } else { tree.back_to_front(viewpoint) };
        let steps = Steps::new(overlay, View::new(tree, viewpoint), near);
        let left = tree.len() + overlay.len();
        Self { fragments, ahead: 0, pieces: 0..0, steps, left }
    }
}

impl<'a> Iterator for Overlaid<'a> {
    type Item = Shape<'a>;

    fn next(&mut self) -> Option<Shape<'a>> {
        loop {
            if self.ahead > 0 {
                self.ahead -= 1;
                self.left -= 1;
                return self.fragments.next().map(Shape::Fragment);
            }
            let piece =
                if self.steps.near_first { self.pieces.next_back() } else { self.pieces.next() };
            if let Some(piece) = piece {
                self.left -= 1;
                let overlay = self.steps.overlay;
                return overlay.shape(overlay.base.fragments as u32 + piece);
            }
            match self.steps.next()? {
                Step::Fragments(len) => self.ahead = len,
                Step::Pieces(pieces) => self.pieces = pieces,
            }
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl ExactSizeIterator for Overlaid<'_> {}
impl FusedIterator for Overlaid<'_> {}

impl Overlay {
    /// The fragments of the tree and the pieces of the overlay, back to front: none hides one that
    /// comes later. What has a number below the tree's [`len`](BspTree::len) is a fragment of the
    /// tree.
    ///
    /// # Errors
    ///
    /// If the tree is neither the one that the overlay was made for nor a clone of it.
    pub fn back_to_front<'a>(
        &'a self,
        tree: &'a BspTree,
        viewpoint: Viewpoint,
    ) -> Result<Overlaid<'a>, Error> {
        self.expect(tree)?;
        Ok(Overlaid::new(self, tree, viewpoint, false))
    }

    /// The same, front to back: the reverse of [`back_to_front`](Self::back_to_front).
    ///
    /// # Errors
    ///
    /// If the tree is neither the one that the overlay was made for nor a clone of it.
    pub fn front_to_back<'a>(
        &'a self,
        tree: &'a BspTree,
        viewpoint: Viewpoint,
    ) -> Result<Overlaid<'a>, Error> {
        self.expect(tree)?;
        Ok(Overlaid::new(self, tree, viewpoint, true))
    }
}

/// How many places of an order are in a word of marks.
const WORD: usize = u32::BITS as usize;

impl Overlay {
    /// Writes the numbers of all fragments and pieces, back to front, into a buffer, and replaces its
    /// contents. Numbers below the tree's [`len`](BspTree::len) are those of its fragments, the others
    /// those of [pieces](Self::piece).
    ///
    /// It takes the time of [`BspTree::back_to_front_into`], of a copy of the list, and of a look at
    /// each plane on the way to the pieces. An empty overlay adds nothing. The buffer is working space
    /// as well; once it has grown to its size, nothing is allocated.
    ///
    /// # Errors
    ///
    /// If the tree is neither the one that the overlay was made for nor a clone of it.
    pub fn back_to_front_into(
        &self,
        tree: &BspTree,
        viewpoint: Viewpoint,
        order: &mut Vec<u32>,
    ) -> Result<(), Error> {
        self.expect(tree)?;
        tree.back_to_front_into(viewpoint, order);
        if !self.is_empty() {
            self.insert(&View::new(tree, viewpoint), order);
        }
        Ok(())
    }

    /// Writes the numbers of all fragments and pieces, front to back: the reverse of
    /// [`back_to_front_into`](Self::back_to_front_into).
    ///
    /// # Errors
    ///
    /// If the tree is neither the one that the overlay was made for nor a clone of it.
    pub fn front_to_back_into(
        &self,
        tree: &BspTree,
        viewpoint: Viewpoint,
        order: &mut Vec<u32>,
    ) -> Result<(), Error> {
        self.back_to_front_into(tree, viewpoint, order)?;
        order.reverse();
        Ok(())
    }

    /// Inserts the pieces into the tree's order.
    ///
    /// Every side of the skeleton knows how many fragments and pieces it has, so where a side begins
    /// is known before it is read, as in the tree's own order.
    fn insert(&self, view: &View, order: &mut Vec<u32>) {
        let (fragments, pieces) = (order.len(), self.len());
        let all = fragments + pieces;
        let (slots, words) = (self.skeleton.slots(), all.div_ceil(WORD));
        // One buffer for all: the caller's, so that a frame allocates nothing.
        let room = all + slots + 2 * words + 2 * pieces;
        order.reserve(room - fragments);
        order.resize(room, 0);
        let (order_itself, rest) = order.split_at_mut(all);
        let (begins, rest) = rest.split_at_mut(slots);
        let (marks, rest) = rest.split_at_mut(words);
        let (before, rest) = rest.split_at_mut(words);
        let (places, numbers) = rest.split_at_mut(pieces);
        self.write_begins(view, begins);
        let groups = &begins[self.skeleton.branches.len()..];
        self.sort(groups, (marks, before), (places, numbers), fragments as u32);
        spread(order_itself, fragments, places, numbers);
        order.truncate(all);
    }

    /// Writes where each slot begins in the order of both parts.
    ///
    /// The loop has no branch on the eye's side, which no processor can predict.
    fn write_begins(&self, view: &View, begins: &mut [u32]) {
        begins[self.skeleton.root().slot as usize] = 0;
        for (i, branch) in self.skeleton.branches.iter().enumerate() {
            let &Branch { plane, rounded, own, pieces, front, back } = branch;
            let is_in_front = view.is_in_front_of(&self.faces, plane, rounded);
            let begin = begins[i];
            let on_plane = own + pieces.len;
            // The order is: far side, own, near side. The far side is the back if the eye is in front.
            let to_front = select_unpredictable(is_in_front, back.len + on_plane, 0);
            let to_back = select_unpredictable(is_in_front, 0, front.len + on_plane);
            let to_pieces = own + select_unpredictable(is_in_front, back.len, front.len);
            begins[front.slot as usize] = begin + to_front;
            begins[back.slot as usize] = begin + to_back;
            begins[pieces.slot as usize] = begin + to_pieces;
        }
    }

    /// Writes the places of all pieces in ascending order, and their numbers, by marks on the places
    /// and how many are marked before each word.
    fn sort(
        &self,
        begins: &[u32],
        (marks, before): (&mut [u32], &mut [u32]),
        (places, numbers): (&mut [u32], &mut [u32]),
        first_number: u32,
    ) {
        let pieces = || {
            let groups = self.skeleton.groups.iter().zip(begins);
            groups.flat_map(|(&Group { first, len }, &begin)| (begin..begin + len).zip(first..))
        };
        for (place, _) in pieces() {
            marks[place as usize / WORD] |= 1 << (place as usize % WORD);
        }
        let mut count = 0;
        for (before, mark) in before.iter_mut().zip(&*marks) {
            *before = count;
            count += mark.count_ones();
        }
        for (place, piece) in pieces() {
            let word = place as usize / WORD;
            let lower = marks[word] & !(u32::MAX << (place as usize % WORD));
            let rank = (before[word] + lower.count_ones()) as usize;
            (places[rank], numbers[rank]) = (place, first_number + piece);
        }
    }
}

/// Inserts numbers into a list at ascending places, from its end on, so that each of the others moves
/// to its final place at once.
fn spread(order: &mut [u32], others: usize, places: &[u32], numbers: &[u32]) {
    let mut end = others;
    for (rank, (&place, &number)) in places.iter().zip(numbers).enumerate().rev() {
        let (place, start) = (place as usize, place as usize - rank);
        order.copy_within(start..end, place + 1);
        order[place] = number;
        end = start;
    }
}
