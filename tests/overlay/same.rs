//! Tests whether two viewpoints have the same order of a tree and an overlay.

use binspace::overlay::Overlay;
use testkit::prelude::*;

/// Two eyes in one cell have the same order. If a plane of the overlay lies between two eyes, they are
/// distinguished, although they are in one cell of the tree.
#[test]
fn eyes_with_the_same_order_write_the_same_list() {
    let mut dice = Dice(5);
    let [mut same, mut other, mut by_overlay] = [0; 3];
    for scene in [scene::city(100, 1), scene::random_triangles(12, 2), scene::cornell_box()] {
        let (low, high) = scene.bounds().expect("corners");
        let size = (high - low).max_element();
        let mut place = || low + (high - low) * dice.point(0.0, 1.0);
        let movers: Vec<[DVec3; 3]> = (0..6).map(|_| [place(), place(), place()]).collect();
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        let mut overlay = Overlay::new(&tree);
        overlay.replace(&tree, &movers).expect("on the grid");
        let list = |eye: Viewpoint| {
            let mut numbers = vec![];
            overlay.order(&tree, eye).expect("its own tree").write_into(&mut numbers);
            numbers
        };
        for _ in 0..400 {
            let eye = place();
            let step = (place() - place()) * 10f64.powi(-(1 + (eye.x.to_bits() % 5) as i32));
            let [one, two] =
                [eye, eye + step.clamp(-size * DVec3::ONE, size * DVec3::ONE)].map(Viewpoint::Eye);
            let is_same = overlay.same_order(&tree, one, two).expect("its own tree");
            assert_eq!(overlay.same_order(&tree, two, one), Ok(is_same));
            assert_eq!(overlay.same_order(&tree, one, one), Ok(true));
            let lists_agree = list(one) == list(two);
            assert!(lists_agree || !is_same, "{one:?} {two:?}");
            assert!(tree.same_order(one, two) || !is_same, "{one:?} {two:?}");
            same += usize::from(is_same);
            other += usize::from(!lists_agree);
            by_overlay += usize::from(tree.same_order(one, two) && !lists_agree);
        }
    }
    enough!(same > 200, other > 100, by_overlay > 5; "{same} {other} {by_overlay}");
}

#[test]
fn only_a_plane_between_two_eyes_tells_them_apart() {
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let tree = BspTree::build([square(0.0), square(4.0)]).expect("two squares");
    let mut overlay = Overlay::new(&tree);
    let eye = |z: f64| Viewpoint::eye([0.5, 0.5, z]);
    assert_eq!(overlay.same_order(&tree, eye(1.0), eye(3.0)), Ok(true));
    overlay.replace(&tree, [square(2.0), square(2.5)]).expect("on the grid");
    for (one, other, is_same) in
        [(1.0, 3.0, false), (1.0, 1.5, true), (-1.0, 1.0, false), (3.0, 3.5, true)]
    {
        assert_eq!(overlay.same_order(&tree, eye(one), eye(other)), Ok(is_same), "{one} {other}");
    }
    let another = BspTree::build([square(0.0), square(4.0)]).expect("two squares");
    assert!(overlay.same_order(&another, eye(1.0), eye(3.0)).is_err());
}
