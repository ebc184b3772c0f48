//! A second order into the same list allocates nothing, and a second frame allocates nothing.

use super::{allocations, counted, least_allocations};
use binspace::Ray;
use testkit::prelude::*;

#[test]
fn a_second_order_allocates_nothing() {
    counted(order_again);
}

#[test]
fn rays_and_points_allocate_nothing() {
    counted(ask);
}

#[test]
fn a_second_frame_allocates_nothing() {
    counted(frame_again);
}

const FROM_ABOVE: [f64; 3] = [3.0, 1.0, 20.0];

fn order_again() {
    let scenes = [
        scene::layers(1, 0.1),
        scene::layers(12, 0.1),
        scene::random_triangles(300, 1),
        scene::city(3000, 1),
    ];
    // Eyes outside the scenes, inside them and on planes, and directions along axes and others. The filter
    // decides some, and integers decide others.
    let viewpoints = [
        Viewpoint::eye(FROM_ABOVE),
        Viewpoint::eye([0.0, 0.0, 0.0]),
        Viewpoint::eye([0.5, 0.5, 0.5]),
        Viewpoint::direction([0.0, 0.0, -1.0]),
        Viewpoint::direction([1.0, 2.0, 3.0]),
    ];
    for scene in scenes {
        let tree = BspTree::build(scene.polygons()).unwrap();
        for forwards in [true, false] {
            let mut order = Vec::new();
            let mut write = |viewpoint| {
                if forwards {
                    tree.back_to_front_into(viewpoint, &mut order);
                } else {
                    tree.order(viewpoint).front_to_back().write_into(&mut order);
                }
                assert_eq!(order.len(), tree.len());
            };
            // The counter works: the first order has to allocate.
            assert!(allocations(|| write(viewpoints[0])) > 0, "{}", scene.name());
            let again = least_allocations(|| viewpoints.into_iter().for_each(&mut write));
            assert_eq!(again, 0, "{}, back to front: {forwards}", scene.name());
        }
        let mesh = tree.welded_mesh().unwrap();
        let (mut order, mut indices) = (Vec::new(), vec![0; mesh.triangles().indices().len()]);
        let mut write = |viewpoint| {
            let written =
                mesh.triangles().write_back_to_front(&tree, viewpoint, &mut order, &mut indices);
            assert_eq!(written, Ok(mesh.triangles().indices().len()));
        };
        assert!(allocations(|| write(viewpoints[0])) > 0, "{}", scene.name());
        let again = least_allocations(|| viewpoints.into_iter().for_each(&mut write));
        assert_eq!(again, 0, "indices of {}", scene.name());
    }
}

/// Rays and points that the filter decides, and others that integers decide.
fn ask() {
    for scene in [scene::random_triangles(300, 1), scene::terrain(3000, 1)] {
        let tree = BspTree::build(scene.polygons()).unwrap();
        let (low, high) = scene.bounds().unwrap();
        let mut hits = 0;
        let used = least_allocations(|| {
            hits = 0;
            for corner in scene.polygons().take(200).map(|polygon| polygon.points()[0]) {
                for from in [low, high * 2.0, corner] {
                    hits += tree.hits(Ray::between(from, corner)).take(3).count();
                    hits += usize::from(tree.is_occluded(Ray::new(from, high - corner)));
                }
                hits += usize::from(tree.locate(corner).is_some());
            }
        });
        assert!(used == 0 && hits > 500, "{}: {used} times, {hits} hits", scene.name());
    }
}

/// Frames of few layers that all move.
fn frame_again() {
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    let mut order = Vec::new();
    let mut frame = |turn: u32| {
        let scene = scene::layers(10, 0.1 + 0.01 * f64::from(turn));
        let upright = [[0.5, -9.0, -9.0], [0.5, 9.0, -9.0], [0.5, 9.0, 9.0], [0.5, -9.0, 9.0]];
        let polygons: Vec<Vec<[f64; 3]>> = scene
            .polygons()
            .map(|polygon| polygon.points().iter().map(|corner| corner.to_array()).collect())
            .chain([upright.to_vec()])
            .collect();
        allocations(|| {
            let tree = builder.build(&polygons).unwrap();
            assert!(tree.len() > polygons.len(), "{}", tree.len());
            tree.back_to_front_into(Viewpoint::eye(FROM_ABOVE), &mut order);
            let vertices = order.iter().flat_map(|&number| tree.fragment(number).vertices());
            assert!(vertices.map(|vertex| vertex.x).sum::<f64>().is_finite());
        })
    };
    assert!(frame(0) > 10);
    // The lists have grown to their sizes after a few similar frames.
    (1..6).for_each(|turn| _ = frame(turn));
    let rounds = [6..12, 12..18, 18..24].map(|turns| turns.map(&mut frame).sum::<usize>());
    // The test runner may allocate while a test runs.
    assert_eq!(rounds.into_iter().min(), Some(0), "{rounds:?}");
}
