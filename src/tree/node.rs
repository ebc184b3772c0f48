//! The nodes of a tree: the public type, the stored record, and walks.

use std::cmp::Ordering;
use std::collections::VecDeque;
use std::fmt;
use std::iter::FusedIterator;
use std::ops::Range;

use glam::DVec3;

use super::parts::{RawChild, RawNode};
use super::{BspTree, fragment};
use crate::Error;
use crate::exact::{Eye, PlaneId, PlaneKind};
use crate::memory::reserve;
use crate::viewpoint::{Facing, Viewpoint};

/// A node of a tree: a [partition plane](BspTree#contents), the [fragments](crate::Fragment) on the plane,
/// and the two sides of the plane.
///
/// [`BspTree::root`] and [`front`](Self::front) return single nodes, and [`BspTree::nodes`] all nodes.
/// [`Order::walk`](crate::Order::walk) visits nodes in the order of a viewpoint. A node is as cheap to copy
/// as a reference.
///
/// The plane contains the points p with `normal().dot(p) == offset()`. The front contains the points with
/// `normal().dot(p) > offset()`. The normal and the offset are rounded. The tree decides by the exact plane,
/// which [`grid_points`](Self::grid_points) returns.
///
/// The fragments on a node's plane have consecutive numbers. So do the fragments in front of the plane, the
/// fragments behind the plane, and the fragments of the whole subtree.
#[derive(Clone, Copy)]
pub struct Node<'t> {
    pub(super) tree: &'t BspTree,
    pub(super) index: u32,
    pub(super) depth: u32,
    /// The fragments of the whole subtree.
    pub(super) first: u32,
    pub(super) end: u32,
}

/// One side of a [`Node`].
#[derive(Clone, Debug, PartialEq)]
pub enum Child<'t> {
    /// Another node.
    Node(Node<'t>),
    /// A [leaf](BspTree::locate), a region that no [partition plane](BspTree#contents) divides: the number of
    /// the leaf's [fragment](crate::Fragment) as a range, or an empty range if the leaf has no fragment.
    Leaf(Range<u32>),
}

impl<'t> Node<'t> {
    /// Returns the node's number. The root has the number 0. Nodes are numbered depth first: first a node,
    /// then its front subtree, then its back subtree.
    pub fn index(&self) -> usize {
        self.index as usize
    }

    /// Returns the number of nodes on the path from the root to this node, both included.
    pub fn depth(&self) -> usize {
        self.depth as usize
    }

    /// Returns the unit normal of the plane. The normal points to the front.
    pub fn normal(&self) -> DVec3 {
        fragment::unit_normal(&self.tree.faces, self.plane())
    }

    /// Returns the distance of the plane from the origin along the normal, in the polygons' unit. A distance
    /// that is too large for `f64` is infinite.
    pub fn offset(&self) -> f64 {
        fragment::offset(&self.tree.faces, self.plane())
    }

    /// Returns the exact plane: three points of the plane on the tree's [grid](BspTree::grid),
    /// counter-clockwise seen from the plane's front.
    pub fn grid_points(&self) -> [[i64; 3]; 3] {
        fragment::plane_points(&self.tree.faces, self.plane())
    }

    /// Returns the index, in input order, of the polygon that the builder took the node's plane from. If the
    /// polygon was triangulated, the plane is the plane of one of the triangles.
    ///
    /// `None` if the builder chose a plane perpendicular to an axis instead. The `normal` and the `offset` of
    /// such a plane are exact, up to the rounding of a corner to the [grid](BspTree::grid).
    pub fn polygon(&self) -> Option<usize> {
        match self.plane().kind() {
            PlaneKind::Face(face) => Some(self.tree.faces.polygon(face)),
            PlaneKind::Axis(..) => None,
        }
    }

    /// Returns the exact plane, named by a face or a corner of [`BspTree::faces`].
    #[doc(hidden)]
    pub fn plane(&self) -> PlaneId {
        self.tree.nodes[self.index()].plane
    }

    /// Returns the side of the plane that a viewpoint sees, exactly. In back-to-front orders, the fragments
    /// on the other side come first. If the plane is seen edge-on, either side may come first.
    pub fn facing(&self, viewpoint: Viewpoint) -> Facing {
        let eye = Eye::new(viewpoint, self.tree.faces.lattice());
        self.tree.faces.plane(self.plane()).facing(&eye).into()
    }

    /// Returns the numbers of the fragments of the whole subtree: on the plane, in front of the plane and
    /// behind.
    pub fn fragments(&self) -> Range<u32> {
        self.first..self.end
    }

    /// Returns the numbers of the fragments on the plane, in input order.
    pub fn on(&self) -> Range<u32> {
        self.ranges().own
    }

    /// Returns the numbers of all fragments in front of the plane, down to the leaves.
    pub fn in_front(&self) -> Range<u32> {
        self.ranges().front
    }

    /// Returns the numbers of all fragments behind the plane, down to the leaves.
    pub fn behind(&self) -> Range<u32> {
        self.ranges().back
    }

    /// Returns the front side: a node or a [leaf](BspTree::locate).
    pub fn front(&self) -> Child<'t> {
        let record = &self.tree.nodes[self.index()];
        self.child(record.front_node(self.index()), self.in_front())
    }

    /// Returns the back side: a node or a [leaf](BspTree::locate).
    pub fn back(&self) -> Child<'t> {
        let record = &self.tree.nodes[self.index()];
        self.child(record.back_node(self.index()), self.behind())
    }

    /// The far side, the fragments on the plane, and the near side: back to front.
    #[inline]
    pub(super) fn parts(&self, is_eye_in_front: bool) -> [Child<'t>; 3] {
        let record = &self.tree.nodes[self.index()];
        let Ranges { own, front, back } = record.ranges(self.fragments());
        let front = self.child(record.front_node(self.index()), front);
        let back = self.child(record.back_node(self.index()), back);
        let own = Child::Leaf(own);
        if is_eye_in_front { [back, own, front] } else { [front, own, back] }
    }

    fn ranges(&self) -> Ranges {
        self.tree.nodes[self.index()].ranges(self.fragments())
    }

    fn child(&self, node: Option<usize>, fragments: Range<u32>) -> Child<'t> {
        match node {
            Some(index) => Child::Node(Node {
                tree: self.tree,
                index: index as u32,
                depth: self.depth + 1,
                first: fragments.start,
                end: fragments.end,
            }),
            None => Child::Leaf(fragments),
        }
    }
}

/// Nodes of one tree are equal if they have the same number.
impl PartialEq for Node<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.tree, other.tree) && self.index == other.index
    }
}

impl Eq for Node<'_> {}

impl fmt::Debug for Node<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Node")
            .field("index", &self.index)
            .field("depth", &self.depth)
            .field("plane", &self.plane())
            .field("on", &self.on())
            .field("in_front", &self.in_front())
            .field("behind", &self.behind())
            .finish()
    }
}

/// The nodes of a tree, depth first: [`BspTree::nodes`].
#[derive(Clone, Debug)]
struct Nodes<'t> {
    tree: &'t BspTree,
    walk: Walk,
    left: usize,
}

impl<'t> Nodes<'t> {
    fn take(&mut self, visit: Visit) -> Node<'t> {
        self.left -= 1;
        let fragments = visit.all();
        Node {
            tree: self.tree,
            index: visit.node as u32,
            depth: visit.depth as u32,
            first: fragments.start,
            end: fragments.end,
        }
    }
}

impl<'t> Iterator for Nodes<'t> {
    type Item = Node<'t>;

    fn next(&mut self) -> Option<Node<'t>> {
        let visit = self.walk.next(self.tree)?;
        Some(self.take(visit))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<'t> DoubleEndedIterator for Nodes<'t> {
    fn next_back(&mut self) -> Option<Node<'t>> {
        let visit = self.walk.next_back(self.tree)?;
        Some(self.take(visit))
    }
}

impl ExactSizeIterator for Nodes<'_> {}
impl FusedIterator for Nodes<'_> {}

impl BspTree {
    /// Returns the root node, whose subtree contains all fragments. `None` if the tree has no nodes. Then the
    /// tree has no fragment, or the tree is a leaf with a single fragment.
    pub fn root(&self) -> Option<Node<'_>> {
        let end = self.records.len() as u32;
        (!self.nodes.is_empty()).then_some(Node { tree: self, index: 0, depth: 1, first: 0, end })
    }

    /// The root, or all fragments if there are no nodes.
    pub(super) fn whole(&self) -> Child<'_> {
        self.root().map_or(Child::Leaf(0..self.records.len() as u32), Child::Node)
    }

    /// Returns all nodes, to draw, measure or check a tree. A node precedes its front subtree, and the front
    /// subtree precedes the back subtree. The whole iteration takes O(nodes) time.
    pub fn nodes(
        &self,
    ) -> impl DoubleEndedIterator<Item = Node<'_>> + ExactSizeIterator + FusedIterator + Clone + fmt::Debug
    {
        Nodes { tree: self, walk: Walk::new(self), left: self.nodes.len() }
    }
}

const BACK_IS_NODE: u32 = 1 << 31;

/// The largest number of fragments of a tree. While an
/// [`OrderLayout`](crate::tree::order::layout::OrderLayout) is laid out, its parts are numbered in 30 bits,
/// and there are fewer than two parts per fragment.
pub(crate) const MOST_FRAGMENTS: usize = (1 << 29) - 1;

/// A stored node.
///
/// Nodes are stored depth first: the root, its front subtree, its back subtree. Fragments are numbered in
/// this order: on the node's plane, in a front leaf, in a back leaf, in the front subtree, in the back
/// subtree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NodeRecord {
    pub(crate) plane: PlaneId,
    own: u32,
    /// The number of fragments in front.
    pub(crate) front_len: u32,
    /// The number of nodes in front; if 0, the front is a leaf.
    pub(crate) front_nodes: u32,
}

impl NodeRecord {
    /// The number of fragments on the plane.
    #[inline]
    pub(crate) fn own(&self) -> u32 {
        self.own & !BACK_IS_NODE
    }

    /// Whether the back is a node rather than a leaf.
    #[inline]
    pub(crate) fn back_is_node(&self) -> bool {
        self.own & BACK_IS_NODE != 0
    }

    /// The number of the child node in front, given this node's number; `None` if the front is a leaf.
    #[inline]
    pub(crate) fn front_node(&self, index: usize) -> Option<usize> {
        (self.front_nodes > 0).then_some(index + 1)
    }

    /// The number of the child node behind, given this node's number; `None` if the back is a leaf.
    #[inline]
    pub(crate) fn back_node(&self, index: usize) -> Option<usize> {
        self.back_is_node().then_some(index + 1 + self.front_nodes as usize)
    }

    /// The ranges of this node's fragments, given the range of the whole subtree.
    #[inline]
    pub(crate) fn ranges(&self, all: Range<u32>) -> Ranges {
        let own = all.start..all.start + self.own();
        // Leaves are numbered before subtrees. So the back precedes the front only if the back is a leaf and
        // the front is not.
        if self.front_nodes > 0 && !self.back_is_node() {
            let middle = all.end - self.front_len;
            return Ranges { front: middle..all.end, back: own.end..middle, own };
        }
        let middle = own.end + self.front_len;
        Ranges { front: own.end..middle, back: middle..all.end, own }
    }
}

/// The fragments of a subtree, divided by the root's plane: on the plane, in front and behind, including all
/// fragments of the nodes below.
#[derive(Clone, Debug)]
pub(crate) struct Ranges {
    pub(crate) own: Range<u32>,
    pub(crate) front: Range<u32>,
    pub(crate) back: Range<u32>,
}

impl Ranges {
    /// All fragments. Those on the plane come first.
    pub(crate) fn all(&self) -> Range<u32> {
        self.own.start..self.back.end.max(self.front.end)
    }
}

/// The numbers of fragments and nodes of a subtree.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sizes {
    fragments: u32,
    nodes: u32,
}

/// Reserves the memory that [`finish`] needs for a number of nodes.
pub(crate) fn make_room(
    raw: usize,
    sizes: &mut Vec<Sizes>,
    nodes: &mut Vec<NodeRecord>,
) -> Result<(), Error> {
    sizes.clear();
    nodes.clear();
    reserve(sizes, raw)?;
    nodes.try_reserve_exact(raw).map_err(|_| Error::out_of_memory())
}

/// Computes the sizes of all subtrees, and replaces the contents of `nodes` by the stored nodes.
pub(crate) fn finish(
    raw: impl DoubleEndedIterator<Item = RawNode> + ExactSizeIterator,
    sizes: &mut Vec<Sizes>,
    nodes: &mut Vec<NodeRecord>,
) {
    // Nodes are read from last to first, so children are read before their parents. Subtrees whose parents
    // have not been read yet are on a stack, front subtrees above back subtrees.
    sizes.clear();
    nodes.clear();
    nodes.reserve_exact(raw.len());
    for node in raw.rev() {
        let mut size = |child| match child {
            RawChild::Leaf(fragments) => Sizes { fragments, nodes: 0 },
            RawChild::Node => sizes.pop().unwrap_or_default(),
        };
        let (front, back) = (size(node.front), size(node.back));
        sizes.push(Sizes {
            fragments: node.own + front.fragments + back.fragments,
            nodes: 1 + front.nodes + back.nodes,
        });
        let back_is_node = if node.back == RawChild::Node { BACK_IS_NODE } else { 0 };
        let own = node.own | back_is_node;
        let Sizes { fragments: front_len, nodes: front_nodes } = front;
        nodes.push(NodeRecord { plane: node.plane, own, front_len, front_nodes });
    }
    nodes.reverse();
}

/// A node on a walk.
#[derive(Clone, Debug)]
pub(super) struct Visit {
    pub(super) node: usize,
    /// The number of nodes on the path to this node, itself included.
    pub(super) depth: usize,
    /// The fragments on the node's plane.
    pub(super) own: Range<u32>,
    /// The fragments of a front leaf.
    pub(super) front: Range<u32>,
    /// The fragments of a back leaf.
    pub(super) back: Range<u32>,
    /// All fragments in front, in a leaf or not.
    pub(super) in_front: Range<u32>,
    /// All fragments behind, in a leaf or not.
    pub(super) behind: Range<u32>,
}

impl Visit {
    /// The fragments of the whole subtree.
    pub(super) fn all(&self) -> Range<u32> {
        self.own.start..self.in_front.end.max(self.behind.end)
    }

    /// The number of fragments in the node's leaves.
    pub(super) fn leaves(&self) -> usize {
        self.front.len() + self.back.len()
    }
}

/// A subtree still to be walked, or only the subtree's root.
#[derive(Clone, Debug)]
struct Subtree {
    node: usize,
    depth: usize,
    /// The fragments of the whole subtree.
    fragments: Range<u32>,
    /// Whether the subtrees below have their own entries in the walk, so that only the root is left here.
    is_root_alone: bool,
}

/// The nodes still to be visited, from both ends: subtrees in memory order.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    subtrees: VecDeque<Subtree>,
}

impl Walk {
    pub(super) fn new(tree: &BspTree) -> Self {
        let all = Subtree {
            node: 0,
            depth: 1,
            fragments: 0..tree.records.len() as u32,
            is_root_alone: false,
        };
        Self { subtrees: if tree.nodes.is_empty() { [].into() } else { [all].into() } }
    }

    /// The next node. `None` at the end, or if stored sizes contradict each other.
    pub(super) fn next(&mut self, tree: &BspTree) -> Option<Visit> {
        let subtree = self.subtrees.pop_front()?;
        let visit = visit(tree, &subtree)?;
        if !subtree.is_root_alone {
            let [front, back] = below(tree, &subtree, &visit);
            for below in [back, front].into_iter().flatten() {
                self.subtrees.push_front(below);
            }
        }
        Some(visit)
    }

    /// The last node that has not been visited from either end. `None` as for [`next`](Self::next).
    pub(super) fn next_back(&mut self, tree: &BspTree) -> Option<Visit> {
        loop {
            let mut subtree = self.subtrees.pop_back()?;
            let visit = visit(tree, &subtree)?;
            if subtree.is_root_alone {
                return Some(visit);
            }
            // The root is stored before all nodes below it, so from this end it is visited last.
            let below = below(tree, &subtree, &visit);
            subtree.is_root_alone = true;
            self.subtrees.push_back(subtree);
            self.subtrees.extend(below.into_iter().flatten());
        }
    }
}

/// The root of a subtree; `None` if there is no such node, or if the node has more fragments than the
/// subtree.
fn visit(tree: &BspTree, subtree: &Subtree) -> Option<Visit> {
    let &Subtree { node: index, depth, ref fragments, .. } = subtree;
    let node = tree.nodes.get(index)?;
    let total = fragments.end - fragments.start;
    total.checked_sub(node.own())?.checked_sub(node.front_len)?;
    let Ranges { own, front: in_front, back: behind } = node.ranges(fragments.clone());
    let front = if node.front_nodes == 0 { in_front.clone() } else { own.end..own.end };
    let back = if node.back_is_node() { front.end..front.end } else { behind.clone() };
    Some(Visit { node: index, depth, own, front, back, in_front, behind })
}

/// The subtrees in front of a root and behind it; `None` for a leaf.
fn below(tree: &BspTree, subtree: &Subtree, root: &Visit) -> [Option<Subtree>; 2] {
    let node = &tree.nodes[root.node];
    let child = |node, fragments: &Range<u32>| {
        let (depth, fragments) = (subtree.depth + 1, fragments.clone());
        Subtree { node, depth, fragments, is_root_alone: false }
    };
    [
        node.front_node(root.node).map(|front| child(front, &root.in_front)),
        node.back_node(root.node).map(|back| child(back, &root.behind)),
    ]
}

impl BspTree {
    /// Returns the partition plane that separates two fragments, or that both fragments lie on. `None` if
    /// both fragments are in one leaf; then both are the same fragment. O(depth).
    ///
    /// # Panics
    ///
    /// If a number belongs to no fragment.
    #[doc(hidden)]
    pub fn plane_between(&self, a: u32, b: u32) -> Option<PlaneId> {
        self.parting(a, b).map(|(plane, _)| plane)
    }

    /// The plane of [`plane_between`](Self::plane_between), and the side of each fragment: `Greater` is the
    /// front, `Equal` the plane itself.
    pub(crate) fn parting(&self, a: u32, b: u32) -> Option<(PlaneId, [Ordering; 2])> {
        let high = a.max(b);
        assert!((high as usize) < self.records.len(), "no fragment {high}");
        let (mut index, mut fragments) = (0, 0..self.records.len() as u32);
        loop {
            let node = &self.nodes[index];
            let Ranges { front, back, .. } = node.ranges(fragments);
            let has_both = |side: &Range<u32>| side.contains(&a) && side.contains(&b);
            let (child, side) = if has_both(&front) {
                (node.front_node(index), front)
            } else if has_both(&back) {
                (node.back_node(index), back)
            } else {
                let side = |fragment: u32| {
                    let is_in_front = front.contains(&fragment);
                    is_in_front.cmp(&back.contains(&fragment))
                };
                return Some((node.plane, [a, b].map(side)));
            };
            // If the side is not a node, both fragments are in one leaf.
            (index, fragments) = (child?, side);
        }
    }
}

#[cfg(test)]
mod between_tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::{BuildOptions, Heuristic, scene};

    /// For a pair of fragments: the plane between the two fragments, and the side of each fragment.
    type Entry = Option<(PlaneId, [Ordering; 2])>;

    /// A table of the planes between any two fragments, from the ranges of all nodes. A node's plane is
    /// between two fragments of the node's subtree unless both fragments lie on the same side of the plane.
    /// No pair of fragments has two such planes.
    fn table(tree: &BspTree) -> Vec<Vec<Entry>> {
        let mut table = vec![vec![None; tree.len()]; tree.len()];
        for node in tree.nodes() {
            let plane = node.plane();
            let on = (node.on(), Ordering::Equal);
            let front = (node.in_front(), Ordering::Greater);
            let back = (node.behind(), Ordering::Less);
            for (one, other) in [(&on, &on), (&on, &front), (&on, &back), (&front, &back)] {
                for a in one.0.clone() {
                    for b in other.0.clone() {
                        let known = [(a, one.1, b, other.1), (b, other.1, a, one.1)].map(
                            |(a, of_a, b, of_b)| {
                                let entry = &mut table[a as usize][b as usize];
                                entry.replace((plane, [of_a, of_b]))
                            },
                        );
                        assert!(one == other || known == [None; 2], "{a} and {b} are parted twice");
                    }
                }
            }
        }
        table
    }

    /// Random triangles. Some lie in the plane of another triangle, and some are repeated.
    fn soup(seed: u64) -> Vec<[glam::DVec3; 3]> {
        let mut random = SplitMix64::new(seed);
        let mut triangles: Vec<[glam::DVec3; 3]> = Vec::new();
        for k in 0..4 + seed % 40 {
            let triangle = std::array::from_fn(|_| random.point(-1.0, 1.0));
            let of_before = triangles.get((random.next() % (k + 1)) as usize).copied();
            triangles.push(match (of_before, random.next() % 4) {
                (Some(other), 0) => other,
                // In the same plane as others, if that plane is perpendicular to z.
                (_, 1) => triangle.map(|p| p.with_z((4.0 * triangle[0].z).round() / 4.0)),
                _ => triangle,
            });
        }
        triangles
    }

    #[test]
    fn the_plane_between_two_fragments_separates_them() {
        let (mut pairs, mut in_one_leaf, mut on_one_plane, mut most) = (0, 0, 0, 0);
        let mut check = |tree: &BspTree, case: &str| {
            let table = table(tree);
            for a in 0..tree.len() as u32 {
                for b in 0..tree.len() as u32 {
                    let expected = table[a as usize][b as usize];
                    assert_eq!(tree.parting(a, b), expected, "{a} and {b}, {case}");
                    let plane = expected.map(|(plane, _)| plane);
                    assert_eq!(tree.plane_between(a, b), plane, "{a} and {b}, {case}");
                    pairs += usize::from(a != b);
                    in_one_leaf += usize::from(expected.is_none());
                }
            }
            on_one_plane += tree.nodes().filter(|node| node.on().len() > 1).count();
            most = most.max(tree.len());
        };
        for seed in 0..40 {
            for &heuristic in Heuristic::ALL {
                let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
                let tree = options.build(soup(seed)).unwrap();
                check(&tree, &format!("seed {seed}, {heuristic}"));
            }
        }
        for scene in [scene::chain(60), scene::random_triangles(40, 2), scene::newell_bars()] {
            check(&BspTree::build(scene.polygons()).unwrap(), scene.name());
        }
        assert!(pairs > 1_000_000 && most > 200, "{pairs} pairs, trees up to {most} fragments");
        assert!(in_one_leaf > 1000 && on_one_plane > 1000, "{in_one_leaf}, {on_one_plane}");
    }
}
