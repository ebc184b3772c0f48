//! Compares visibility maps and drawings with rays, and with pictures in which separate integers decide every
//! pixel.

mod areas;
mod bent;
mod between;
mod borders;
mod coincidences;
mod connected;
mod crossings;
mod extremes;
mod fans;
mod flat_faces;
mod grid_crossings;
mod hidden;
mod hidden_crossings;
mod in_front;
mod lines;
mod matrices;
mod meetings;
mod on_surfaces;
mod overlay;
mod pen;
mod pictures;
mod progress;
mod same;
mod scenes;
mod seams;
mod sheets;
mod sides;
mod sightlines;
mod silhouettes;
mod translucent;

use testkit::prelude::*;

/// The visible parts of a tree.
fn map_of<'t>(tree: &'t BspTree, camera: &Camera) -> VisibilityMap<'t> {
    map_with(tree, camera, |_| 1.0)
}

/// The visible parts of a tree whose polygons have opacities.
fn map_with<'t>(
    tree: &'t BspTree,
    camera: &Camera,
    opacity: impl Fn(usize) -> f64,
) -> VisibilityMap<'t> {
    tree.visibility(camera, &with_opacities(tree, opacity)).unwrap()
}

/// The point of a tree's grid that is nearest to a place.
fn on_grid(tree: &BspTree, place: DVec3) -> DVec3 {
    let lattice = tree.faces().lattice();
    lattice.to_world(lattice.to_lattice(place).map(f64::round))
}
