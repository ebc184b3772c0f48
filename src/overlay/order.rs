//! One order of a tree's fragments and an overlay's pieces.

use std::iter::FusedIterator;
use std::ops::Range;

use smallvec::{SmallVec, smallvec};

use super::Overlay;
use super::skeleton::{Branch, Part};
use crate::error::Error;
use crate::tree::order::sides::View;
use crate::tree::{BspTree, Fragment, Ordered};
use crate::viewpoint::Viewpoint;

/// What comes next in an order.
enum Step {
    /// So many fragments of the tree, in the tree's order.
    Static(u32),
    /// Pieces, by their numbers in the overlay.
    Pieces(Range<u32>),
}

/// The steps of an order.
#[derive(Clone, Debug)]
struct Steps<'a> {
    overlay: &'a Overlay,
    view: View,
    near_first: bool,
    stack: SmallVec<[Part; 64]>,
}

impl<'a> Steps<'a> {
    fn new(overlay: &'a Overlay, view: View, near_first: bool) -> Self {
        Self { overlay, view, near_first, stack: smallvec![overlay.skeleton.root] }
    }

    fn next(&mut self) -> Option<Step> {
        loop {
            match self.stack.pop()? {
                Part::Static(0) => {}
                Part::Static(len) => return Some(Step::Static(len)),
                Part::Pieces { len: 0, .. } => {}
                Part::Pieces { first, len } => return Some(Step::Pieces(first..first + len)),
                Part::Branch(number) => self.open(number),
            }
        }
    }

    fn open(&mut self, number: u32) {
        let branch = &self.overlay.skeleton.branches[number as usize];
        let &Branch { plane, rounded, own, first, len, front, back } = branch;
        let is_in_front = self.view.is_in_front_of(&self.overlay.faces, plane, rounded);
        let (far, near) = if is_in_front { (back, front) } else { (front, back) };
        let mut parts = [far, Part::Static(own), Part::Pieces { first, len }, near];
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
    type Item = Fragment<'a>;

    fn next(&mut self) -> Option<Fragment<'a>> {
        loop {
            if self.ahead > 0 {
                self.ahead -= 1;
                self.left -= 1;
                return self.fragments.next();
            }
            let piece =
                if self.steps.near_first { self.pieces.next_back() } else { self.pieces.next() };
            if let Some(piece) = piece {
                self.left -= 1;
                let overlay = self.steps.overlay;
                return overlay.piece(overlay.base.fragments as u32 + piece);
            }
            match self.steps.next()? {
                Step::Static(len) => self.ahead = len,
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
    /// If the tree is not the one that the overlay was made for.
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
    /// If the tree is not the one that the overlay was made for.
    pub fn front_to_back<'a>(
        &'a self,
        tree: &'a BspTree,
        viewpoint: Viewpoint,
    ) -> Result<Overlaid<'a>, Error> {
        self.expect(tree)?;
        Ok(Overlaid::new(self, tree, viewpoint, true))
    }

    /// Writes the numbers of all fragments and pieces, back to front, into a buffer, and replaces its
    /// contents. Numbers below the tree's [`len`](BspTree::len) are those of its fragments, the others
    /// those of [pieces](Self::piece).
    ///
    /// It takes the time of [`BspTree::back_to_front_into`] and of a copy of the list. An empty
    /// overlay adds nothing. Nothing is allocated once the buffer has its size, unless the skeleton
    /// of the tree that leads to the pieces is very deep.
    ///
    /// # Errors
    ///
    /// If the tree is not the one that the overlay was made for.
    pub fn back_to_front_into(
        &self,
        tree: &BspTree,
        viewpoint: Viewpoint,
        order: &mut Vec<u32>,
    ) -> Result<(), Error> {
        self.expect(tree)?;
        tree.back_to_front_into(viewpoint, order);
        if !self.is_empty() {
            self.insert(Steps::new(self, View::new(tree, viewpoint), true), order);
        }
        Ok(())
    }

    /// Writes the numbers of all fragments and pieces, front to back: the reverse of
    /// [`back_to_front_into`](Self::back_to_front_into).
    ///
    /// # Errors
    ///
    /// If the tree is not the one that the overlay was made for.
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

    /// Inserts the pieces into the tree's order, from its near end on, so that each fragment moves to
    /// its final place at once.
    fn insert(&self, mut steps: Steps<'_>, order: &mut Vec<u32>) {
        let fragments = order.len();
        let mut left = self.len();
        order.resize(fragments + left, 0);
        // Fragments before `end` are in their old places; those since the last pieces are `run`.
        let (mut end, mut run) = (fragments, 0);
        while let Some(step) = steps.next() {
            match step {
                Step::Static(len) => run += len as usize,
                Step::Pieces(pieces) => {
                    order.copy_within(end - run..end, end - run + left);
                    end -= run;
                    run = 0;
                    left -= pieces.len();
                    let places = &mut order[end + left..][..pieces.len()];
                    let numbers = pieces.start + fragments as u32..;
                    places.iter_mut().zip(numbers).for_each(|(place, number)| *place = number);
                    // What is left of the tree's order is where it belongs.
                    if left == 0 {
                        return;
                    }
                }
            }
        }
    }
}
