//! A tree of any builder as plain lists, to measure its errors and its orders.

use std::cmp::Ordering;
use std::fmt;
use std::ops::Range;

use binspace::internals::{EdgeLine, Eye, Faces, PlaneId, VertexId};
use binspace::{BspTree, Child, Viewpoint};

/// A BSP tree whose vertices have a definition and a position: the library's tree, or a tree of [rounded
/// numbers](Tree::with_epsilon).
#[derive(Clone)]
pub struct Tree {
    pub(crate) faces: Faces,
    pub(crate) nodes: Vec<Node>,
    pub(crate) fragments: Vec<Fragment>,
    /// The vertices of all fragments that are not whole faces.
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) cuts: usize,
    /// The side of a plane on which an eye lies.
    pub(crate) eye_side: fn(&Faces, PlaneId, &Eye) -> Ordering,
}

/// Nodes are stored depth first, the front before the back. Fragments are numbered in this order: on the
/// node's plane, in its front leaf, in its back leaf, and then in the nodes below.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) plane: PlaneId,
    /// The number of nodes on the path from the root to this node, including this node.
    pub(crate) depth: usize,
    /// Whether the node is in front of its parent.
    pub(crate) is_front: bool,
    /// The fragments on the node's plane.
    pub(crate) on: Range<u32>,
    pub(crate) front: Side,
    pub(crate) back: Side,
    /// The fragments of the node's whole subtree.
    pub(crate) all: Range<u32>,
}

/// One side of a node: the fragments of a leaf, or the number of another node.
#[derive(Clone, Debug)]
pub(crate) enum Side {
    Leaf(Range<u32>),
    Node(usize),
}

/// A fragment. Its vertices end where the vertices of the next fragment begin. A whole face has no vertices
/// here.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fragment {
    pub(crate) face: u32,
    pub(crate) start: u32,
}

/// A vertex: its position in lattice units, its definition, and the line from it to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Vertex {
    pub(crate) position: [f64; 3],
    pub(crate) vertex_id: VertexId,
    pub(crate) line: EdgeLine,
}

impl Tree {
    /// Returns the number of fragments.
    pub fn len(&self) -> usize {
        self.fragments.len()
    }

    /// Returns whether there are no fragments.
    pub fn is_empty(&self) -> bool {
        self.fragments.is_empty()
    }

    /// Returns the number of times that a piece was cut in two.
    pub fn cuts(&self) -> usize {
        self.cuts
    }

    /// Returns the number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the largest number of nodes on a path from the root.
    pub fn depth(&self) -> usize {
        self.nodes.iter().map(|node| node.depth).max().unwrap_or(0)
    }

    /// Returns the faces that the fragments are pieces of.
    pub fn faces(&self) -> &Faces {
        &self.faces
    }

    /// Returns the resident size in bytes, without the faces.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.fragments) + size_of_val(&*self.vertices)
    }

    /// Returns the face that a fragment is a piece of.
    pub fn face(&self, fragment: u32) -> u32 {
        self.fragments[fragment as usize].face
    }

    /// The vertices of a fragment; none if it is a whole face.
    fn stored(&self, fragment: u32) -> &[Vertex] {
        let start = self.fragments[fragment as usize].start as usize;
        let next = self.fragments.get(fragment as usize + 1);
        &self.vertices[start..next.map_or(self.vertices.len(), |next| next.start as usize)]
    }

    /// Returns whether a fragment is a whole face.
    pub fn is_whole(&self, fragment: u32) -> bool {
        self.stored(fragment).is_empty()
    }

    /// Returns the vertices of a fragment in lattice units, rounded.
    pub fn lattice_vertices(&self, fragment: u32) -> impl Iterator<Item = [f64; 3]> {
        let stored = self.stored(fragment);
        let whole = if stored.is_empty() { self.faces.corners(self.face(fragment)) } else { &[] };
        whole.iter().copied().chain(stored.iter().map(|vertex| vertex.position))
    }

    /// Returns the definition of each vertex of a fragment.
    pub fn vertex_ids(&self, fragment: u32) -> impl Iterator<Item = VertexId> {
        let stored = self.stored(fragment);
        let corners =
            if stored.is_empty() { self.faces.corners(self.face(fragment)).len() } else { 0 };
        (0..corners as u32)
            .map(VertexId::corner)
            .chain(stored.iter().map(|vertex| vertex.vertex_id))
    }

    /// Returns the partition planes, depth first. Each has the ranges of the fragments on the plane, in front
    /// of it, and behind it.
    pub fn partitions(&self) -> impl Iterator<Item = (PlaneId, [Range<u32>; 3])> {
        let all = |side: &Side| match side {
            Side::Leaf(fragments) => fragments.clone(),
            Side::Node(node) => self.nodes[*node].all.clone(),
        };
        self.nodes
            .iter()
            .map(move |node| (node.plane, [node.on.clone(), all(&node.front), all(&node.back)]))
    }

    /// Replaces the list's content by the numbers of all fragments, back to front. Takes O(n) time, without
    /// recursion.
    pub fn back_to_front_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        order.clear();
        let eye = Eye::new(viewpoint, self.faces.lattice());
        let mut stack = Vec::new();
        if !self.nodes.is_empty() {
            stack.push(Side::Node(0));
        }
        while let Some(side) = stack.pop() {
            match side {
                Side::Leaf(fragments) => order.extend(fragments),
                Side::Node(node) => {
                    let Node { plane, on, front, back, .. } = &self.nodes[node];
                    let is_in_front = (self.eye_side)(&self.faces, *plane, &eye).is_gt();
                    let [far, near] = if is_in_front { [back, front] } else { [front, back] };
                    stack.extend([near.clone(), Side::Leaf(on.clone()), far.clone()]);
                }
            }
        }
    }
}

impl fmt::Debug for Tree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tree")
            .field("faces", &self.faces.len())
            .field("nodes", &self.nodes.len())
            .field("fragments", &self.fragments.len())
            .finish_non_exhaustive()
    }
}

impl From<&BspTree> for Tree {
    fn from(tree: &BspTree) -> Self {
        let mut is_front = vec![false; tree.nodes().count()];
        let nodes = tree.nodes().map(|node| {
            let side = |child| match child {
                Child::Node(node) => Side::Node(node.index()),
                Child::Leaf(fragments) => Side::Leaf(fragments),
            };
            let [front, back] = [node.front(), node.back()].map(side);
            if let Side::Node(front) = front {
                is_front[front] = true;
            }
            Node {
                plane: node.plane(),
                depth: node.depth(),
                is_front: is_front[node.index()],
                on: node.on(),
                front,
                back,
                all: node.fragments(),
            }
        });
        let nodes = nodes.collect();
        let (mut fragments, mut vertices) = (Vec::new(), Vec::new());
        for fragment in tree.fragments() {
            fragments.push(Fragment { face: fragment.face(), start: vertices.len() as u32 });
            if !fragment.is_whole() {
                let names = fragment.vertex_ids().zip(fragment.lines());
                let placed = fragment.lattice_vertices().zip(names);
                vertices.extend(placed.map(|(position, (vertex_id, line))| Vertex {
                    position,
                    vertex_id,
                    line,
                }));
            }
        }
        let (faces, cuts) = (tree.faces().clone(), tree.stats().splits);
        Self { faces, nodes, fragments, vertices, cuts, eye_side: Faces::eye_side }
    }
}
