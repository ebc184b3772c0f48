//! Wrong layouts of orders.

use super::{trees, verdict};
use crate::exact::StoredVertex;
use crate::tree::BspTree;

const LAYOUT: &str = "the layout for orders does not match the nodes";
const POSITIONS: &str = "node 0: the positions do not match the vertices";
const ROUNDED: &str = "the rounded planes do not match the nodes";

/// Breaks every tree to which an edit applies. Returns the number of these trees.
fn assert_all(fault: &str, edit: impl Fn(&mut BspTree) -> Option<()>) -> usize {
    let mut broken = 0;
    for (name, mut tree) in trees() {
        if edit(&mut tree).is_some() {
            let said = verdict(&tree);
            assert!(said.contains(fault), "{name}: {said:?}");
            broken += 1;
        }
    }
    broken
}

#[test]
fn a_change_of_an_inner_node_is_found() {
    let broken = [
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.inner.pop().map(drop)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.inner.last_mut().map(|b| b.node += 1)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.inner.last_mut().map(|b| b.own ^= 1)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.inner.first_mut().map(|b| b.front += 1)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.inner.first_mut().map(|b| b.back += 1)),
        assert_all(LAYOUT, |tree| {
            let inner = tree.layout.as_mut()?.inner.first_mut()?;
            inner.front_part ^= inner.back_part ^ 7;
            Some(())
        }),
        assert_all(LAYOUT, |tree| {
            tree.layout.as_mut()?.inner.first_mut().map(|b| b.back_part += 1)
        }),
        assert_all(LAYOUT, |tree| {
            let inner = &mut tree.layout.as_mut()?.inner;
            inner.iter_mut().find(|b| b.own > 0).map(|b| b.own_first += 1)
        }),
    ];
    assert!(broken.iter().all(|&broken| broken >= 20), "{broken:?}");
}

#[test]
fn a_change_of_a_block_or_a_span_or_a_permutation_is_found() {
    let blocks = [
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.blocks.pop().map(drop)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.blocks.first_mut().map(|t| t.node += 1)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.blocks.last_mut().map(|t| t.first += 1)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.blocks.last_mut().map(|t| t.row ^= 1)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.permutations.last_mut().map(|p| p[5] ^= 1)),
        assert_all(LAYOUT, |tree| {
            let [first, .., last] = &mut tree.layout.as_mut()?.permutations[..] else {
                return None;
            };
            let distinct = first != last;
            std::mem::swap(first, last);
            distinct.then_some(())
        }),
    ];
    assert!(blocks.iter().all(|&broken| broken >= 15), "{blocks:?}");
    let runs = [
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.spans.pop().map(drop)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.spans.first_mut().map(|r| r.first += 1)),
        assert_all(LAYOUT, |tree| tree.layout.as_mut()?.spans.last_mut().map(|r| r.len -= 1)),
    ];
    assert!(runs.iter().all(|&broken| broken >= 2), "{runs:?}");
}

#[test]
fn rounded_planes_of_other_nodes_are_found() {
    let swapped = assert_all(ROUNDED, |tree| {
        let [first, .., last] = tree.nodes[..] else { return None };
        let distinct = first.plane != last.plane;
        let mut nodes = tree.nodes.clone();
        nodes.reverse();
        tree.planes.fill(&tree.faces, &nodes).unwrap();
        distinct.then_some(())
    });
    let missing = assert_all(ROUNDED, |tree| {
        let enough = tree.nodes.len() > 4;
        tree.planes.fill(&tree.faces, &tree.nodes[4.min(tree.nodes.len())..]).unwrap();
        enough.then_some(())
    });
    assert!(swapped >= 20 && missing >= 20, "{swapped} {missing}");
}

/// Stores the positions of a tree's vertices, as in a tree for one view.
fn keep_positions(tree: &mut BspTree) -> Option<()> {
    let of = |fragment: crate::Fragment<'_>| {
        let place =
            |stored: &StoredVertex| tree.faces.position(fragment.face(), stored.vertex_id());
        fragment.stored().iter().map(place).collect::<Vec<_>>()
    };
    let positions: Vec<_> = tree.fragments().flat_map(of).collect();
    tree.positions = positions;
    (!tree.positions.is_empty()).then_some(())
}

#[test]
fn positions_of_other_vertices_or_of_more_or_fewer_are_found() {
    let mut kept = 0;
    for (name, mut tree) in trees() {
        kept += usize::from(keep_positions(&mut tree).is_some());
        assert_eq!(verdict(&tree), "", "{name}");
    }
    let broken = [
        assert_all(POSITIONS, |tree| keep_positions(tree).map(|()| tree.positions.push([0.0; 3]))),
        assert_all(POSITIONS, |tree| {
            keep_positions(tree)?;
            tree.positions.pop();
            // A tree without cut vertices stores no positions.
            (!tree.positions.is_empty()).then_some(())
        }),
        assert_all(POSITIONS, |tree| {
            keep_positions(tree)?;
            tree.positions.last_mut().map(|position| position[2] += 1.0)
        }),
    ];
    assert!(kept >= 15 && broken == [kept; 3], "{kept} {broken:?}");
}
