//! Iterators over orders, fragments, their parts and nodes: read from both ends, and of the stated length.

use std::fmt::Debug;
use std::iter::FusedIterator;
use testkit::prelude::*;
use testkit::shapes::sheet;

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
        let mut frames = FrameBuilder::new(BuildOptions::DEFAULT);
        trees.push(frames.build(scene.polygons()).unwrap().clone());
    }
    trees.push(BspTree::build(Vec::<[DVec3; 3]>::new()).unwrap());
    trees
}

fn reversed<T>(iterator: impl Iterator<Item = T>) -> Vec<T> {
    let mut list: Vec<T> = iterator.collect();
    list.reverse();
    list
}

/// Compares an iterator with a list: from the front, from the back, and from both ends in a random pattern.
/// Copies that are made in between are compared too.
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
            check_ends(
                tree.order(eye).front_to_back().into_iter().map(|f| f.index()),
                &order,
                &mut dice,
            );
            assert_eq!(tree.back_to_front(eye).len(), tree.len());
        }
    }
    enough!(cut > 10; "{cut}");
}

#[test]
fn fragments_and_nodes_are_read_from_both_ends() {
    let (mut dice, mut deep) = (Dice(8), 0);
    for tree in trees() {
        let numbers: Vec<u32> = (0..tree.len() as u32).collect();
        check_ends(tree.fragments().map(|f| f.index()), &numbers, &mut dice);
        assert_eq!(tree.fragments().nth(2).map(|f| f.index()), numbers.get(2).copied());
        let stats = tree.stats();
        // The numbers of fragments and faces are equal, so nothing was cut.
        assert_eq!(tree.face_count(), stats.faces);
        assert_eq!(tree.len() == tree.face_count(), stats.splits == 0);
        let nodes: Vec<_> = tree.nodes().collect();
        assert_eq!(nodes.len(), stats.nodes);
        assert_eq!(nodes.iter().map(|node| node.depth()).max().unwrap_or(0), stats.depth_max);
        check_ends(tree.nodes(), &nodes, &mut dice);
        deep += usize::from(stats.depth_max > 8);
    }
    enough!(deep > 10; "{deep}");
}

/// Two squares, lines that are dropped, and an arrow of two triangles, all above each other. Then a square
/// through the first two squares.
#[test]
fn equal_numbers_of_fragments_and_faces_mean_no_cuts() {
    let square = |z: f64| sheet(2, z, 4.0).to_vec();
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

/// In an earlier version, the debug output listed all faces of the tree.
#[test]
fn debug_output_is_about_the_fragment_alone() {
    let tree = BspTree::build([sheet(2, 0.0, 4.0), sheet(2, 1.0, 4.0)]).unwrap();
    let text = format!("{:?}", tree.fragment(1));
    assert!(
        text.starts_with("Fragment { index: 1, polygon: 1, vertices: [") && text.len() < 200,
        "{text}"
    );
    assert!(format!("{:?}", tree.faces()).contains("faces: 2, .."));
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
