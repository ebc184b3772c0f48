//! Planes through one line, where most decisions are ties: the default heuristic against a sample
//! of own planes.

use binspace::{BuildOptions, Heuristic};
use std::time::{Duration, Instant};
use support::{Table, Target, against, check, rulings, time};

const HEURISTICS: [Heuristic; 2] = [Heuristic::Auto, Heuristic::Sampled { candidates: 16 }];

pub(crate) fn run() {
    let table = Table::new(
        "Planes through one line: auto against sampled(16)",
        &["scene", "fragments", "by sample", "auto", "sampled", "ratio", "target", "met"],
    );
    for (strips, patches) in [(60, 1), (200, 1), (600, 1), (1000, 1), (60, 14)] {
        let scene = rulings(strips, patches);
        let mut shortest = [Duration::MAX; 2];
        let mut fragments = [0; 2];
        for round in 0..(12_000 / scene.len()).clamp(7, 40) {
            // In turn, so that other work on the machine slows both.
            for (i, heuristic) in HEURISTICS.into_iter().enumerate() {
                let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
                let start = Instant::now();
                let tree = options.build(scene.polygons()).expect("within budget");
                shortest[i] = shortest[i].min(start.elapsed());
                fragments[i] = tree.len();
                if round == 0 {
                    check(&tree, &scene);
                }
            }
        }
        let ([auto, sampled], [fragments, by_sample]) = (shortest, fragments);
        let ratio = auto.as_secs_f64() / sampled.as_secs_f64();
        let [ratio, target, met] = against(ratio, Target::AtMost(2.0));
        table.row(&[
            scene.name().to_owned(),
            fragments.to_string(),
            by_sample.to_string(),
            time(auto),
            time(sampled),
            ratio,
            target,
            met,
        ]);
    }
}
