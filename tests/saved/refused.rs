//! Each check of a file of a tree: a file that is wrong in that alone is refused, and says so.

use binspace::{BspTree, BuildOptions};
use testkit::saved::{bytes, seal};

/// Where the parts of the file are; `BspTree::write` describes the layout.
const TOLERANCE: usize = 72;
const FACES: usize = 88;
const CORNERS: usize = FACES + 2 * 12;
const COUNTS: usize = CORNERS + 8 * 24 + 3 * 8;
const CUTS: usize = COUNTS + 5 * 8 + 2 * 8;
const NODES: usize = CUTS + 8 + 8;
const FRAGMENTS: usize = NODES + 8 + 8;
const VERTICES: usize = FRAGMENTS + 3 * 8;

/// Two squares that cross: the first is whole, the second is cut in two.
fn file() -> Vec<u8> {
    let flat = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let upright = [[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
    let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build([flat, upright]).unwrap();
    let file = bytes(&tree);
    assert_eq!(file.len(), VERTICES + 8 * 12 + 4, "the layout");
    file
}

fn get(file: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(file[at..at + 4].try_into().unwrap())
}

fn put(file: &mut [u8], at: usize, value: u32) {
    file[at..at + 4].copy_from_slice(&value.to_le_bytes());
}

fn corner(k: usize) -> usize {
    CORNERS + 24 * k
}

/// The axis of moves, 3 for none, and the second and third corner of the triangle.
fn frame(axis: u32, second: u32, third: u32) -> u32 {
    axis << 30 | second << 15 | third
}

/// A coordinate that is twice as far out as the grid is wide.
fn put_far(file: &mut [u8], at: usize, sign: i64) {
    file[at..at + 8].copy_from_slice(&(sign << 52).to_le_bytes());
}

/// The first vertex whose line to the next is a cut, or an edge.
fn vertex(file: &[u8], is_cut: bool) -> usize {
    let mut places = (0..8).map(|vertex| VERTICES + 12 * vertex);
    places.find(|&at| (get(file, at + 8) >> 28 & 7 != 0) == is_cut).unwrap()
}

/// Changes a file.
type Damage = fn(&mut Vec<u8>);

#[test]
fn what_is_wrong_in_one_thing_is_refused_for_that() {
    let faults: [(&str, Damage); 24] = [
        ("its tolerance is negative", |file| {
            file[TOLERANCE..TOLERANCE + 8].copy_from_slice(&(-1f64).to_le_bytes());
        }),
        ("comes before one of an earlier polygon", |file| {
            put(file, FACES, 1);
            put(file, FACES + 12, 0);
        }),
        ("is not convex", |file| {
            let second = file[corner(1)..corner(2)].to_vec();
            file.copy_within(corner(2)..corner(3), corner(1));
            file[corner(2)..corner(3)].copy_from_slice(&second);
        }),
        ("is not planar", |file| file[corner(1) + 16] ^= 4),
        ("has no area", |file| {
            file.copy_within(corner(0)..corner(1), corner(2));
            file.copy_within(corner(0)..corner(1), corner(3));
        }),
        ("corner 1 is outside the grid", |file| put_far(file, corner(1), 1)),
        ("corner 7 is outside the grid", |file| put_far(file, corner(7) + 16, -1)),
        // The corners of both faces together are as many.
        ("face 0 has too few corners", |file| {
            put(file, FACES + 4, 2);
            put(file, FACES + 12 + 4, 6);
        }),
        ("face 1 names corners that it does not have", |file| {
            put(file, FACES + 12 + 8, frame(3, 1, 4));
        }),
        ("names corners that it does not have", |file| put(file, FACES + 8, frame(3, 0, 2))),
        ("names corners that it does not have", |file| put(file, FACES + 8, frame(3, 2, 2))),
        ("is moved along another axis", |file| put(file, FACES + 8, frame(0, 1, 2))),
        // Off by a step, and moved by half a step at most.
        ("is not planar", |file| {
            file[corner(3) + 16] ^= 1;
            put(file, FACES + 8, frame(2, 1, 2));
        }),
        ("are impossible", |file| put(file, COUNTS, 3)),
        ("are more than the fragments", |file| put(file, CUTS, 4)),
        ("has a plane that separates no fragments", |file| put(file, NODES + 4, 1)),
        ("has a side of an unknown kind", |file| file[NODES + 4] |= 3),
        ("has more fragments than there are", |file| put(file, NODES + 4, 9 << 4)),
        ("are not those of its fragments", |file| put(file, NODES + 4, 2 << 4)),
        ("names a face or corner that does not exist", |file| put(file, NODES, 1 << 28 | 2)),
        ("is of a face that is there uncut", |file| put(file, FRAGMENTS, 1)),
        ("has a vertex on the wrong side of a cut", |file| {
            let line = vertex(file, true) + 8;
            let other = get(file, line) ^ 1 << 31;
            put(file, line, other);
        }),
        ("has a vertex that is not on its line", |file| {
            // Another corner in place of the cut's first end.
            let at = vertex(file, true);
            [at, at + 4].into_iter().for_each(|at| put(file, at, 0));
        }),
        ("has a vertex that is not on its edge", |file| {
            let line = vertex(file, false) + 8;
            let other = (get(file, line) + 2) % 4;
            put(file, line, other);
        }),
    ];
    assert!(BspTree::read(&file()[..]).is_ok());
    for (expected, spoil) in faults {
        let mut file = file();
        spoil(&mut file);
        seal(&mut file);
        let message = BspTree::read(&file[..]).expect_err(expected).to_string();
        assert!(message.contains(expected), "{message}, not {expected}");
    }
}

#[test]
fn triangles_are_checked() {
    let triangle = [[0.0, 0.0, 0.0], [4.0, 0.0, 1.0], [0.0, 4.0, 2.0]];
    let file = bytes(&BspTree::build([triangle]).unwrap());
    let corners = FACES + 12;
    let damage: [(&str, Damage); 4] = [
        ("corner 2 is outside the grid", |file| put_far(file, FACES + 12 + 48, -1)),
        ("face 0 has no area", |file| file.copy_within(FACES + 12..FACES + 36, FACES + 36)),
        ("face 0 is moved, but a triangle", |file| put(file, FACES + 8, frame(2, 1, 2))),
        ("names corners that it does not have", |file| put(file, FACES + 8, frame(3, 1, 3))),
    ];
    assert_eq!(get(&file, corners + 72), 0, "no numbered faces");
    for (expected, spoil) in damage {
        let mut file = file.clone();
        spoil(&mut file);
        seal(&mut file);
        let message = BspTree::read(&file[..]).expect_err(expected).to_string();
        assert!(message.contains(expected), "{message}, not {expected}");
    }
}

/// The count of cuts is the builder's, and no difference of what else is in the file.
#[test]
fn the_count_of_cuts_is_read() {
    let mut file = file();
    assert_eq!((get(&file, CUTS), get(&file, CUTS + 4)), (1, 0));
    assert_eq!(BspTree::read(&file[..]).unwrap().stats().splits, 1);
    put(&mut file, CUTS, 3);
    seal(&mut file);
    assert_eq!(BspTree::read(&file[..]).unwrap().stats().splits, 3);
    for (place, value) in [(CUTS, u32::MAX), (CUTS + 4, 1), (CUTS + 4, u32::MAX)] {
        put(&mut file, place, value);
        seal(&mut file);
        let message = BspTree::read(&file[..]).unwrap_err().to_string();
        assert!(message.contains("cuts"), "{message}");
    }
}

fn put_len(file: &mut [u8], at: usize, len: u64) {
    file[at..at + 8].copy_from_slice(&len.to_le_bytes());
}

/// A length one above what it may be is refused for that, and the largest for something else: that so
/// much is not there.
#[test]
fn limits_are_where_they_are_said_to_be() {
    let file = file();
    let (labels, fragments) = (1 << 28, (1 << 29) - 1);
    let lists = CORNERS + 8 * 24;
    let mut limits = vec![
        ("faces", FACES - 8, labels),
        ("numbered faces", lists, 2),
        ("moved corners", lists + 8, 8),
        ("dropped polygons", lists + 16, labels),
        ("cuts", CUTS, fragments),
        ("nodes", NODES - 8, fragments),
        ("fragments", FRAGMENTS - 8, fragments),
    ];
    limits.extend((0..5).map(|k| ("counts of polygons", COUNTS + 8 * k, labels)));
    for (what, at, limit) in limits {
        for (len, is_too_many) in [(limit, false), (limit + 1, true), (u64::MAX, true)] {
            let mut file = file.clone();
            put_len(&mut file, at, len);
            seal(&mut file);
            let message = BspTree::read(&file[..]).expect_err(what).to_string();
            let says = message.contains(&format!(" {limit} is the most"));
            assert_eq!(says, is_too_many, "{what}, {len}: {message}");
        }
    }
    // The corners of all faces together: one fewer than names.
    for (corners, is_too_many) in [(labels - 1, false), (labels, true)] {
        let mut file = file.clone();
        put(&mut file, FACES + 4, corners as u32 - 4);
        seal(&mut file);
        let message = BspTree::read(&file[..]).expect_err("corners").to_string();
        assert_eq!(message.contains(" 268435455 is the most"), is_too_many, "{corners}: {message}");
    }
}

/// A corner's number may be as large as a polygon may have corners, and no larger.
#[test]
fn corner_numbers_are_checked() {
    let bay = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [2.0, 1.0, 0.0], [0.0, 4.0, 0.0]];
    let tree = BspTree::build([bay]).unwrap();
    let file = bytes(&tree);
    let faces = get(&file, FACES - 8) as usize;
    assert_eq!(faces, 3);
    let list = FACES + 12 * faces + 24 * 3 * faces;
    let numbered = get(&file, list) as usize;
    assert!(numbered > 0);
    let first = list + 8 + 4 * numbered;
    for (value, is_refused) in
        [((1 << 28) - 1, false), (1 << 28, true), (1 << 31 | 1 << 28, true), (1 << 31 | 7, false)]
    {
        let mut file = file.clone();
        put(&mut file, first, value);
        seal(&mut file);
        let read = BspTree::read(&file[..]);
        assert_eq!(read.is_err(), is_refused, "{value:#x}: {read:?}");
        if let Err(error) = read {
            assert!(error.to_string().contains("corner number 0 is too large"), "{error}");
        }
    }
    // The last face with numbers is given as the one before it.
    assert!(numbered > 1);
    let mut file = file;
    let before = get(&file, first - 8);
    put(&mut file, first - 4, before);
    seal(&mut file);
    let message = BspTree::read(&file[..]).unwrap_err().to_string();
    assert!(message.contains("is unknown or out of order"), "{message}");
}
