//! Light between surfaces: the Cornell box.

use binspace::raster::{NONE, Rays, zbuffer};
use binspace::scene::cornell_box;
use binspace::view::Camera;
use binspace::{BspTree, glam::DVec3};
use binspace_evidence::room::Room;

use super::chapter::{Chapter, Picture, percent};
use crate::failure::Failure;

const SIZE: [u32; 2] = [320, 320];
/// The side of a patch of the pictures, and of those of the table, in the unit of the scene.
const FINE: f64 = 45.0;
const COARSE: f64 = 140.0;
/// The light that is shown white.
const WHITE: f64 = 0.035;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Light between surfaces");
    chapter.text(
        "A diffuse surface lights all that it sees. Cut into patches, a scene is a system of linear \
         equations: the form factor from one patch to another is the share of its light that arrives \
         there (Goral, Torrance, Greenberg & Battaile, Modeling the Interaction of Light Between Diffuse \
         Surfaces, 1984). What a point sees of a patch has a closed form (Lambert, 1760); how much of \
         it is free is asked of the tree, by exact sight lines between pairs of points, each weighted by the \
         light that it carries. They end a millionth of their length before the surfaces, as points on \
         these are rounded. In a closed room, \
         the factors of a patch sum to 1: here the open side is closed by a black wall, so that what \
         escapes is counted too.",
    );
    let mut rows = Vec::new();
    for side in [1, 2, 4, 8] {
        let room = Room::new(COARSE, side).map_err(failure)?;
        let balance = room.balance();
        let total = balance.arrived + balance.escaped;
        rows.push([
            (side * side).to_string(),
            room.factors.sight_lines.to_string(),
            percent(balance.arrived, 1.0).to_string(),
            percent(balance.escaped, 1.0).to_string(),
            format!("{:.5}", (total - 1.0).abs()),
        ]);
    }
    chapter.table(
        [
            "sight lines a pair",
            "sight lines",
            "light that arrives",
            "light that escapes",
            "lost or won",
        ],
        rows,
    );
    let room = Room::new(FINE, 1).map_err(failure)?;
    let [direct, once] = [0, 1].map(|bounces| room.leaving(bounces));
    chapter.text(format!(
        "The pictures have {} patches and {} sight lines, one a pair that may see one another. The \
         ceiling gets no light straight from the lamp, which lies in it; one bounce lights it, and the \
         red and the green wall colour what is beside them. The measurements and the view are those \
         that Cornell University published; colours are those of display, so only shapes and shadows \
         are to be compared with the published picture.",
        room.patches.len(),
        room.factors.sight_lines,
    ));
    chapter.pictures([
        Picture::new(SIZE, shown(&room, &direct)?, "Direct light"),
        Picture::new(SIZE, shown(&room, &once)?, "Direct light and one bounce"),
    ]);
    Ok(())
}

fn failure(error: binspace::Error) -> Failure {
    Failure::about("a tree", error)
}

/// The patches, each in the colour of what leaves it.
fn shown(room: &Room, leaving: &[[f64; 3]]) -> Result<Vec<u8>, Failure> {
    let surfaces = &room.patches[..room.surfaces()];
    let tree = BspTree::build(surfaces.iter().map(|patch| patch.corners)).map_err(failure)?;
    let (eye, target) = cornell_box().suggested_view().unwrap_or((DVec3::ZERO, DVec3::Z));
    let view = |error| Failure::about("a view", error);
    let camera = Camera::perspective(eye, target, DVec3::Y, 0.69, SIZE).map_err(view)?;
    let rays = Rays::new(&camera, tree.faces()).map_err(view)?;
    let depth = zbuffer(&rays, tree.faces());
    let byte = |light: f64| (255.0 * (light / WHITE).min(1.0).powf(1.0 / 2.2)) as u8;
    let rgb = |polygon: usize| leaving[polygon].map(byte);
    let pixel = |&face: &u32| match face {
        NONE => [0; 3],
        face => rgb(tree.faces().polygon(face)),
    };
    Ok(depth.image().faces().iter().flat_map(pixel).collect())
}
