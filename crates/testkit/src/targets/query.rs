//! Rays, points and regions in small scenes, compared with rationals.

use super::super::decode;
use super::super::dice::Dice;
use super::super::hits::{Oracle, Score};
use super::super::saved::use_queries;
use super::super::shots::Shots;
use arbitrary::{Result, Unstructured};

/// Builds a tree, and runs queries until the bytes end.
pub fn run(data: &[u8]) {
    // Too few bytes change nothing.
    let _ = ask(&mut Unstructured::new(data));
}

fn ask(bytes: &mut Unstructured<'_>) -> Result<()> {
    let options = decode::options(bytes)?;
    let polygons = decode::polygons(bytes, 8)?;
    let Ok(tree) = options.build(&polygons) else { return Ok(()) };
    if tree.is_empty() {
        return Ok(());
    }
    let (oracle, shots) = (Oracle::new(&tree), Shots::new(tree.faces()));
    let mut score = Score::default();
    if let Err(what) = use_queries(&tree) {
        panic!("{what}: {polygons:?}");
    }
    while !bytes.is_empty() && score.rays < 20 {
        let mut dice = Dice(bytes.arbitrary()?);
        if let Err(what) = oracle.check(shots.ray(&mut dice), &mut score) {
            panic!("{what}: {polygons:?}");
        }
    }
    Ok(())
}
