//! The leaves of points, by planes in rationals.

use binspace::{Child, Ray};
use testkit::hits::Oracle;
use testkit::prelude::*;
use testkit::rational;
use testkit::shots::Shots;
use testkit::views::in_lattice;

#[test]
fn points_are_where_rationals_say() {
    let (mut dice, mut on_planes, mut in_leaves, mut points, mut inside) = (Dice(11), 0, 0, 0, 0);
    for scene in [
        scene::random_triangles(60, 2),
        scene::city(300, 1),
        scene::crossing(9),
        scene::cornell_box(),
        scene::layers(20, 1e-4),
    ] {
        for heuristic in [Heuristic::Auto, Heuristic::First, Heuristic::FreePlanes] {
            // Half of the trees have the default tolerance, with which a polygon may reach out of its leaf.
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
            let exact = options.clone().with_tolerance(0.0);
            let options = if heuristic == Heuristic::Auto { options } else { exact };
            let tree = options.build(scene.polygons()).unwrap();
            let (oracle, shots) = (Oracle::new(&tree), Shots::new(tree.faces()));
            for k in 0..120 {
                let point = match k % 4 {
                    0 => shots.corner(&mut dice),
                    1 => {
                        let face = dice.below(tree.faces().len()) as u32;
                        shots.on_plane(face, &mut dice)
                    }
                    2 => shots.around(1.1, &mut dice),
                    _ => shots.around(1e4, &mut dice),
                };
                let found = check(&oracle, point);
                on_planes += found.planes;
                inside += found.inside;
                points += 1;
                in_leaves += tree.locate(point).unwrap().fragments().len();
            }
        }
    }
    assert!(points == 15 * 120 && on_planes > 600 && in_leaves > 20, "{on_planes} {in_leaves}");
    enough!(inside > 20; "{inside}");
}

/// The number of planes that contain a point, and whether its leaf was tested.
struct Found {
    planes: usize,
    inside: usize,
}

/// Compares the path to a point's leaf with planes in rationals.
fn check(oracle: &Oracle<'_>, point: DVec3) -> Found {
    let tree = oracle.tree();
    let location = tree.locate(point).expect("a point within reach");
    let exact = in_lattice(oracle.faces().lattice(), point);
    let (mut last, mut is_in_front, mut planes) = (None, false, Vec::new());
    let mut part = tree.root().map_or(Child::Leaf(0..tree.len() as u32), Child::Node);
    while let Child::Node(node) = part {
        let side = rational::sign(&model::plane(oracle.faces(), node.plane()).at(&exact));
        if side == Ordering::Equal {
            planes.push(node);
        }
        (last, is_in_front) = (Some(node), side != Ordering::Less);
        part = if is_in_front { node.front() } else { node.back() };
    }
    assert_eq!((location.node(), location.is_in_front()), (last, is_in_front), "{point}");
    assert_eq!(Child::Leaf(location.fragments()), part);
    assert_eq!(location.planes(), planes);
    // A point on no plane is inside its leaf.
    let mut inside = 0;
    if planes.is_empty() && tree.faces().tolerance() == 0.0 {
        let polygon = |fragment| tree.fragment(fragment).polygon();
        let leaf: Vec<usize> = location.fragments().map(polygon).collect();
        for hit in tree.hits(Ray::between(point, point)) {
            assert!(leaf.contains(&hit.polygon()), "{point}");
            inside += 1;
        }
    }
    Found { planes: planes.len(), inside }
}

#[test]
fn a_tree_without_nodes_is_one_leaf() {
    let tree = BspTree::build::<[[f64; 3]; 3]>([]).unwrap();
    let location = tree.locate([0.2, 0.2, 0.0]).unwrap();
    assert!(location.node().is_none() && location.planes().is_empty());
    assert_eq!(location.fragments(), 0..0);
}

#[test]
fn locations_are_equal_in_one_leaf_and_on_the_same_planes_only() {
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let tree = BspTree::build([square(0.0), square(2.0)]).unwrap();
    let at = |z: f64| tree.locate([0.2, 0.3, z]).unwrap();
    // One node, whose front and back are leaves.
    let height = tree.root().unwrap().offset();
    assert_eq!(tree.nodes().len(), 1);
    let heights = [height - 0.5, height, height + 0.5];
    for (i, a) in heights.into_iter().enumerate() {
        assert_eq!(at(a), tree.locate([7.0, -3.0, a]).unwrap());
        for (j, b) in heights.into_iter().enumerate() {
            assert_eq!(at(a).node(), at(b).node());
            assert_eq!(at(a) == at(b), i == j, "{a} {b}");
        }
    }
    let other = tree.clone();
    assert!(heights.iter().all(|&z| at(z) != other.locate([0.2, 0.3, z]).unwrap()));
}
