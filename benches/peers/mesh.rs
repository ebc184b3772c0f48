//! Indices of a mesh, written back to front, against the order of the fragments alone.

use binspace::mesh::Mesh;
use binspace::{BspTree, Error, Viewpoint};
use std::time::{Duration, Instant};
use support::{Table, check, ratio, scene, time, viewpoints};

const SCENES: [&str; 7] = [
    "terrain:100000",
    "sphere:10000",
    "city:100000",
    "random:1000",
    "bunny.obj",
    "engine.obj",
    "level_large.obj",
];

type Make = fn(&BspTree) -> Result<Mesh, Error>;

/// Both meshes of a tree.
const KINDS: [(&str, Make); 2] = [("loose", BspTree::mesh), ("welded", BspTree::welded_mesh)];

pub(crate) fn run() {
    let table = Table::new(
        "Index buffers",
        &[
            "scene",
            "fragments",
            "mesh",
            "triangles",
            "made in",
            "order",
            "indices",
            "indices ÷ order",
        ],
    );
    for name in SCENES {
        let scene = scene(name);
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        check(&tree, &scene);
        for (kind, make) in KINDS {
            let begin = Instant::now();
            let mesh = make(&tree).expect("memory");
            let making = begin.elapsed();
            let (mut ordering, mut writing) = (Duration::ZERO, Duration::ZERO);
            for viewpoint in viewpoints(&scene) {
                let [order, write] = compare(&tree, &mesh, viewpoint);
                ordering += order / 5;
                writing += write / 5;
            }
            table.row(&[
                name.to_owned(),
                tree.len().to_string(),
                kind.to_owned(),
                (mesh.triangles().indices().len() / 3).to_string(),
                time(making),
                time(ordering),
                time(writing),
                ratio(writing, ordering),
            ]);
        }
    }
}

/// The shortest times of an order, and of an order and its indices, taken in turns.
fn compare(tree: &BspTree, mesh: &Mesh, viewpoint: Viewpoint) -> [Duration; 2] {
    let triangles = mesh.triangles();
    let (mut order, mut indices) = (Vec::new(), vec![0; triangles.indices().len()]);
    let mut shortest = [Duration::MAX; 2];
    for _ in 0..(5_000_000 / tree.len()).clamp(9, 300) {
        let begin = Instant::now();
        tree.back_to_front_into(viewpoint, &mut order);
        shortest[0] = shortest[0].min(begin.elapsed());
        let begin = Instant::now();
        let count = triangles.write_back_to_front(tree, viewpoint, &mut order, &mut indices);
        shortest[1] = shortest[1].min(begin.elapsed());
        assert_eq!(count, Ok(indices.len()));
    }
    let expected = tree
        .back_to_front(viewpoint)
        .flat_map(|fragment| &triangles.indices()[triangles.range(fragment.index())]);
    assert!(expected.eq(&indices), "the indices are in order");
    shortest
}
