//! What exactness costs: the same builder with the exact kernel, and with one of f64 and an
//! epsilon.

use binspace::internals::{Exact, Faces};
use binspace::{BuildOptions, Heuristic, Tolerance};
use binspace_evidence::{Float, KernelTree};
use std::time::{Duration, Instant};
use support::{Table, Target, against, check, rulings, scene, time};

/// The epsilon, and the tolerance of the exact kernel, as a share of the extent.
const EPSILON: f64 = 1e-9;

const SAMPLED: Heuristic = Heuristic::Sampled { candidates: 16 };

/// The target is looser on lattices, where many points lie exactly on planes, and on planes
/// through one line, where most decisions are ties.
const SCENES: [(&str, Heuristic, f64); 17] = [
    ("rulings:60", SAMPLED, 3.0),
    ("rulings:60", Heuristic::Auto, 3.0),
    ("rulings:600", SAMPLED, 3.0),
    ("rulings:600", Heuristic::Auto, 3.0),
    ("random:1000", SAMPLED, 1.3),
    ("random:1000", Heuristic::Auto, 1.3),
    ("bunny_4k.obj", SAMPLED, 1.3),
    ("bunny_4k.obj", Heuristic::Auto, 1.3),
    ("suzanne_2k.obj", SAMPLED, 1.3),
    ("maple_tree_166k.obj", Heuristic::Auto, 1.3),
    ("showroom_big_cc0.obj", Heuristic::Auto, 1.3),
    ("teapot_quads_32k.obj", Heuristic::Auto, 1.3),
    ("chessboard_63k.obj", Heuristic::Auto, 1.3),
    ("doom_e1m1.obj", SAMPLED, 1.5),
    ("doom_map12_big.obj", Heuristic::Auto, 1.5),
    ("city:2000", SAMPLED, 1.5),
    ("city:100000", Heuristic::Auto, 1.5),
];

pub(crate) fn run() {
    let table = Table::new(
        "Exact kernel against f64 with an epsilon of 1e-9",
        &[
            "scene",
            "heuristic",
            "exact",
            "epsilon",
            "pieces",
            "with epsilon",
            "ratio",
            "target",
            "met",
        ],
    );
    for (name, heuristic, target) in SCENES {
        let found = match name.strip_prefix("rulings:") {
            Some(strips) => Some(rulings(strips.parse().expect("a number"), 1)),
            None => scene(name),
        };
        let Some(scene) = found else { continue };
        // The same for both, on scenes from files too.
        let tolerance = Tolerance::Relative(EPSILON);
        let options =
            BuildOptions::DEFAULT.with_heuristic(heuristic).with_relative_tolerance(EPSILON);
        let (mut exact, mut epsilon) = (Duration::MAX, Duration::MAX);
        let mut pieces = [0; 2];
        for round in 0..if scene.len() > 100_000 { 2 } else { 7 } {
            let prepared = || Faces::new(scene.polygons(), tolerance).expect("finite").0;
            let begin = Instant::now();
            let tree = KernelTree::build(Exact, &options, prepared()).expect("within budget");
            exact = exact.min(begin.elapsed());
            pieces[0] = tree.len();
            if round == 0 {
                check(&options.build(scene.polygons()).expect("within budget"), &scene);
            }
            let begin = Instant::now();
            let float = Float::<f64>::new(EPSILON);
            let tree = KernelTree::build(float, &options, prepared()).expect("within budget");
            epsilon = epsilon.min(begin.elapsed());
            pieces[1] = tree.len();
        }
        let ratio = exact.as_secs_f64() / epsilon.as_secs_f64();
        let [ratio, target, met] = against(ratio, Target::AtMost(target));
        table.row(&[
            name.to_owned(),
            heuristic.to_string(),
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
