//! The cost of exactness: trees by `sampled(16)` with exact decisions, and a textbook tree with the same
//! candidates by `f64` and an epsilon. The textbook tree is not tuned: a ratio above 1 does not mean that
//! exact decisions take no time.

use binspace::internals::Faces;
use binspace::{BuildOptions, Heuristic, Tolerance};
use binspace_evidence::Tree;
use std::time::{Duration, Instant};
use support::{Table, check, ratio, rulings, scene, threads, time};

/// The epsilon, and the tolerance of the exact tree, as a share of the extent.
const EPSILON: f64 = 1e-9;

/// In rulings, many planes contain one line, so most decisions are ties.
const SCENES: [&str; 10] = [
    "rulings:60",
    "rulings:600",
    "random:1000",
    "city:2000",
    "terrain:10000",
    "bunny.obj",
    "spider.obj",
    "person.obj",
    "level.obj",
    "level_large.obj",
];

pub(crate) fn run() {
    let table = Table::new(
        "Exact against epsilon",
        &["scene", "exact", "epsilon", "pieces", "with epsilon", "epsilon ÷ exact"],
    );
    let one = threads(1);
    for name in SCENES {
        let scene = match name.strip_prefix("rulings:") {
            Some(strips) => rulings(strips.parse().expect("a number")),
            None => scene(name),
        };
        // Both trees have the same tolerance, also on scenes from files.
        let tolerance = Tolerance::Relative(EPSILON);
        let options = BuildOptions::DEFAULT
            .with_heuristic(Heuristic::Sampled { candidates: 16 })
            .with_relative_tolerance(EPSILON);
        let (mut exact, mut epsilon) = (Duration::MAX, Duration::MAX);
        let mut pieces = [0; 2];
        for round in 0..7 {
            let begin = Instant::now();
            let tree = one.install(|| options.build(scene.polygons())).expect("within budget");
            exact = exact.min(begin.elapsed());
            pieces[0] = tree.len();
            if round == 0 {
                check(&tree, &scene);
            }
            let begin = Instant::now();
            let (faces, _) = Faces::new(scene.polygons(), tolerance).expect("finite");
            let tree = Tree::with_epsilon::<f64>(faces, EPSILON, usize::MAX).expect("no budget");
            epsilon = epsilon.min(begin.elapsed());
            pieces[1] = tree.len();
        }
        table.row(&[
            name.to_owned(),
            time(exact),
            time(epsilon),
            pieces[0].to_string(),
            pieces[1].to_string(),
            ratio(epsilon, exact),
        ]);
    }
}
