//! Subtrees of wrong sizes.

use super::{Dismantled, assert_fault, build, crossing, trees, verdict};
use crate::build::Heuristic;
use crate::exact::PlaneId;
use crate::scene;
use crate::tree::node::{NodeRecord, finish};
use crate::tree::parts::{RawChild, RawNode};

const COUNTS: &str = "the sizes of its subtrees contradict each other";

/// The same node with another number of fragments on its plane, and another kind of back.
fn with_own(node: &NodeRecord, own: u32, back_is_node: bool) -> NodeRecord {
    let back = if back_is_node { RawChild::Node } else { RawChild::Leaf(0) };
    let raw = RawNode { plane: node.plane, own, front: RawChild::Leaf(0), back };
    let last = RawNode { back: RawChild::Leaf(0), ..raw };
    let mut nodes = Vec::new();
    finish([raw, last].into_iter(), &mut Vec::new(), &mut nodes);
    with_front(&nodes[0], node.front_len, node.front_nodes)
}

/// The same node with other numbers of fragments and nodes in front.
fn with_front(node: &NodeRecord, front_len: u32, front_nodes: u32) -> NodeRecord {
    let mut node = *node;
    (node.front_len, node.front_nodes) = (front_len, front_nodes);
    node
}

#[test]
fn sizes_that_are_off_are_found_wherever_they_are() {
    let mut broken = 0;
    for (name, tree) in trees() {
        let step = 1 + tree.nodes.len() / 8;
        for at in (0..tree.nodes.len()).step_by(step) {
            let node = tree.nodes[at];
            let (own, back_is_node) = (node.own(), node.back_is_node());
            let (len, nodes) = (node.front_len, node.front_nodes);
            let edits = [
                with_front(&node, len + 1, nodes),
                with_front(&node, len.wrapping_sub(1), nodes),
                with_front(&node, u32::MAX, nodes),
                with_front(&node, len, nodes + 1),
                with_front(&node, len, nodes.wrapping_sub(1)),
                with_front(&node, len, u32::MAX),
                with_own(&node, own + 1, back_is_node),
                with_own(&node, own.wrapping_sub(1) & 0x7fff_ffff, back_is_node),
                with_own(&node, own, !back_is_node),
            ];
            for edit in edits {
                let mut tree = tree.clone();
                tree.nodes[at] = edit;
                assert_ne!(verdict(&tree), "", "{name}, node {at}: {edit:?} for {node:?}");
                broken += 1;
            }
        }
    }
    assert!(broken > 1000, "{broken}");
}

#[test]
fn nodes_and_fragments_too_few_or_too_many_are_counted() {
    let tree = crossing(5);
    let mut longer = tree.clone();
    longer.nodes.push(tree.nodes[0]);
    assert!(verdict(&longer).contains(COUNTS));
    let mut shorter = tree.clone();
    shorter.nodes.pop();
    assert!(verdict(&shorter).contains(COUNTS));
    let mut none = tree.clone();
    none.nodes.clear();
    assert!(verdict(&none).contains(COUNTS));
    let mut no_fragments = tree.clone();
    no_fragments.records.clear();
    assert!(verdict(&no_fragments).contains(COUNTS));
    let mut one_more = tree.clone();
    one_more.records.push(tree.records[tree.records.len() - 1]);
    assert_ne!(verdict(&one_more), "");
}

/// Nodes that are all empty and have two sides each would be walked 2ⁿ times.
#[test]
fn sizes_that_send_a_walk_in_circles_end_it() {
    let mut tree = build(&scene::chain(200), Heuristic::First);
    let idle = with_own(&tree.nodes[0], 0, true);
    for node in &mut tree.nodes[1..] {
        *node = with_front(&idle, 0, 1);
    }
    assert_ne!(verdict(&tree), "");
}

#[test]
fn a_plane_that_separates_nothing_is_found() {
    let idle = RawNode {
        plane: PlaneId::axis(0, 0),
        own: 0,
        front: RawChild::Node,
        back: RawChild::Leaf(0),
    };
    // All squares are on one side of the plane through the first corner.
    let tree = build(&scene::chain(30), Heuristic::First);
    let fault = "its plane separates no fragments";
    assert_fault(&tree, |parts| parts.nodes.insert(0, idle), fault);
    let behind = RawNode { front: RawChild::Leaf(0), back: RawChild::Node, ..idle };
    assert_fault(&tree, |parts| parts.nodes.insert(0, behind), fault);
}

#[test]
fn fragments_that_no_plane_tells_apart_are_a_crowd() {
    let fault = "a leaf has more than one fragment";
    for heuristic in [Heuristic::First, Heuristic::default()] {
        let tree = build(&scene::random_triangles(50, 1), heuristic);
        // One side of the root becomes a leaf that contains the whole subtree.
        for front in [true, false] {
            let edit = |parts: &mut Dismantled| {
                let root = &tree.nodes[0];
                let front_nodes = root.front_nodes as usize;
                let back_len = tree.records.len() as u32 - root.own() - root.front_len;
                assert!(front_nodes > 0 && root.back_is_node());
                if front {
                    parts.nodes.drain(1..=front_nodes);
                    parts.nodes[0].front = RawChild::Leaf(root.front_len);
                } else {
                    parts.nodes.truncate(1 + front_nodes);
                    parts.nodes[0].back = RawChild::Leaf(back_len);
                }
            };
            assert_fault(&tree, edit, fault);
        }
    }
}
