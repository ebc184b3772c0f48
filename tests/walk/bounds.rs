//! Boxes compared with exact vertices.

use crate::walk::trees;
use testkit::model::Face;
use testkit::prelude::*;
use testkit::rational::Point;

/// The exact vertices of each fragment, in the world.
fn vertices(tree: &BspTree) -> Vec<Vec<Point>> {
    let faces = tree.faces();
    let lattice = faces.lattice();
    // The step is a power of two, and the origin is a whole number of steps, so both are exact.
    let step = rational::step(lattice);
    let origin = rational::point(lattice.to_world([0.0; 3]));
    let world = |p: Point| -> Point { std::array::from_fn(|i| &p[i] * &step + &origin[i]) };
    let all: Vec<Face> = (0..faces.len() as u32).map(|face| Face::new(faces, face)).collect();
    let of = |fragment: binspace::Fragment<'_>| {
        let face = &all[fragment.face() as usize];
        fragment.vertex_ids().map(|vertex_id| world(face.resolve(faces, vertex_id))).collect()
    };
    tree.fragments().map(of).collect()
}

/// The least and the largest coordinates.
fn hull<'a>(points: impl Iterator<Item = &'a Point> + Clone) -> [Point; 2] {
    let along = |i: usize| points.clone().map(move |p| &p[i]);
    [
        [0, 1, 2].map(|i| along(i).min().unwrap().clone()),
        [0, 1, 2].map(|i| along(i).max().unwrap().clone()),
    ]
}

#[test]
fn boxes_hold_every_vertex_exactly_and_are_hardly_larger() {
    let [mut cut, mut exact] = [0; 2];
    for tree in trees().into_iter().filter(|tree| !tree.is_empty()) {
        // Of each fragment.
        let hulls: Vec<[Point; 2]> = vertices(&tree).iter().map(|v| hull(v.iter())).collect();
        let [low, high] = tree.bounds().unwrap();
        let extent = (high - low).max_element();
        let mut check = |[low, high]: [DVec3; 2], range: std::ops::Range<u32>, what: &str| {
            let range = range.start as usize..range.end as usize;
            let [least, most] = hull(hulls[range].iter().flatten());
            for axis in 0..3 {
                for (outer, inner, sign) in
                    [(low[axis], &least[axis], 1.0), (high[axis], &most[axis], -1.0)]
                {
                    let beyond = (inner - rational::exact(outer)).to_f64().value() * sign;
                    let slack = extent * 2f64.powi(-23) + 3.0 * outer.abs() * f64::EPSILON;
                    assert!((0.0..=slack).contains(&beyond), "{what}: {beyond:e} of {slack:e}");
                    exact += usize::from(beyond == 0.0);
                }
            }
        };
        check([low, high], 0..tree.len() as u32, "all");
        for fragment in tree.fragments() {
            let index = fragment.index();
            let [low, high] = tree.fragment(index).bounds();
            check([low, high], index..index + 1, "fragment");
            assert!(fragment.vertices().all(|p| p.clamp(low, high) == p));
            cut += usize::from(!fragment.is_whole());
        }
        for node in tree.nodes() {
            check(node.bounds(), node.fragments(), "node");
        }
    }
    enough!(cut > 1000, exact > 1000; "{cut} {exact}");
}

/// Corners that the tolerance moves are stored as the nearest points of the grid, so exact corners may be
/// outside by half a step. Exact vertices of cuts are on either side of the rounded vertices. Scenes are
/// around the origin, where the box itself is not rounded outwards.
#[test]
fn boxes_hold_corners_that_are_moved_and_vertices_that_are_rounded() {
    let mut dice = Dice(8);
    let [mut moved, mut cut, mut beyond] = [0; 3];
    for _ in 0..times(60) {
        let mut share = || dice.point(-0.5, 0.5);
        // Polygons that cross each other, and that are planar except for a rounding that counts.
        let quad = |_| {
            let (at, u, v) = (share() * 0.25, share(), share());
            [at - u, at - v, at + u * 0.9, at + v * 1.1].map(|p| p + share() * 1e-12)
        };
        let options = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-2.0), DVec3::splat(2.0));
        let tree = options.build((0..4).map(quad)).unwrap();
        let vertices = vertices(&tree);
        for fragment in tree.fragments() {
            let index = fragment.index();
            let [low, high] = tree.fragment(index).bounds();
            let [least, most] = hull(vertices[index as usize].iter());
            let rounded = fragment.vertices().reduce(DVec3::max).unwrap();
            for axis in 0..3 {
                assert!(rational::exact(low[axis]) <= least[axis], "{index}");
                assert!(rational::exact(high[axis]) >= most[axis], "{index}");
                beyond += usize::from(rational::exact(rounded[axis]) < most[axis]);
            }
            moved += usize::from(fragment.is_whole());
            cut += usize::from(!fragment.is_whole());
        }
    }
    assert!(moved + cut > 400 && beyond > 200, "{moved} {cut} {beyond}");
}

#[test]
fn a_tree_of_nothing_has_no_box() {
    assert_eq!(BspTree::build::<[[f64; 3]; 3]>([]).unwrap().bounds(), None);
}

/// A triangle with an edge that leans by 2⁻⁵⁰ over its height of 1. A floor cuts it at the height 2⁻¹², at x
/// = ½ + 2⁻⁶², which an `f64` cannot hold.
#[test]
fn a_box_has_room_for_the_rounding_of_a_cut() {
    let foot = 2f64.powi(-12);
    let floor = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let triangle = [[0.5, 0.0, -foot], [0.5 + 2f64.powi(-50), 0.0, 1.0 - foot], [-0.5, 0.25, -0.5]];
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).with_tolerance(0.0);
    let tree = options.build([floor.to_vec(), triangle.to_vec()]).unwrap();
    let mut lower =
        tree.fragments().filter(|f| f.polygon() == 1 && f.vertices().all(|p| p.z < 0.5));
    let fragment = lower.next().expect("the part below the floor");
    assert_eq!(fragment.vertices().map(|p| p.x).fold(-1.0, f64::max), 0.5);
    let [_, high] = tree.fragment(fragment.index()).bounds();
    assert!(high.x > 0.5, "{high} leaves out the cut");
    let root = tree.root().expect("the floor's node");
    assert!(root.bounds()[1].x > 0.5 && tree.bounds().unwrap()[1].x > 0.5);
}

/// The box of a tree is the box of its polygons, for any number of polygons, and at any place in given
/// bounds.
#[test]
fn polygons_in_a_corner_of_their_room_have_a_small_box() {
    let options = BuildOptions::DEFAULT.with_bounds(DVec3::splat(-100.0), DVec3::splat(100.0));
    for count in [1, 15, 16, 17, 100, 256, 257] {
        let square = |k: u32| {
            let z = 50.0 + f64::from(k) / 256.0;
            [[50.0, 50.0, z], [51.0, 50.0, z], [51.0, 51.0, z], [50.0, 51.0, z]]
        };
        let tree = options.build((0..count).map(square)).unwrap();
        let [low, high] = tree.bounds().unwrap();
        assert!(low.min_element() > 49.99 && high.max_element() < 51.01, "{count}: {low} {high}");
    }
}
