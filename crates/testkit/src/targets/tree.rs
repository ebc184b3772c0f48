//! Builds a tree of any scene by any heuristic, and judges it.

use super::super::dice::Dice;
use super::super::hits::{Oracle, Score};
use super::super::rays::Rays;
use super::super::shots::Shots;
use super::super::{decode, judge, orders, views};
use arbitrary::{Result, Unstructured};
use binspace::glam::DVec3;
use binspace::{BspTree, FrameBuilder};

/// Builds a scene of at most twelve polygons. Exact rationals judge fragments and hits of rays, and rays
/// judge orders.
pub fn run(data: &[u8]) {
    // Too few bytes make no scene.
    let _ = try_run(&mut Unstructured::new(data));
}

fn try_run(bytes: &mut Unstructured<'_>) -> Result<()> {
    let options = decode::options(bytes)?;
    let seed: u64 = u64::from(bytes.arbitrary::<u16>()?);
    let polygons = decode::polygons(bytes, 12)?;
    let infinite = polygons.iter().position(|polygon| polygon.iter().any(|c| !c.is_finite()));
    let tree = match options.build(&polygons) {
        Ok(tree) => tree,
        Err(error) => {
            let refused = infinite.is_some() && error.polygon() == infinite;
            assert!(refused, "{error}");
            return Ok(());
        }
    };
    assert_eq!(infinite, None, "a coordinate that is no number passed");
    let mut frames = FrameBuilder::new(options.clone());
    let frame = frames.build(&polygons).expect("what the tree was built of");
    for tree in [&tree, frame] {
        if let Err(what) = check(tree, &polygons, &mut Dice(seed)) {
            panic!("{what}: {options:?} {polygons:?}");
        }
    }
    Ok(())
}

fn check(
    tree: &BspTree,
    polygons: &[Vec<DVec3>],
    dice: &mut Dice,
) -> std::result::Result<(), String> {
    judge::judge(tree, polygons)?;
    if tree.is_empty() {
        return Ok(());
    }
    let mut rays = Rays::new(tree);
    for _ in 0..4 {
        let view = views::some_view(tree.faces(), &rays, dice);
        orders::check(tree, view.viewpoint)?;
        rays.check(&view, 6, dice)?;
    }
    let (oracle, shots) = (Oracle::new(tree), Shots::new(tree.faces()));
    (0..8).try_for_each(|_| oracle.check(shots.ray(dice), &mut Score::default()))
}
