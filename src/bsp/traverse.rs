//! Orders one fragment at a time.

use std::iter::FusedIterator;
use std::ops::{ControlFlow, Range};

use super::planes::View;
use super::{BspTree, Fragment};
use crate::geom::{Exact, Kernel, Viewpoint};

/// A part of a tree: fragments in the order of their numbers, or a subtree.
#[derive(Clone, Debug)]
enum Part {
    Run(Range<u32>),
    Subtree { node: u32, fragments: Range<u32> },
}

/// The fragments of a tree in the order of a viewpoint: [`BspTree::back_to_front`] and
/// [`BspTree::front_to_back`].
#[derive(Clone, Debug)]
pub struct Ordered<'t, K: Kernel = Exact> {
    tree: &'t BspTree<K>,
    view: View,
    front_to_back: bool,
    run: Range<u32>,
    stack: Vec<Part>,
    left: usize,
}

impl<'t, K: Kernel> Ordered<'t, K> {
    fn new(tree: &'t BspTree<K>, viewpoint: Viewpoint, front_to_back: bool) -> Self {
        let left = tree.records.len();
        let all = 0..left as u32;
        let root = if tree.nodes.is_empty() {
            Part::Run(all)
        } else {
            Part::Subtree { node: 0, fragments: all }
        };
        let view = View::new(tree, viewpoint);
        Self { tree, view, front_to_back, run: 0..0, stack: vec![root], left }
    }

    /// Puts the parts of a subtree on the stack, the first to come on top.
    fn open(&mut self, index: u32, fragments: Range<u32>) {
        let node = &self.tree.nodes[index as usize];
        let mut next = fragments.start;
        let mut take = |len| {
            next += len;
            Part::Run(next - len..next)
        };
        let own = take(node.own());
        let back_len = fragments.len() as u32 - node.own() - node.front_len;
        // Leaves first: their fragments are numbered before those of the subtrees.
        let front_leaf = (node.front_nodes == 0).then(|| take(node.front_len));
        let back_leaf = (!node.back_is_node()).then(|| take(back_len));
        let mut subtree = |len, node| {
            next += len;
            Part::Subtree { node, fragments: next - len..next }
        };
        let front = front_leaf.unwrap_or_else(|| subtree(node.front_len, index + 1));
        let back = back_leaf.unwrap_or_else(|| subtree(back_len, index + 1 + node.front_nodes));
        let is_in_front = self.view.is_in_front(self.tree, index as usize);
        let (first, last) =
            if is_in_front != self.front_to_back { (back, front) } else { (front, back) };
        self.stack.extend([last, own, first]);
    }
}

impl<'t, K: Kernel> Iterator for Ordered<'t, K> {
    type Item = Fragment<'t, K>;

    fn next(&mut self) -> Option<Fragment<'t, K>> {
        while self.run.is_empty() {
            match self.stack.pop()? {
                Part::Run(run) => self.run = run,
                Part::Subtree { node, fragments } => self.open(node, fragments),
            }
        }
        self.left -= 1;
        let index = if self.front_to_back { self.run.next_back() } else { self.run.next() };
        index.map(|index| self.tree.fragment(index))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<K: Kernel> ExactSizeIterator for Ordered<'_, K> {}
impl<K: Kernel> FusedIterator for Ordered<'_, K> {}

impl<K: Kernel> BspTree<K> {
    /// The fragments, back to front: none hides one that comes later.
    pub fn back_to_front(&self, viewpoint: Viewpoint) -> Ordered<'_, K> {
        Ordered::new(self, viewpoint, false)
    }

    /// The fragments, front to back: none is hidden by one that comes later.
    pub fn front_to_back(&self, viewpoint: Viewpoint) -> Ordered<'_, K> {
        Ordered::new(self, viewpoint, true)
    }

    /// Shows the fragments to a visitor, back to front, until it breaks off; gives what it broke
    /// off with.
    pub fn visit_back_to_front<B>(
        &self,
        viewpoint: Viewpoint,
        visit: impl FnMut(Fragment<'_, K>) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        self.back_to_front(viewpoint).try_for_each(visit)
    }

    /// Shows the fragments to a visitor, front to back, until it breaks off (say, because every
    /// pixel is covered); gives what it broke off with.
    pub fn visit_front_to_back<B>(
        &self,
        viewpoint: Viewpoint,
        visit: impl FnMut(Fragment<'_, K>) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        self.front_to_back(viewpoint).try_for_each(visit)
    }
}
