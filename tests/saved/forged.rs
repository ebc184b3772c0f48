//! Forged nodes and fragments in files with right faces. If a tree is read, it is right for the planes that
//! the file names.

use super::File;
use std::time::Instant;
use testkit::effort::effort;
use testkit::prelude::*;
use testkit::saved::bytes;

type Square = [[f64; 3]; 4];

const FLAT: Square = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];

const NODE: usize = 8;
const FRAGMENT: usize = 4;

/// A square in front of another.
fn at_height(z: f64) -> Square {
    FLAT.map(|[x, y, _]| [x, y, z])
}

/// A tree's file, and the start of its nodes and fragments.
fn places(tree: &BspTree) -> (File, [usize; 2]) {
    let file = File::of(tree);
    let fragments = file.0.len() - 4 - FRAGMENT * tree.len();
    (file, [fragments - 8 - NODE * tree.nodes().len(), fragments])
}

/// The file of a tree of squares, divided by the plane of the first square, and the same places.
fn file(polygons: &[Square]) -> (File, [usize; 2]) {
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    places(&options.with_tolerance(0.0).build(polygons).expect("a tree"))
}

#[test]
fn every_node_but_the_first_has_a_parent() {
    let (mut file, [nodes, _]) = file(&[0.0, 1.0, 2.0].map(at_height));
    // Two nodes: the second is in front of the first.
    let shape = nodes + 4;
    assert_eq!([file.get(shape), file.get(shape + 8)], [1 << 4 | 2 << 2, 1 << 4 | 1 << 2]);
    assert_eq!(file.message(), "");
    file.put(shape, 1 << 4 | 1 << 2);
    file.refused("node 1 has no parent");
    file.put(shape, 1 << 4 | 2 << 2 | 2);
    file.refused("do not match its fragments");
}

/// The planes determine the face of each fragment. A file with another face is refused.
#[test]
fn each_fragment_has_the_face_that_its_planes_determine() {
    let mut other = FLAT;
    other.iter_mut().for_each(|corner| corner[0] += 5.0);
    let (file, [_, fragments]) = file(&[FLAT, other, at_height(1.0)]);
    assert_eq!(file.message(), "");
    for faces in [[0, 1, 2], [1, 0, 2], [0, 0, 2], [1, 1, 2], [0, 2, 1], [0, 1, 3]] {
        let mut file = file.clone();
        for (k, face) in faces.into_iter().enumerate() {
            file.put(fragments + FRAGMENT * k, face);
        }
        if faces == [0, 1, 2] {
            assert_eq!(file.message(), "");
        } else {
            file.refused("is listed with another face than its planes make");
        }
    }
}

/// Two squares are on one side of a plane, and the file puts both into one leaf.
#[test]
fn a_leaf_has_no_more_than_one_piece() {
    let (mut file, [nodes, fragments]) = file(&[0.0, 1.0, 2.0].map(at_height));
    file.put(nodes + 4, 1 << 4 | 1 << 2);
    file.0.drain(nodes + NODE..nodes + 2 * NODE);
    file.put(nodes - 8, 1);
    let fragments = fragments - NODE;
    file.0.drain(fragments + 2 * FRAGMENT..fragments + 3 * FRAGMENT);
    file.put(fragments - 8, 2);
    file.refused("node 0 does not have the fragments that its plane makes");
}

/// In a list of nodes, a node has the plane of the node before it, which separates nothing any more.
#[test]
fn a_plane_that_is_used_again_is_refused() {
    let squares: Vec<Square> = (0..400).map(|k| at_height(f64::from(k))).collect();
    let (file, [nodes, _]) = file(&squares);
    assert_eq!(file.len(nodes - 8), 399);
    for again in 1..399 {
        let mut file = file.clone();
        file.put(nodes + NODE * again, file.get(nodes + NODE * (again - 1)));
        file.refused(&format!("node {again} does not have the fragments that its plane makes"));
    }
}

/// With nodes that each cut everything, a small file would have more pieces than memory holds.
#[test]
fn pieces_do_not_exceed_the_fragments_of_the_file() {
    // Long strips side by side, and walls across all of them.
    const STRIPS: usize = 2000;
    let strip = |k: usize| {
        let (y, z) = (2.0 * k as f64, (k * 977 % STRIPS) as f64);
        [[0.0, y, z], [999.0, y, z], [999.0, y + 1.0, z], [0.0, y + 1.0, z]]
    };
    let wall = |k: usize| {
        let far = 9.0 * STRIPS as f64;
        let x = k as f64 + 0.5;
        [[x, -far, -9.0], [x, -far, -8.0], [x, -far - 1.0, -8.0], [x, -far - 1.0, -9.0]]
    };
    let polygons: Vec<Square> = (0..STRIPS).map(strip).chain((0..900).map(wall)).collect();
    let tree = BuildOptions::DEFAULT.with_heuristic(Heuristic::First).build(&polygons).unwrap();
    let (file, [nodes, _]) = places(&tree);
    assert_eq!(tree.len(), STRIPS + 900, "nothing is cut");
    let mut forged = file.clone();
    for node in 0..tree.nodes().len() {
        forged.put(nodes + NODE * node, 1 << 28 | (STRIPS + node % 900) as u32);
    }
    let begin = Instant::now();
    forged.refused("does not have the fragments that its plane makes");
    assert!(begin.elapsed().as_secs() < 10, "it is cut all the same");
}

/// Planes of other faces and corners in one node or in several. The file is refused, or its tree is right.
#[test]
fn whatever_planes_a_file_names_its_tree_is_right() {
    let (mut dice, mut read) = (Dice(1), [0; 2]);
    for scene in [
        scene::random_triangles(12, 1),
        scene::crossing(5),
        scene::city(60, 1),
        scene::newell_bars(),
        scene::sphere(60),
    ] {
        for by in [Heuristic::First, Heuristic::FreePlanes, Heuristic::default()] {
            let options = BuildOptions::DEFAULT.with_heuristic(by);
            let tree = options.build(scene.polygons()).expect("a tree");
            let (file, [nodes, _]) = places(&tree);
            for _ in 0..200 * effort() {
                let mut file = file.clone();
                for _ in 0..1 + dice.below(2) {
                    let plane = nodes + NODE * dice.below(tree.nodes().len());
                    // A plane near the right one, which may separate the same fragments, or any plane.
                    let near = file.get(plane) + 1 + dice.below(3) as u32;
                    let kind = 1 + dice.below(4) as u32;
                    let any = kind << 28 | dice.below(3 * tree.face_count()) as u32;
                    file.put(plane, if dice.below(2) == 0 { near } else { any });
                }
                let outcome = file.read();
                read[usize::from(outcome.is_ok())] += 1;
                if let Ok(forged) = outcome {
                    assert_eq!(forged.validate(), Ok(()), "{} by {by}", scene.name());
                    assert_eq!(forged.len(), tree.len());
                    assert_eq!(BspTree::read(&bytes(&forged)[..]).unwrap().stats(), forged.stats());
                }
            }
        }
    }
    enough!(read[0] > 1000, read[1] > 50; "{read:?}");
}
