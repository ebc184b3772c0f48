//! Decisions and cuts compared with rationals, on scenes that are hard to decide.

use proptest::prelude::*;
use proptest::sample::Index;
use testkit::cut_walk::{Tally, Walk};
use testkit::hard::HardScene;
use testkit::judge::Verdict;
use testkit::prelude::*;

/// The face to cut, and the plane: a plane of a face, or a plane through a corner perpendicular to an axis.
#[derive(Clone, Debug)]
struct Plan {
    face: Index,
    cuts: Vec<(Option<usize>, Index, bool)>,
}

fn plan() -> impl Strategy<Value = Plan> {
    let axis = prop_oneof![2 => Just(None), 1 => (0..3usize).prop_map(Some)];
    let cuts = prop::collection::vec((axis, any::<Index>(), any::<bool>()), 1..14);
    (any::<Index>(), cuts).prop_map(|(face, cuts)| Plan { face, cuts })
}

fn follow(scene: &HardScene, plan: &Plan, tally: &mut Tally) -> Verdict {
    let faces = scene.faces();
    if faces.is_empty() {
        return Ok(());
    }
    let mut walk = Walk::new(&faces, plan.face.index(faces.len()) as u32, tally);
    let corners = (0..faces.len() as u32).map(|face| faces.corners(face).len()).sum();
    for &(axis, index, keep_back) in &plan.cuts {
        let plane = match axis {
            None => PlaneId::face(index.index(faces.len()) as u32),
            Some(axis) => PlaneId::axis(axis, index.index(corners) as u32),
        };
        walk.step(plane, keep_back)?;
    }
    Ok(())
}

/// The counts guard the generators: scenes that floats alone could decide would prove nothing.
#[test]
fn pieces_of_hard_scenes_agree_with_rationals() {
    let cases = (hard::scene(), plan());
    let tally = tally(file!(), 1200, cases, |tally: &mut Tally, (scene, plan)| {
        follow(&scene, &plan, tally).map_err(fail)
    });
    // Far below the usual counts, so that no choice of random scenes misses them.
    let is_share = |part: usize, of: usize, least: f64| part as f64 > least * of as f64;
    assert!(is_share(tally.undecided, tally.signs, 0.1), "{tally:?}");
    assert!(is_share(tally.undecided - tally.on_plane, tally.signs, 0.0005), "{tally:?}");
    assert!(is_share(tally.wrong, tally.signs, 0.001), "{tally:?}");
    assert!(is_share(tally.cuts, tally.pieces, 0.02), "{tally:?}");
    assert!(is_share(tally.moved, tally.pieces, 0.02), "{tally:?}");
    assert!(is_share(tally.tolerated, tally.pieces, 0.002), "{tally:?}");
    assert!(is_share(tally.pieces - tally.ambiguous, tally.pieces, 0.9), "{tally:?}");
    enough!(tally.inside > 480; "{tally:?}");
}
