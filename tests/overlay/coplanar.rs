//! Coplanar polygons come in input order, and an overlay of nothing changes nothing.

use binspace::glam::{DVec3, dvec3};
use binspace::{BspTree, BuildOptions, Overlay, Viewpoint, scene};

fn square(x: f64, z: f64) -> Vec<DVec3> {
    let point = |a: f64, b: f64| dvec3(x + a, b, z);
    vec![point(0.0, 0.0), point(2.0, 0.0), point(2.0, 2.0), point(0.0, 2.0)]
}

/// A decal lies over what it is coplanar with, from both sides, in leaves and on planes of nodes.
#[test]
fn decals_come_after_what_they_lie_on() {
    let still: Vec<_> = (0..40).map(|k| square(f64::from(k), f64::from(k % 3))).collect();
    let bounds = [DVec3::splat(-1.0), DVec3::splat(50.0)];
    let options = BuildOptions::DEFAULT.with_bounds(bounds[0], bounds[1]);
    let tree = options.build(&still).expect("a tree");
    let mut overlay = Overlay::new(&tree);
    let mut reversed = square(7.5, 1.0);
    reversed.reverse();
    let decals = [square(6.5, 1.0), square(7.0, 1.0), reversed, square(6.0, 1.0 + 1e-9)];
    overlay.replace(&tree, &decals).expect("on the grid");
    for z in [9.0, -9.0] {
        for viewpoint in [Viewpoint::eye([7.0, 1.0, z]), Viewpoint::direction([0.0, 0.1, -z])] {
            let order = overlay.back_to_front(&tree, viewpoint).expect("its own tree");
            let layer = |z: f64| (z - 1.0).abs() < 1e-6;
            let level = order.filter(|f| layer(f.vertices().next().expect("a vertex").z));
            let near = level.filter(|f| (5..=8).contains(&f.polygon()) || f.polygon() >= 40);
            let polygons: Vec<usize> = near.map(|f| f.polygon()).collect();
            let place = |wanted: usize| {
                let mut places = (0..polygons.len()).filter(move |&at| polygons[at] == wanted);
                [places.clone().next(), places.next_back()].map(|place| place.expect("a place"))
            };
            let place = |wanted| place.clone()(wanted);
            for pair in [7, 40, 41, 42, 43].windows(2) {
                assert!(place(pair[0])[1] < place(pair[1])[0], "{pair:?} from {viewpoint:?}");
            }
        }
    }
}

#[test]
fn an_overlay_of_nothing_gives_the_order_of_the_tree() {
    for scene in [scene::city(400, 2), scene::random_triangles(60, 3), scene::chain(1)] {
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        let mut overlay = Overlay::new(&tree);
        let (mut order, mut still) = (Vec::new(), Vec::new());
        for round in 0..4 {
            let eye = Viewpoint::eye([f64::from(round), 2.0, 3.0]);
            let moving = (round == 2).then(|| scene.polygons().next().expect("a polygon"));
            overlay.replace(&tree, moving).expect("on the grid");
            overlay.back_to_front_into(&tree, eye, &mut order).expect("its own tree");
            tree.back_to_front_into(eye, &mut still);
            assert_eq!(overlay.is_empty(), round != 2);
            assert_eq!(order == still, round != 2, "{}", scene.name());
            let listed = overlay.back_to_front(&tree, eye).expect("its own tree");
            assert!(listed.map(|f| f.index()).eq(order.iter().copied()));
        }
    }
}

/// Without a tree the overlay is a tree of its own.
#[test]
fn an_empty_tree_can_have_an_overlay() {
    let bounds = [DVec3::splat(-5.0), DVec3::splat(5.0)];
    let options = BuildOptions::DEFAULT.with_bounds(bounds[0], bounds[1]);
    let tree = options.build(Vec::<[DVec3; 3]>::new()).expect("a tree of nothing");
    let mut overlay = Overlay::new(&tree);
    overlay.replace(&tree, [square(0.0, 0.5), square(0.0, 0.25), square(0.0, 0.75)]).expect("fits");
    let order = overlay.back_to_front(&tree, Viewpoint::direction([0.0, 0.0, -1.0])).expect("own");
    assert!(order.map(|f| f.polygon()).eq([1, 0, 2]));
}
