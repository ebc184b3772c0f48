//! A tree with the decisions of any kernel, in the form in which the builder returns it.

use std::cmp::Ordering;
use std::fmt;
use std::ops::Range;

use binspace::internals::{
    Exact, Eye, Faces, Kernel, Line, Parts, Piece, PlaneId, RawChild, Side, Symbol, Tuning, Vertex,
    parts, parts_of_tree,
};
use binspace::{BspTree, BuildOptions, Error, Viewpoint};

/// A tree of faces that the library's own builder built with the decisions of a kernel, to measure
/// what rounded decisions do. Its orders use an explicit stack, O(n).
#[derive(Clone)]
pub struct KernelTree<K: Kernel> {
    kernel: K,
    faces: Faces,
    nodes: Vec<Node>,
    /// The face of each fragment, and where its vertices begin.
    fragments: Vec<(u32, u32)>,
    vertices: Vec<K::Stored>,
    cuts: usize,
}

/// Nodes stand depth first, the front before the back. Fragments are numbered likewise: those on
/// the plane, those of a front leaf, those of a back leaf, then those of the nodes below.
#[derive(Clone, Copy, Debug)]
struct Node {
    plane: PlaneId,
    own: u32,
    front: RawChild,
    back: RawChild,
    /// How many fragments there are in its subtree, and how many nodes.
    fragments: u32,
    nodes: u32,
}

/// A node on a walk through a tree.
#[derive(Clone, Debug)]
pub(crate) struct Visit {
    pub(crate) plane: PlaneId,
    /// How many nodes there are on the path to it, itself included.
    pub(crate) depth: usize,
    /// Whether it is in front of its parent.
    pub(crate) is_front: bool,
    /// The fragments on its plane, of a front leaf, and of a back leaf.
    pub(crate) on: Range<u32>,
    pub(crate) front: Range<u32>,
    pub(crate) back: Range<u32>,
}

impl<K: Kernel> KernelTree<K> {
    /// Builds a tree of faces, with the tolerance of the faces, not that of the options.
    ///
    /// # Errors
    ///
    /// If a budget runs out.
    pub fn build(kernel: K, options: &BuildOptions, faces: Faces) -> Result<Self, Error> {
        let parts = parts(kernel, options, &Tuning::DEFAULT, &faces)?;
        Ok(Self::new(kernel, faces, parts))
    }

    fn new(kernel: K, faces: Faces, parts: Parts<K::Stored>) -> Self {
        let mut nodes: Vec<Node> = Vec::with_capacity(parts.nodes.len());
        // From the last to the first: `nodes` holds those behind, the next one last.
        for raw in parts.nodes.iter().rev() {
            let at = |behind: usize| nodes[nodes.len() - 1 - behind];
            let (front, front_nodes) = match raw.front {
                RawChild::Leaf(len) => (len, 0),
                RawChild::Node => (at(0).fragments, at(0).nodes),
            };
            let (back, back_nodes) = match raw.back {
                RawChild::Leaf(len) => (len, 0),
                RawChild::Node => {
                    let child = at(front_nodes as usize);
                    (child.fragments, child.nodes)
                }
            };
            nodes.push(Node {
                plane: raw.plane,
                own: raw.own,
                front: raw.front,
                back: raw.back,
                fragments: raw.own + front + back,
                nodes: 1 + front_nodes + back_nodes,
            });
        }
        nodes.reverse();
        let fragments = parts.records.iter().map(|record| (record.face, record.vertices)).collect();
        Self { kernel, faces, nodes, fragments, vertices: parts.vertices, cuts: parts.cuts }
    }

    /// How many fragments there are.
    pub fn len(&self) -> usize {
        self.fragments.len()
    }

    /// Whether there are no fragments.
    pub fn is_empty(&self) -> bool {
        self.fragments.is_empty()
    }

    /// How often a piece was cut in two.
    pub fn cuts(&self) -> usize {
        self.cuts
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// The most nodes on a path from the root.
    pub fn depth(&self) -> usize {
        self.walk().map(|visit| visit.depth).max().unwrap_or(0)
    }

    /// The faces that the fragments are pieces of.
    pub fn faces(&self) -> &Faces {
        &self.faces
    }

    /// The resident size in bytes, besides the faces.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.fragments) + size_of_val(&*self.vertices)
    }

    /// The face that a fragment is a piece of.
    pub fn face(&self, fragment: u32) -> u32 {
        self.fragments[fragment as usize].0
    }

    /// The vertices of a fragment as they are kept; none if it is all of its face.
    fn stored(&self, fragment: u32) -> &[K::Stored] {
        let start = self.fragments[fragment as usize].1 as usize;
        let next = self.fragments.get(fragment as usize + 1);
        &self.vertices[start..next.map_or(self.vertices.len(), |next| next.1 as usize)]
    }

    /// Whether a fragment is all of its face.
    pub fn is_whole(&self, fragment: u32) -> bool {
        self.stored(fragment).is_empty()
    }

    /// The vertices of a fragment in lattice units, rounded.
    pub fn lattice_vertices(&self, fragment: u32) -> impl Iterator<Item = [f64; 3]> {
        let (face, stored) = (self.face(fragment), self.stored(fragment));
        let whole = if stored.is_empty() { self.faces.corners(face) } else { &[] };
        let restored =
            stored.iter().map(move |v| self.kernel.restore(&self.faces, face, v).position());
        whole.iter().copied().chain(restored)
    }

    /// For each vertex of a fragment, its definition.
    pub fn symbols(&self, fragment: u32) -> impl Iterator<Item = Symbol> {
        let stored = self.stored(fragment);
        let corners =
            if stored.is_empty() { self.faces.corners(self.face(fragment)).len() } else { 0 };
        (0..corners as u32).map(Symbol::corner).chain(stored.iter().map(K::symbol))
    }

    /// For each edge of a fragment, what bounds it there.
    pub fn lines(&self, fragment: u32) -> impl Iterator<Item = Line> {
        let stored = self.stored(fragment);
        let corners =
            if stored.is_empty() { self.faces.corners(self.face(fragment)).len() } else { 0 };
        (0..corners as u32).map(Line::edge).chain(stored.iter().map(K::line))
    }

    /// Where a fragment lies against a plane, by the kernel.
    pub fn classify(&self, fragment: u32, plane: PlaneId) -> Side {
        let face = self.face(fragment);
        let vertices: Vec<K::Vertex> = self
            .stored(fragment)
            .iter()
            .map(|stored| self.kernel.restore(&self.faces, face, stored))
            .collect();
        let cut = (!vertices.is_empty()).then_some(&vertices[..]);
        let splitter = self.kernel.splitter(&self.faces, plane);
        self.kernel.classify(&self.faces, &splitter, Piece { face, cut })
    }

    /// Writes the numbers of all fragments, back to front, in place of what the list held.
    pub fn back_to_front_into(&self, viewpoint: Viewpoint, order: &mut Vec<u32>) {
        order.clear();
        let eye = Eye::new(viewpoint, self.faces.lattice());
        let mut stack =
            vec![if self.nodes.is_empty() { Part::Run(0..0) } else { Part::Node(0, 0) }];
        while let Some(part) = stack.pop() {
            match part {
                Part::Run(run) => order.extend(run),
                Part::Node(index, first) => {
                    let node = &self.nodes[index as usize];
                    let mut next = first;
                    let mut run = |len: u32| {
                        next += len;
                        Part::Run(next - len..next)
                    };
                    let on = run(node.own);
                    let mut leaf = |child| match child {
                        RawChild::Leaf(len) => Some(run(len)),
                        RawChild::Node => None,
                    };
                    let (front, back) = (leaf(node.front), leaf(node.back));
                    let (mut child, mut first) = (index + 1, next);
                    let mut subtree = || {
                        let part = Part::Node(child, first);
                        let size = &self.nodes[child as usize];
                        (child, first) = (child + size.nodes, first + size.fragments);
                        part
                    };
                    let front = front.unwrap_or_else(&mut subtree);
                    let back = back.unwrap_or_else(&mut subtree);
                    let side = self.kernel.eye_side(&self.faces, node.plane, &eye);
                    let [far, near] =
                        if side == Ordering::Greater { [back, front] } else { [front, back] };
                    stack.extend([near, on, far]);
                }
            }
        }
    }

    /// The partition planes, depth first, each with the fragments on it, and all in front and
    /// behind.
    pub fn partitions(&self) -> impl Iterator<Item = (PlaneId, [Range<u32>; 3])> {
        self.walk().zip(self.nodes.iter().enumerate()).map(|(visit, (index, node))| {
            // Subtrees are numbered behind the leaves of their parent.
            let (mut child, mut next) = (index + 1, visit.back.end);
            let mut subtree = || {
                let size = &self.nodes[child];
                (child, next) = (child + size.nodes as usize, next + size.fragments);
                next - size.fragments..next
            };
            let front = if node.front == RawChild::Node { subtree() } else { visit.front };
            let back = if node.back == RawChild::Node { subtree() } else { visit.back };
            (visit.plane, [visit.on, front, back])
        })
    }

    /// The nodes, depth first.
    pub(crate) fn walk(&self) -> impl Iterator<Item = Visit> {
        let (mut stack, mut next) = (vec![(1, false)], 0);
        self.nodes.iter().map(move |node| {
            let (depth, is_front) = stack.pop().unwrap_or((1, false));
            let mut take = |child| {
                let len = if let RawChild::Leaf(len) = child { len } else { 0 };
                next += len;
                next - len..next
            };
            let on = take(RawChild::Leaf(node.own));
            let (front, back) = (take(node.front), take(node.back));
            for (child, is_front) in [(node.back, false), (node.front, true)] {
                if child == RawChild::Node {
                    stack.push((depth + 1, is_front));
                }
            }
            Visit { plane: node.plane, depth, is_front, on, front, back }
        })
    }
}

impl<K: Kernel> fmt::Debug for KernelTree<K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("KernelTree")
            .field("kernel", &self.kernel)
            .field("faces", &self.faces.len())
            .field("nodes", &self.nodes.len())
            .field("fragments", &self.fragments.len())
            .finish_non_exhaustive()
    }
}

impl From<&BspTree> for KernelTree<Exact> {
    fn from(tree: &BspTree) -> Self {
        Self::new(Exact, tree.faces().clone(), parts_of_tree(tree))
    }
}

/// A part of a tree: fragments in the order of their numbers, or a node with its first fragment.
enum Part {
    Run(Range<u32>),
    Node(u32, u32),
}
