//! Deciding where pieces lie against a plane, and cutting them, by both kernels.

#![allow(missing_docs, reason = "criterion's macros make functions without any")]

use binspace::internals::{Exact, Faces, Kernel, Piece, PlaneId, Side, split};
use binspace::scene::random_triangles;
use binspace_evidence::Float;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;

/// How many faces lie in front of a plane, behind, on it, across.
fn classify<K: Kernel>(kernel: K, faces: &Faces, plane: PlaneId) -> [usize; 4] {
    let splitter = kernel.splitter(faces, plane);
    let mut counts = [0; 4];
    for face in 0..faces.len() as u32 {
        let side = kernel.classify(faces, &splitter, Piece { face, cut: None });
        counts[side as usize] += 1;
    }
    counts
}

/// Cuts every face that spans a plane; gives how many vertices the parts have.
fn cut<K: Kernel>(kernel: K, faces: &Faces, plane: PlaneId, spanning: &[u32]) -> [usize; 2] {
    let splitter = kernel.splitter(faces, plane);
    let (mut outline, mut front, mut back) = (Vec::new(), Vec::new(), Vec::new());
    for &face in spanning {
        outline.clear();
        let corners = 0..faces.corners(face).len() as u32;
        outline.extend(corners.map(|k| kernel.corner(faces, face, k)));
        split(&kernel, faces, &splitter, face, &outline, &mut front, &mut back);
    }
    [front.len(), back.len()]
}

fn spanning(faces: &Faces, plane: PlaneId) -> Vec<u32> {
    let splitter = Exact.splitter(faces, plane);
    let spans =
        |&face: &u32| Exact.classify(faces, &splitter, Piece { face, cut: None }) == Side::Spanning;
    (0..faces.len() as u32).filter(spans).collect()
}

fn bench(criterion: &mut Criterion) {
    let scene = random_triangles(10_000, 1);
    let (faces, _) = Faces::new(scene.polygons(), None).expect("finite");
    let plane = PlaneId::axis(0, faces.corner_range(77).start as u32);
    let across = spanning(&faces, plane);

    let [front, back, on, spans] = classify(Exact, &faces, plane);
    assert_eq!(front + back + on + spans, faces.len());
    assert_eq!(spans, across.len());
    let [in_front, behind] = cut(Exact, &faces, plane, &across);
    // A triangle is cut into a triangle and a quad, or, through a corner, into two triangles.
    assert!(in_front + behind <= 7 * spans && in_front + behind >= 6 * spans);

    let float = Float::<f64>::default();
    let mut group = criterion.benchmark_group("classify");
    group.throughput(Throughput::Elements(faces.len() as u64));
    group.bench_function("exact", |b| b.iter(|| classify(Exact, black_box(&faces), plane)));
    group.bench_function("float", |b| b.iter(|| classify(float, black_box(&faces), plane)));
    group.finish();
    let mut group = criterion.benchmark_group("split");
    group.throughput(Throughput::Elements(spans as u64));
    group.bench_function("exact", |b| b.iter(|| cut(Exact, black_box(&faces), plane, &across)));
    group.bench_function("float", |b| b.iter(|| cut(float, black_box(&faces), plane, &across)));
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2));
    targets = bench
}
criterion_main!(benches);
