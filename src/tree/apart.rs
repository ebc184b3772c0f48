//! Taking a tree apart.

use super::BspTree;
use super::node_record::NodeRecord;
use super::parts::{Parts, RawChild, RawNode};
use super::walk::Walk;
use crate::exact::ExactStored;

/// The nodes of a tree as the builder wrote them, in their order. Takes O(depth) memory.
pub(super) fn raw_nodes(tree: &BspTree) -> impl Iterator<Item = RawNode> {
    let mut walk = Walk::new(tree);
    std::iter::from_fn(move || {
        let visit = walk.next(tree)?;
        let node = &tree.nodes[visit.node];
        let &NodeRecord { plane, front_len, front_nodes, .. } = node;
        let child = |is_node, len| if is_node { RawChild::Node } else { RawChild::Leaf(len) };
        Some(RawNode {
            plane,
            own: node.own(),
            front: child(front_nodes > 0, front_len),
            back: child(node.back_is_node(), visit.behind.len() as u32),
        })
    })
}

/// The parts that a tree was made of.
pub fn parts_of_tree(tree: &BspTree) -> Parts<ExactStored> {
    Parts {
        nodes: raw_nodes(tree).collect(),
        records: tree.records.clone(),
        vertices: tree.vertices.clone(),
        positions: tree.positions.clone(),
        cuts: tree.cuts,
    }
}
