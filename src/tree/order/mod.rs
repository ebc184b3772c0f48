//! Orders: as iterators, as walks of nodes, and as numbers in a list.

pub(crate) mod eye;
pub(crate) mod layout;

use std::collections::VecDeque;
use std::hint::select_unpredictable;
use std::iter::FusedIterator;
use std::ops::{ControlFlow, Range};

use crate::tree::{BspTree, Child, Fragment, Node};
use crate::viewpoint::Viewpoint;
use eye::View;
use layout::{Chain, FRAGMENTS, Inner, NEXT, NODES, OrderLayout, ROOT, Span};

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

/// What a walk comes to: [`BspTree::walk_back_to_front`] and [`BspTree::walk_front_to_back`].
#[derive(Clone, Copy, Debug)]
pub enum Part<'t> {
    /// A subtree, before anything in it.
    Subtree(Node<'t>),
    /// A fragment, in its place in the order.
    Fragment(Fragment<'t>),
}

/// How a walk goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow<B = ()> {
    /// Into the subtree. After a fragment: to the next part.
    Descend,
    /// Past the subtree: nothing in it is visited. After a fragment: to the next part.
    Skip,
    /// Not at all: the walk ends and returns the value.
    Break(B),
}

impl BspTree {
    /// Visits subtrees and fragments, back to front, and leaves out the subtrees that `visit`
    /// skips. Returns what `visit` broke with.
    ///
    /// The fragments of subtrees that are not skipped come in the order of
    /// [`back_to_front`](Self::back_to_front). A subtree comes when the walk reaches it: after all
    /// that is behind it, before anything in it. Takes O(parts visited) time and O(depth) memory,
    /// and does not recurse.
    ///
    /// With [`Bounds`](crate::Bounds), what lies outside of a region is left out as a whole:
    ///
    /// ```
    /// use binspace::{BspTree, Flow, Part, Viewpoint};
    ///
    /// let square = |x: f64| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.5], [x, 1.0, 1.0]];
    /// let tree = BspTree::build((0..100).map(|k| square(f64::from(k))))?;
    /// let bounds = tree.bounds()?;
    /// let mut seen = Vec::new();
    /// let mut subtrees = 0;
    /// let _ = tree.walk_back_to_front(Viewpoint::eye([50.0, -9.0, 3.0]), |part| match part {
    ///     Part::Subtree(node) => {
    ///         subtrees += 1;
    ///         let [low, high] = bounds.of(node);
    ///         if high.x < 20.0 || low.x > 23.5 { Flow::Skip } else { Flow::<()>::Descend }
    ///     }
    ///     Part::Fragment(fragment) => {
    ///         seen.push(fragment.polygon());
    ///         Flow::Descend
    ///     }
    /// });
    /// assert!((20..=23).all(|polygon| seen.contains(&polygon)));
    /// assert!(subtrees < 40);
    /// # Ok::<(), binspace::Error>(())
    /// ```
    pub fn walk_back_to_front<'t, B>(
        &'t self,
        viewpoint: Viewpoint,
        visit: impl FnMut(Part<'t>) -> Flow<B>,
    ) -> ControlFlow<B> {
        self.walk(viewpoint, false, visit)
    }

    /// Visits subtrees and fragments, front to back, and leaves out the subtrees that `visit`
    /// skips; otherwise as [`walk_back_to_front`](Self::walk_back_to_front). A subtree comes after
    /// all that is in front of it: skip it if that hides it.
    pub fn walk_front_to_back<'t, B>(
        &'t self,
        viewpoint: Viewpoint,
        visit: impl FnMut(Part<'t>) -> Flow<B>,
    ) -> ControlFlow<B> {
        self.walk(viewpoint, true, visit)
    }

    fn walk<'t, B>(
        &'t self,
        viewpoint: Viewpoint,
        is_front_to_back: bool,
        mut visit: impl FnMut(Part<'t>) -> Flow<B>,
    ) -> ControlFlow<B> {
        let view = View::new(self, viewpoint);
        let mut pending = vec![self.whole()];
        while let Some(next) = pending.pop() {
            match next {
                Child::Node(node) => match visit(Part::Subtree(node)) {
                    Flow::Descend => {
                        let mut parts = node.parts(view.is_in_front(self, node.index()));
                        // The last one is taken first.
                        if !is_front_to_back {
                            parts.reverse();
                        }
                        pending.extend(parts);
                    }
                    Flow::Skip => {}
                    Flow::Break(value) => return ControlFlow::Break(value),
                },
                Child::Leaf(mut run) => {
                    let take = |run: &mut std::ops::Range<u32>| {
                        if is_front_to_back { run.next_back() } else { run.next() }
                    };
                    while let Some(index) = take(&mut run) {
                        if let Flow::Break(value) = visit(Part::Fragment(self.fragment(index))) {
                            return ControlFlow::Break(value);
                        }
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }
}

/// Spare places behind an order: a block always writes as many numbers as the largest has.
const ROOM: usize = FRAGMENTS;

impl BspTree {
    /// Writes the numbers of all fragments, back to front, into a buffer, and replaces its contents.
    ///
    /// The buffer is working space as well. Its capacity grows to one or two numbers per fragment,
    /// at most four per fragment plus sixteen; after that, nothing is allocated.
    ///
    /// O(n), without a stack: every node stores how many fragments lie on each of its sides, so the
    /// place of a subtree in the order is known before the subtree is read, and each number is
    /// written to its final place.
    pub fn back_to_front_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        let view = View::new(self, viewpoint);
        let Some(layout) = &self.layout else {
            order.clear();
            let (nodes, fragments) = (self.nodes.len() as u32, self.len() as u32);
            return write_from_nodes(self, &view, 0..nodes, 0..fragments, order);
        };
        write_order(layout, self.records.len(), self.planes.words(), order, |signs| {
            view.write_signs(self, signs);
        });
    }

    /// Writes the numbers of all fragments, front to back, into a buffer: the reverse of
    /// [`back_to_front_into`](Self::back_to_front_into).
    pub fn front_to_back_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        self.back_to_front_into(viewpoint, order);
        order.reverse();
    }
}

/// Adds the order of a subtree, or of all, from the nodes themselves.
pub(in crate::tree) fn write_from_nodes(
    tree: &BspTree,
    view: &View,
    nodes: Range<u32>,
    fragments: Range<u32>,
    order: &mut Vec<u32>,
) {
    let (begin, len) = (order.len(), fragments.len());
    order.resize(begin + len + 2 * nodes.len(), 0);
    // Where the subtree at each node begins in the order, and how many fragments it has.
    let (numbers, subtrees) = order[begin..].split_at_mut(len);
    match subtrees.first_chunk_mut() {
        Some(root) => *root = [0, len as u32],
        None => {
            numbers.iter_mut().zip(fragments.clone()).for_each(|(place, number)| *place = number)
        }
    }
    // Fragments are numbered in the order in which nodes are met here.
    let mut next = fragments.start;
    let mut write = |begin: u32, len: u32| {
        let places = &mut numbers[begin as usize..][..len as usize];
        places.iter_mut().zip(next..).for_each(|(place, number)| *place = number);
        next += len;
    };
    for (i, index) in (nodes.start as usize..nodes.end as usize).enumerate() {
        let node = &tree.nodes[index];
        let [begin, all] = [subtrees[2 * i], subtrees[2 * i + 1]];
        let (own, front) = (node.own(), node.front_len);
        let back = all - own - front;
        let is_in_front = view.is_in_front(tree, index);
        let to_own = begin + select_unpredictable(is_in_front, back, front);
        let to_front = begin + select_unpredictable(is_in_front, back + own, 0);
        let to_back = begin + select_unpredictable(is_in_front, 0, front + own);
        write(to_own, own);
        let sides = [(node.front_node(i), to_front, front), (node.back_node(i), to_back, back)];
        for (child, begin, len) in sides {
            match child {
                Some(child) => subtrees[2 * child..][..2].copy_from_slice(&[begin, len]),
                None => write(begin, len),
            }
        }
    }
    order.truncate(begin + len);
}

/// Writes an order in three passes over the tree's memory: on which side of each node the eye is,
/// then where each subtree begins in the order, then the fragments of subtrees too small for that.
///
/// `write_signs` fills `words` words with a bit for each node, 1 if the eye is in front.
#[inline]
fn write_order(
    layout: &OrderLayout,
    fragments: usize,
    words: usize,
    order: &mut Vec<u32>,
    write_signs: impl FnOnce(&mut [u32]),
) {
    // One buffer for all: the caller's, so that a frame allocates nothing.
    order.resize(fragments + ROOM + layout.parts() + words, 0);
    let (numbers, rest) = order.split_at_mut(fragments + ROOM);
    // Where each part begins in the order.
    let (begins, signs) = rest.split_at_mut(layout.parts());
    if let Some(root) = begins.get_mut(ROOT as usize) {
        *root = 0;
    }
    write_signs(signs);
    write_inner(&layout.inner, signs, begins, numbers);
    let begins = &begins[ROOT as usize + layout.inner.len()..];
    let (of_blocks, of_spans) = begins.split_at(layout.blocks.len());
    write_blocks(layout, signs, of_blocks, numbers);
    write_spans(&layout.spans, of_spans, numbers);
    order.truncate(fragments);
}

/// Writes the fragments on the planes of inner nodes, and notes where the parts on their sides begin.
///
/// The loop has no branch on the eye's side, which no processor can predict; missing parts and
/// fragments write to dummy slots.
fn write_inner(inner: &[Inner], signs: &[u32], begins: &mut [u32], numbers: &mut [u32]) {
    let nowhere = numbers.len() - 1;
    let mut begin = 0;
    for (inner, next) in inner.iter().zip(ROOT as usize + 1..) {
        let &Inner { own, front, back, .. } = inner;
        let is_in_front = is_in_front(signs, inner.node);
        // The order is: far side, own, near side. The far side is the back if the eye is in front.
        let mut to_front = select_unpredictable(is_in_front, back + own, 0);
        let mut to_back = select_unpredictable(is_in_front, 0, front + own);
        let to_own = select_unpredictable(is_in_front, back, front);
        if own <= 1 {
            let place = select_unpredictable(own == 1, (begin + to_own) as usize, nowhere);
            // Without an own fragment, the write goes to a spare place behind the order. That is
            // cheaper than a branch that is taken for every other node.
            numbers[place] = inner.own_first;
        } else if let Some(chain) = inner.chain() {
            let to_rest = write_chain(&chain, signs, begin, numbers);
            // One of the two sides is `NOBODY`; the other is what the chain leaves.
            (to_front, to_back) = (to_rest, to_rest);
        } else {
            begins[inner.own_first as usize] = begin + to_own;
        }
        begins[inner.front_part as usize] = begin + to_front;
        begins[inner.back_part as usize] = begin + to_back;
        // The next inner node mostly is a child of this one, and then its place has just been computed.
        // Passing it on in a register saves the loop from waiting for a store to be read back.
        let stored = begins[next];
        let from_back = select_unpredictable(inner.back_part == NEXT, begin + to_back, stored);
        begin = select_unpredictable(inner.front_part == NEXT, begin + to_front, from_back);
    }
}

/// Writes subtrees of up to four fragments, each by one look into a table.
fn write_blocks(layout: &OrderLayout, signs: &[u32], begins: &[u32], numbers: &mut [u32]) {
    for (block, &begin) in layout.blocks.iter().zip(begins) {
        let word = block.node as usize / 32;
        // The bits of a block's nodes may lie across two words; `signs` has one word more than it needs.
        let words = u64::from(signs[word]) | u64::from(signs[word + 1]) << 32;
        let signs = (words >> (block.node % 32)) as usize % (1 << NODES);
        let places = layout.permutations[block.row as usize][signs] as usize;
        let room = numbers[begin as usize..].first_chunk_mut::<FRAGMENTS>();
        let Some(numbers) = room else { continue };
        // Always four writes. A fragment that the block does not have shares the place of the first
        // one, which is written last.
        numbers[places >> 6] = block.first + 3;
        numbers[places >> 4 & 3] = block.first + 2;
        numbers[places >> 2 & 3] = block.first + 1;
        numbers[places & 3] = block.first;
    }
}

fn write_spans(spans: &[Span], begins: &[u32], numbers: &mut [u32]) {
    for (run, &begin) in spans.iter().zip(begins) {
        let places = &mut numbers[begin as usize..][..run.len as usize];
        places.iter_mut().zip(run.first..).for_each(|(place, number)| *place = number);
    }
}

/// Writes the fragments of a chain from both ends inwards. Returns how many of them come before the
/// rest, which lies behind or in front of the last node.
fn write_chain(chain: &Chain, signs: &[u32], begin: u32, numbers: &mut [u32]) -> u32 {
    let places = &mut numbers[begin as usize..][..(chain.nodes + chain.rest) as usize];
    let (mut far, mut near) = (0, places.len() - 1);
    for (node, number) in (chain.first_node..).zip(chain.first..).take(chain.nodes as usize) {
        // The node's fragment is further than the rest if the rest and the eye are on one side.
        let is_far = is_in_front(signs, node) == chain.rest_is_front;
        places[select_unpredictable(is_far, far, near)] = number;
        far += usize::from(is_far);
        near -= usize::from(!is_far);
    }
    far as u32
}

#[inline]
fn is_in_front(signs: &[u32], node: u32) -> bool {
    signs[node as usize / 32] >> (node % 32) & 1 == 1
}

#[cfg(test)]
mod tests;
