//! Pictures that show the backs of most faces.

use binspace::paint::paint_tree;
use binspace::raster::{NONE, Rays};
use binspace::scene::Scene;
use binspace::view::Camera;
use binspace::{BspTree, Facing};

use crate::camera;
use crate::terminal::remark;

/// The longer side, in pixels, of the small picture by which backs are counted.
const SIDE: u32 = 128;
/// Note if more than 3 of 4 pixels show backs. Open surfaces and random triangles may show as many backs as
/// fronts. Too small: notes on those scenes. Too large: rooms are missed.
const MOSTLY: [usize; 2] = [4, 3];

/// Notes that a picture from outside a scene shows mostly backs of faces, for example because a room's near
/// walls hide the room's inside.
pub(crate) fn note_backs(scene: &Scene, tree: &BspTree, camera: &Camera) {
    if camera::is_inside(camera, scene) {
        return;
    }
    let Some([backs, all]) = count(tree, camera) else { return };
    if backs * MOSTLY[0] > all * MOSTLY[1] {
        let share = format!("{} % of the picture shows back faces", 100 * backs / all);
        let full = format!(
            "{share}: the scene is a room seen from outside, or the polygons are wound clockwise; \
             `--cull back` omits back faces"
        );
        remark(scene.name(), format!("{share} (`--cull back` omits them)"), full);
    }
}

/// The numbers of pixels of a small picture that show a back, and that show anything. `None` if there is no
/// such picture.
fn count(tree: &BspTree, camera: &Camera) -> Option<[usize; 2]> {
    let [width, height] = camera.size().map(u64::from);
    let longer = width.max(height).max(SIDE.into());
    let size = [width, height].map(|side| (side * u64::from(SIDE) / longer).max(1) as u32);
    let rays = Rays::new(&camera.with_size(size).ok()?, tree.faces()).ok()?;
    let mut is_back = vec![false; tree.faces().len()];
    for fragment in tree.fragments() {
        is_back[fragment.face() as usize] = fragment.facing(camera.viewpoint()) == Facing::Back;
    }
    let image = paint_tree(tree, camera.viewpoint(), &rays);
    let shown = image.faces().iter().filter(|&&face| face != NONE);
    let backs = shown.clone().filter(|&&face| is_back[face as usize]).count();
    Some([backs, shown.count()])
}
