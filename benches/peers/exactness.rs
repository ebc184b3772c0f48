//! The cost of exactness: trees by `sampled(16)` with exact decisions, and a textbook tree with the same
//! candidates by `f64` and an epsilon.

use binspace::internals::Faces;
use binspace::{BuildOptions, Heuristic, Tolerance};
use binspace_evidence::Tree;
use std::time::{Duration, Instant};
use support::{Table, Target, against, check, rulings, scene, time};

/// The epsilon, and the tolerance of the exact tree, as a share of the extent.
const EPSILON: f64 = 1e-9;

/// The target is looser on lattices, where many points lie exactly on planes, and on planes
/// through one line, where most decisions are ties.
const SCENES: [(&str, f64); 8] = [
    ("rulings:60", 3.0),
    ("rulings:600", 3.0),
    ("random:1000", 1.3),
    ("bunny_4k.obj", 1.3),
    ("suzanne_2k.obj", 1.3),
    ("teapot_quads_32k.obj", 1.3),
    ("doom_e1m1.obj", 1.5),
    ("city:2000", 1.5),
];

pub(crate) fn run() {
    let table = Table::new(
        "Exact decisions against f64 with an epsilon of 1e-9, sampled(16), one thread",
        &["scene", "exact", "epsilon", "pieces", "with epsilon", "ratio", "target", "met"],
    );
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for (name, target) in SCENES {
        let found = match name.strip_prefix("rulings:") {
            Some(strips) => Some(rulings(strips.parse().expect("a number"), 1)),
            None => scene(name),
        };
        let Some(scene) = found else { continue };
        // The same tolerance for both trees, on scenes from files too.
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
        let ratio = exact.as_secs_f64() / epsilon.as_secs_f64();
        let [ratio, target, met] = against(ratio, Target::AtMost(target));
        table.row(&[
            name.to_owned(),
            time(exact),
            time(epsilon),
            pieces[0].to_string(),
            pieces[1].to_string(),
            ratio,
            target,
            met,
        ]);
    }
}
