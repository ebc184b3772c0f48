//! Culled orders of a tree and an overlay, compared with the vertices of all shapes.

use binspace::overlay::{Overlay, Shape, Shapes};
use binspace::{Culling, Facing, Frustum};
use testkit::prelude::*;

/// The points that decide whether a shape is in a frustum, and the side that the shape shows.
fn looked_at(shape: Shape<'_>, viewpoint: Viewpoint) -> (Vec<DVec3>, Option<Facing>) {
    match shape {
        Shape::Fragment(piece) => (piece.vertices().collect(), Some(piece.facing(viewpoint))),
        Shape::Segment(segment) => (segment.ends().to_vec(), None),
        Shape::Marker(marker) => (vec![marker.position()], None),
        _ => unreachable!(),
    }
}

#[test]
fn a_culled_order_is_the_whole_order_without_outside_and_back_facing_fragments() {
    let mut dice = Dice(17);
    let [mut kept, mut outside, mut turned, mut lines] = [0; 4];
    for scene in [scene::city(300, 1), scene::random_triangles(60, 2), scene::cornell_box()] {
        let (low, high) = scene.bounds().expect("corners");
        let size = (high - low).max_element();
        let mut place = || low + (high - low) * dice.point(0.0, 1.0);
        let movers: Vec<[DVec3; 3]> = (0..30).map(|_| [place(), place(), place()]).collect();
        let threads: Vec<[DVec3; 2]> = (0..10).map(|_| [place(), place()]).collect();
        let points: Vec<DVec3> = (0..20).map(|_| place()).collect();
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        let mut overlay = Overlay::new(&tree);
        let shapes = Shapes::NONE.with_polygons(&movers).with_lines(&threads).with_points(points);
        overlay.replace_with(&tree, shapes).expect("on the grid");
        for (viewpoint, drawn) in [
            (Viewpoint::Eye(place()), None),
            (Viewpoint::Eye(high * 2.0), Some(Facing::Front)),
            (Viewpoint::direction([0.3, -0.2, -1.0]), Some(Facing::Back)),
        ] {
            let planes: Vec<(DVec3, f64)> = (0..3)
                .map(|_| {
                    let normal = (place() - place()).normalize();
                    (normal, normal.dot(place()))
                })
                .collect();
            let mut culling = Culling::NONE.with_frustum(Frustum::new(planes.clone()));
            if let Some(drawn) = drawn {
                culling = culling.with_facing(drawn);
            }
            let order = overlay.order(&tree, viewpoint).expect("its own tree").culled(&culling);
            let mut left = Vec::new();
            order.write_into(&mut left);
            assert!(order.into_iter().map(|shape| shape.index()).eq(left.iter().copied()));
            let mut reverse = Vec::new();
            order.front_to_back().write_into(&mut reverse);
            assert!(reverse.iter().rev().eq(&left));

            let mut left = left.into_iter().peekable();
            for shape in overlay.order(&tree, viewpoint).expect("its own tree") {
                let is_kept = left.next_if_eq(&shape.index()).is_some();
                let (points, facing) = looked_at(shape, viewpoint);
                let is_turned = drawn.zip(facing).is_some_and(|(drawn, facing)| drawn != facing);
                let furthest = points.iter().copied().reduce(DVec3::max).expect("a point");
                let nearest = points.iter().copied().reduce(DVec3::min).expect("a point");
                let reach = planes.iter().map(|&(normal, offset)| {
                    let corner = DVec3::select(normal.cmpgt(DVec3::ZERO), furthest, nearest);
                    normal.dot(corner) - offset
                });
                let reach = reach.fold(f64::INFINITY, f64::min);
                match (is_turned, reach / size) {
                    (true, _) => assert!(!is_kept, "{shape:?}"),
                    (false, 0.0..) => assert!(is_kept, "{shape:?} {reach}"),
                    (false, ..-1e-5) => assert!(!is_kept, "{shape:?} {reach}"),
                    _ => {}
                }
                let is_moving = shape.index() as usize >= tree.len();
                kept += usize::from(is_kept && is_moving);
                outside += usize::from(!is_kept && !is_turned && is_moving);
                turned += usize::from(is_turned && is_moving);
                lines += usize::from(facing.is_none() && is_kept);
            }
            assert_eq!(left.next(), None, "every number of the list is in the whole order");
        }
    }
    enough!(kept > 200, outside > 200, turned > 200, lines > 60; "{kept} {outside} {turned} {lines}");
}

/// Coplanar pieces keep their input order after the fragments on their plane, with and without culling. The
/// earlier contents of a buffer are replaced.
#[test]
fn coplanar_pieces_keep_their_places() {
    let square = |x: f64, z: f64| [[x, 0.0, z], [x + 1.0, 0.0, z], [x + 1.0, 1.0, z], [x, 1.0, z]];
    let tree = BspTree::build((0..8).map(|k| square(f64::from(k % 4), f64::from(k / 4)))).unwrap();
    let mut overlay = Overlay::new(&tree);
    let shifted = |x: f64, z: f64| square(x, z).map(|[x, y, z]| [x + 0.25, y / 2.0, z]);
    let pieces = (0..12).map(|k| shifted(f64::from(k % 3), 0.5 * f64::from(k / 3)));
    overlay.replace(&tree, pieces).unwrap();
    let culling = Culling::NONE.with_frustum(Frustum::new([(DVec3::NEG_X, -2.6)]));
    let (mut left, mut right) = (0, 0);
    for height in [-9.0, 0.2, 0.7, 9.0] {
        let order = overlay.order(&tree, Viewpoint::eye([2.0, 0.3, height])).unwrap();
        let (mut whole, mut culled) = (vec![], vec![77; 5]);
        order.write_into(&mut whole);
        order.culled(&culling).write_into(&mut culled);
        assert!(whole.len() == overlay.len() + tree.len());
        right += whole.len() - culled.len();
        left += culled.len();
        let mut rest = whole.into_iter();
        assert!(culled.iter().all(|number| rest.any(|next| next == *number)), "{culled:?}");
    }
    enough!(left > 40, right > 4; "{left} {right}");
}

/// Without shapes, the culled order is the tree's own culled order.
#[test]
fn an_empty_overlay_culls_as_its_tree_does() {
    let tree = BspTree::build(scene::city(200, 1).polygons()).expect("within budget");
    let [low, high] = tree.bounds().expect("polygons");
    let culling = Culling::NONE.with_frustum(Frustum::from_box([low, (low + high) * 0.5]));
    let viewpoint = Viewpoint::Eye(high * 1.5);
    let (mut own, mut both) = (Vec::new(), Vec::new());
    tree.order(viewpoint).culled(&culling).write_into(&mut own);
    let overlay = Overlay::new(&tree);
    overlay.order(&tree, viewpoint).expect("its own").culled(&culling).write_into(&mut both);
    assert!(own == both && !own.is_empty() && own.len() < tree.len(), "{}", own.len());
}

/// Pieces that are seen edge-on are kept only by `Facing::EdgeOn`.
#[test]
fn pieces_seen_edge_on_are_of_neither_side() {
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let tree = BspTree::build([square(0.0), square(2.0)]).unwrap();
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, [[[0.5, 0.0, 0.2], [0.5, 1.0, 0.2], [0.5, 1.0, 0.8]]]).unwrap();
    let order = |facing: Facing| {
        let culling = Culling::NONE.with_facing(facing);
        let order = overlay.order(&tree, Viewpoint::eye([0.5, 0.3, 9.0])).unwrap();
        let shapes = order.culled(&culling).into_iter();
        shapes.map(|shape| shape.index()).collect::<Vec<u32>>()
    };
    assert_eq!(order(Facing::EdgeOn), [2]);
    assert_eq!(order(Facing::Front), [0, 1]);
    assert_eq!(order(Facing::Back), []);
}
