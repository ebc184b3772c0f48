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
/// fragments are on its plane, in front and behind, and which sides are nodes; for a leaf, how many
/// fragments it has. Twigs of the same shape share a row of the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(in crate::tree) struct TwigShape {
    nodes: [ShapeNode; NODES],
    len: u8,
    fragments: u8,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct ShapeNode {
    own: u8,
    /// How many fragments are in front, in a leaf or below nodes; likewise behind.
    front: u8,
    back: u8,
    /// How many nodes are in front; if none, the front is a leaf.
    front_nodes: u8,
    back_is_node: bool,
}

impl TwigShape {
    /// The shape of a leaf.
    pub(in crate::tree) fn leaf(fragments: u32) -> Self {
        Self { fragments: fragments as u8, ..Self::default() }
    }

    /// The shape of a whole subtree of at most [`NODES`] nodes and [`FRAGMENTS`] fragments.
    pub(in crate::tree) fn of(subtree: &[NodeRecord], fragments: u32) -> Self {
        let mut shape =
            Self { len: subtree.len() as u8, fragments: fragments as u8, ..Self::default() };
        // How many fragments the subtree at each node has.
        let mut totals = [fragments; NODES];
        for (k, node) in subtree.iter().enumerate() {
            let (own, front) = (node.own(), node.front_len);
            let back = totals[k] - own - front;
            let front_nodes = node.front_nodes as usize;
            if front_nodes > 0 {
                totals[k + 1] = front;
            }
            if node.back_is_node() {
                totals[k + 1 + front_nodes] = back;
            }
            shape.nodes[k] = ShapeNode {
                own: own as u8,
                front: front as u8,
                back: back as u8,
                front_nodes: front_nodes as u8,
                back_is_node: node.back_is_node(),
            };
        }
        shape
    }

    /// Its row of the table.
    pub(in crate::tree) fn permutations(&self) -> Permutations {
        std::array::from_fn(|signs| self.places(signs))
    }

    fn places(&self, signs: usize) -> u8 {
        let mut order = Places::default();
        if self.len == 0 {
            order.put(0, self.fragments);
        }
        let mut begins = [0; NODES];
        for (k, node) in self.nodes[..self.len as usize].iter().enumerate() {
            let begin = begins[k];
            let is_in_front = signs >> k & 1 == 1;
            let far = begin + if is_in_front { node.back } else { node.front };
            let near = far + node.own;
            let (front, back) = if is_in_front { (near, begin) } else { (begin, near) };
            order.put(far, node.own);
            let front_nodes = node.front_nodes as usize;
            if front_nodes > 0 {
                begins[k + 1] = front;
            } else {
                order.put(front, node.front);
            }
            if node.back_is_node {
                begins[k + 1 + front_nodes] = back;
            } else {
                order.put(back, node.back);
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
