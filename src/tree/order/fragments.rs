//! Orders one fragment at a time.

use std::collections::VecDeque;
use std::iter::FusedIterator;
use std::ops::{ControlFlow, Range};

use super::eye_sides::View;
use crate::tree::{BspTree, Child, Fragment, Node};
use crate::viewpoint::Viewpoint;

/// The fragments of a tree in the order of a viewpoint: [`BspTree::back_to_front`] and
/// [`BspTree::front_to_back`].
///
/// It can be read from both ends. To read all n fragments takes O(n) time, from either end or from
/// both, and O(depth) memory.
#[derive(Clone, Debug)]
pub struct Ordered<'t> {
    tree: &'t BspTree,
    view: View,
    /// Whether `next` takes the nearest fragment rather than the furthest.
    front_to_back: bool,
    /// The furthest fragments, behind all of `parts`.
    far: Range<u32>,
    /// What neither end has come to, back to front. Each end opens subtrees only as far as it must.
    parts: VecDeque<Child<'t>>,
    /// The nearest fragments, in front of all of `parts`.
    near: Range<u32>,
    left: usize,
}

impl<'t> Ordered<'t> {
    fn new(tree: &'t BspTree, viewpoint: Viewpoint, front_to_back: bool) -> Self {
        let left = tree.records.len();
        let view = View::new(tree, viewpoint);
        let parts = [tree.whole()].into();
        Self { tree, view, front_to_back, far: 0..0, parts, near: 0..0, left }
    }

    /// The parts of a subtree, back to front.
    fn open(&self, node: Node<'t>) -> [Child<'t>; 3] {
        node.parts(self.view.is_in_front(self.tree, node.index()))
    }

    fn take_furthest(&mut self) -> Option<Fragment<'t>> {
        while self.far.is_empty() {
            match self.parts.pop_front() {
                Some(Child::Leaf(run)) => self.far = run,
                Some(Child::Node(node)) => {
                    let parts = self.open(node);
                    parts.into_iter().rev().for_each(|part| self.parts.push_front(part));
                }
                // Only the run that the other end is reading is left: this end reads on in it.
                None => {
                    let index = self.near.next()?;
                    return Some(self.take(index));
                }
            }
        }
        let index = self.far.next()?;
        Some(self.take(index))
    }

    fn take_nearest(&mut self) -> Option<Fragment<'t>> {
        while self.near.is_empty() {
            match self.parts.pop_back() {
                Some(Child::Leaf(run)) => self.near = run,
                Some(Child::Node(node)) => {
                    let parts = self.open(node);
                    self.parts.extend(parts);
                }
                None => {
                    let index = self.far.next_back()?;
                    return Some(self.take(index));
                }
            }
        }
        let index = self.near.next_back()?;
        Some(self.take(index))
    }

    fn take(&mut self, index: u32) -> Fragment<'t> {
        self.left -= 1;
        self.tree.fragment(index)
    }
}

impl<'t> Iterator for Ordered<'t> {
    type Item = Fragment<'t>;

    fn next(&mut self) -> Option<Fragment<'t>> {
        if self.front_to_back { self.take_nearest() } else { self.take_furthest() }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl DoubleEndedIterator for Ordered<'_> {
    fn next_back(&mut self) -> Option<Self::Item> {
        if self.front_to_back { self.take_furthest() } else { self.take_nearest() }
    }
}

impl ExactSizeIterator for Ordered<'_> {}
impl FusedIterator for Ordered<'_> {}

impl BspTree {
    /// The fragments, back to front: none hides one that comes later.
    pub fn back_to_front(&self, viewpoint: Viewpoint) -> Ordered<'_> {
        Ordered::new(self, viewpoint, false)
    }

    /// The fragments, front to back: none is hidden by one that comes later. The reverse of
    /// [`back_to_front`](Self::back_to_front).
    pub fn front_to_back(&self, viewpoint: Viewpoint) -> Ordered<'_> {
        Ordered::new(self, viewpoint, true)
    }

    /// Calls `visit` with each fragment, back to front, until it returns [`ControlFlow::Break`],
    /// and returns what it returned last.
    pub fn visit_back_to_front<B>(
        &self,
        viewpoint: Viewpoint,
        visit: impl FnMut(Fragment<'_>) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        self.back_to_front(viewpoint).try_for_each(visit)
    }

    /// Calls `visit` with each fragment, front to back, until it returns [`ControlFlow::Break`]
    /// (say, because every pixel is covered), and returns what it returned last.
    pub fn visit_front_to_back<B>(
        &self,
        viewpoint: Viewpoint,
        visit: impl FnMut(Fragment<'_>) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        self.front_to_back(viewpoint).try_for_each(visit)
    }
}
