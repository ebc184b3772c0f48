//! Where points are, by planes in rationals.

use super::support::dice::Dice;
use super::support::hits::Oracle;
use super::support::shots::Shots;
use super::support::{model, rational};
use binspace::glam::DVec3;
use binspace::scene;
use binspace::{BspTree, BuildOptions, Child, Heuristic, Ray};
use std::cmp::Ordering;

#[test]
fn points_are_where_rationals_say() {
    let (mut dice, mut on_planes, mut in_leaves, mut points) = (Dice(11), 0, 0, 0);
    for scene in [
        scene::random_triangles(60, 2),
        scene::city(300, 1),
        scene::crossing(9),
        scene::cornell_box(),
        scene::layers(20, 1e-4),
    ] {
        for heuristic in [Heuristic::Auto, Heuristic::First, Heuristic::FreePlanes] {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
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
                on_planes += check(&oracle, point);
                points += 1;
                in_leaves += tree.locate(point).unwrap().fragments().len();
            }
        }
    }
    assert!(points == 15 * 120 && on_planes > 600 && in_leaves > 20, "{on_planes} {in_leaves}");
}

/// Holds the way to a point's leaf against planes in rationals; gives how many it is on.
fn check(oracle: &Oracle<'_>, point: DVec3) -> usize {
    let tree = oracle.tree();
    let location = tree.locate(point).expect("a point within reach");
    let exact = oracle.to_lattice(point);
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
    // On no plane, it is inside of its leaf.
    if planes.is_empty() && tree.faces().tolerance() == 0.0 {
        let mut leaf = location.fragments().map(|fragment| tree.fragment(fragment).polygon());
        let mut containing = tree.hits(Ray::between(point, point));
        assert!(containing.all(|hit| leaf.any(|polygon| polygon == hit.polygon())), "{point}");
    }
    planes.len()
}

#[test]
fn a_tree_without_nodes_is_one_leaf() {
    let tree = BspTree::build::<[[f64; 3]; 3]>([]).unwrap();
    let location = tree.locate([0.2, 0.2, 0.0]).unwrap();
    assert!(location.node().is_none() && location.planes().is_empty());
    assert_eq!(location.fragments(), 0..0);
}
