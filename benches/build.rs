//! Building by every heuristic.

#![allow(missing_docs, reason = "criterion's macros make functions without any")]

use binspace::scene::{city, random_triangles, sphere, teapot};
use binspace::{BuildOptions, Heuristic};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::time::Duration;
use support::check;

fn bench(criterion: &mut Criterion) {
    for scene in [random_triangles(500, 1), city(2000, 1), sphere(2000), teapot(8)] {
        let mut group = criterion.benchmark_group(format!("build/{}", scene.name()));
        group.throughput(Throughput::Elements(scene.len() as u64));
        for &heuristic in Heuristic::ALL {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
            let build = || options.build(scene.polygons()).expect("within budget");
            let tree = build();
            check(&tree, &scene);
            let fragments = tree.len();
            group.bench_function(heuristic.to_string(), |b| {
                b.iter_with_large_drop(|| {
                    let tree = build();
                    assert_eq!(tree.len(), fragments);
                    tree
                });
            });
        }
        group.finish();
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(800));
    targets = bench
}
criterion_main!(benches);
