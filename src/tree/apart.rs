//! Taking a tree apart.

use super::BspTree;
use super::node_record::NodeRecord;
use super::parts::{Parts, RawChild, RawNode};
use super::walk::Walk;
use crate::exact::ExactStored;

/// The parts that a tree was made of.
pub fn parts_of_tree(tree: &BspTree) -> Parts<ExactStored> {
    let mut nodes = Vec::with_capacity(tree.nodes.len());
    let mut walk = Walk::new(tree);
    while let Some(visit) = walk.next(tree) {
        let NodeRecord { plane, front_len, front_nodes, .. } = tree.nodes[visit.node];
        let child = |is_node, len| if is_node { RawChild::Node } else { RawChild::Leaf(len) };
        nodes.push(RawNode {
            plane,
            own: tree.nodes[visit.node].own(),
            front: child(front_nodes > 0, front_len),
            back: child(tree.nodes[visit.node].back_is_node(), visit.behind.len() as u32),
        });
    }
    Parts {
        nodes,
        records: tree.records.clone(),
        vertices: tree.vertices.clone(),
        positions: tree.positions.clone(),
        cuts: tree.cuts,
    }
}
