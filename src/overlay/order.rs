//! One order of a tree's fragments and an overlay's pieces.

use std::iter::FusedIterator;
use std::ops::Range;

use smallvec::{SmallVec, smallvec};

use super::Overlay;
use super::shapes::Shape;
use super::skeleton::{Branch, Group, SlotContent, SlotSide};
use crate::error::Error;
use crate::tree::order::eye_sides::View;
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
