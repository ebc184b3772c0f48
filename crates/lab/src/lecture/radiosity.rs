//! Light between surfaces: the Cornell box.

use binspace::raster::{NONE, Rays, zbuffer};
use binspace::scene::cornell_box;
use binspace::view::Camera;
use binspace::{BspTree, glam::DVec3};
use binspace_evidence::patches::{FormFactors, patches};
use binspace_evidence::rectangles::{facing, in_a_corner};
use binspace_evidence::room::Room;

use super::chapter::{Chapter, Picture, percent};
use binspace_cli::failure::Failure;

const SIZE: [u32; 2] = [320, 320];
/// The sides of a patch in the pictures and in the table, in the unit of the scene.
const FINE: f64 = 45.0;
const COARSE: f64 = 140.0;
/// The amount of light that is shown as white.
const WHITE: f64 = 0.035;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Light between surfaces");
    chapter.text(
        "A diffuse surface lights every surface that it sees. A scene divided into patches gives a system of \
         linear equations. The form factor from one patch to another is the share of the first patch's light \
         that arrives at the second (Goral, Torrance, Greenberg & Battaile, Modeling the Interaction of \
         Light Between Diffuse Surfaces, 1984). The form factor from a point to a whole patch has a closed \
         form (Lambert, 1760). The tree finds the visible share of the patch, by exact sight lines between \
         pairs of points. Each sight line is weighted by the light that it carries. Points on surfaces are \
         rounded, so each sight line ends a millionth of its length before the surface. In a closed room, \
         the form factors of a patch sum to 1. Here a black wall closes the open side, so that escaping \
         light is counted too.",
    );
    published(chapter)?;
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
    chapter.text(
        "The next test is the Cornell box, where blocks hide some sight lines. All light of the lamp must \
         arrive at the surfaces or escape. The last column is the light that is missing or surplus for one \
         set of random points; the tests take the mean of six sets.",
    );
    chapter.table(
        [
            "sight lines per pair",
            "sight lines",
            "light that arrives",
            "light that escapes",
            "lost or gained",
        ],
        rows,
    );
    let room = Room::new(FINE, 1).map_err(failure)?;
    let [direct, once] = [0, 1].map(|bounces| room.leaving(bounces));
    chapter.text(format!(
        "The pictures have {} patches and {} sight lines, one for each pair of patches that might be \
         visible to each other. Each patch has one colour. The lamp lies in the ceiling, so the \
         ceiling gets no direct light. One bounce lights it, and the red and the green wall colour the \
         surfaces beside them. Cornell University built and measured this box. This page uses the \
         university's measurements: the surfaces, the camera, and the reflectances of the paints at \
         620, 540 and 460 nm, shown as red, green and blue. The lamp is taken as white. We may not \
         copy the published pictures. The pictures are at https://www.graphics.cornell.edu/online/box \
         under \"Comparison\", a photograph beside a computed picture. The measurements are under \
         \"Data\". Three things should agree: the outlines of the walls and blocks, the shadows of the \
         blocks, and the sides of the blocks and parts of the floor that turn red or green. Three \
         things differ. The published pictures contain all bounces, so their shadows are lighter. The \
         published pictures show the colour of the real lamp, which is warmer, and have smooth shading.",
        room.patches.len(),
        room.factors.sight_lines,
    ));
    chapter.pictures([
        Picture::new(SIZE, shown(&room, &direct)?, "Direct light"),
        Picture::new(SIZE, shown(&room, &once)?, "Direct light and one bounce"),
    ]);
    Ok(())
}

/// Compares form factors by sight lines with published formulas.
fn published(chapter: &mut Chapter) -> Result<(), Failure> {
    let level = |[x, y]: [f64; 2], z: f64| {
        [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]].map(|[x, y]| DVec3::new(x, y, z))
    };
    let turned = |[a, b, c, d]: [DVec3; 4]| [d, c, b, a];
    let wall = |y: f64, z: f64| {
        [[0.0, 0.0], [y, 0.0], [y, z], [0.0, z]].map(|[y, z]| DVec3::new(0.0, y, z))
    };
    let cases = [
        (
            "facing squares, one side apart",
            [1.0, 1.0],
            turned(level([1.0, 1.0], 1.0)),
            facing([1.0, 1.0], 1.0),
        ),
        (
            "facing rectangles 2 by 3, 1.5 apart",
            [2.0, 3.0],
            turned(level([2.0, 3.0], 1.5)),
            facing([2.0, 3.0], 1.5),
        ),
        ("squares in a corner", [1.0, 1.0], wall(1.0, 1.0), in_a_corner(1.0, 1.0, 1.0)),
        (
            "rectangles 2 by 3 and 3 by 4 in a corner",
            [2.0, 3.0],
            wall(3.0, 4.0),
            in_a_corner(3.0, 2.0, 4.0),
        ),
    ];
    let mut rows = Vec::new();
    for (name, sides, other, truth) in cases {
        let quads = [level(sides, 0.0), other];
        let tree = BspTree::build(quads).map_err(failure)?;
        let whole = patches(&quads, f64::INFINITY);
        let found = [4, 16, 64]
            .map(|side| format!("{:.5}", FormFactors::new(&tree, &whole, side, 1).factor(0, 1)));
        let [few, more, most] = found;
        rows.push([name.to_owned(), few, more, most, format!("{truth:.5}")]);
    }
    chapter.text(
        "Published formulas exist for two rectangles that face each other, and for two rectangles that \
         share an edge at a right angle (Howell, A Catalog of Radiation Heat Transfer Configuration \
         Factors, C-11 and C-14). The table gives the share of light from the first rectangle to the \
         second, by sight lines and by the formulas:",
    );
    chapter.table(["rectangles", "16 lines", "256 lines", "4096 lines", "published formula"], rows);
    Ok(())
}

fn failure(error: binspace::Error) -> Failure {
    Failure::about("a tree", error)
}

/// The patches, each in the colour of the light that leaves it.
fn shown(room: &Room, leaving: &[[f64; 3]]) -> Result<Vec<u8>, Failure> {
    let surfaces = &room.patches[..room.surfaces()];
    let tree = BspTree::build(surfaces.iter().map(|patch| patch.corners)).map_err(failure)?;
    let (eye, target) = cornell_box().suggested_view().unwrap_or((DVec3::ZERO, DVec3::Z));
    let view = |error| Failure::about("a view", error);
    // The published camera: film size 0.025, focal length 0.035.
    let camera = Camera::perspective_by_slope(eye, target, DVec3::Y, 0.0125 / 0.035, SIZE);
    let camera = camera.map_err(view)?;
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
