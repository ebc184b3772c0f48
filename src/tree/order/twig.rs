//! Subtrees of few fragments, whose orders are looked up in a table.

use crate::tree::node_record::NodeRecord;

/// The most fragments of a twig: four places of two bits each fit a byte.
pub(in crate::tree) const FRAGMENTS: usize = 4;
/// The most nodes of a twig: the builder divides only sets of two pieces or more.
pub(in crate::tree) const NODES: usize = FRAGMENTS - 1;

/// The places of a twig's fragments for every combination of signs of its nodes.
///
/// Bit k of the index is 1 if the eye is in front of node k. Bits 2k and 2k + 1 of the value are the
/// place of fragment k. Fragments that the twig does not have share the place of the first.
pub(in crate::tree) type Permutations = [u8; 1 << NODES];

/// Everything but the signs that decides the places of a twig's fragments: for each node, how many
/// fragments are on its plane and in front, how many nodes are in front, and whether the back is one;
/// how many nodes there are, none for a leaf; and how many fragments. Twigs of the same shape share a
/// row of the table.
///
/// Packed, as there is one to look up for each twig.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::tree) struct TwigShape(u32);

/// The bits of a node in a shape. Numbers up to [`FRAGMENTS`] take three, up to [`NODES`] two.
const NODE_BITS: u32 = 3 + 3 + 2 + 1;
/// The bits of the number of fragments, behind those of the nodes.
const FRAGMENTS_AT: u32 = NODE_BITS * NODES as u32;
/// The bits of the number of nodes, behind those.
const LEN_AT: u32 = FRAGMENTS_AT + 3;

/// A node of a shape.
struct ShapeNode {
    own: u8,
    /// How many fragments are in front, in a leaf or below nodes.
    front: u8,
    /// How many nodes are in front; if none, the front is a leaf.
    front_nodes: u8,
    back_is_node: bool,
}

impl TwigShape {
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

    /// Its row of the table.
    pub(in crate::tree) fn permutations(self) -> Permutations {
        std::array::from_fn(|signs| self.places(signs))
    }

    fn places(self, signs: usize) -> u8 {
        let mut order = Places::default();
        if self.len() == 0 {
            order.put(0, self.fragments());
        }
        // Where the fragments of the subtree at each node begin, and how many it has.
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
