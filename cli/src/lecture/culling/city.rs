//! The steps of culling in a large scene.

use std::collections::BTreeSet;

use binspace::BspTree;
use binspace::glam::dvec3;
use binspace::internals::paint_order;
use binspace::raster::{Rays, compare, picture, zbuffer};
use binspace::scene;
use binspace::view::Camera;
use binspace_evidence::culling::steps;

use crate::colours::{Colouring, Colours};
use crate::failure::Failure;
use crate::lecture::chapter::{Chapter, Picture, percent};

const SIZE: [u32; 2] = [320, 240];
/// A tenth of the scene that the test takes, so that the lecture stays short.
const POLYGONS: u32 = 260_000;
const SKY: [u8; 3] = [200, 215, 230];

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Culling");
    let failure = |error| Failure::about("a view", error);
    let scene = scene::city(POLYGONS, 1);
    let tree = BspTree::build(scene.polygons()).map_err(|error| Failure::about("a tree", error))?;
    let bounds = tree.bounds().map_err(|error| Failure::about("boxes", error))?;
    // Over a crossing of two streets, above the highest roof.
    let eye = dvec3(2400.0, 2400.0, 130.0);
    let target = eye + dvec3(1.0, 0.8, -0.3);
    let camera = Camera::perspective(eye, target, scene.up(), 1.0, SIZE).map_err(failure)?;
    let rays = Rays::new(&camera, tree.faces()).map_err(failure)?;
    let truth = zbuffer(&rays, tree.faces());
    let steps = steps(&tree, &bounds, &camera, &rays);
    let mut rows = Vec::new();
    for step in &steps {
        let painted = paint_order(&tree, &step.left, &rays);
        let wrong = compare(&rays, tree.faces(), &painted, truth.image()).wrong();
        let polygons: BTreeSet<usize> =
            step.left.iter().map(|&fragment| tree.fragment(fragment).polygon()).collect();
        rows.push([
            step.name.to_owned(),
            polygons.len().to_string(),
            percent(polygons.len() as f64, scene.len() as f64).to_string(),
            format!("{:.2} ms", step.time.as_secs_f64() * 1e3),
            painted.drawn().to_string(),
            wrong.to_string(),
        ]);
    }
    chapter.text(format!(
        "Most of a large scene need not be drawn: what is outside of the view volume, the backs of closed \
         bodies, and what is hidden. Here are a city of {} polygons and an eye above its roofs. Each \
         step leaves out what the steps before it leave out and some more. The tree does it by boxes \
         of whole subtrees, so the time goes with what is left, not with what there is. Every picture \
         is compared with that of an exact depth buffer that gets all polygons: none differs. What \
         the last step leaves are those polygons that own a pixel, no more.",
        scene.len(),
    ));
    chapter.table(
        ["left out", "polygons left", "share", "time", "pixels drawn", "wrong pixels"],
        rows,
    );
    let colours = Colours::new(&scene, Colouring::Material);
    let rgb = picture(&rays, tree.faces(), truth.image(), |polygon| colours.rgb(polygon), SKY);
    chapter.pictures([Picture::new(SIZE, rgb, "The same picture from each list")]);
    Ok(())
}
