//! Small scenes full of coincidences.

use proptest::prelude::*;
use testkit::hits::{Oracle, Score};
use testkit::prelude::*;
use testkit::shots::Shots;

#[test]
fn rays_agree_with_integers() {
    let cases = (hard::scene(), hard::heuristic(), any::<u64>(), any::<bool>());
    let score = tally(file!(), 256, cases, |score: &mut Score, (scene, by, seed, of_frame)| {
        let mut builder = FrameBuilder::new(scene.options(by));
        let tree = match of_frame {
            true => builder.build(&scene.polygons).map_err(fail)?,
            false => &scene.build(by).map_err(fail)?,
        };
        if tree.is_empty() {
            return Ok(());
        }
        let (oracle, shots) = (Oracle::new(tree), Shots::new(tree.faces()));
        let mut dice = Dice(seed);
        for _ in 0..50 {
            oracle.check(shots.ray(&mut dice), score).map_err(fail)?;
        }
        Ok(())
    });
    enough!(score.rays > 10_000, score.hits > 10_000; "{score:?}");
    enough!(score.in_plane > 2000, score.ties > 2000, score.at_ends > 2000; "{score:?}");
    assert!(score.blocked.min(score.clear) > 3000, "{score:?}");
}
