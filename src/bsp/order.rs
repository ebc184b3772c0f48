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
    /// held. Allocates nothing once the buffer has grown to `len + 2 × nodes`.
    ///
    /// Where the fragments of a subtree begin in the order is known before the subtree is walked,
    /// as every node knows how many lie on each of its sides. So the nodes are taken as they stand
    /// in memory, without a stack, and each fragment's number is written to its final place.
    pub fn back_to_front_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        let view = View::new(self, viewpoint);
        let (fragments, nodes) = (self.records.len(), self.nodes.len());
        // Behind the order, the place where each subtree begins and ends in it.
        order.resize(fragments + 2 * nodes, 0);
        let (order_part, places) = order.split_at_mut(fragments);
        if let Some(root) = places.first_chunk_mut() {
            *root = [0, fragments as u32];
        }
        let mut next = 0;
        let mut write = |at: u32, len: u32| {
            // Mostly there is one; the loop that follows is slower for it.
            if len == 1 {
                order_part[at as usize] = next;
                next += 1;
                return;
            }
            for (slot, id) in order_part[at as usize..(at + len) as usize].iter_mut().zip(next..) {
                *slot = id;
            }
            next += len;
        };
        for (i, node) in self.nodes.iter().enumerate() {
            let (begin, end) = (places[2 * i], places[2 * i + 1]);
            let (own, front) = (node.own(), node.front_len);
            let back = end - begin - own - front;
            let is_in_front = view.is_in_front(self, node);
            // Far, own, near.
            let far = if is_in_front { back } else { front };
            let near_begin = begin + far + own;
            let (front_begin, back_begin) =
                if is_in_front { (near_begin, begin) } else { (begin, near_begin) };
            write(begin + far, own);
            if node.front_nodes > 0 {
                places[2 * i + 2..2 * i + 4].copy_from_slice(&[front_begin, front_begin + front]);
            } else {
                write(front_begin, front);
            }
            if node.back_is_node() {
                let child = 2 * (i + 1 + node.front_nodes as usize);
                places[child..child + 2].copy_from_slice(&[back_begin, back_begin + back]);
            } else {
                write(back_begin, back);
            }
        }
        order.truncate(fragments);
    }

    /// Writes the numbers of all fragments, front to back, into a buffer: the reverse of
    /// [`back_to_front_into`](Self::back_to_front_into).
    pub fn front_to_back_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        self.back_to_front_into(viewpoint, order);
        order.reverse();
    }
}
