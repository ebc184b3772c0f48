//! The steps of culling in a large scene.

use binspace::BspTree;
use binspace::raster::{Rays, picture, zbuffer};
use binspace::scene;
use binspace_evidence::culling::{measure, over_the_city};

use crate::lecture::chapter::{Chapter, Picture, percent};
use binspace_cli::colours::{Colouring, Colours};
use binspace_cli::failure::Failure;

const SIZE: [u32; 2] = [320, 240];
/// The number of polygons: a tenth of the report's city, so that the lecture stays short.
const POLYGONS: u32 = 260_000;
const SKY: [u8; 3] = [200, 215, 230];

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Culling");
    let failure = |error| Failure::about("a view", error);
    let scene = scene::city(POLYGONS, 1);
    let tree = BspTree::build(scene.polygons()).map_err(|error| Failure::about("a tree", error))?;
    let camera = over_the_city(SIZE).map_err(failure)?;
    let rays = Rays::new(&camera, tree.faces()).map_err(failure)?;
    let truth = zbuffer(&rays, tree.faces());
    let rows = measure(&tree, &camera, &rays).into_iter().map(|left| {
        let share = percent(left.polygons as f64, scene.len() as f64);
        [
            left.name.to_owned(),
            left.polygons.to_string(),
            share.to_string(),
            format!("{:.2} ms", left.time.as_secs_f64() * 1e3),
            left.drawn.to_string(),
            left.wrong.to_string(),
        ]
    });
    chapter.text(format!(
        "Most polygons of a large scene need not be drawn: polygons outside the view volume, back faces of \
         closed bodies, and hidden polygons. The scene is a city of {} polygons, and the eye is above its \
         roofs. Each step leaves out everything that the steps before it leave out, and more. The tree tests \
         the bounding boxes of subtrees, so a subtree far from the boundary of the view is accepted or \
         rejected as a whole. The steps themselves take time, and the last one also draws the polygons that \
         it finds into a mask. In return, omitted polygons need no drawing. The \
         picture of each step is compared with the picture of an exact depth buffer, which gets all \
         polygons. No picture differs. The last step leaves exactly the polygons that are visible in at \
         least one pixel. `binspace-lab report` prints the same table for a city of 2600000 polygons, ten \
         times as many.",
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
