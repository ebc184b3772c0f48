//! Boxes against exact vertices.

use crate::support::model::Face;
use crate::support::rational::{self, Point, Rational};
use crate::trees;
use binspace::BspTree;
use binspace::glam::DVec3;
use num_traits::ToPrimitive;

/// The exact vertices of each fragment, in the world.
fn vertices(tree: &BspTree) -> Vec<Vec<Point>> {
    let faces = tree.faces();
    let lattice = faces.lattice();
    // A power of two, and a whole number of these: both exact.
    let step = rational::exact(lattice.length_to_world(1.0));
    let origin = rational::point(lattice.to_world([0.0; 3]));
    let world = |p: Point| -> Point { std::array::from_fn(|i| &p[i] * &step + &origin[i]) };
    let all: Vec<Face> = (0..faces.len() as u32).map(|face| Face::new(faces, face)).collect();
    let of = |fragment: binspace::Fragment<'_>| {
        let face = &all[fragment.face() as usize];
        fragment.symbols().map(|symbol| world(face.resolve(faces, symbol))).collect()
    };
    tree.fragments().map(of).collect()
}

/// The least and the largest coordinates.
fn hull<'a>(points: impl Iterator<Item = &'a Point> + Clone) -> [Point; 2] {
    let by = |pick: fn(Rational, Rational) -> Rational| {
        std::array::from_fn(|i| points.clone().map(|p| p[i].clone()).reduce(pick).unwrap())
    };
    [by(Rational::min), by(Rational::max)]
}

#[test]
fn boxes_hold_every_vertex_exactly_and_are_hardly_larger() {
    let [mut cut, mut exact] = [0; 2];
    for tree in trees().into_iter().filter(|tree| !tree.is_empty()) {
        let bounds = tree.bounds().unwrap();
        let vertices = vertices(&tree);
        let [low, high] = bounds.all().unwrap();
        let extent = (high - low).max_element();
        let mut check = |[low, high]: [DVec3; 2], range: std::ops::Range<u32>, what: &str| {
            let range = range.start as usize..range.end as usize;
            let [least, most] = hull(vertices[range].iter().flatten());
            for axis in 0..3 {
                for (outer, inner, sign) in
                    [(low[axis], &least[axis], 1.0), (high[axis], &most[axis], -1.0)]
                {
                    let beyond = (inner - rational::exact(outer)).to_f64().unwrap() * sign;
                    let slack = extent * 2f64.powi(-51) + 3.0 * outer.abs() * f64::EPSILON;
                    assert!((0.0..=slack).contains(&beyond), "{what}: {beyond:e} of {slack:e}");
                    exact += usize::from(beyond == 0.0);
                }
            }
        };
        check([low, high], 0..tree.len() as u32, "all");
        for fragment in tree.fragments() {
            let index = fragment.index();
            let [low, high] = bounds.of_fragment(index);
            check([low, high], index..index + 1, "fragment");
            assert!(fragment.vertices().all(|p| p.clamp(low, high) == p));
            cut += usize::from(!fragment.is_whole());
        }
        for node in tree.nodes() {
            check(bounds.of(node), node.fragments(), "node");
        }
    }
    assert!(cut > 1000 && exact > 1000, "{cut} {exact}");
}

#[test]
fn a_tree_of_nothing_has_no_box() {
    let bounds = BspTree::build::<[[f64; 3]; 3]>([]).unwrap().bounds().unwrap();
    assert_eq!(bounds.all(), None);
}
