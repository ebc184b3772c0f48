//! Walking a tree: its nodes, its bounds, and orders without invisible fragments.

mod bounds;
mod culling;
mod nodes;
mod occlusion;
mod order;
mod sides;
mod threads;

use testkit::prelude::*;
use testkit::scenes::{cells, polygons};

/// Polygons with area of many kinds: cut, moved by the tolerance, far out, in one plane, walls of cells.
fn scenes() -> Vec<Vec<Vec<DVec3>>> {
    let mut scenes: Vec<Vec<Vec<DVec3>>> = [
        scene::random_triangles(70, 3),
        scene::city(120, 1),
        scene::crossing(9),
        scene::teapot(3),
        scene::newell_bars(),
        scene::chain(40),
    ]
    .map(|scene| polygons(&scene))
    .into();
    // Scenes off the grid and off the origin, so that every corner is rounded, and most corners are moved.
    for (scale, shift) in [(1e-9, 1.0), (0.3, 1e6), (1e120, -1e121)] {
        let turn = binspace::glam::DMat3::from_euler(binspace::glam::EulerRot::XYZ, 0.3, 1.1, 2.0);
        let place = |p: &DVec3| turn * *p * scale + DVec3::new(shift, -shift, 0.5 * shift);
        let source = [&scenes[0], &scenes[1]][usize::from(scale > 1.0)];
        let moved = source.iter().map(|polygon| polygon.iter().map(place).collect());
        scenes.push(moved.collect());
    }
    scenes.push(cells(4, &mut Dice(4)));
    scenes
}

/// Trees of all kinds, also for one view.
fn trees() -> Vec<BspTree> {
    let mut trees = Vec::new();
    for scene in scenes() {
        for heuristic in [Heuristic::default(), Heuristic::First, Heuristic::FreePlanes] {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
            trees.push(options.build(&scene).unwrap());
        }
        let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
        trees.push(builder.build(&scene).unwrap().clone());
    }
    trees.push(BspTree::build::<[[f64; 3]; 3]>([]).unwrap());
    trees.push(BspTree::build([[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]).unwrap());
    trees
}

/// Viewpoints in a tree's box, around it and at infinity, and on corners of its polygons.
fn viewpoints(tree: &BspTree, dice: &mut Dice) -> Vec<Viewpoint> {
    let Some([low, high]) = tree.bounds() else { return vec![Viewpoint::eye([1.0, 2.0, 3.0])] };
    let size = high - low;
    let mut any = |reach: f64| {
        let share = DVec3::from_array([0; 3].map(|_| dice.share() * reach - 0.5 * (reach - 1.0)));
        low + size * share
    };
    let mut views: Vec<Viewpoint> =
        [1.0, 1.0, 1.0, 3.0, 3.0, 1e4].map(|reach| Viewpoint::Eye(any(reach))).into();
    let corner = tree.fragment(0).vertices().next().unwrap();
    views.extend([
        Viewpoint::Eye(corner),
        Viewpoint::Direction(any(1.0) - any(1.0)),
        Viewpoint::Direction(DVec3::NEG_Z),
        Viewpoint::eye([f64::INFINITY, 0.0, f64::NAN]),
    ]);
    views
}
