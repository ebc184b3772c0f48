//! Fragments on wrong sides and in wrong orders.

use super::{Dismantled, assert_fault, build, crossing, decals, tilted};
use crate::build::Heuristic;
use crate::exact::PlaneId;
use crate::scene;
use crate::tree::parts::{RawChild, RawNode};

#[test]
fn sides_that_are_exchanged_are_found() {
    for tree in [
        build(&scene::chain(40), Heuristic::First),
        build(&scene::chain(900), Heuristic::default()),
        build(&tilted(&scene::sphere(600)), Heuristic::default()),
    ] {
        let has_one_leaf = |node: &&mut RawNode| {
            let sides = (node.front, node.back);
            matches!(sides, (RawChild::Leaf(a), RawChild::Leaf(b)) if a != b)
        };
        let edit = |parts: &mut Dismantled| match parts.nodes.iter_mut().rfind(has_one_leaf) {
            Some(node) => std::mem::swap(&mut node.front, &mut node.back),
            None => {
                // The last node has one fragment on each side.
                let last = parts.pieces.len() - 1;
                parts.pieces.swap(last - 1, last);
            }
        };
        assert_fault(&tree, edit, "but its place requires");
    }
}

#[test]
fn fragments_that_change_places_are_found() {
    let tree = crossing(6);
    let mut swapped = 0;
    for (a, b) in (0..tree.len()).flat_map(|a| (a + 1..tree.len()).map(move |b| (a, b))) {
        let edit = |parts: &mut Dismantled| parts.pieces.swap(a, b);
        assert_fault(&tree, edit, "but its place requires");
        swapped += 1;
    }
    assert!(swapped > 50, "{swapped}");
}

#[test]
fn a_piece_that_grows_to_its_whole_face_is_found_on_both_sides() {
    let tree = crossing(6);
    for fragment in tree.fragments().filter(|fragment| !fragment.is_whole()) {
        let edit = |parts: &mut Dismantled| parts.pieces[fragment.index() as usize].1.clear();
        assert_fault(&tree, edit, "Spanning");
    }
}

#[test]
fn a_fragment_beside_the_plane_that_it_is_said_to_be_on_is_found() {
    let tree = build(&scene::chain(12), Heuristic::First);
    let edit = |parts: &mut Dismantled| {
        let last = parts.nodes.last_mut().expect("a node");
        last.own += 1;
        (last.front, last.back) = (RawChild::Leaf(0), RawChild::Leaf(0));
    };
    assert_fault(&tree, edit, "but its place requires Coplanar");
}

#[test]
fn a_plane_that_faces_the_other_way_is_found() {
    let tree = build(&decals(), Heuristic::First);
    let mut flipped = 0;
    for (at, node) in tree.nodes().enumerate() {
        let normal = |plane| tree.faces.plane(plane).normal_f64().normalize();
        for plane in (0..tree.faces.len() as u32).map(PlaneId::face) {
            let is_opposite = normal(plane).dot(normal(node.plane())) < -0.9;
            if is_opposite && node.in_front().len() + node.behind().len() > 0 {
                let edit = |parts: &mut Dismantled| parts.nodes[at].plane = plane;
                assert_fault(&tree, edit, "but its place requires");
                flipped += 1;
            }
        }
    }
    assert!(flipped > 0);
}

#[test]
fn coplanar_fragments_out_of_input_order_are_found() {
    let mut swapped = 0;
    for scene in [decals(), tilted(&decals())] {
        for by in [Heuristic::First, Heuristic::default()] {
            let tree = build(&scene, by);
            for on in tree.nodes().map(|node| node.on()).filter(|on| on.len() > 1) {
                let edit = |parts: &mut Dismantled| {
                    parts.pieces.swap(on.start as usize, on.start as usize + 1)
                };
                let fault = format!("fragment {} on its plane comes before one", on.start);
                assert_fault(&tree, edit, &fault);
                let last = on.end as usize - 1;
                let edit = |parts: &mut Dismantled| parts.pieces.swap(last - 1, last);
                assert_fault(&tree, edit, "on its plane comes before one of an earlier polygon");
                swapped += 1;
            }
        }
    }
    assert!(swapped >= 8, "{swapped}");
}

#[test]
fn a_face_beside_its_own_plane_is_found_and_counts_as_misplaced() {
    let tree = build(&scene::chain(2), Heuristic::First);
    let edit = |parts: &mut Dismantled| {
        let [root] = &mut parts.nodes[..] else { panic!("one node") };
        // The other square stays on its side.
        if root.front == RawChild::Leaf(1) {
            parts.pieces.swap(0, 1);
        }
        (root.own, root.front, root.back) = (0, RawChild::Leaf(1), RawChild::Leaf(1));
    };
    assert_fault(&tree, edit, "is Coplanar, but");
}
