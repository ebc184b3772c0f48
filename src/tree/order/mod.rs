//! Orders: as iterators, as walks of nodes, and as numbers in a list.

pub(crate) mod eye;
pub(crate) mod layout;

use std::collections::VecDeque;
use std::hint::select_unpredictable;
use std::iter::FusedIterator;
use std::ops::{ControlFlow, Range};

use super::culling::{Cull, Culling};
use crate::tree::{BspTree, Child, Fragment, Node};
use crate::viewpoint::Viewpoint;
use eye::View;
use layout::{Chain, FRAGMENTS, Inner, NEXT, NODES, OrderLayout, ROOT, Span};

/// The order of a tree's [fragments](Fragment) for one viewpoint: [`BspTree::order`].
///
/// Back to front by default; see [`front_to_back`](Self::front_to_back). Write the order into a list of
/// numbers, iterate over its fragments, or [walk](Self::walk) its subtrees:
///
/// ```
/// use binspace::{BspTree, Viewpoint};
///
/// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
/// let tree = BspTree::build([square(2.0), square(0.0), square(1.0)])?;
/// let order = tree.order(Viewpoint::eye([0.5, 0.5, 9.0])).front_to_back();
///
/// let mut numbers = Vec::new();
/// order.write_into(&mut numbers);
/// assert!(order.into_iter().map(|fragment| fragment.index()).eq(numbers));
/// assert!(order.into_iter().map(|fragment| fragment.polygon()).eq([0, 2, 1]));
/// # Ok::<(), binspace::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
#[must_use = "an order is written, iterated over or walked"]
pub struct Order<'t> {
    pub(crate) tree: &'t BspTree,
    pub(crate) viewpoint: Viewpoint,
    pub(crate) is_front_to_back: bool,
    pub(crate) culling: Option<&'t Culling>,
}

impl BspTree {
    /// Returns the order of the fragments for a viewpoint, for writing into a list, iteration or a walk.
    pub fn order(&self, viewpoint: Viewpoint) -> Order<'_> {
        Order { tree: self, viewpoint, is_front_to_back: false, culling: None }
    }

    /// Iterates over the fragments back to front: no fragment hides a later fragment. A shorthand for
    /// iterating over [`order`](Self::order).
    pub fn back_to_front(&self, viewpoint: Viewpoint) -> Ordered<'_> {
        self.order(viewpoint).into_iter()
    }

    /// Replaces a buffer's contents by the numbers of all fragments, back to front. A shorthand for
    /// [`Order::write_into`].
    pub fn back_to_front_into(&self, viewpoint: Viewpoint, numbers: &mut Vec<u32>) {
        self.order(viewpoint).write_into(numbers);
    }
}

impl<'t> Order<'t> {
    /// Reverses the order to front to back: no later fragment hides an earlier fragment. Front to back is the
    /// exact reverse of back to front.
    pub fn front_to_back(self) -> Self {
        Self { is_front_to_back: true, ..self }
    }

    /// Leaves out the fragments that are outside the frustum of `culling` or do not show the side that
    /// `culling` keeps. The other fragments keep their order.
    pub fn culled(self, culling: &'t Culling) -> Self {
        Self { culling: Some(culling), ..self }
    }

    /// Replaces a buffer's contents by the numbers of the fragments.
    ///
    /// Takes O(n) time. The buffer also serves as working space: its capacity usually grows to one or two
    /// numbers per fragment, and to at most four numbers per fragment plus sixteen. Once the buffer is large
    /// enough, nothing is allocated.
    ///
    /// A [culled](Self::culled) order skips subtrees outside the frustum and subtrees seen only from the
    /// wrong side. The time of a culled order is proportional to the number of remaining fragments plus the
    /// number of fragments close to the frustum's boundary. The call then allocates O(depth) memory, plus a
    /// bit for each fragment and for each block of 16 fragments.
    ///
    /// [`Triangles::write_order`](crate::mesh::Triangles::write_order) converts the list into indices of
    /// triangles.
    pub fn write_into(self, numbers: &mut Vec<u32>) {
        match self.culling {
            Some(culling) => {
                numbers.clear();
                Cull::new(self.tree, self.viewpoint, culling).write(numbers);
            }
            None => self.tree.write_all(self.viewpoint, numbers),
        }
        if self.is_front_to_back {
            numbers.reverse();
        }
    }

    /// Visits subtrees and fragments, and skips the subtrees for which `visit` returns [`Flow::Skip`].
    /// Returns the value of [`Flow::Break`], if any.
    ///
    /// A subtree is visited before its own fragments and subtrees, and after everything that precedes the
    /// subtree in the order. So in a front-to-back walk, a subtree is visited after all fragments that may
    /// hide it.
    ///
    /// The walk takes O(subtrees and fragments visited) time and O(depth) memory, and does not recurse. The
    /// walk of a [culled](Self::culled) order first tests the boxes against the frustum, and needs one more
    /// bit of memory for each fragment.
    ///
    /// ```
    /// use binspace::{BspTree, Flow, Part, Viewpoint};
    ///
    /// let square = |x: f64| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.5], [x, 1.0, 1.0]];
    /// let tree = BspTree::build((0..100).map(|k| square(f64::from(k))))?;
    /// let mut seen = Vec::new();
    /// let mut subtrees = 0;
    /// let _ = tree.order(Viewpoint::eye([50.0, -9.0, 3.0])).walk(|part| match part {
    ///     Part::Subtree(node) => {
    ///         subtrees += 1;
    ///         let [low, high] = node.bounds();
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
    pub fn walk<B>(self, mut visit: impl FnMut(Part<'t>) -> Flow<B>) -> ControlFlow<B> {
        let Self { tree, viewpoint, is_front_to_back, culling } = self;
        let view = View::new(tree, viewpoint);
        let cull = culling.map(|culling| Cull::new(tree, viewpoint, culling));
        let mut pending = vec![tree.whole()];
        while let Some(next) = pending.pop() {
            match next {
                Child::Node(node) => {
                    if cull.as_ref().is_some_and(|cull| !cull.shows_some(&node)) {
                        continue;
                    }
                    match visit(Part::Subtree(node)) {
                        Flow::Descend => {
                            let mut parts = node.parts(view.is_in_front(tree, node.index()));
                            // A stack: the last part is visited first.
                            if !is_front_to_back {
                                parts.reverse();
                            }
                            pending.extend(parts);
                        }
                        Flow::Skip => {}
                        Flow::Break(value) => return ControlFlow::Break(value),
                    }
                }
                Child::Leaf(mut run) => {
                    let take = |run: &mut Range<u32>| {
                        if is_front_to_back { run.next_back() } else { run.next() }
                    };
                    while let Some(index) = take(&mut run) {
                        if cull.as_ref().is_some_and(|cull| !cull.shows(index)) {
                            continue;
                        }
                        if let Flow::Break(value) = visit(Part::Fragment(tree.fragment(index))) {
                            return ControlFlow::Break(value);
                        }
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }
}

impl<'t> IntoIterator for Order<'t> {
    type Item = Fragment<'t>;
    type IntoIter = Ordered<'t>;

    /// A culled order is written into a list first.
    fn into_iter(self) -> Ordered<'t> {
        let Self { tree, viewpoint, is_front_to_back, culling } = self;
        let (mut left, mut parts) = (tree.records.len(), VecDeque::from([tree.whole()]));
        if culling.is_some() {
            let mut numbers = Vec::new();
            Self { is_front_to_back: false, ..self }.write_into(&mut numbers);
            left = numbers.len();
            parts = numbers.into_iter().map(|number| Child::Leaf(number..number + 1)).collect();
        }
        let view = View::new(tree, viewpoint);
        Ordered { tree, view, is_front_to_back, far: 0..0, parts, near: 0..0, left }
    }
}

/// A [subtree](Node) or [fragment](Fragment) visited by a walk: [`Order::walk`].
#[derive(Clone, Copy, Debug)]
pub enum Part<'t> {
    /// A subtree. The walk visits a subtree before the subtree's own fragments and subtrees.
    Subtree(Node<'t>),
    /// A fragment. The walk visits fragments in the order of the viewpoint.
    Fragment(Fragment<'t>),
}

/// The result of the caller's function in a walk ([`Order::walk`]): how the walk continues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow<B = ()> {
    /// Enter the [subtree](Node). After a [fragment](Fragment): continue with the next [part](Part).
    Descend,
    /// Skip the subtree. After a fragment: continue with the next [part](Part).
    Skip,
    /// End the walk, which then returns this value.
    Break(B),
}

/// Iterates over the [fragments](Fragment) of a tree in an [`Order`].
///
/// This iterator can be read from both ends. Reading all n fragments takes O(n) time and O(depth) memory. A
/// [culled](Order::culled) order is written into a list before the first fragment is returned.
#[derive(Clone, Debug)]
pub struct Ordered<'t> {
    tree: &'t BspTree,
    view: View,
    /// Whether `next` takes the nearest fragment rather than the furthest.
    is_front_to_back: bool,
    /// The furthest fragments, behind all of `parts`.
    far: Range<u32>,
    /// The parts that the iterator has reached from neither end, back to front. Each end opens subtrees only
    /// as far as necessary.
    parts: VecDeque<Child<'t>>,
    /// The nearest fragments, in front of all of `parts`.
    near: Range<u32>,
    left: usize,
}

impl<'t> Ordered<'t> {
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
                // Only the run that the other end is reading remains: continue with that run.
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
        if self.is_front_to_back { self.take_nearest() } else { self.take_furthest() }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl DoubleEndedIterator for Ordered<'_> {
    fn next_back(&mut self) -> Option<Self::Item> {
        if self.is_front_to_back { self.take_furthest() } else { self.take_nearest() }
    }
}

impl ExactSizeIterator for Ordered<'_> {}
impl FusedIterator for Ordered<'_> {}

/// Spare places behind an order: a block always writes the largest number of fragments that a block may
/// have.
const ROOM: usize = FRAGMENTS;

impl BspTree {
    /// Writes the numbers of all fragments, back to front.
    fn write_all(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
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
}

/// Appends the order of a subtree, or of the whole tree, without using the layout.
pub(in crate::tree) fn write_from_nodes(
    tree: &BspTree,
    view: &View,
    nodes: Range<u32>,
    fragments: Range<u32>,
    order: &mut Vec<u32>,
) {
    let (begin, len) = (order.len(), fragments.len());
    order.resize(begin + len + 2 * nodes.len(), 0);
    // The first place of each node's subtree in the order, and its number of fragments.
    let (numbers, subtrees) = order[begin..].split_at_mut(len);
    match subtrees.first_chunk_mut() {
        Some(root) => *root = [0, len as u32],
        None => {
            numbers.iter_mut().zip(fragments.clone()).for_each(|(place, number)| *place = number)
        }
    }
    // Fragments are numbered in the order in which this loop visits nodes.
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

/// Writes an order in three passes over the tree's memory. The first computes the eye's side of each node,
/// the second computes the place of each subtree in the order, and the third writes the fragments of small
/// subtrees.
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
    // One buffer for everything, supplied by the caller, so that a frame allocates nothing.
    order.resize(fragments + ROOM + layout.parts() + words, 0);
    let (numbers, rest) = order.split_at_mut(fragments + ROOM);
    // The first place of each part in the order.
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

/// Writes the fragments on the planes of inner nodes, and stores the first places of the parts on the sides
/// of these nodes.
///
/// The loop does not branch on the eye's side, because no processor can predict that branch. Missing parts
/// and fragments write to dummy places.
fn write_inner(inner: &[Inner], signs: &[u32], begins: &mut [u32], numbers: &mut [u32]) {
    let nowhere = numbers.len() - 1;
    let mut begin = 0;
    for (inner, next) in inner.iter().zip(ROOT as usize + 1..) {
        let &Inner { own, front, back, .. } = inner;
        let is_in_front = is_in_front(signs, inner.node);
        // The order is: far side, own fragments, near side. The far side is the back if the eye is in front.
        let mut to_front = select_unpredictable(is_in_front, back + own, 0);
        let mut to_back = select_unpredictable(is_in_front, 0, front + own);
        let to_own = select_unpredictable(is_in_front, back, front);
        if own <= 1 {
            let place = select_unpredictable(own == 1, (begin + to_own) as usize, nowhere);
            // For an inner node without a fragment of its own, this writes to a spare place behind the order.
            // The write is cheaper than a branch that is taken for every other node.
            numbers[place] = inner.own_first;
        } else if let Some(chain) = inner.chain() {
            let to_rest = write_chain(&chain, signs, begin, numbers);
            // One of the two sides is `NOBODY`; the other contains the fragments below the chain.
            (to_front, to_back) = (to_rest, to_rest);
        } else {
            begins[inner.own_first as usize] = begin + to_own;
        }
        begins[inner.front_part as usize] = begin + to_front;
        begins[inner.back_part as usize] = begin + to_back;
        // The next inner node mostly is a child of this node, and the child's place has just been computed.
        // Passing the place on in a register saves the loop from waiting for a store to be read back.
        let stored = begins[next];
        let from_back = select_unpredictable(inner.back_part == NEXT, begin + to_back, stored);
        begin = select_unpredictable(inner.front_part == NEXT, begin + to_front, from_back);
    }
}

/// Writes the fragments of blocks. Each block takes one look-up in a table.
fn write_blocks(layout: &OrderLayout, signs: &[u32], begins: &[u32], numbers: &mut [u32]) {
    for (block, &begin) in layout.blocks.iter().zip(begins) {
        let word = block.node as usize / 32;
        // The bits of a block's nodes may lie across two words; `signs` has a spare word at the end.
        let words = u64::from(signs[word]) | u64::from(signs[word + 1]) << 32;
        let signs = (words >> (block.node % 32)) as usize % (1 << NODES);
        let places = layout.permutations[block.row as usize][signs] as usize;
        let room = numbers[begin as usize..].first_chunk_mut::<FRAGMENTS>();
        let Some(numbers) = room else { continue };
        // Always four writes. A missing fragment shares the place of the first fragment, which is written
        // last.
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

/// Writes the fragments of a chain from both ends inwards. Returns the number of the chain's fragments that
/// precede the fragments below the chain's last node.
fn write_chain(chain: &Chain, signs: &[u32], begin: u32, numbers: &mut [u32]) -> u32 {
    let places = &mut numbers[begin as usize..][..(chain.nodes + chain.rest) as usize];
    let (mut far, mut near) = (0, places.len() - 1);
    for (node, number) in (chain.first_node..).zip(chain.first..).take(chain.nodes as usize) {
        // The node's fragment is further than the remaining fragments if the remaining fragments and the eye
        // are on the same side.
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
