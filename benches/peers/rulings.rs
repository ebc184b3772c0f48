//! Planes through one line, where most decisions are ties: the default heuristic against a sample
//! of own planes.

use binspace::{BuildOptions, Heuristic};
use support::{Table, Target, against, best, check, rulings, time};

pub(crate) fn run() {
    let table = Table::new(
        "Planes through one line: auto against sampled(16)",
        &["scene", "fragments", "by sample", "auto", "sampled", "ratio", "target", "met"],
    );
    for patches in [1, 4, 14] {
        let scene = rulings(patches);
        let build = |heuristic| {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
            let (time, tree) = best(|| options.build(scene.polygons()).expect("within budget"));
            check(&tree, &scene);
            (time, tree.len())
        };
        let (auto, fragments) = build(Heuristic::Auto);
        let (sampled, by_sample) = build(Heuristic::Sampled { candidates: 16 });
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
