//! Portals of real levels, in the folder that `BINSPACE_SCENES` names.

#![allow(clippy::print_stderr, reason = "the figures are shown on request")]

use binspace::raster::{NONE, zbuffer};
use binspace_evidence::portals::{Cells, Seen};
use std::collections::BTreeSet;
use testkit::prelude::*;

/// The height of eyes over the floor.
const HEIGHT: f64 = 41.0;

/// Eyes over floors, looking all around one after another.
fn cameras(scene: &Scene, step: usize) -> Vec<(DVec3, Camera)> {
    let up = scene.up();
    let foot = |corners: &[DVec3]| {
        let arms = corners.windows(2).map(|p| (p[0] - corners[0]).cross(p[1] - corners[0]));
        let normal = arms.sum::<DVec3>().normalize_or_zero();
        (normal.dot(up) > 0.99).then(|| corners.iter().sum::<DVec3>() / corners.len() as f64)
    };
    let floors = (0..scene.len()).filter_map(|polygon| foot(scene.polygon(polygon)));
    let along = up.any_orthonormal_vector();
    let look = |(k, foot): (usize, DVec3)| {
        let (eye, turn) = (foot + up * HEIGHT, k as f64);
        let ahead = along * turn.cos() + up.cross(along) * turn.sin();
        (eye, Camera::perspective(eye, eye + ahead, up, 1.3, [160, 120]).unwrap())
    };
    floors.step_by(step).enumerate().map(look).collect()
}

/// The polygons that own a pixel.
fn owners(tree: &BspTree, camera: &Camera) -> BTreeSet<usize> {
    let rays = Rays::new(camera, tree.faces()).unwrap();
    let depth = zbuffer(&rays, tree.faces());
    let shown = depth.image().faces().iter().filter(|&&face| face != NONE);
    shown.map(|&face| tree.faces().polygon(face)).collect()
}

#[test]
#[ignore = "needs the real scenes: BINSPACE_SCENES"]
fn no_polygon_that_owns_a_pixel_of_a_real_level_is_left_out() {
    let folder = testkit::real_scenes::folder();
    // Sets of cells take seconds each in the larger level.
    for (name, step, eyes_a_set) in
        [("doom_e1m1.obj", 2, Some(8)), ("doom_map12_big.obj", 35, None)]
    {
        let (scene, _) = Scene::read_obj(folder.join(name)).unwrap();
        let tree = BspTree::build(scene.polygons()).unwrap();
        let cells = Cells::new(&tree, scene.len());
        let (mut owned, mut kept, mut eyes) = (0, 0, 0);
        for (k, (eye, camera)) in cameras(&scene, step).into_iter().enumerate() {
            let owners = owners(&tree, &camera);
            let holds = |seen: &Seen| owners.iter().all(|&polygon| seen.polygons[polygon]);
            let seen = cells.seen_from(eye, &camera.frustum());
            assert!(holds(&seen), "{name}, from {eye}");
            if eyes_a_set.is_some_and(|each| k % each == 0) {
                for cell in cells.at(eye) {
                    assert!(holds(&cells.seen_from_cell(cell)), "{name}, the cell of {eye}");
                }
            }
            (owned, kept, eyes) = (owned + owners.len(), kept + seen.polygon_count(), eyes + 1);
        }
        enough!(eyes > 50, owned > 1500; "{name}: {owned} from {eyes} eyes");
        assert!(kept < 2 * owned, "{name}: {kept} kept, {owned} own a pixel");
        eprintln!("{name}: {eyes} eyes, {owned} own a pixel, {kept} kept");
    }
}
