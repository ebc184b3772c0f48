//! Portals and potentially visible sets of an interior.

use std::collections::BTreeSet;

use binspace::BspTree;
use binspace::glam::{DVec3, dvec3};
use binspace::internals::SplitMix64;
use binspace::raster::{NONE, Rays, colour_of, picture, zbuffer};
use binspace::view::Camera;
use binspace_evidence::interior::rooms;
use binspace_evidence::portals::{Cells, Seen};

use crate::lecture::chapter::{Chapter, Picture, percent};
use binspace_cli::failure::Failure;

const SIZE: [u32; 2] = [320, 240];
/// The number of rooms on a side, each room 8 by 8 and 3 high.
const SIDE: usize = 6;
const WIDTH: f64 = 8.0 * SIDE as f64;
/// The number of eyes in the table.
const EYES: usize = 40;
const SMALL: [u32; 2] = [160, 120];

/// The level with its derived data.
struct Level {
    tree: BspTree,
    cells: Cells,
    polygons: usize,
}

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Portals and potentially visible sets");
    let quads = rooms(SIDE);
    let tree = BspTree::build(&quads).map_err(|error| Failure::about("a tree", error))?;
    let cells = Cells::new(&tree, quads.len());
    let level = Level { tree, cells, polygons: quads.len() };
    chapter.text(format!(
        "In a building, other rooms are visible only through doors. The leaves of the tree are convex \
         cells. A portal is the part of a plane between two cells that no polygon covers. From an eye, a \
         polygon is visible only through a sequence of portals, each of which narrows the view (Jones, A \
         New Approach to the ‘Hidden Line’ Problem, 1971). From a whole cell, a polygon may be visible \
         if some line through portals reaches it. These polygons are the potentially visible set of the \
         cell, which can be computed before any eye is known (Airey 1990; Teller & Séquin, Visibility \
         Preprocessing for Interactive Walkthroughs, 1991). This level has {} rooms and {} polygons; its \
         tree has {} cells and {} portals.",
        SIDE * SIDE,
        level.polygons,
        level.cells.len(),
        level.cells.portal_count(),
    ));
    let eye = dvec3(18.0, 19.5, 1.6);
    show(chapter, &level, eye, eye + dvec3(1.0, 0.12, -0.02))?;
    figures(chapter, &level)
}

impl Level {
    /// The polygons that own a pixel.
    fn owners(&self, camera: &Camera) -> Result<BTreeSet<usize>, Failure> {
        let faces = self.tree.faces();
        let rays = Rays::new(camera, faces).map_err(|error| Failure::about("a view", error))?;
        let depth = zbuffer(&rays, faces);
        let shown = depth.image().faces().iter().filter(|&&face| face != NONE);
        Ok(shown.map(|&face| faces.polygon(face)).collect())
    }

    /// The set that may be seen from the cells that contain a point.
    fn set_of(&self, eye: DVec3) -> Vec<bool> {
        let sets = self.cells.at(eye).into_iter().map(|cell| self.cells.seen_from_cell(cell));
        sets.fold(vec![false; self.polygons], |all, set: Seen| {
            all.iter().zip(&set.polygons).map(|(&a, &b)| a || b).collect()
        })
    }

    fn picture(
        &self,
        camera: &Camera,
        colour: impl Fn(usize) -> [u8; 3],
        fronts: bool,
    ) -> Result<Vec<u8>, Failure> {
        let faces = self.tree.faces();
        let rays = Rays::new(camera, faces).map_err(|error| Failure::about("a view", error))?;
        let rays = if fronts { rays.with_front_faces_only() } else { rays };
        let depth = zbuffer(&rays, faces);
        Ok(picture(&rays, faces, depth.image(), colour, [255; 3]))
    }
}

/// Shows the view of an eye, and a plan of the polygons kept for the eye and for its cell.
fn show(chapter: &mut Chapter, level: &Level, eye: DVec3, target: DVec3) -> Result<(), Failure> {
    let failure = |error| Failure::about("a view", error);
    let camera = Camera::perspective(eye, target, DVec3::Z, 0.9, SIZE).map_err(failure)?;
    let owners = level.owners(&camera)?;
    let seen = level.cells.seen_from(eye, &camera.frustum());
    let set = level.set_of(eye);
    // Front faces only: seen from above, this leaves out the ceilings.
    let middle = dvec3(0.5 * WIDTH, 0.5 * WIDTH, 0.0);
    let down = dvec3(0.0, 0.45, -1.0);
    let plan = Camera::parallel(down, DVec3::Y, middle, 1.02 * WIDTH, SIZE).map_err(failure)?;
    let status = |polygon: usize| match (owners.contains(&polygon), seen.polygons[polygon]) {
        (true, _) => [90, 190, 90],
        (_, true) => [240, 200, 60],
        _ if set[polygon] => [120, 165, 235],
        _ => [110, 110, 115],
    };
    chapter.pictures([
        Picture::new(SIZE, level.picture(&camera, colour_of, false)?, "The view of the eye"),
        Picture::new(
            SIZE,
            level.picture(&plan, status, true)?,
            "From above, without ceilings. Green: visible in a pixel of the view. Yellow: kept for the eye, \
             but not visible. Blue: only in the set of the eye's cell. Grey: left out",
        ),
    ]);
    let counts = [owners.len(), seen.polygon_count(), set.iter().filter(|&&kept| kept).count()];
    chapter.text(format!(
        "Of {} polygons, {} are visible in at least one pixel of this view. For this view, portals keep {} \
         polygons. For the whole cell of the eye and all directions, portals keep {}.",
        level.polygons, counts[0], counts[1], counts[2],
    ));
    Ok(())
}

/// Counts over many eyes.
fn figures(chapter: &mut Chapter, level: &Level) -> Result<(), Failure> {
    let mut random = SplitMix64::new(8);
    let [mut owned, mut around] = [0; 2];
    // Polygons kept, and visible polygons left out.
    let [mut by_volume, mut by_eye, mut by_cell] = [[0; 2]; 3];
    for _ in 0..EYES {
        let mut at = || random.range(0.3, WIDTH - 0.3);
        let eye = dvec3(at(), at(), 1.6);
        let turn = random.range(0.0, std::f64::consts::TAU);
        let set = level.set_of(eye);
        let mut all = BTreeSet::new();
        for quarter in 0..4 {
            let angle = turn + f64::from(quarter) * std::f64::consts::FRAC_PI_2;
            let target = eye + dvec3(angle.cos(), angle.sin(), 0.0);
            let camera = Camera::perspective(eye, target, DVec3::Z, 1.3, SMALL)
                .map_err(|error| Failure::about("a view", error))?;
            let owners = level.owners(&camera)?;
            let seen = level.cells.seen_from(eye, &camera.frustum());
            add(&mut by_eye, &seen.polygons, &owners);
            add(&mut by_volume, &in_view(level, &camera), &owners);
            owned += owners.len();
            all.extend(owners);
        }
        add(&mut by_cell, &set, &all);
        around += all.len();
    }
    let row = |name: &str, [kept, missing]: [usize; 2], owned: usize| {
        let too_many = percent(kept.saturating_sub(owned) as f64, owned as f64).to_string();
        [name.to_owned(), kept.to_string(), owned.to_string(), too_many, missing.to_string()]
    };
    chapter.table(
        ["kept", "polygons kept", "visible", "too many", "visible but left out"],
        [
            row("for a view, all", [level.polygons * EYES * 4, 0], owned),
            row("for a view, by the view volume", by_volume, owned),
            row("for a view, through portals", by_eye, owned),
            row("for a cell, through portals", by_cell, around),
        ],
    );
    chapter.text(format!(
        "The figures are sums over {EYES} eyes at random places, with four views each. An exact depth \
         buffer judges each view. A cell is judged by the four views of one eye in it. So some polygons \
         counted as unneeded are visible from other points of the cell.",
    ));
    Ok(())
}

/// Adds to the number of kept polygons, and to the number of visible polygons that are not kept.
fn add([kept, missing]: &mut [usize; 2], polygons: &[bool], owners: &BTreeSet<usize>) {
    *kept += polygons.iter().filter(|&&is_kept| is_kept).count();
    *missing += owners.iter().filter(|&&polygon| !polygons[polygon]).count();
}

/// The polygons in the view volume, by the boxes of their fragments.
fn in_view(level: &Level, camera: &Camera) -> Vec<bool> {
    let frustum = camera.frustum();
    let mut inside = vec![false; level.polygons];
    for fragment in level.tree.fragments() {
        let (low, high) = fragment
            .vertices()
            .fold((DVec3::MAX, DVec3::MIN), |(low, high), p| (low.min(p), high.max(p)));
        inside[fragment.polygon()] |= frustum.meets([low, high]);
    }
    inside
}
