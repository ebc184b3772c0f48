//! Deciding the side of a plane on which pieces lie, and cutting pieces: exactly, and by rounded numbers.

#![allow(missing_docs, reason = "criterion's macros make functions without any")]

use binspace::internals::{Faces, PlaneId, PreparedPlane, Side, Vertex, split};
use binspace::scene::random_triangles;
use binspace_evidence::{RoundedPiece, RoundedPlane};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;

/// The numbers of faces in front of a plane, behind the plane, on the plane, and across it.
fn count(sides: impl Iterator<Item = Side>) -> [usize; 4] {
    let mut counts = [0; 4];
    sides.for_each(|side| counts[side as usize] += 1);
    counts
}

/// Cuts faces that span a plane; returns the number of vertices of the parts.
fn cut(faces: &Faces, plane: &PreparedPlane, spanning: &[u32]) -> [usize; 2] {
    let (mut outline, mut front, mut back) = (Vec::new(), Vec::new(), Vec::new());
    for &face in spanning {
        outline.clear();
        outline.extend(Vertex::corners(faces, face));
        split(faces, plane, face, &outline, &mut front, &mut back);
    }
    [front.len(), back.len()]
}

/// Does the same with rounded numbers.
fn cut_rounded(plane: &RoundedPlane<f64>, spanning: &[RoundedPiece]) -> [usize; 2] {
    let mut counts = [0; 2];
    for piece in spanning {
        let parts = plane.split(piece);
        (0..2).for_each(|i| counts[i] += parts[i].positions().count());
    }
    counts
}

fn bench(criterion: &mut Criterion) {
    const FACE: u32 = 77;
    let scene = random_triangles(10_000, 1);
    let (faces, _) = Faces::new(scene.polygons(), None).expect("finite");
    let all = 0..faces.len() as u32;
    let exact = PreparedPlane::new(&faces, PlaneId::face(FACE));
    let rounded = RoundedPlane::<f64>::new(&faces, FACE, 1e-9);
    let pieces: Vec<RoundedPiece> =
        all.clone().map(|face| RoundedPiece::whole::<f64>(&faces, face)).collect();
    let classify = || count(all.clone().map(|face| exact.classify(black_box(&faces), face, None)));
    let classify_rounded = || count(black_box(&pieces).iter().map(|piece| rounded.classify(piece)));

    let spans = |&face: &u32| exact.classify(&faces, face, None) == Side::Spanning;
    let across: Vec<u32> = all.clone().filter(spans).collect();
    let pieces_across: Vec<RoundedPiece> =
        across.iter().map(|&face| pieces[face as usize].clone()).collect();
    let counts = classify();
    assert_eq!(counts.iter().sum::<usize>(), faces.len());
    assert_eq!(counts, classify_rounded());
    let parts = cut(&faces, &exact, &across);
    assert_eq!(parts, cut_rounded(&rounded, &pieces_across));
    // A triangle is cut into a triangle and a quad, or into two triangles if the cut goes through a corner.
    let vertices = parts[0] + parts[1];
    assert!(vertices <= 7 * across.len() && vertices >= 6 * across.len());

    let mut group = criterion.benchmark_group("classify");
    group.throughput(Throughput::Elements(faces.len() as u64));
    group.bench_function("exact", |b| b.iter(classify));
    group.bench_function("rounded", |b| b.iter(classify_rounded));
    group.finish();
    let mut group = criterion.benchmark_group("split");
    group.throughput(Throughput::Elements(across.len() as u64));
    group.bench_function("exact", |b| b.iter(|| cut(black_box(&faces), &exact, &across)));
    group.bench_function("rounded", |b| b.iter(|| cut_rounded(&rounded, &pieces_across)));
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
