//! Judges scenes, several at a time.

use binspace::ErrorKind;
use rayon::prelude::*;
use testkit::as_given::ray::Targets;
use testkit::as_given::scene::Scene;
use testkit::as_given::trees_by_rays::{Court, Score, Shot, shots};
use testkit::prelude::*;

/// The options for judging a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trial<'a> {
    pub(crate) heuristics: &'a [Heuristic],
    pub(crate) views: usize,
    pub(crate) rays: usize,
    /// The largest number of fragments for each polygon; trees that would have more are counted, not
    /// judged.
    pub(crate) most: usize,
}

impl Trial<'_> {
    /// Builds a scene's trees and judges them by the same rays; panics if one is wrong.
    pub(crate) fn hold(&self, scene: &Scene, seed: u64) -> Score {
        let targets = Targets::new(scene);
        let shots = shots(&targets, [self.views, self.rays], &mut Dice(seed));
        let judge = |&heuristic: &Heuristic| {
            self.tree(&targets, &shots, heuristic)
                .unwrap_or_else(|what| panic!("{} by {heuristic}, seed {seed}: {what}", scene.name))
        };
        self.heuristics.par_iter().map(judge).reduce(Score::default, Score::plus)
    }

    fn tree(
        &self,
        targets: &Targets<'_>,
        shots: &[Shot],
        heuristic: Heuristic,
    ) -> Result<Score, String> {
        let scene = targets.scene;
        let most = self.most * scene.polygons.len();
        if heuristic == Heuristic::Auto
            && let Ok(frame) = scene.frame(most)
        {
            let judged = Court::new(targets, &frame).judge(shots);
            judged.map_err(|what| format!("of a frame: {what}"))?;
        }
        match scene.build(heuristic, most) {
            Ok(tree) => Court::new(targets, &tree).judge(shots),
            Err(error) if error.kind() == ErrorKind::OverBudget => {
                Ok(Score { given_up: 1, ..Score::default() })
            }
            Err(error) => Err(error.to_string()),
        }
    }

    /// Judges several scenes, each generated from its number.
    pub(crate) fn hold_all(
        &self,
        kinds: usize,
        seed: u64,
        make: impl Fn(usize, &mut Dice) -> Scene + Sync,
    ) -> Vec<(String, Score)> {
        let hold = |kind: usize| {
            let seed = seed << 8 | kind as u64;
            let scene = make(kind, &mut Dice(seed));
            (scene.name.clone(), self.hold(&scene, seed))
        };
        (0..kinds).into_par_iter().map(hold).collect()
    }
}
