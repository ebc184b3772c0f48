//! Overlays: one order of a tree and of polygons that move, held against an exact depth buffer that
//! knows neither, and against exact areas.

mod coplanar;
mod cost;
mod errors;
mod judge;
#[path = "../support/mod.rs"]
mod support;
mod walks;

use binspace::glam::DVec3;
use binspace::view::views;
use binspace::{BspTree, BuildOptions, Heuristic, Overlay};
use judge::Judged;
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use support::hard::{self, HardScene, Tolerance};
use support::tally::tally;

type Corners = Vec<DVec3>;

/// A scene in two parts: each polygon is in the tree or moves.
#[derive(Debug)]
struct Divided {
    tree: BspTree,
    moving: Vec<Corners>,
    all: Vec<Corners>,
}

/// Divides a scene by the bits of a number. The bounds hold all.
fn divide(scene: &HardScene, bits: u64, by: Heuristic) -> Result<Divided, TestCaseError> {
    let is_moving = |i: usize| bits >> (i % 64) & 1 == 1;
    let part = |moving: bool| -> Vec<Corners> {
        let polygons = scene.polygons.iter().enumerate();
        polygons.filter(|&(i, _)| is_moving(i) == moving).map(|(_, p)| p.clone()).collect()
    };
    let (still, moving) = (part(false), part(true));
    let [low, high] = bounds(&scene.polygons);
    let mut options = BuildOptions::DEFAULT.with_heuristic(by).with_bounds(low, high);
    options.tolerance = scene.tolerance().into();
    let tree = options.build(&still).map_err(|error| TestCaseError::reject(error.to_string()))?;
    let all = still.iter().chain(&moving).cloned().collect();
    Ok(Divided { tree, moving, all })
}

fn bounds(polygons: &[Corners]) -> [DVec3; 2] {
    let corners = || polygons.iter().flatten().copied();
    [corners().reduce(DVec3::min), corners().reduce(DVec3::max)].map(Option::unwrap_or_default)
}

#[test]
fn the_painter_shows_what_the_depth_buffer_sees() {
    let by = prop::sample::select(Heuristic::ALL);
    let cases = (hard::scene(), any::<u64>(), by, any::<u64>());
    let judged: Judged = tally(file!(), 256, cases, |judged: &mut Judged, case| {
        let (scene, bits, by, seed) = case;
        let scene = scene.with_tolerance(Tolerance::Share(0.0));
        let Divided { tree, moving, all } = divide(&scene, bits, by)?;
        let mut overlay = Overlay::new(&tree);
        // Something else before, so that what is left of it would show.
        overlay.replace(&tree, &all).map_err(|error| TestCaseError::fail(error.to_string()))?;
        overlay.replace(&tree, &moving).map_err(|error| TestCaseError::fail(error.to_string()))?;
        for camera in views(bounds(&all), DVec3::Z, 4, [40, 30], seed).unwrap_or_default() {
            judged.look(&tree, &overlay, &camera).map_err(TestCaseError::fail)?;
        }
        Ok(())
    });
    judged.assert_floor(700, 100_000, 10_000);
}

#[test]
fn pieces_tile_their_polygons() {
    let by = prop::sample::select(Heuristic::ALL);
    let cases = (hard::scene(), any::<u64>(), by);
    let counts = tally(file!(), 256, cases, |counts: &mut [usize; 2], (scene, bits, by)| {
        let Divided { tree, moving, .. } = divide(&scene, bits, by)?;
        let mut overlay = Overlay::new(&tree);
        overlay.replace(&tree, &moving).map_err(|error| TestCaseError::fail(error.to_string()))?;
        counts[0] += judge::areas(&tree, &overlay).map_err(TestCaseError::fail)?;
        counts[1] += overlay.len();
        Ok(())
    });
    let [faces, pieces] = counts;
    assert!(faces > 500 && pieces > faces * 5 / 4, "{faces} faces in {pieces} pieces");
}
