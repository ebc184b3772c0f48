//! Everything a tree says about itself, to be compared bit for bit.

use binspace::geom::{Kernel, Line, Viewpoint};
use binspace::{BspTree, Partition};

/// A fragment: its face, its polygon, its lines, its vertices in lattice units.
type Piece = (u32, usize, Vec<Line>, Vec<[u64; 3]>);

/// A tree's planes and fragments.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Snapshot {
    pub(crate) partitions: Vec<Partition>,
    pub(crate) pieces: Vec<Piece>,
}

impl Snapshot {
    pub(crate) fn of<K: Kernel>(tree: &BspTree<K>) -> Self {
        let bits = |p: [f64; 3]| p.map(f64::to_bits);
        let pieces = tree.fragments().map(|fragment| {
            let vertices = fragment.lattice_vertices().map(bits).collect();
            (fragment.face(), fragment.polygon(), fragment.lines().collect(), vertices)
        });
        Self { partitions: tree.partitions().collect(), pieces: pieces.collect() }
    }
}

/// The fragments' numbers, back to front.
pub(crate) fn order<K: Kernel>(tree: &BspTree<K>, viewpoint: Viewpoint) -> Vec<u32> {
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    order
}

/// The fragments' polygons, back to front.
pub(crate) fn polygons<K: Kernel>(tree: &BspTree<K>, viewpoint: Viewpoint) -> Vec<usize> {
    order(tree, viewpoint).into_iter().map(|id| tree.fragment(id).polygon()).collect()
}
