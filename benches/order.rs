//! Orders, as lists of numbers and one fragment at a time.

#![allow(missing_docs, reason = "criterion's macros make functions without any")]

use binspace::glam::DVec3;
use binspace::overlay::Overlay;
use binspace::scene::{city, random_triangles, sphere};
use binspace::{BspTree, Culling, Frustum, Viewpoint};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;

/// Checks that all forms of an order are the same permutation.
fn check(tree: &BspTree, viewpoint: Viewpoint) {
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    assert!(tree.back_to_front(viewpoint).map(|fragment| fragment.index()).eq(order.clone()));
    let reverse =
        tree.order(viewpoint).front_to_back().into_iter().map(|fragment| fragment.index());
    assert!(reverse.eq(order.iter().rev().copied()));
    order.sort_unstable();
    assert!(order.into_iter().eq(0..tree.len() as u32));
}

fn bench(criterion: &mut Criterion) {
    for scene in [random_triangles(1000, 1), city(10_000, 1), sphere(100_000)] {
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        assert_eq!(tree.validate(), Ok(()));
        let eye = Viewpoint::eye([0.31, -3.7, 1.3]);
        let direction = Viewpoint::direction([0.3, 0.5, -0.8]);
        check(&tree, eye);
        check(&tree, direction);
        let mut group = criterion.benchmark_group(format!("order/{}", scene.name()));
        group.throughput(Throughput::Elements(tree.len() as u64));
        let mut order = Vec::new();
        for (name, viewpoint) in [("indices/eye", eye), ("indices/direction", direction)] {
            group.bench_function(name, |b| {
                b.iter(|| {
                    tree.back_to_front_into(black_box(viewpoint), &mut order);
                    assert_eq!(order.len(), tree.len());
                });
            });
        }
        group.bench_function("iterator/eye", |b| {
            let sum = |viewpoint| tree.back_to_front(viewpoint).map(|f| f.polygon()).sum::<usize>();
            b.iter(|| sum(black_box(eye)));
        });
        group.finish();
    }
}

/// A level with a tenth in view, and ten doors in an overlay: the culled order of both, against the whole
/// order filtered by hand.
fn level(criterion: &mut Criterion) {
    let tree = BspTree::build(city(100_000, 1).polygons()).expect("within budget");
    let [low, high] = tree.bounds().expect("polygons");
    let (middle, reach) = ((low + high) / 2.0, (high - low).max_element() / 10.0);
    let planes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let planes = planes.map(|normal| (normal, normal.dot(middle) - reach));
    let culling = Culling::NONE.with_frustum(Frustum::new(planes));
    let doors = (0..10).map(|k| {
        let hinge = middle + reach * DVec3::new(0.2 * f64::from(k) - 0.9, 0.1, 0.0);
        let [across, up] = [DVec3::X, DVec3::Z].map(|axis| axis * reach / 20.0);
        [hinge, hinge + across, hinge + across + up, hinge + up]
    });
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, doors).expect("on the grid");
    let eye = Viewpoint::Eye(middle);
    let order = || overlay.order(&tree, eye).expect("its tree");
    let mut group = criterion.benchmark_group("level");
    let (mut numbers, mut filtered, mut list) = (vec![], vec![], vec![]);
    group.bench_function("the tree alone, culled", |b| {
        b.iter(|| tree.order(eye).culled(&culling).write_into(&mut list));
    });
    let mut is_shown = vec![false; tree.len()];
    group.bench_function("whole order with doors, filtered by hand", |b| {
        b.iter(|| {
            tree.order(eye).culled(&culling).write_into(&mut list);
            is_shown.fill(false);
            list.iter().for_each(|&number| is_shown[number as usize] = true);
            order().write_into(&mut filtered);
            filtered.retain(|&number| is_shown.get(number as usize).copied().unwrap_or(true));
        });
    });
    group.bench_function("culled order with doors", |b| {
        b.iter(|| order().culled(&culling).write_into(&mut numbers));
    });
    group.finish();
    // The filter by hand keeps all doors, because all are in view.
    assert_eq!(numbers, filtered);
    assert!(numbers.len() > list.len() + 9 && list.len() > tree.len() / 50, "{}", list.len());
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2));
    targets = bench, level
}
criterion_main!(benches);
