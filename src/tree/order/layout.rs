//! The layout of a tree's fragments in memory, for writing orders: inner nodes, blocks ordered by a table,
//! and spans.

use std::collections::HashMap;

use crate::Error;
use crate::memory::push;
use crate::tree::node::NodeRecord;

/// The least length of a chain. Shorter chains are stored as ordinary inner nodes. Too small: branches on
/// chains take longer than short chains save. Too large: long chains are ordered node by node.
const SHORTEST_CHAIN: usize = 8;

impl OrderLayout {
    /// Lays out a tree. O(nodes).
    pub(in crate::tree) fn new(nodes: &[NodeRecord], fragments: u32) -> Result<Self, Error> {
        let mut layout =
            LayoutBuilder { nodes, layout: Self::default(), rows: HashMap::new(), next: 0 };
        layout.fill(fragments)?;
        let mut layout = layout.layout;
        layout.number();
        layout.inner.shrink_to_fit();
        layout.blocks.shrink_to_fit();
        layout.spans.shrink_to_fit();
        Ok(layout)
    }

    /// Replaces the number of a part within its kind by the part number, for all links to parts. The number
    /// of parts of each kind must be known.
    fn number(&mut self) {
        let blocks = ROOT + self.inner.len() as u32;
        let spans = blocks + self.blocks.len() as u32;
        for inner in &mut self.inner {
            let parts = [&mut inner.front_part, &mut inner.back_part];
            let own = (inner.own > 1 && inner.own & CHAIN == 0).then_some(&mut inner.own_first);
            for part in parts.into_iter().chain(own) {
                *part = match *part & KIND {
                    BLOCK => blocks + (*part & !KIND),
                    SPAN => spans + (*part & !KIND),
                    _ => *part,
                };
            }
        }
    }
}

/// The bits for the kind of a part while parts are numbered within their kind. These bits are free because a
/// tree has fewer than 2²⁹ fragments.
const KIND: u32 = BLOCK | SPAN;
const BLOCK: u32 = 1 << 31;
const SPAN: u32 = 1 << 30;

/// A side of an inner node.
enum InnerSide {
    Front,
    Back,
}

struct LayoutBuilder<'a> {
    nodes: &'a [NodeRecord],
    layout: OrderLayout,
    rows: HashMap<BlockShape, u32>,
    /// The first fragment that is not yet in a part.
    next: u32,
}

/// A subtree still to be laid out.
struct Unplaced {
    node: usize,
    nodes: usize,
    fragments: u32,
    /// The inner node above the subtree, and the side of that node on which the subtree lies.
    parent: Option<(usize, InnerSide)>,
}

impl LayoutBuilder<'_> {
    fn fill(&mut self, fragments: u32) -> Result<(), Error> {
        let all = Unplaced { node: 0, nodes: self.nodes.len(), fragments, parent: None };
        let mut stack = if self.nodes.is_empty() { vec![] } else { vec![all] };
        while let Some(subtree) = stack.pop() {
            let is_block = subtree.nodes <= NODES && subtree.fragments as usize <= FRAGMENTS;
            let part = if is_block {
                let nodes = &self.nodes[subtree.node..][..subtree.nodes];
                self.block(
                    subtree.node,
                    BlockShape::of(nodes, subtree.fragments),
                    subtree.fragments,
                )?
            } else {
                self.inner(&subtree, &mut stack)?
            };
            if let Some((inner, side)) = subtree.parent {
                // Parents are laid out before their children, so the child's number is stored in the parent
                // only now. A child directly after its parent gets `NEXT`, which the writing loop can
                // recognise without reading memory.
                let part = if part == ROOT + inner as u32 + 1 { NEXT } else { part };
                let inner = &mut self.layout.inner[inner];
                match side {
                    InnerSide::Front => inner.front_part = part,
                    InnerSide::Back => inner.back_part = part,
                }
            }
        }
        Ok(())
    }

    fn inner(&mut self, subtree: &Unplaced, stack: &mut Vec<Unplaced>) -> Result<u32, Error> {
        let index = self.layout.inner.len();
        let mut links = self.links(subtree);
        let first = self.next;
        if links >= SHORTEST_CHAIN {
            // The parts below a chain depend only on the chain's last node. The other nodes have one fragment
            // each, with consecutive numbers, so it is enough to count these nodes.
            self.next += links as u32 - 1;
        } else {
            links = 1;
        }
        let node_index = subtree.node + links - 1;
        let node = &self.nodes[node_index];
        let (own, front) = (node.own(), node.front_len);
        let back = subtree.fragments - (links as u32 - 1) - own - front;
        let own_first = if own <= 1 { self.take(own) } else { self.leaf(own)? };
        let front_nodes = node.front_nodes as usize;
        let front_part = if front_nodes == 0 { self.leaf(front)? } else { NOBODY };
        let back_part = if node.back_is_node() { NOBODY } else { self.leaf(back)? };
        // The back is pushed first, so that the front is popped first: inner nodes, blocks and fragments
        // must be numbered depth first, as in memory.
        if node.back_is_node() {
            let parent = Some((index, InnerSide::Back));
            let nodes = subtree.nodes - links - front_nodes;
            let node = node_index + 1 + front_nodes;
            push(stack, Unplaced { node, nodes, fragments: back, parent })?;
        }
        if front_nodes > 0 {
            let parent = Some((index, InnerSide::Front));
            let node = node_index + 1;
            push(stack, Unplaced { node, nodes: front_nodes, fragments: front, parent })?;
        }
        let (own, own_first) =
            if links > 1 { (CHAIN | links as u32, first) } else { (own, own_first) };
        let node = subtree.node as u32;
        let inner = Inner { node, own, front, back, front_part, back_part, own_first };
        push(&mut self.layout.inner, inner)?;
        Ok(ROOT + index as u32)
    }

    /// The number of nodes at the top of a subtree that form a chain.
    fn links(&self, subtree: &Unplaced) -> usize {
        let mut fragments = subtree.fragments;
        let side = |node: &NodeRecord, fragments: u32| {
            let rest_is_front = node.front_len + 1 == fragments;
            let rest_is_node =
                if rest_is_front { node.front_nodes > 0 } else { node.back_is_node() };
            let is_link = node.own() == 1 && rest_is_node && (rest_is_front || node.front_len == 0);
            is_link.then_some(rest_is_front)
        };
        let first = side(&self.nodes[subtree.node], fragments);
        self.nodes[subtree.node..]
            .iter()
            .take_while(|node| {
                // Stops where the side changes: after that node, the remaining fragments would no longer lie
                // between the two ends.
                let same = first.is_some() && side(node, fragments) == first;
                fragments -= u32::from(same);
                same
            })
            .count()
    }

    /// Makes a part of fragments that no node separates.
    fn leaf(&mut self, fragments: u32) -> Result<u32, Error> {
        match fragments {
            0 => Ok(NOBODY),
            _ if fragments as usize <= FRAGMENTS => {
                self.block(0, BlockShape::leaf(fragments), fragments)
            }
            _ => {
                let first = self.take(fragments);
                push(&mut self.layout.spans, Span { first, len: fragments })?;
                Ok(SPAN | (self.layout.spans.len() as u32 - 1))
            }
        }
    }

    /// Makes a block; blocks of one shape share a row of the table.
    fn block(&mut self, node: usize, shape: BlockShape, fragments: u32) -> Result<u32, Error> {
        // The table has a row for each shape, and the number of shapes is fixed.
        let permutations = &mut self.layout.permutations;
        let row = *self.rows.entry(shape).or_insert_with(|| {
            permutations.push(shape.permutations());
            permutations.len() as u32 - 1
        });
        let first = self.take(fragments);
        push(&mut self.layout.blocks, Block { node: node as u32, first, row })?;
        Ok(BLOCK | (self.layout.blocks.len() as u32 - 1))
    }

    /// Assigns the next fragments to a part, and returns the number of the first fragment.
    fn take(&mut self, fragments: u32) -> u32 {
        let first = self.next;
        self.next += fragments;
        first
    }
}

/// The part number that stands for no part.
pub(in crate::tree) const NOBODY: u32 = 0;
/// The part number of the inner node that follows in memory.
pub(in crate::tree) const NEXT: u32 = 1;
/// The part number of the whole tree.
pub(in crate::tree) const ROOT: u32 = 2;

/// A tree's fragments, divided into *parts*. The fragments of a part are contiguous in every order.
///
/// - An *inner node* is a node together with all parts on its plane and sides.
/// - A *block* is a subtree or leaf of at most [`FRAGMENTS`](FRAGMENTS) fragments and
///   [`NODES`](NODES) nodes.
/// - A *span* is a longer sequence of fragments that are always in the order of their numbers, such as many
///   fragments on one plane.
///
/// Parts are numbered from [`ROOT`]: inner nodes first, then blocks, then spans, each depth first.
///
/// There are fewer than two parts per fragment. Proof: call *ends* the blocks, the spans, and the fragments
/// that are alone on the plane of an inner node. Each end has a different fragment, so there are at most as
/// many ends as fragments. A node has fragments on its plane or on both sides, so an inner node contains at
/// least two ends or inner nodes. So there are fewer inner nodes than ends. The exception is an inner node
/// with both sides empty. Such an inner node contains one span, which has more than [`FRAGMENTS`](FRAGMENTS)
/// fragments.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::tree) struct OrderLayout {
    pub(in crate::tree) inner: Vec<Inner>,
    pub(in crate::tree) blocks: Vec<Block>,
    pub(in crate::tree) spans: Vec<Span>,
    /// For each shape of block, the permutation of the block's fragments for every combination of signs of
    /// the block's nodes.
    pub(in crate::tree) permutations: Vec<Permutations>,
}

/// A node whose subtree is too large for a block, or several such nodes in a row; see [`Chain`].
///
/// The value of `own` decides the meaning of `own` and `own_first`:
///
/// | `own` | meaning | `own_first` |
/// |---|---|---|
/// | 0 | no fragment on the plane | unused |
/// | 1 | one fragment on the plane | its number |
/// | 2 or more, below [`CHAIN`] | that many fragments on the plane | their part number |
/// | [`CHAIN`] + n | a chain of n nodes | the number of the first node's fragment |
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tree) struct Inner {
    /// The node, or the first of a chain.
    pub(in crate::tree) node: u32,
    pub(in crate::tree) own: u32,
    /// The numbers of fragments in front of the node and behind it, at all levels below. For a chain, the
    /// node is the chain's last node.
    pub(in crate::tree) front: u32,
    pub(in crate::tree) back: u32,
    /// The part numbers of the two sides. For a chain, the part number of one side is [`NOBODY`].
    pub(in crate::tree) front_part: u32,
    pub(in crate::tree) back_part: u32,
    pub(in crate::tree) own_first: u32,
}

/// The bit that marks an [`Inner`] as a chain.
pub(super) const CHAIN: u32 = 1 << 31;

/// Consecutive nodes. Each node has one fragment on its plane, and a single child with all other fragments of
/// the node's subtree, always on the same side. The order is written from both ends inwards; the fragments
/// below the last node are in the middle.
pub(in crate::tree) struct Chain {
    pub(in crate::tree) first_node: u32,
    pub(in crate::tree) nodes: u32,
    /// The fragment of the first node; the other nodes' fragments follow.
    pub(in crate::tree) first: u32,
    /// The number of fragments below the last node.
    pub(in crate::tree) rest: u32,
    pub(in crate::tree) rest_is_front: bool,
}

impl Inner {
    /// The chain, if this inner node is a chain.
    #[inline]
    pub(in crate::tree) fn chain(&self) -> Option<Chain> {
        (self.own & CHAIN != 0).then(|| Chain {
            first_node: self.node,
            nodes: self.own & !CHAIN,
            first: self.own_first,
            rest: self.front + self.back,
            rest_is_front: self.front > 0,
        })
    }
}

/// A subtree or a leaf of few fragments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tree) struct Block {
    /// The block's first node; arbitrary for a leaf.
    pub(in crate::tree) node: u32,
    /// The block's first fragment.
    pub(in crate::tree) first: u32,
    /// The block's row of [`OrderLayout::permutations`].
    pub(in crate::tree) row: u32,
}

/// Fragments in the order of their numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tree) struct Span {
    pub(in crate::tree) first: u32,
    pub(in crate::tree) len: u32,
}

impl OrderLayout {
    /// The number of parts, [`NOBODY`] and [`NEXT`] included.
    pub(in crate::tree) fn parts(&self) -> usize {
        ROOT as usize + self.inner.len() + self.blocks.len() + self.spans.len()
    }

    /// The size of the heap memory in bytes.
    pub(in crate::tree) fn bytes(&self) -> usize {
        size_of_val(&*self.inner)
            + size_of_val(&*self.blocks)
            + size_of_val(&*self.spans)
            + size_of_val(&*self.permutations)
    }
}

/// The largest number of fragments of a block: four places of two bits each fit a byte.
pub(in crate::tree) const FRAGMENTS: usize = 4;
/// The largest number of nodes of a block: the builder divides only sets of two pieces or more.
pub(in crate::tree) const NODES: usize = FRAGMENTS - 1;

/// The places of a block's fragments for every combination of signs of the block's nodes.
///
/// Bit k of the index is 1 if the eye is in front of node k. Bits 2k and 2k + 1 of the value are the place of
/// fragment k. Missing fragments share the place of the first fragment.
pub(in crate::tree) type Permutations = [u8; 1 << NODES];

/// The data that, together with the signs, decide the places of a block's fragments. For each node: the
/// numbers of fragments on the node's plane and in front, the number of nodes in front, and whether the back
/// is a node. For the block: the numbers of nodes (0 for a leaf) and of fragments. Blocks of the same shape
/// share a row of the table.
///
/// The data are packed into an integer, because the shape of every block is looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::tree) struct BlockShape(u32);

/// The number of bits of a node in a shape. Numbers up to [`FRAGMENTS`] take three bits, and up to [`NODES`]
/// two.
const NODE_BITS: u32 = 3 + 3 + 2 + 1;
/// The start of the number of fragments, after the bits of the nodes.
const FRAGMENTS_AT: u32 = NODE_BITS * NODES as u32;
/// The start of the number of nodes, after the number of fragments.
const LEN_AT: u32 = FRAGMENTS_AT + 3;

/// A node of a shape.
struct ShapeNode {
    own: u8,
    /// The number of fragments in front, in a leaf or below nodes.
    front: u8,
    /// The number of nodes in front; if 0, the front is a leaf.
    front_nodes: u8,
    back_is_node: bool,
}

impl BlockShape {
    /// The shape of a leaf.
    pub(in crate::tree) fn leaf(fragments: u32) -> Self {
        Self(fragments << FRAGMENTS_AT)
    }

    /// The shape of a whole subtree of at most [`NODES`] nodes and [`FRAGMENTS`] fragments.
    pub(in crate::tree) fn of(subtree: &[NodeRecord], fragments: u32) -> Self {
        let bits = (subtree.len() as u32) << LEN_AT | fragments << FRAGMENTS_AT;
        Self(subtree.iter().zip(0..).fold(bits, |bits, (node, k)| {
            let sides = node.front_nodes << 1 | u32::from(node.back_is_node());
            bits | (node.own() << 6 | node.front_len << 3 | sides) << (NODE_BITS * k)
        }))
    }

    fn fragments(self) -> u8 {
        (self.0 >> FRAGMENTS_AT & 7) as u8
    }

    fn len(self) -> usize {
        (self.0 >> LEN_AT) as usize
    }

    fn node(self, k: usize) -> ShapeNode {
        let bits = self.0 >> (NODE_BITS * k as u32);
        ShapeNode {
            own: (bits >> 6 & 7) as u8,
            front: (bits >> 3 & 7) as u8,
            front_nodes: (bits >> 1 & 3) as u8,
            back_is_node: bits & 1 == 1,
        }
    }

    /// The shape's row of the table.
    pub(in crate::tree) fn permutations(self) -> Permutations {
        std::array::from_fn(|signs| self.places(signs))
    }

    fn places(self, signs: usize) -> u8 {
        let mut order = Places::default();
        if self.len() == 0 {
            order.put(0, self.fragments());
        }
        // The first fragment and the number of fragments of the subtree at each node.
        let (mut begins, mut totals) = ([0; NODES], [self.fragments(); NODES]);
        for k in 0..self.len() {
            let (node, begin) = (self.node(k), begins[k]);
            let in_back = totals[k] - node.own - node.front;
            let is_in_front = signs >> k & 1 == 1;
            let far = begin + if is_in_front { in_back } else { node.front };
            let near = far + node.own;
            let (front, back) = if is_in_front { (near, begin) } else { (begin, near) };
            order.put(far, node.own);
            let front_nodes = node.front_nodes as usize;
            if front_nodes > 0 {
                (begins[k + 1], totals[k + 1]) = (front, node.front);
            } else {
                order.put(front, node.front);
            }
            if node.back_is_node {
                (begins[k + 1 + front_nodes], totals[k + 1 + front_nodes]) = (back, in_back);
            } else {
                order.put(back, in_back);
            }
        }
        order.packed()
    }
}

/// The places of fragments, in the order of their numbers.
#[derive(Default)]
struct Places {
    places: [u8; FRAGMENTS],
    len: usize,
}

impl Places {
    /// Assigns the next `len` fragments the places from `begin` on.
    fn put(&mut self, begin: u8, len: u8) {
        for place in begin..begin + len {
            self.places[self.len] = place;
            self.len += 1;
        }
    }

    fn packed(&self) -> u8 {
        let first = self.places[0];
        let place = |k: usize| if k < self.len { self.places[k] } else { first };
        (0..FRAGMENTS).fold(0, |packed, k| packed | place(k) << (2 * k))
    }
}
