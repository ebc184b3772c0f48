//! An order from the tree, against sorting as many depths with `radsort`.

use binspace::{BspTree, Viewpoint};
use std::time::{Duration, Instant};
use support::{Table, Target, against, check, scene, viewpoints};

const SCENES: [(&str, f64); 11] = [
    ("random:700", 0.6),
    ("city:10000", 0.6),
    ("sphere:10000", 0.6),
    ("terrain:10000", 0.6),
    ("city:100000", 0.4),
    ("sphere:100000", 0.4),
    ("terrain:100000", 0.4),
    ("chessboard_63k.obj", 0.4),
    ("sphere:1000000", 0.4),
    ("terrain:1000000", 0.4),
    ("showroom_big_cc0.obj", 0.4),
];

pub(crate) fn run() {
    let table = Table::new(
        "Order, index form, one thread, against radsort of (f32 depth, u32 index)",
        &["scene", "fragments", "nodes", "ns / fragment", "ns / key", "ratio", "target", "met"],
    );
    for (name, target) in SCENES {
        let Some(scene) = scene(name) else { continue };
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        check(&tree, &scene);
        let (mut ordering, mut sorting) = (Duration::ZERO, Duration::ZERO);
        let viewpoints = viewpoints(&scene);
        for &viewpoint in &viewpoints {
            let (order, sort) = compare(&tree, viewpoint);
            ordering += order;
            sorting += sort;
        }
        let each =
            |time: Duration| time.as_secs_f64() * 1e9 / (viewpoints.len() * tree.len()) as f64;
        let [ratio, target, met] =
            against(ordering.as_secs_f64() / sorting.as_secs_f64(), Target::AtMost(target));
        table.row(&[
            name.to_owned(),
            tree.len().to_string(),
            tree.stats().nodes.to_string(),
            format!("{:.2}", each(ordering)),
            format!("{:.2}", each(sorting)),
            ratio,
            target,
            met,
        ]);
    }
}

/// The shortest times of an order and of a sort, taken in turns.
fn compare(tree: &BspTree, viewpoint: Viewpoint) -> (Duration, Duration) {
    let depths: Vec<f32> = tree
        .fragments()
        .map(|fragment| {
            let (mut sum, mut count) = (binspace::glam::DVec3::ZERO, 0.0);
            for vertex in fragment.vertices() {
                sum += vertex;
                count += 1.0;
            }
            let Viewpoint::Eye(eye) = viewpoint else { unreachable!("only eyes are measured") };
            -(sum / count).distance_squared(eye) as f32
        })
        .collect();
    let (mut order, mut keys) = (Vec::new(), Vec::with_capacity(tree.len()));
    tree.back_to_front_into(viewpoint, &mut order);
    let (buffer, capacity) = (order.as_ptr(), order.capacity());

    let (mut ordering, mut sorting) = (Duration::MAX, Duration::MAX);
    let rounds = (5_000_000 / tree.len()).clamp(5, 100);
    for _ in 0..rounds {
        let begin = Instant::now();
        tree.back_to_front_into(viewpoint, &mut order);
        ordering = ordering.min(begin.elapsed());

        keys.clear();
        keys.extend(depths.iter().copied().zip(0_u32..));
        let begin = Instant::now();
        radsort::sort_by_key(&mut keys, |key| key.0);
        sorting = sorting.min(begin.elapsed());
    }

    assert!(keys.is_sorted_by_key(|key| key.0));
    assert_eq!((order.as_ptr(), order.capacity()), (buffer, capacity), "the buffer is kept");
    assert!(
        tree.back_to_front(viewpoint).map(|fragment| fragment.index()).eq(order.iter().copied())
    );
    order.sort_unstable();
    assert!(order.into_iter().eq(0..tree.len() as u32));
    (ordering, sorting)
}
