//! Nodes and their planes.

use crate::walk::{scenes, trees};
use binspace::{Child, Facing, Node};
use testkit::prelude::*;
use testkit::rational::Plane;

/// All nodes below a node, depth first, by its children.
fn below(root: Node<'_>) -> Vec<Node<'_>> {
    let (mut found, mut pending) = (Vec::new(), vec![root]);
    while let Some(node) = pending.pop() {
        found.push(node);
        for child in [node.back(), node.front()] {
            if let Child::Node(child) = child {
                assert_eq!(child.depth(), node.depth() + 1);
                pending.push(child);
            }
        }
    }
    found
}

#[test]
fn the_children_lead_to_all_nodes_and_the_ranges_to_all_fragments() {
    let mut deep = 0;
    for tree in trees() {
        let nodes: Vec<Node<'_>> = tree.nodes().collect();
        assert_eq!(tree.root(), nodes.first().copied());
        assert_eq!(tree.root().map_or(vec![], below), nodes);
        let mut met = vec![0; tree.len()];
        for (index, node) in nodes.iter().enumerate() {
            assert_eq!(node.index(), index);
            let mut parts = vec![node.on()];
            for (child, all) in [(node.front(), node.in_front()), (node.back(), node.behind())] {
                match child {
                    Child::Node(child) => assert_eq!(child.fragments(), all),
                    Child::Leaf(run) => {
                        assert_eq!(run, all);
                        assert!(run.len() <= 1);
                        parts.push(run);
                    }
                }
            }
            parts.into_iter().flatten().for_each(|fragment| met[fragment as usize] += 1);
            let mut all: Vec<u32> = node.on().chain(node.in_front()).chain(node.behind()).collect();
            all.sort_unstable();
            assert!(all.into_iter().eq(node.fragments()));
            deep = node.depth().max(deep);
        }
        assert!(met.iter().all(|&count| count == 1), "{met:?}");
        assert_eq!(tree.root().is_none(), tree.is_empty());
    }
    enough!(deep > 20; "{deep}");
}

/// Compares planes with the given polygons in rationals, without the lattice and without code of the library.
#[test]
fn planes_belong_to_the_polygons_that_they_name() {
    let [mut named, mut free] = [0; 2];
    for scene in scenes() {
        for heuristic in [Heuristic::default(), Heuristic::FreePlanes] {
            let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
            let tree = options.build(&scene).unwrap();
            let all = scene.iter().flatten();
            let [low, high] = all
                .clone()
                .fold([DVec3::MAX, DVec3::MIN], |[low, high], &p| [low.min(p), high.max(p)]);
            let size = low.abs().max(high.abs()).max_element();
            let step = (high - low).max_element() * 2f64.powi(-51) + size * 2f64.powi(-50);
            for node in tree.nodes() {
                let (normal, offset) = (node.normal(), node.offset());
                assert!((normal.length() - 1.0).abs() < 1e-15);
                let Some(polygon) = node.polygon() else {
                    let axis = normal.abs().max_position();
                    assert_eq!(normal, DVec3::AXES[axis]);
                    assert!(all.clone().any(|p| (p[axis] - offset).abs() <= step));
                    free += 1;
                    continue;
                };
                // All corners are on the plane, up to the grid and the tolerance.
                let slack = step * 4.0 + tree.stats().tolerance;
                // The plane of a bent polygon contains the corners of one of its triangles.
                let is_on = |p: &&DVec3| (normal.dot(**p) - offset).abs() <= slack;
                let on = scene[polygon].iter().filter(is_on).count();
                enough!(on >= 3; "{node:?} of {polygon}");
                if let [a, b, c] = scene[polygon][..] {
                    let exact = Plane::through([a, b, c].map(rational::point).each_ref());
                    let largest = exact.normal.iter().map(Signed::abs).max().unwrap();
                    let unit = exact.normal.each_ref().map(|c| (c / &largest).to_f64().value());
                    let unit = DVec3::from(unit).normalize();
                    // The grid moves a corner by up to a step, which turns thin triangles by a larger angle.
                    let [u, v] = [b - a, c - a];
                    let height = u.cross(v).length() / u.length().max(v.length());
                    let turned = 4.0 * step / height + 1e-15;
                    assert!((unit - normal).length() <= turned, "{unit} {normal} {turned:e}");
                    named += 1;
                }
            }
        }
    }
    enough!(named > 300, free > 100; "{named} {free}");
}

/// Fragments have the planes of their faces, for any cuts. Compared in rationals on the grid.
#[test]
fn fragments_tell_the_planes_of_their_faces() {
    let (mut fragments, mut on_nodes) = (0, 0);
    for tree in trees() {
        let grid = tree.grid();
        let two = rational::exact(2.0);
        let step = num_traits::pow(two.clone(), grid.exponent.unsigned_abs() as usize);
        let step = if grid.exponent < 0 { rational::Rational::ONE / step } else { step };
        let base = rational::point(grid.base);
        for fragment in tree.fragments() {
            let points = fragment.grid_points().map(|g| -> rational::Point {
                std::array::from_fn(|i| &base[i] + &step * rational::Rational::from(g[i]))
            });
            let plane = Plane::through(points.each_ref());
            let largest = plane.normal.iter().map(Signed::abs).max().unwrap();
            let scaled = plane.normal.each_ref().map(|c| c / &largest);
            let unit = DVec3::from(scaled.each_ref().map(|c| c.to_f64().value())).normalize();
            let (normal, offset) = (fragment.normal(), fragment.offset());
            assert!((normal - unit).abs().max_element() <= 3.0 * f64::EPSILON, "{normal} {unit}");
            // The square of the exact offset, because roots are irrational.
            let square = |x: &rational::Rational| x * x;
            let length = rational::total(scaled.iter().map(square));
            let exact = rational::scalar(&scaled, &points[0]);
            let size = points.iter().flatten().map(Signed::abs).max().unwrap();
            let slack = size * rational::exact(12.0 * f64::EPSILON);
            let offset = rational::exact(offset);
            let [low, high] = [&offset - &slack, &offset + &slack];
            // low <= exact / root(length) <= high.
            let signed = |x: &rational::Rational| x * x.abs();
            assert!(signed(&low) * &length <= signed(&exact), "{fragment:?}");
            assert!(signed(&exact) <= signed(&high) * &length, "{fragment:?}");
            fragments += 1;
        }
        for node in tree.nodes() {
            for index in node.on() {
                let fragment = tree.fragment(index);
                if node.polygon() == Some(fragment.polygon())
                    && fragment.grid_points() == node.grid_points()
                {
                    assert_eq!(
                        (fragment.normal(), fragment.offset()),
                        (node.normal(), node.offset())
                    );
                    on_nodes += 1;
                }
            }
        }
    }
    enough!(fragments > 3000, on_nodes > 1000; "{fragments} {on_nodes}");
}

#[test]
fn the_front_of_a_fragment_is_where_its_corners_run_counter_clockwise() {
    let up = [[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
    let [a, b, c] = up;
    let tree = BspTree::build([up, [c, b, a]]).unwrap();
    let of = |index: u32| (tree.fragment(index).normal(), tree.fragment(index).offset());
    assert_eq!([of(0), of(1)], [(DVec3::Z, 2.0), (DVec3::NEG_Z, -2.0)]);
}

#[test]
fn nodes_of_two_trees_are_never_equal() {
    let trees =
        [1, 1].map(|seed| BspTree::build(binspace::scene::city(30, seed).polygons()).unwrap());
    let [ours, others] = trees.each_ref().map(|tree| tree.nodes().collect::<Vec<_>>());
    assert!(ours.len() > 10 && ours.len() == others.len());
    for (k, node) in ours.iter().enumerate() {
        assert!(ours.iter().enumerate().all(|(j, other)| (node == other) == (j == k)));
        assert!(others.iter().all(|other| node != other));
    }
}

#[test]
fn a_node_returns_the_side_of_a_viewpoint() {
    use binspace::Viewpoint;
    let tree = BspTree::build([[[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]]]).unwrap();
    let root = tree.root().unwrap();
    assert_eq!((root.normal(), root.offset(), root.polygon()), (DVec3::Z, 2.0, Some(0)));
    let facing = |z: f64| root.facing(Viewpoint::eye([9.0, 9.0, z]));
    assert_eq!(
        [2.0f64.next_up(), 2.0, 1.0].map(facing),
        [Facing::Front, Facing::EdgeOn, Facing::Back]
    );
    assert_eq!(root.facing(Viewpoint::direction([0.0, 0.0, -1.0])), Facing::Front);
    assert_eq!(root.facing(Viewpoint::direction([1.0, 0.0, 0.0])), Facing::EdgeOn);
}
