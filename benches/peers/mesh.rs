//! Indices of a mesh, written back to front, against the order of the fragments alone.

use binspace::{BspTree, Mesh, Viewpoint};
use std::time::{Duration, Instant};
use support::{Table, Target, against, check, scene, time, viewpoints};

const SCENES: [&str; 7] = [
    "terrain:100000",
    "sphere:10000",
    "city:100000",
    "random:1000",
    "bunny_4k.obj",
    "chessboard_63k.obj",
    "maple_tree_166k.obj",
];

pub(crate) fn run() {
    let table = Table::new(
        "Indices back to front, one thread, against the order of the fragments",
        &[
            "scene",
            "fragments",
            "triangles",
            "welded",
            "mesh made in",
            "order",
            "indices",
            "ratio",
            "target",
            "met",
        ],
    );
    for name in SCENES {
        let Some(scene) = scene(name) else { continue };
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        check(&tree, &scene);
        let begin = Instant::now();
        let mesh = tree.welded_mesh().expect("memory");
        let making = begin.elapsed();
        let loose = tree.mesh().expect("memory");
        let (mut ordering, mut writing) = (Duration::ZERO, Duration::ZERO);
        for viewpoint in viewpoints(&scene) {
            let [order, write] = compare(&tree, &loose, viewpoint);
            ordering += order;
            writing += write;
        }
        let ratio = writing.as_secs_f64() / ordering.as_secs_f64();
        let [ratio, target, met] = against(ratio, Target::AtMost(1.5));
        let triangles = |mesh: &Mesh| (mesh.triangles().indices().len() / 3).to_string();
        table.row(&[
            name.to_owned(),
            tree.len().to_string(),
            triangles(&loose),
            triangles(&mesh),
            time(making),
            time(ordering),
            time(writing),
            ratio,
            target,
            met,
        ]);
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
