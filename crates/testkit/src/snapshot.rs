//! A tree's planes and fragments, for comparing trees bit for bit.

use binspace::internals::{EdgeLine, PlaneId};
use binspace::{BspTree, Viewpoint};
use std::ops::Range;

/// A fragment: its face, its polygon, its lines, its vertices in lattice units.
type Piece = (u32, usize, Vec<EdgeLine>, Vec<[u64; 3]>);

/// A partition plane by its name, its depth, and the fragments on it, in front and behind.
type Node = (PlaneId, usize, [Range<u32>; 3]);

/// A tree's planes and fragments.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    pub nodes: Vec<Node>,
    pub pieces: Vec<Piece>,
}

impl Snapshot {
    pub fn of(tree: &BspTree) -> Self {
        let bits = |p: [f64; 3]| p.map(f64::to_bits);
        let pieces = tree.fragments().map(|fragment| {
            let vertices = fragment.lattice_vertices().map(bits).collect();
            (fragment.face(), fragment.polygon(), fragment.lines().collect(), vertices)
        });
        let nodes = tree
            .nodes()
            .map(|node| (node.plane(), node.depth(), [node.on(), node.in_front(), node.behind()]));
        Self { nodes: nodes.collect(), pieces: pieces.collect() }
    }
}

/// Returns the fragments' numbers, back to front.
pub fn order(tree: &BspTree, viewpoint: Viewpoint) -> Vec<u32> {
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    order
}

/// Returns the fragments' polygons, back to front.
pub fn polygons(tree: &BspTree, viewpoint: Viewpoint) -> Vec<usize> {
    order(tree, viewpoint).into_iter().map(|id| tree.fragment(id).polygon()).collect()
}
