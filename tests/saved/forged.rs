//! Forged fragments: outlines and lists that are wrong in one thing, which nothing else would notice.

use binspace::{BspTree, BuildOptions, Heuristic};
use testkit::enough;
use testkit::saved::{bytes, seal};

type Square = [[f64; 3]; 4];

const FLAT: Square = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
const UPRIGHT: Square = [[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];

/// A file, and where its fragments and their vertices begin.
struct File {
    bytes: Vec<u8>,
    fragments: usize,
    vertices: usize,
}

const FRAGMENT: usize = 8;
const VERTEX: usize = 12;

impl File {
    fn of(polygons: &[Square]) -> Self {
        // The plane of the first divides the others.
        let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
        let tree = options.with_tolerance(0.0).build(polygons).expect("a tree");
        let cut = |f: binspace::Fragment<'_>| if f.is_whole() { 0 } else { f.vertex_count() };
        let stored: usize = tree.fragments().map(cut).sum();
        let bytes = bytes(&tree);
        let vertices = bytes.len() - 4 - VERTEX * stored;
        Self { fragments: vertices - FRAGMENT * tree.len(), vertices, bytes }
    }

    fn get(&self, at: usize) -> u32 {
        u32::from_le_bytes(self.bytes[at..at + 4].try_into().expect("four"))
    }

    fn put(&mut self, at: usize, value: u32) {
        self.bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
    }

    /// What reading says; nothing if it is a tree.
    fn message(&self) -> String {
        let mut bytes = self.bytes.clone();
        seal(&mut bytes);
        BspTree::read(&bytes[..]).map_or_else(|error| error.to_string(), |_| String::new())
    }
}

/// A cut bounds a fragment: the vertices on both sides of its ends are inside of it.
#[test]
fn both_neighbours_of_a_cut_are_looked_at() {
    let mut refused = 0;
    for piece in 0..2 {
        let mut file = File::of(&[FLAT, UPRIGHT]);
        let start = file.vertices + 4 * VERTEX * piece;
        // Its cut comes first, which changes nothing.
        let is_cut = |k: &usize| file.get(start + VERTEX * k + 8) >> 28 & 7 != 0;
        let cut = (0..4).find(is_cut).expect("it is cut");
        file.bytes[start..start + 4 * VERTEX].rotate_left(VERTEX * cut);
        assert_eq!(file.message(), "");
        for vertex in [2, 3] {
            let at = start + VERTEX * vertex;
            let corner = file.get(at);
            assert!(corner < 4 && file.get(at + 4) == corner, "a corner");
            // The one across the cut.
            let across = 3 - corner;
            [at, at + 4].into_iter().for_each(|at| file.put(at, across));
            let message = file.message();
            assert!(message.contains("on the wrong side of a cut"), "{vertex}: {message}");
            [at, at + 4].into_iter().for_each(|at| file.put(at, corner));
            refused += 1;
        }
    }
    assert_eq!(refused, 4);
}

#[test]
fn every_node_but_the_first_has_a_parent() {
    let at_height = |z: f64| FLAT.map(|[x, y, _]| [x, y, z]);
    let mut file = File::of(&[0.0, 1.0, 2.0].map(at_height));
    // Two nodes: the second is in front of the first.
    let shape = file.fragments - 8 - 2 * 8 + 4;
    assert_eq!([file.get(shape), file.get(shape + 8)], [1 << 4 | 2 << 2, 1 << 4 | 1 << 2]);
    assert_eq!(file.message(), "");
    file.put(shape, 1 << 4 | 1 << 2);
    assert!(file.message().contains("node 1 has no parent"), "{}", file.message());
    file.put(shape, 1 << 4 | 2 << 2 | 2);
    assert!(file.message().contains("are not those of its fragments"), "{}", file.message());
}

#[test]
fn fragments_on_a_plane_must_be_in_input_order() {
    let mut other = FLAT;
    other.iter_mut().for_each(|corner| corner[0] += 5.0);
    let mut third = FLAT;
    third.iter_mut().for_each(|corner| corner[2] = 1.0);
    let mut file = File::of(&[FLAT, other, third]);
    let first = (0..2).map(|k| file.fragments + FRAGMENT * k);
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
        let file = File::of(&polygons);
        assert_eq!(file.message(), "");
        let count = (file.vertices - file.fragments) / FRAGMENT;
        let face = |k: usize| file.get(file.fragments + FRAGMENT * k);
        let all: Vec<u32> = (0..count).map(face).collect();
        let pieces = |face: u32| all.iter().filter(|&&other| other == face).count();
        for (k, &own) in all.iter().enumerate().filter(|(_, own)| pieces(**own) == 1) {
            for other in (0..4).filter(|&other| other != own) {
                let mut file = File { bytes: file.bytes.clone(), ..file };
                file.put(file.fragments + FRAGMENT * k, other);
                let message = file.message();
                if pieces(other) == 2 {
                    let is_last = all[..k].contains(&other);
                    refused[usize::from(is_last)] += 1;
                }
                assert!(message.contains("is there uncut"), "{k} {other} {all:?}: {message}");
            }
        }
    }
    enough!(refused[0] > 0, refused[1] > 0; "{refused:?}");
}
