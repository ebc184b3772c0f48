//! Orders, as lists of numbers and one fragment at a time.

#![allow(missing_docs, reason = "criterion's macros make functions without any")]

use binspace::scene::{city, random_triangles, sphere};
use binspace::{BspTree, Viewpoint};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;

/// All forms of an order must be one permutation.
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

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2));
    targets = bench
}
criterion_main!(benches);
