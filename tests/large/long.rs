//! The long run: seed after seed.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;

use binspace::Heuristic;

use super::all_scenes::{self, KINDS};
use super::trees_by_rays::Score;
use super::trial::Trial;
use testkit::dice::Dice;
use testkit::effort::effort;

/// The sum of what was judged of scenes of one name.
#[derive(Default)]
struct Table(BTreeMap<String, (usize, Score)>);

impl Table {
    fn add(&mut self, (name, score): (String, Score)) {
        let row = self.0.entry(name).or_default();
        *row = (row.0 + 1, row.1.add(score));
    }

    fn text(&self) -> String {
        let mut text = String::new();
        let columns = "scenes trees given-up faces fragments rays pairs coplanar borders grazing \
                       excused";
        let mut row = |name: &str, cells: Vec<String>| {
            let cells: Vec<String> = cells.iter().map(|cell| format!("{cell:>11}")).collect();
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{name:<18}{}", cells.concat());
        };
        row("", columns.split(' ').map(String::from).collect());
        let mut all = (0, Score::default());
        let cells = |(scenes, s): (usize, Score)| {
            let numbers = [
                scenes,
                s.trees,
                s.given_up,
                s.faces,
                s.fragments,
                s.rays,
                s.pairs,
                s.coplanar,
                s.borders,
                s.grazing,
                s.excused,
            ];
            numbers.map(|number| number.to_string()).to_vec()
        };
        for (name, &scores) in &self.0 {
            row(name, cells(scores));
            all = (all.0 + scores.0, all.1.add(scores.1));
        }
        row("all", cells(all));
        text
    }
}

/// One scene of a seed: of 450 to 850 polygons, or of up to 5 000 by the heuristics that are fast.
fn one(seed: u64, kind: usize) -> (String, Score) {
    const FAST: [Heuristic; 4] = [
        Heuristic::Auto,
        Heuristic::FreePlanes,
        Heuristic::Random { seed: 1 },
        Heuristic::Sampled { candidates: 16 },
    ];
    let large = seed % 2 == 1;
    let heuristics: &[Heuristic] = if large { &FAST } else { Heuristic::ALL };
    let trial = Trial { heuristics, views: 20, rays: 20, most: 20 };
    let seed = seed << 8 | kind as u64;
    let mut dice = Dice(seed);
    let n = if large { 1000 + dice.below(4000) } else { 450 + dice.below(400) };
    let scene = match kind.checked_sub(KINDS) {
        None => all_scenes::scene(kind, &mut dice, n),
        Some(noisy) => all_scenes::noisy(noisy, &mut dice, n),
    };
    (scene.name.clone(), trial.hold(&scene, seed))
}

#[test]
#[ignore = "takes a minute for each unit of BINSPACE_EFFORT"]
fn scenes_of_seed_after_seed_are_in_order() {
    let mut table = Table::default();
    for seed in (1000..).take(effort()) {
        (0..KINDS + 2).for_each(|kind| table.add(one(seed, kind)));
    }
    std::io::stdout().write_all(table.text().as_bytes()).expect("standard output");
    assert!(table.0.len() >= KINDS, "every kind had its turn");
}
