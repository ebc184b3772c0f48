//! Indices written for a viewpoint, compared with the order of the fragments.

use binspace::mesh::Triangles;
use testkit::prelude::*;

const EYES: [Viewpoint; 3] = [
    Viewpoint::Eye(binspace::glam::dvec3(3.0, 1.0, 2.0)),
    Viewpoint::Eye(binspace::glam::dvec3(0.4, 0.5, 0.6)),
    Viewpoint::Direction(binspace::glam::dvec3(0.3, -1.0, 0.2)),
];

fn trees() -> Vec<BspTree> {
    let scenes = [
        scene::random_triangles(200, 4),
        scene::city(300, 2),
        scene::sphere(400),
        scene::layers(7, 0.1),
        scene::chain(90),
        scene::teapot(4),
    ];
    let mut trees: Vec<BspTree> =
        scenes.iter().map(|scene| BspTree::build(scene.polygons()).unwrap()).collect();
    trees.push(BspTree::build(Vec::<[[f64; 3]; 3]>::new()).unwrap());
    trees
}

fn check(tree: &BspTree, triangles: &Triangles) {
    const UNTOUCHED: u32 = u32::MAX - 7;
    for eye in EYES {
        let expected: Vec<u32> = tree
            .back_to_front(eye)
            .flat_map(|fragment| triangles.indices()[triangles.range(fragment.index())].to_vec())
            .collect();
        let mut order = Vec::new();
        let mut written = vec![UNTOUCHED; expected.len() + 9];
        let count = triangles.write_back_to_front(tree, eye, &mut order, &mut written).unwrap();
        assert_eq!(count, expected.len());
        assert!(written[..count] == expected, "from {eye:?}");
        assert!(written[count..].iter().all(|&index| index == UNTOUCHED));
        let exact = triangles.write_back_to_front(tree, eye, &mut order, &mut written[..count]);
        assert_eq!(exact.unwrap(), count);
    }
}

#[test]
fn indices_come_in_the_order_of_the_fragments() {
    for tree in trees() {
        for mesh in [tree.mesh().unwrap(), tree.welded_mesh().unwrap()] {
            check(&tree, mesh.triangles());
            check(&tree, &mesh.triangles_of(|polygon| polygon % 3 == 0).unwrap());
            check(&tree, &mesh.triangles_of(|_| false).unwrap());
        }
    }
}

#[test]
fn a_short_buffer_and_another_tree_are_errors() {
    let trees = trees();
    let mesh = trees[0].mesh().unwrap();
    let (mut order, mut indices) = (Vec::new(), vec![7; mesh.triangles().indices().len() - 1]);
    let mut write = |tree, indices: &mut [u32]| {
        mesh.triangles()
            .write_back_to_front(tree, EYES[0], &mut order, indices)
            .unwrap_err()
            .to_string()
    };
    let error = write(&trees[0], &mut indices);
    assert!(error.contains(&indices.len().to_string()), "{error}");
    let error = write(&trees[1], &mut indices);
    assert!(error.contains("make the mesh of this tree"), "{error}");
    assert!(indices.iter().all(|&index| index == 7), "nothing is written");
}

/// Unwelded, a fragment has the vertices that it has in the tree.
#[test]
fn fragments_keep_their_vertices() {
    for tree in trees() {
        let mesh = tree.mesh().unwrap();
        let mut vertices = 0;
        for fragment in tree.fragments() {
            let range = mesh.triangles().range(fragment.index());
            assert_eq!(range.len(), 3 * (fragment.vertex_count() - 2));
            let mut own = mesh.triangles().indices()[range].to_vec();
            own.sort_unstable();
            own.dedup();
            assert_eq!(own.len(), fragment.vertex_count());
            for (position, weights) in fragment.vertices().zip(fragment.weights()) {
                let found = own.iter().map(|&v| mesh.vertex(v)).find(|v| {
                    // Triangles of one polygon may list the ends of their common edge in either order.
                    let is_same = |&(k, w): &(u32, f64)| {
                        weights
                            .iter()
                            .any(|&(other, weight)| other == k && (weight - w).abs() < 1e-9)
                    };
                    v.position.distance(position) < 1e-12
                        && v.weights.len() == weights.len()
                        && v.weights.iter().all(is_same)
                });
                assert!(found.is_some_and(|v| v.polygon == fragment.polygon()), "{fragment:?}");
            }
            vertices += own.len();
        }
        // Fragments of one polygon share vertices, and polygons share points.
        assert!(mesh.len() <= vertices && mesh.positions().len() <= mesh.len());
        assert_eq!(mesh.is_empty(), tree.is_empty());
        assert!(mesh.memory_usage() >= 24 * mesh.positions().len());
    }
}
