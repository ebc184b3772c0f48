//! The arrays of a page: the tree, and the outlines of its fragments.

use std::hash::Hash;
use std::ops::Range;

use binspace::internals::{EdgeLine, LATTICE_LIMIT};
use binspace::{BspTree, Child, Fragment, Node};
use indexmap::IndexSet;
use serde::Serialize;

use super::packed::Packed;

/// Kinds of edges, as the script names them.
const ORIGINAL: u32 = 0;
const CUT: u32 = 1;
/// An edge within a polygon that was triangulated.
const INNER: u32 = 2;

/// The arrays, as the script names them.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Arrays {
    /// Points of the grid, three numbers each.
    points: Packed,
    /// For each plane, three of `points`, counter-clockwise seen from its front. A plane perpendicular to an
    /// axis has one point twice, and the axis. The planes of nodes come first.
    plane_points: Packed,
    /// For each node, depth first: the node's plane, the numbers of fragments on the plane and in the node's
    /// two leaves, and the numbers of the node's two children, or 0.
    node_planes: Packed,
    own: Packed,
    front_leaf: Packed,
    back_leaf: Packed,
    front_node: Packed,
    back_node: Packed,
    /// Pairs of a polygon and one of the polygon's planes, two numbers each.
    faces: Packed,
    /// For each fragment: the number of its pair in `faces`, and the number of its corners.
    fragment_faces: Packed,
    corner_counts: Packed,
    /// For each of these corners: the number of vertices that earlier corners use, minus the number of this
    /// corner's vertex; and the kind of the edge from this corner to the next.
    corners: Packed,
    edge_kinds: Packed,
    /// The vertices, three numbers each.
    vertices: Packed,
    polygon_materials: Packed,
}

impl Arrays {
    /// The arrays, and the number of planes of nodes.
    pub(super) fn of(tree: &BspTree, polygon_materials: &[u32]) -> (Self, usize) {
        let mut planes = Planes::default();
        let nodes = Nodes::of(tree, &mut planes);
        let node_planes = planes.planes.len();
        let fragments = Fragments::of(tree, &mut planes);
        // The grid's numbers are below 2⁵³, so they are exact as f64.
        let points: Vec<f64> = planes.points.iter().flatten().map(|&c| c as f64).collect();
        let vertices = fragments.vertices.iter().flatten();
        let vertices: Vec<f32> = vertices.map(|&bits| f32::from_bits(bits)).collect();
        let arrays = Self {
            points: Packed::double(&points),
            plane_points: Packed::whole(&flat(planes.planes)),
            node_planes: Packed::whole(&nodes.planes),
            own: Packed::whole(&nodes.own),
            front_leaf: Packed::whole(&nodes.front.leaves),
            back_leaf: Packed::whole(&nodes.back.leaves),
            front_node: Packed::whole(&nodes.front.nodes),
            back_node: Packed::whole(&nodes.back.nodes),
            faces: Packed::whole(&flat(fragments.faces)),
            fragment_faces: Packed::whole(&fragments.fragment_faces),
            corner_counts: Packed::whole(&fragments.counts),
            corners: Packed::whole(&fragments.corners),
            edge_kinds: Packed::whole(&fragments.edges),
            vertices: Packed::single(&vertices),
            polygon_materials: Packed::whole(polygon_materials),
        };
        (arrays, node_planes)
    }
}

/// The number of a value in a set, to which a new value is added.
pub(super) fn number<T: Eq + Hash>(set: &mut IndexSet<T>, value: T) -> u32 {
    set.insert_full(value).0 as u32
}

fn flat<const N: usize>(set: IndexSet<[u32; N]>) -> Vec<u32> {
    set.into_iter().flatten().collect()
}

/// The planes of a tree, and the grid points that define these planes.
#[derive(Default)]
struct Planes {
    points: IndexSet<[i64; 3]>,
    planes: IndexSet<[u32; 3]>,
}

impl Planes {
    fn through(&mut self, points: [[i64; 3]; 3]) -> u32 {
        let points = points.map(|point| number(&mut self.points, point));
        number(&mut self.planes, points)
    }

    fn of_node(&mut self, node: &Node<'_>) -> u32 {
        let [point, next, _] = node.grid_points();
        // The second point of a plane without a polygon is a step along the axis after the plane's.
        let is_free = node.polygon().is_none();
        let Some(step) = (0..3).find(|&axis| is_free && next[axis] != point[axis]) else {
            return self.through(node.grid_points());
        };
        let (point, axis) = (number(&mut self.points, point), (step as u32 + 2) % 3);
        number(&mut self.planes, [point, point, axis])
    }
}

/// The nodes of a tree, depth first.
#[derive(Default)]
struct Nodes {
    planes: Vec<u32>,
    own: Vec<u32>,
    front: Side,
    back: Side,
}

/// The two sides of each node.
#[derive(Default)]
struct Side {
    /// The number of fragments, if the side is a leaf.
    leaves: Vec<u32>,
    /// The node's number, if the side is a node; otherwise 0, the root's number.
    nodes: Vec<u32>,
}

impl Side {
    fn push(&mut self, child: &Child<'_>) {
        let (fragments, node) = match child {
            Child::Leaf(fragments) => (len(fragments), 0),
            Child::Node(node) => (0, node.index() as u32),
        };
        self.leaves.push(fragments);
        self.nodes.push(node);
    }
}

fn len(fragments: &Range<u32>) -> u32 {
    fragments.end - fragments.start
}

impl Nodes {
    fn of(tree: &BspTree, planes: &mut Planes) -> Self {
        let mut nodes = Self::default();
        for node in tree.nodes() {
            nodes.planes.push(planes.of_node(&node));
            nodes.own.push(len(&node.on()));
            nodes.front.push(&node.front());
            nodes.back.push(&node.back());
        }
        nodes
    }
}

/// The fragments of a tree in the order of their numbers. Fragments of a node come after the fragments of all
/// nodes before it: first the fragments on the node's plane, then in the front leaf, then in the back leaf.
#[derive(Default)]
struct Fragments {
    faces: IndexSet<[u32; 2]>,
    fragment_faces: Vec<u32>,
    counts: Vec<u32>,
    corners: Vec<u32>,
    edges: Vec<u32>,
    /// The vertices, by the bits of their coordinates.
    vertices: IndexSet<[u32; 3]>,
}

impl Fragments {
    fn of(tree: &BspTree, planes: &mut Planes) -> Self {
        let mut all = Self::default();
        for fragment in tree.fragments() {
            let face = [fragment.polygon() as u32, planes.through(fragment.grid_points())];
            all.fragment_faces.push(number(&mut all.faces, face));
            all.counts.push(fragment.vertex_count() as u32);
            all.edges.extend(edge_kinds(&fragment));
            for vertex in fragment.lattice_vertices() {
                let bits = vertex.map(|c| ((c / LATTICE_LIMIT) as f32).to_bits());
                let first_new = all.vertices.len() as u32;
                all.corners.push(first_new - number(&mut all.vertices, bits));
            }
        }
        all
    }
}

/// The kinds of a fragment's edges, from each vertex to the next.
fn edge_kinds(fragment: &Fragment<'_>) -> impl Iterator<Item = u32> {
    let kind = |(line, edge): (EdgeLine, Option<u32>)| match (line.as_cut(), edge) {
        (Some(_), _) => CUT,
        (None, Some(_)) => ORIGINAL,
        (None, None) => INNER,
    };
    fragment.lines().zip(fragment.edges()).map(kind)
}
