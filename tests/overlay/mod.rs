//! Overlays: one order of a tree and moving polygons, compared with an exact depth buffer that uses
//! neither, and with exact areas.

mod borders;
mod cleared;
mod coplanar;
mod cost;
mod crowd;
mod culled;
mod errors;
mod hits;
mod hosts;
mod judge;
mod lines;
mod marks;
mod mesh;
mod numbers;
mod oracle;
mod same;
mod sight;
mod slivers;
mod stacks;
mod tiling;
mod walks;

use binspace::overlay::Overlay;
use binspace::view::views;
use judge::Judged;
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use testkit::hard::{HardScene, Tolerance};
use testkit::prelude::*;

type Corners = Vec<DVec3>;

/// A scene in two parts: each polygon is in the tree or moves.
#[derive(Debug)]
struct Divided {
    tree: BspTree,
    moving: Vec<Corners>,
    all: Vec<Corners>,
}

/// Divides a scene by the bits of a number. The tree's bounds contain both parts.
fn divide(scene: &HardScene, bits: u64, by: Heuristic) -> Result<Divided, TestCaseError> {
    let is_moving = |i: usize| bits >> (i % 64) & 1 == 1;
    let part = |moving: bool| -> Vec<Corners> {
        let polygons = scene.polygons.iter().enumerate();
        polygons.filter(|&(i, _)| is_moving(i) == moving).map(|(_, p)| p.clone()).collect()
    };
    let (still, moving) = (part(false), part(true));
    let [low, high] = scene.bounds().expect("corners");
    let tree = scene.options(by).with_bounds(low, high).build(&still).map_err(fail)?;
    let all = still.iter().chain(&moving).cloned().collect();
    Ok(Divided { tree, moving, all })
}

#[test]
fn the_painter_agrees_with_the_depth_buffer() {
    let cases = (hard::scene(), any::<u64>(), hard::heuristic(), any::<u64>());
    let judged: Judged = tally(file!(), 256, cases, |judged: &mut Judged, case| {
        let (scene, bits, by, seed) = case;
        let scene = scene.with_tolerance(Tolerance::Share(0.0));
        let Divided { tree, moving, all } = divide(&scene, bits, by)?;
        let mut overlay = Overlay::new(&tree);
        // Other contents come first, so that remains of them would be visible.
        overlay.replace(&tree, &all).map_err(fail)?;
        overlay.replace(&tree, &moving).map_err(fail)?;
        let bounds = hard::bounds(&all).expect("corners");
        for camera in views(bounds, DVec3::Z, 4, [40, 30], seed).unwrap_or_default() {
            judged.look(&tree, &overlay, &camera).map_err(fail)?;
        }
        Ok(())
    });
    judged.assert_floor(700, 100_000, 10_000);
}

/// Cameras with their eyes in planes of faces of both parts, next to them, and on corners.
fn awkward_cameras(overlay: &Overlay, dice: &mut Dice) -> Vec<Camera> {
    let faces = overlay.faces();
    if faces.is_empty() {
        return vec![];
    }
    let mut random_face = || dice.below(faces.len()) as u32;
    let [face, target] = [random_face(), random_face()];
    let [p, q, r] = faces.reference_triangle(face).map(|c| DVec3::from(faces.corner(c)));
    let inside = p + (q - p) * dice.around_zero(3) + (r - p) * dice.around_zero(3);
    let missed = inside + DVec3::AXES[dice.below(3)] * dice.around_zero(1);
    let target = faces.corners(target).iter().map(|&c| DVec3::from(c)).sum::<DVec3>()
        / faces.corners(target).len() as f64;
    let [p, inside, missed, target] =
        [p, inside, missed, target].map(|point| faces.lattice().to_world(point.to_array()));
    let up = DVec3::new(0.1, 0.2, 1.0);
    let eyes = [p, inside, missed].into_iter();
    eyes.filter_map(|eye| Camera::perspective(eye, target, up, 1.2, [40, 30]).ok()).collect()
}

#[test]
fn the_painter_is_right_from_eyes_in_planes_and_corners() {
    let cases = (hard::scene(), any::<u64>(), hard::heuristic(), any::<u64>());
    let judged: Judged = tally(file!(), 256, cases, |judged: &mut Judged, case| {
        let (scene, bits, by, seed) = case;
        let Divided { tree, moving, .. } =
            divide(&scene.with_tolerance(Tolerance::Share(0.0)), bits, by)?;
        let mut overlay = Overlay::new(&tree);
        overlay.replace(&tree, &moving).map_err(fail)?;
        for camera in awkward_cameras(&overlay, &mut Dice(seed)) {
            judged.look(&tree, &overlay, &camera).map_err(fail)?;
        }
        Ok(())
    });
    judged.assert_floor(500, 50_000, 10_000);
}

#[test]
fn pieces_tile_their_polygons() {
    let cases = (hard::scene(), any::<u64>(), hard::heuristic());
    let counts = tally(file!(), 256, cases, |counts: &mut [usize; 2], (scene, bits, by)| {
        let Divided { tree, moving, all } = divide(&scene, bits, by)?;
        let [mut overlay, mut fresh] = [Overlay::new(&tree), Overlay::new(&tree)];
        overlay.replace(&tree, &all).map_err(fail)?;
        overlay.replace(&tree, &moving).map_err(fail)?;
        fresh.replace(&tree, &moving).map_err(fail)?;
        judge::same(&tree, [&overlay, &fresh]).map_err(fail)?;
        counts[0] += judge::areas(&tree, &overlay).map_err(fail)?;
        counts[1] += overlay.len();
        Ok(())
    });
    let [faces, pieces] = counts;
    assert!(faces > 500 && pieces > faces * 5 / 4, "{faces} faces in {pieces} pieces");
}
