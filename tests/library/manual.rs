//! What the pages of `BspTree`, `Viewpoint` and `BuildOptions` say of iterators, odd viewpoints and
//! odd tolerances.

use std::fmt::Debug;
use std::iter::FusedIterator;

use binspace::glam::{DVec3, dvec3};
use binspace::scene::{self, ScenePolygon};
use binspace::{BspTree, BuildOptions, Heuristic, Viewpoint};
use testkit::dice::Dice;

const EYES: [Viewpoint; 4] = [
    Viewpoint::Eye(dvec3(3.0, 1.0, 2.0)),
    Viewpoint::Eye(dvec3(0.1, -0.2, 0.05)),
    Viewpoint::Direction(dvec3(0.3, -1.0, 0.2)),
    Viewpoint::Direction(DVec3::Z),
];

/// Trees with cuts, with long runs in one plane, with lists, and without a node.
fn trees() -> Vec<BspTree> {
    let squares = (0..30).map(|k| {
        let (x, y) = (f64::from(k % 6), f64::from(k / 6));
        vec![[x, y, 0.0], [x + 1.5, y, 0.0], [x + 1.5, y + 1.5, 0.0], [x, y + 1.5, 0.0]]
    });
    let mut trees = vec![BspTree::build(squares).unwrap()];
    for scene in [
        scene::random_triangles(150, 4),
        scene::crossing(9),
        scene::chain(60),
        scene::city(300, 2),
        scene::chain(1),
    ] {
        for &by in Heuristic::ALL {
            let options = BuildOptions::DEFAULT.with_heuristic(by);
            trees.push(options.build(scene.polygons()).unwrap());
        }
    }
    trees.push(BspTree::build(Vec::<[DVec3; 3]>::new()).unwrap());
    trees
}

fn reversed<T>(iterator: impl Iterator<Item = T>) -> Vec<T> {
    let mut list: Vec<T> = iterator.collect();
    list.reverse();
    list
}

/// Holds an iterator against a list: from the front, from the back, and from both ends in a random
/// pattern; and copies of it made on the way.
fn check_ends<I>(iterator: I, expected: &[I::Item], dice: &mut Dice)
where
    I: DoubleEndedIterator<Item: PartialEq + Debug> + ExactSizeIterator + FusedIterator + Clone,
{
    assert_eq!(iterator.len(), expected.len());
    assert_eq!(iterator.clone().collect::<Vec<_>>(), expected);
    assert!(reversed(iterator.clone().rev()) == expected);
    for bias in [1, 2, 5] {
        let mut ends = iterator.clone();
        let mut left = 0..expected.len();
        while !left.is_empty() {
            assert_eq!(ends.len(), left.len());
            assert_eq!(ends.size_hint(), (left.len(), Some(left.len())));
            if dice.roll().is_multiple_of(40) {
                assert_eq!(ends.clone().collect::<Vec<_>>(), expected[left.clone()]);
                assert_eq!(reversed(ends.clone().rev()), expected[left.clone()]);
            }
            let (found, at) = if dice.roll() % 6 < bias {
                (ends.next(), left.next())
            } else {
                (ends.next_back(), left.next_back())
            };
            assert_eq!(found.as_ref(), at.map(|at| &expected[at]));
        }
        for _ in 0..3 {
            assert_eq!((ends.next(), ends.next_back(), ends.len()), (None, None, 0));
        }
    }
}

#[test]
fn orders_are_read_from_both_ends() {
    let (mut dice, mut cut) = (Dice(7), 0);
    for tree in trees() {
        cut += usize::from(tree.stats().splits > 0);
        for eye in EYES {
            let mut order = Vec::new();
            tree.back_to_front_into(eye, &mut order);
            check_ends(tree.back_to_front(eye).map(|f| f.index()), &order, &mut dice);
            order.reverse();
            check_ends(tree.front_to_back(eye).map(|f| f.index()), &order, &mut dice);
            assert_eq!(tree.back_to_front(eye).len(), tree.len());
        }
    }
    assert!(cut > 10, "{cut}");
}

#[test]
fn fragments_and_nodes_are_read_from_both_ends() {
    let (mut dice, mut deep) = (Dice(8), 0);
    for tree in trees() {
        let numbers: Vec<u32> = (0..tree.len() as u32).collect();
        check_ends(tree.fragments().map(|f| f.index()), &numbers, &mut dice);
        assert_eq!(tree.fragments().nth(2).map(|f| f.index()), numbers.get(2).copied());
        let stats = tree.stats();
        // As many fragments as faces say that nothing was cut.
        assert_eq!(tree.face_count(), stats.faces);
        assert_eq!(tree.len() == tree.face_count(), stats.splits == 0);
        let nodes: Vec<_> = tree.nodes().collect();
        assert_eq!(nodes.len(), stats.nodes);
        assert_eq!(nodes.iter().map(|node| node.depth()).max().unwrap_or(0), stats.depth_max);
        check_ends(tree.nodes(), &nodes, &mut dice);
        deep += usize::from(stats.depth_max > 8);
    }
    assert!(deep > 10, "{deep}");
}

/// Two squares, lines that are dropped, and an arrow of two triangles, all above each other; then a
/// square through the first two.
#[test]
fn as_many_fragments_as_faces_say_that_nothing_was_cut() {
    let square = |z: f64| vec![[0.0, 0.0, z], [4.0, 0.0, z], [4.0, 4.0, z], [0.0, 4.0, z]];
    let line = vec![[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [2.0, 0.0, 5.0]];
    let arrow = vec![[0.0, 0.0, 2.0], [2.0, 1.0, 2.0], [4.0, 0.0, 2.0], [2.0, 4.0, 2.0]];
    let mut polygons = vec![square(0.0), square(1.0), line.clone(), line, arrow];
    let tree = BspTree::build(&polygons).unwrap();
    assert_eq!((tree.face_count(), tree.len()), (4, 4));
    polygons.push(vec![[2.0, 1.0, -1.0], [2.0, 3.0, -1.0], [2.0, 3.0, 1.5], [2.0, 1.0, 1.5]]);
    let tree = BspTree::build(&polygons).unwrap();
    assert_eq!(tree.face_count(), 5);
    assert!(tree.len() > 5);
}

#[test]
fn the_parts_of_a_fragment_are_read_from_both_ends() {
    let tree = BspTree::build(scene::random_triangles(60, 1).polygons()).unwrap();
    for fragment in tree.fragments() {
        let n = fragment.vertex_count();
        assert!(n >= 3);
        let (vertices, edges) = (fragment.vertices(), fragment.edges());
        assert_eq!((vertices.len(), edges.len(), fragment.weights().len()), (n, n, n));
        assert_eq!(reversed(vertices.clone().rev()), vertices.collect::<Vec<_>>());
        assert_eq!(reversed(edges.clone().rev()), edges.collect::<Vec<_>>());
        let weights = fragment.weights();
        assert_eq!(reversed(weights.clone().rev()), weights.collect::<Vec<_>>());
    }
}

/// Every fragment is where the rounded plane of a node says, but for rounding.
#[test]
fn normals_and_offsets_of_nodes_are_those_of_their_planes() {
    let (mut checked, far) = (0, dvec3(1e3, -2e3, 5e2));
    for scene in [scene::random_triangles(80, 2), scene::city(200, 1), scene::crossing(9)] {
        let moved =
            |polygon: ScenePolygon<'_>| polygon.iter().map(|&p| p + far).collect::<Vec<_>>();
        let tree = BspTree::build(scene.polygons().map(moved)).unwrap();
        let (low, high) = scene.bounds().unwrap();
        let slack = 1e-8 * (high - low).max_element();
        for node in tree.nodes() {
            assert!((node.normal().length() - 1.0).abs() < 1e-15);
            for (numbers, least, most) in [
                (node.on(), -slack, slack),
                (node.in_front(), -slack, f64::INFINITY),
                (node.behind(), f64::NEG_INFINITY, slack),
            ] {
                for vertex in numbers.flat_map(|number| tree.fragment(number).vertices()) {
                    let distance = node.normal().dot(vertex) - node.offset();
                    assert!((least..=most).contains(&distance), "{distance}: {node:?}");
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 10_000, "{checked}");
}

fn square(z: f64) -> [DVec3; 4] {
    [(2.0, 4.0), (4.0, 4.0), (4.0, 6.0), (2.0, 6.0)].map(|(x, y)| dvec3(x, y, z))
}

fn polygons(tree: &BspTree, viewpoint: Viewpoint) -> Vec<usize> {
    tree.back_to_front(viewpoint).map(|fragment| fragment.polygon()).collect()
}

/// Two squares above each other and four upright ones side by side, around (3, 5, 1).
fn boxed() -> BspTree {
    let upright = |x: f64| square(0.0).map(|p| dvec3(x, p.y, p.x - 2.0));
    let upright = [2.0, 2.5, 3.5, 4.0].map(upright);
    BspTree::build([square(-1.0), square(3.0)].into_iter().chain(upright)).unwrap()
}

#[test]
fn a_coordinate_that_is_not_a_number_is_that_of_the_middle() {
    let tree = boxed();
    for z in [-9.0, 0.5, 1.5, 9.0] {
        let at = |x: f64| polygons(&tree, Viewpoint::eye([x, 5.0, z]));
        assert_eq!(at(f64::NAN), at(3.0));
        assert!(at(3.0) != at(0.0) && at(3.0) != at(9.0), "the case shows nothing");
    }
    let middle = polygons(&tree, Viewpoint::eye([3.0, 5.0, 1.0]));
    assert_eq!(polygons(&tree, Viewpoint::Eye(DVec3::NAN)), middle);
    let along = |x: f64| polygons(&tree, Viewpoint::direction([x, 0.1, 0.2]));
    assert_eq!(along(f64::NAN), along(0.0));
}

#[test]
fn an_infinite_eye_looks_along_its_infinite_coordinates() {
    let tree = boxed();
    for sign in [-1.0, 1.0] {
        let infinite = sign * f64::INFINITY;
        let eye = |x, y, z| polygons(&tree, Viewpoint::eye([x, y, z]));
        let towards = |x, y, z| polygons(&tree, Viewpoint::direction([x, y, z]));
        assert_eq!(eye(-7.0, 5.0, infinite), towards(0.0, 0.0, -sign));
        assert_eq!(eye(infinite, 5.0, 1e200), towards(-sign, 0.0, 0.0));
        assert_eq!(eye(infinite, 5.0, infinite), towards(-sign, 0.0, -sign));
        assert_eq!(towards(infinite, 5.0, infinite), towards(sign, 0.0, sign));
    }
}

#[test]
fn a_direction_of_no_length_is_downwards() {
    let tree = boxed();
    let down = polygons(&tree, Viewpoint::Direction(DVec3::NEG_Z));
    assert_ne!(down, polygons(&tree, Viewpoint::Direction(DVec3::Z)), "the case shows nothing");
    for odd in [DVec3::ZERO, -DVec3::ZERO, DVec3::NAN, dvec3(f64::NAN, 0.0, 0.0)] {
        assert_eq!(polygons(&tree, Viewpoint::Direction(odd)), down);
    }
    // Of any length but zero.
    for length in [5e-324, 1e-300, 1.0, f64::MAX] {
        let up = Viewpoint::Direction(DVec3::Z * length);
        assert_eq!(polygons(&tree, up), polygons(&tree, Viewpoint::Direction(DVec3::Z)));
    }
}

/// Layers count as coplanar, and so come in input order from below, up to the tolerance that counts.
#[test]
fn a_tolerance_beyond_a_share_of_the_extent_counts_as_that() {
    let wide = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let layer = |z: f64| wide.map(|[x, y]| [x, y, z]);
    let is_coplanar = |gap: f64, tolerance: f64| {
        let options = BuildOptions::DEFAULT.with_tolerance(tolerance);
        let tree = options.build([layer(0.0), layer(gap)]).unwrap();
        tree.root().unwrap().on().len() == 2
    };
    for tolerance in [0.5, 1.0, 1e300, f64::INFINITY] {
        assert!(is_coplanar(1.0 / 257.0, tolerance), "{tolerance}");
        assert!(!is_coplanar(1.0 / 127.0, tolerance), "{tolerance}");
    }
    assert!(!is_coplanar(1.0 / 257.0, 1e-9) && !is_coplanar(1.0 / 257.0, 0.0));
    for bad in [-1.0, -5e-324, f64::NEG_INFINITY, f64::NAN] {
        let error = BuildOptions::DEFAULT.with_tolerance(bad).build([layer(0.0)]).unwrap_err();
        assert!(error.to_string().contains("tolerance"), "{error}");
    }
}
