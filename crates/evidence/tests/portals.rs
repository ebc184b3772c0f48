//! Portals of real levels, in the folder that `BINSPACE_SCENES` names.

#[path = "../../../tests/support/real_scenes.rs"]
mod real_scenes;

use binspace::glam::DVec3;
use binspace::raster::{NONE, Rays, zbuffer};
use binspace::scene::Scene;
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions};
use binspace_evidence::portals::Cells;
use std::collections::BTreeSet;

/// Points at the height of eyes over floors, with the directions of the compass.
fn cameras(scene: &Scene, height: f64, step: usize) -> Vec<(DVec3, Camera)> {
    let up = scene.up();
    let floor = |corners: &[DVec3]| {
        let normal: DVec3 =
            corners.windows(2).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0])).sum();
        (normal.normalize_or_zero().dot(up) > 0.99)
            .then(|| corners.iter().sum::<DVec3>() / corners.len() as f64)
    };
    let floors = (0..scene.len()).filter_map(|polygon| floor(scene.polygon(polygon)));
    let along = up.any_orthonormal_vector();
    let look = |(k, foot): (usize, DVec3)| {
        let (eye, turn) = (foot + up * height, k as f64);
        let ahead = along * turn.cos() + up.cross(along) * turn.sin();
        (eye, Camera::perspective(eye, eye + ahead, up, 1.3, [160, 120]).unwrap())
    };
    floors.step_by(step).enumerate().map(look).collect()
}

#[test]
fn nothing_that_owns_a_pixel_of_a_level_is_left_out() {
    let Some(folder) = real_scenes::folder("portals of levels") else { return };
    for (name, height, step) in [("doom_e1m1.obj", 41.0, 20)] {
        let (scene, _) = Scene::read_obj(&folder.join(name)).unwrap();
        let begin = std::time::Instant::now();
        let tree = BuildOptions::DEFAULT.build(scene.polygons()).unwrap();
        let _ = BspTree::len(&tree);
        let cells = Cells::new(&tree, scene.len());
        eprintln!(
            "{:?} {} {} {} {}",
            begin.elapsed(),
            scene.len(),
            tree.len(),
            cells.len(),
            cells.portal_count()
        );
        let (mut owned, mut kept, mut eyes) = (0, 0, 0);
        for (eye, camera) in cameras(&scene, height, step) {
            let begin = std::time::Instant::now();
            let seen = cells.seen_from(eye, &camera.frustum());
            let took = begin.elapsed();
            let rays = Rays::new(&camera, tree.faces()).unwrap();
            let depth = zbuffer(&rays, tree.faces());
            let shown = depth.image().faces().iter().filter(|&&face| face != NONE);
            let owners: BTreeSet<usize> = shown.map(|&face| tree.faces().polygon(face)).collect();
            let missing = owners.iter().filter(|&&polygon| !seen.polygons[polygon]).count();
            eprintln!(
                "{eye} {took:?} own {} kept {} missing {missing}",
                owners.len(),
                seen.polygon_count()
            );
            (owned, kept, eyes) = (owned + owners.len(), kept + seen.polygon_count(), eyes + 1);
        }
        eprintln!("{owned} {kept} {eyes}");
    }
}
