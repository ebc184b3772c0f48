//! Forged fragments: outlines and lists that are wrong in one thing, which nothing else would notice.

use binspace::{BuildOptions, Heuristic};
use testkit::enough;

use super::File;

type Square = [[f64; 3]; 4];

const FLAT: Square = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
const UPRIGHT: Square = [[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];

const FRAGMENT: usize = 8;
const VERTEX: usize = 12;

/// A file, and where its fragments and their vertices begin.
fn file(polygons: &[Square]) -> (File, [usize; 2]) {
    // The plane of the first divides the others.
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let tree = options.with_tolerance(0.0).build(polygons).expect("a tree");
    let cut = |f: binspace::Fragment<'_>| if f.is_whole() { 0 } else { f.vertex_count() };
    let stored: usize = tree.fragments().map(cut).sum();
    let file = File::of(&tree);
    let vertices = file.0.len() - 4 - VERTEX * stored;
    (file, [vertices - FRAGMENT * tree.len(), vertices])
}

/// A cut bounds a fragment: the vertices on both sides of its ends are inside of it.
#[test]
fn both_neighbours_of_a_cut_are_looked_at() {
    let mut refused = 0;
    for piece in 0..2 {
        let (mut file, [_, vertices]) = file(&[FLAT, UPRIGHT]);
        let start = vertices + 4 * VERTEX * piece;
        // Its cut comes first, which changes nothing.
        let is_cut = |k: &usize| file.get(start + VERTEX * k + 8) >> 28 & 7 != 0;
        let cut = (0..4).find(is_cut).expect("it is cut");
        file.0[start..start + 4 * VERTEX].rotate_left(VERTEX * cut);
        assert_eq!(file.message(), "");
        for vertex in [2, 3] {
            let at = start + VERTEX * vertex;
            let corner = file.get(at);
            assert!(corner < 4 && file.get(at + 4) == corner, "a corner");
            // The one across the cut.
            let across = 3 - corner;
            [at, at + 4].into_iter().for_each(|at| file.put(at, across));
            file.refused("on the wrong side of a cut");
            [at, at + 4].into_iter().for_each(|at| file.put(at, corner));
            refused += 1;
        }
    }
    assert_eq!(refused, 4);
}

#[test]
fn every_node_but_the_first_has_a_parent() {
    let at_height = |z: f64| FLAT.map(|[x, y, _]| [x, y, z]);
    let (mut file, [fragments, _]) = file(&[0.0, 1.0, 2.0].map(at_height));
    // Two nodes: the second is in front of the first.
    let shape = fragments - 8 - 2 * 8 + 4;
    assert_eq!([file.get(shape), file.get(shape + 8)], [1 << 4 | 2 << 2, 1 << 4 | 1 << 2]);
    assert_eq!(file.message(), "");
    file.put(shape, 1 << 4 | 1 << 2);
    file.refused("node 1 has no parent");
    file.put(shape, 1 << 4 | 2 << 2 | 2);
    file.refused("are not those of its fragments");
}

#[test]
fn fragments_on_a_plane_must_be_in_input_order() {
    let mut other = FLAT;
    other.iter_mut().for_each(|corner| corner[0] += 5.0);
    let mut third = FLAT;
    third.iter_mut().for_each(|corner| corner[2] = 1.0);
    let (mut file, [fragments, _]) = file(&[FLAT, other, third]);
    let first = (0..2).map(|k| fragments + FRAGMENT * k);
    let first = first.clone().find(|&at| (file.get(at), file.get(at + FRAGMENT)) == (0, 1));
    let at = first.expect("both squares, one behind the other");
    assert_eq!(file.message(), "");
    for (faces, is_right) in [([1, 0], false), ([0, 0], false), ([1, 1], false), ([0, 1], true)] {
        file.put(at, faces[0]);
        file.put(at + FRAGMENT, faces[1]);
        let message = file.message();
        if faces == [1, 0] {
            assert!(message.contains("not in input order"), "{message}");
        }
        assert_eq!(message.is_empty(), is_right, "{faces:?}: {message}");
    }
}

/// Whichever comes first.
#[test]
fn a_face_is_whole_or_in_pieces() {
    let mut aside = FLAT;
    aside.iter_mut().for_each(|corner| *corner = [corner[0] + 9.0, corner[1], corner[2] + 3.0]);
    let mut before = FLAT;
    before.iter_mut().for_each(|corner| *corner = [corner[0] - 9.0, corner[1], corner[2] - 3.0]);
    let mut refused = [0; 2];
    for polygons in [[FLAT, UPRIGHT, aside, before], [UPRIGHT, FLAT, before, aside]] {
        let (file, [fragments, vertices]) = file(&polygons);
        assert_eq!(file.message(), "");
        let count = (vertices - fragments) / FRAGMENT;
        let face = |k: usize| file.get(fragments + FRAGMENT * k);
        let all: Vec<u32> = (0..count).map(face).collect();
        let pieces = |face: u32| all.iter().filter(|&&other| other == face).count();
        for (k, &own) in all.iter().enumerate().filter(|(_, own)| pieces(**own) == 1) {
            for other in (0..4).filter(|&other| other != own) {
                let mut file = file.clone();
                file.put(fragments + FRAGMENT * k, other);
                if pieces(other) == 2 {
                    let is_last = all[..k].contains(&other);
                    refused[usize::from(is_last)] += 1;
                }
                file.refused("is there uncut");
            }
        }
    }
    enough!(refused[0] > 0, refused[1] > 0; "{refused:?}");
}
