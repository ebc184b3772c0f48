//! Trees of convex bodies, which are built by peeling piece by piece. They are valid, uncut, in input order
//! on each plane, and within their budgets.

use binspace::ErrorKind;
use binspace::glam::{DQuat, EulerRot};
use testkit::prelude::*;
use testkit::scenes::triangles;

/// A rotated cube, each side a grid of squares that face one way, in random order.
fn cube(side: usize, inwards: bool) -> Vec<[DVec3; 4]> {
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7);
    let mut squares = Vec::new();
    for (axis, end) in (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]) {
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            let corner = |u: usize, v: usize| {
                let at = |k: usize| 2.0 * k as f64 / side as f64 - 1.0;
                let mut p = [end, at(i + u), at(j + v)];
                p.rotate_right(axis);
                turn * DVec3::from_array(p)
            };
            let mut square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if (end > 0.0) == inwards {
                square.reverse();
            }
            squares.push(square);
        }
    }
    let n = squares.len();
    let step = (n * 3 / 8..n).find(|step| (2..=*step).all(|d| n % d > 0 || step % d > 0));
    (0..n).map(|k| squares[k * step.expect("a step") % n]).collect()
}

#[test]
fn convex_bodies_are_taken_apart_in_input_order_within_their_depth() {
    let (mut shared, mut single) = (0, 0);
    for (side, inwards) in [1, 2, 3, 5, 7, 8, 12].into_iter().flat_map(|n| [(n, false), (n, true)])
    {
        let cube = cube(side, inwards);
        for count in [cube.len(), cube.len() - 1, cube.len() / 2 + 1] {
            let polygons = &cube[..count];
            let options = BuildOptions::DEFAULT.with_tolerance(1e-9);
            let tree: BspTree = options.build(polygons).expect("within budget");
            assert_eq!(tree.validate(), Ok(()), "{count} of {side}");
            assert_eq!(tree.len(), count, "{side}");
            let depth = tree.stats().depth_max;
            assert!(options.clone().with_max_depth(depth).build(polygons).is_ok());
            let less = options.with_max_depth(depth - 1).build(polygons);
            assert!(
                less.is_err_and(|error| error.kind() == ErrorKind::OverBudget),
                "{count} of {side}"
            );
            shared += tree.nodes().filter(|node| node.on().len() > 2).count();
            single += tree.nodes().filter(|node| node.on().len() == 1).count();
        }
    }
    enough!(shared > 50, single > 10; "{shared} {single}");
}

/// A body is peeled first, and what is inside it is divided at a greater depth. With a second body beside it, the
/// peeling itself begins below another node.
#[test]
fn what_is_inside_a_convex_body_counts_from_the_depth_of_its_layers() {
    let mut dice = Dice(5);
    let mut polygons: Vec<Corners> = cube(8, false).iter().map(|square| square.to_vec()).collect();
    polygons.extend(triangles(&mut dice, 40, [-0.2, 0.2], 0.1));
    let apart = |polygon: &Corners| polygon.iter().map(|&p| p + 9.0 * DVec3::X).collect();
    let beside: Vec<Corners> = polygons.iter().map(apart).collect();
    for polygons in [polygons.clone(), [polygons, beside].concat()] {
        let options = BuildOptions::DEFAULT;
        let tree: BspTree = options.build(&polygons).expect("within budget");
        let depth = tree.stats().depth_max;
        assert!(depth > 10, "{depth}");
        assert!(options.clone().with_max_depth(depth).build(&polygons).is_ok());
        assert!(options.with_max_depth(depth - 1).build(&polygons).is_err(), "{depth}");
    }
}
