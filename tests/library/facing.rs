//! The side of a fragment that faces a viewpoint, compared with exact rationals.

use binspace::Facing;
use binspace::verify::verify_fronts;
use binspace::view;
use testkit::prelude::*;
use testkit::views::View;

/// Viewpoints anywhere, on corners, in planes of faces, and directions along planes.
fn viewpoints(tree: &BspTree, dice: &mut Dice) -> Vec<View> {
    let faces = tree.faces();
    let size = faces.corners(0).iter().flatten().fold(1.0f64, |a, c| a.max(c.abs()));
    let mut point = |reach: f64| {
        DVec3::from_array(std::array::from_fn(|_| {
            ((dice.roll() % 2001) as f64 / 1000.0 - 1.0) * size * reach
        }))
    };
    let mut views: Vec<View> = (0..6).map(|_| View::eye(faces, point(2.0))).collect();
    views.extend((0..6).map(|_| View::direction(point(1.0))));
    views.extend([DVec3::X, DVec3::NEG_Y, DVec3::Z].map(View::direction));
    for face in 0..faces.len().min(6) as u32 {
        let [a, b, c] = [0, 1, 2].map(|k| DVec3::from(faces.corners(face)[k]));
        views.extend([a, a + (b - a) * 2.0, b + (c - b) * 3.0].map(|p| View::eye(faces, p)));
        views.extend([b - a, a - c].map(View::direction));
    }
    views
}

#[test]
fn fragments_face_the_side_that_rationals_say() {
    let mut dice = Dice(5);
    let mut counts = [0; 3];
    let square = |z: f64| vec![[0.1, 0.0, z], [1.0, 0.3, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let bent = vec![[0.0; 3], [1.0, 0.0, 0.2], [1.0, 1.0, -0.1], [0.0, 1.0, 0.3]];
    let squares = BuildOptions::DEFAULT.build([square(0.0), square(0.7), bent]).unwrap();
    let mut trees = vec![squares];
    for scene in [
        scene::random_triangles(60, 3),
        scene::crossing(5),
        scene::city(60, 1),
        scene::cornell_box(),
    ] {
        trees.push(BspTree::build(scene.polygons()).unwrap());
    }
    for tree in &trees {
        for view in viewpoints(tree, &mut dice) {
            for fragment in tree.fragments() {
                let plane = model::plane(tree.faces(), PlaneId::face(fragment.face()));
                let (found, expected) = (fragment.facing(view.viewpoint), view.side(&plane).into());
                assert_eq!(found, expected, "{fragment:?} {view:?}");
                counts[found as usize] += 1;
            }
        }
    }
    let [front, back, edge_on] = counts;
    assert!(back.min(front) > 2000 && edge_on > 200, "{counts:?}");
}

/// Tests the sign convention on a hand-made example.
#[test]
fn a_front_is_where_corners_run_counter_clockwise() {
    let tree = BspTree::build([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]).unwrap();
    let facing = |viewpoint| tree.fragment(0).facing(viewpoint);
    assert_eq!(facing(Viewpoint::eye([5.0, -9.0, 1e-12])), Facing::Front);
    assert_eq!(facing(Viewpoint::eye([0.2, 0.2, -1.0])), Facing::Back);
    assert_eq!(facing(Viewpoint::eye([7.0, 7.0, 0.0])), Facing::EdgeOn);
    assert_eq!(facing(Viewpoint::direction([0.0, 0.0, -1.0])), Facing::Front);
    assert_eq!(facing(Viewpoint::direction([3.0, 0.0, 1e-9])), Facing::Back);
    assert_eq!(facing(Viewpoint::direction([3.0, -1.0, 0.0])), Facing::EdgeOn);
    // As for orders: NaN is not an error.
    assert_eq!(facing(Viewpoint::direction([0.0; 3])), Facing::Front);
    assert_eq!(facing(Viewpoint::eye([0.0, 0.0, f64::NEG_INFINITY])), Facing::Back);
    assert_eq!(facing(Viewpoint::eye([f64::INFINITY, 0.0, 5.0])), Facing::EdgeOn);
}

/// A room with its walls facing inwards: from outside, the walls between the eye and the room are left out,
/// and everything behind them is visible.
#[test]
fn a_room_is_seen_from_outside_without_the_walls_that_face_away() {
    let room = scene::cornell_box();
    for scene in [room, scene::random_triangles(80, 9), scene::city(200, 3)] {
        let tree = BspTree::build(scene.polygons()).unwrap();
        let (low, high) = scene.bounds().unwrap();
        for camera in view::views([low, high], scene.up(), 6, [80, 60], 4).unwrap() {
            let seen = verify_fronts(&tree, &camera).unwrap();
            assert!(seen.is_right(), "{} {camera:?}", scene.name());
            let mut facing = vec![Facing::EdgeOn; tree.faces().len()];
            for fragment in tree.fragments() {
                facing[fragment.face() as usize] = fragment.facing(camera.viewpoint());
            }
            let shown = [&seen.painted, seen.truth.image()].map(|image| image.faces().iter());
            let shown = shown.into_iter().flatten().filter(|&&face| face != binspace::raster::NONE);
            assert!(shown.into_iter().all(|&face| facing[face as usize] == Facing::Front));
        }
    }
}
