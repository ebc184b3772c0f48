//! A tree deeper than any builder makes in a short time.

use super::parts::{Parts, RawChild, RawNode, Record};
use super::{BspTree, Child, Culling, Flow, Part};
use crate::exact::PlaneId;
use crate::{Facing, Frustum, Viewpoint, scene};
use glam::DVec3;

/// A tree of squares one behind the other: all later squares are behind the plane of each square.
fn list(count: u32) -> BspTree {
    let chain = BspTree::build(scene::chain(count).polygons()).unwrap();
    let node = |face| RawNode {
        plane: PlaneId::face(face),
        own: 1,
        front: RawChild::Leaf(0),
        back: if face + 1 < count { RawChild::Node } else { RawChild::Leaf(0) },
    };
    let parts = Parts {
        nodes: (0..count).map(node).collect(),
        records: (0..count).map(|face| Record { face, vertices: 0 }).collect(),
        ..Parts::default()
    };
    BspTree::new(chain.faces.clone(), *chain.preparation(), parts).unwrap()
}

#[test]
fn a_list_of_100_000_nodes_is_walked_on_a_small_stack() {
    const COUNT: u32 = 100_000;
    let work = || {
        let tree = list(COUNT);
        assert_eq!(tree.stats().depth_max, COUNT as usize);
        let viewpoint = Viewpoint::eye([0.0, 50_000.5, 0.0]);
        let (mut order, mut found) = (Vec::new(), Vec::new());
        tree.back_to_front_into(viewpoint, &mut order);
        let _ = tree.order(viewpoint).walk(|part| {
            if let Part::Fragment(fragment) = part {
                found.push(fragment.index());
            }
            Flow::<()>::Descend
        });
        assert_eq!(found, order);
        tree.order(viewpoint).culled(&Culling::NONE).write_into(&mut found);
        assert_eq!(found, order);
        // Fronts face −y, so an eye sees the fronts of squares that are further along y.
        let ahead = Frustum::new([(DVec3::Y, 60_000.0), (DVec3::NEG_Y, -60_002.5)]);
        let culling = Culling::NONE.with_frustum(ahead).with_facing(Facing::Front);
        tree.order(viewpoint).culled(&culling).write_into(&mut found);
        assert_eq!(found, [60_002, 60_001, 60_000]);

        let (mut node, mut depth) = (tree.root().unwrap(), 1);
        while let Child::Node(child) = node.back() {
            (node, depth) = (child, depth + 1);
        }
        assert_eq!((node.depth(), depth), (COUNT as usize, COUNT));
    };
    let small = std::thread::Builder::new().stack_size(256 * 1024);
    small.spawn(work).unwrap().join().unwrap();
}
