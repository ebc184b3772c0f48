//! Orders as lists of fragment numbers, in one linear pass over the nodes.

use std::cmp::Ordering;

use super::BspTree;
use super::node::Node;
use crate::geom::{Eye, Kernel, LATTICE_LIMIT, Viewpoint};

/// A viewpoint made ready for a tree's nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    eye: Eye,
    /// In 2⁵¹ lattice units.
    point: ([f64; 3], f64),
    bound: f64,
}

impl View {
    pub(super) fn new<K: Kernel>(tree: &BspTree<K>, viewpoint: Viewpoint) -> Self {
        let eye = Eye::new(viewpoint, tree.faces.lattice());
        let (e, w) = eye.homogeneous();
        let unit = if w > 0.0 { LATTICE_LIMIT } else { 1.0 };
        let point = (e.map(|c| c / unit), w);
        Self { eye, point, bound: Node::bound(point) }
    }

    /// Whether the eye is in front of a node's plane; certified.
    #[inline]
    pub(super) fn is_in_front<K: Kernel>(&self, tree: &BspTree<K>, node: &Node) -> bool {
        let distance = node.distance(self.point);
        if distance.abs() > self.bound {
            distance > 0.0
        } else {
            self.decide(tree, node) == Ordering::Greater
        }
    }

    #[cold]
    fn decide<K: Kernel>(&self, tree: &BspTree<K>, node: &Node) -> Ordering {
        tree.kernel.eye_side(&tree.faces, node.plane, &self.eye)
    }
}

impl<K: Kernel> BspTree<K> {
    /// Writes the numbers of all fragments, back to front, into a buffer, in place of what it
    /// held. Allocates nothing once the buffer has grown to `len + 2 × nodes + 3`.
    ///
    /// Where the fragments of a subtree begin in the order is known before the subtree is walked,
    /// as every node knows how many lie on each of its sides. So the nodes are taken as they stand
    /// in memory, without a stack, and each fragment's number is written to its final place.
    /// Nothing branches on the eye's side or on the shape of the tree: what is not there is written
    /// to a place of its own that nobody reads.
    pub fn back_to_front_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        let view = View::new(self, viewpoint);
        let (fragments, nodes) = (self.records.len(), self.nodes.len());
        // Behind the order and a place for nobody: where each subtree begins in it, and how many
        // fragments it has; last, again, a place for nobody.
        order.resize(fragments + 1 + 2 * (nodes + 1), 0);
        let (order_part, places) = order.split_at_mut(fragments + 1);
        let (places, _) = places.as_chunks_mut::<2>();
        let pass = Pass { order: order_part, next: 0 };
        self.write_order(&view, pass, places);
        order.truncate(fragments);
    }

    #[inline]
    fn write_order(&self, view: &View, mut pass: Pass<'_>, places: &mut [[u32; 2]]) {
        let nodes = &self.nodes[..];
        // The subtree at hand: where it begins in the order, and how many fragments it has.
        let [mut begin, mut len] = [0, self.records.len() as u32];
        let mut i = 0;
        while let Some(node) = nodes.get(i) {
            let is_in_front = view.is_in_front(self, node);
            i += 1;
            if node.is_link() {
                // Its fragment is the furthest or the nearest of the subtree.
                let is_far = is_in_front != (node.front_nodes == 0);
                len -= 1;
                pass.write_one(if is_far { begin } else { begin + len });
                begin += u32::from(is_far);
                continue;
            }
            let (own, front) = (node.own(), node.front_len);
            let back = len - own - front;
            // Far, own, near.
            let far = begin + if is_in_front { back } else { front };
            let near = far + own;
            let front_begin = if is_in_front { near } else { begin };
            let back_begin = if is_in_front { begin } else { near };
            let (front_is_node, back_is_node) = (node.front_nodes > 0, node.back_is_node());
            let front_leaf = if front_is_node { 0 } else { front };
            let back_leaf = if back_is_node { 0 } else { back };
            let parts = [(far, own), (front_begin, front_leaf), (back_begin, back_leaf)];
            if node.is_plain() {
                parts.into_iter().for_each(|(at, len)| pass.write_at_most_one(at, len));
            } else {
                parts.into_iter().for_each(|(at, len)| pass.write(at, len));
            }
            let back_node = i + node.front_nodes as usize;
            let nobody = places.len() - 1;
            places[if back_is_node { back_node } else { nobody }] = [back_begin, back];
            // The next in memory is the front subtree, or one whose place was written before.
            let written = places[i];
            [begin, len] = if front_is_node { [front_begin, front] } else { written };
        }
    }

    /// Writes the numbers of all fragments, front to back, into a buffer: the reverse of
    /// [`back_to_front_into`](Self::back_to_front_into).
    pub fn front_to_back_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        self.back_to_front_into(viewpoint, order);
        order.reverse();
    }
}

/// An order being written: fragments get their numbers in the order in which they are met.
struct Pass<'a> {
    /// At its end, a place for nobody.
    order: &'a mut [u32],
    next: u32,
}

impl Pass<'_> {
    #[inline]
    fn write_one(&mut self, at: u32) {
        self.order[at as usize] = self.next;
        self.next += 1;
    }

    #[inline]
    fn write_at_most_one(&mut self, at: u32, len: u32) {
        let nobody = self.order.len() - 1;
        self.order[if len > 0 { at as usize } else { nobody }] = self.next;
        self.next += len;
    }

    #[cold]
    fn write(&mut self, at: u32, len: u32) {
        let places = &mut self.order[at as usize..(at + len) as usize];
        places.iter_mut().zip(self.next..).for_each(|(place, number)| *place = number);
        self.next += len;
    }
}
