//! Tests each check of a tree's file: a file that fails only this check is refused with its message.

use super::File;
use testkit::prelude::*;

/// The start of the file's parts; `BspTree::write` describes the layout.
const TOLERANCE: usize = 72;
const FACES: usize = 88;
const CORNERS: usize = FACES + 2 * 12;
const COUNTS: usize = CORNERS + 8 * 24 + 3 * 8;
const NODES: usize = COUNTS + 4 * 8 + 2 * 8 + 8;
const FRAGMENTS: usize = NODES + 8 + 8;

/// Two squares that cross: the first is whole, the second is cut in two.
fn file() -> File {
    let flat = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let upright = [[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
    let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build([flat, upright]).unwrap();
    let file = File::of(&tree);
    assert_eq!(file.0.len(), FRAGMENTS + 3 * 4 + 4, "the layout");
    file
}

fn corner(k: usize) -> usize {
    CORNERS + 24 * k
}

/// The axis of moves, 3 for none, and the second and third corner of the triangle.
fn frame(axis: u32, second: u32, third: u32) -> u32 {
    axis << 30 | second << 15 | third
}

/// Puts a coordinate far outside the grid.
fn put_far(file: &mut File, at: usize, sign: i64) {
    file.put_bytes(at, &(sign << 52).to_le_bytes());
}

/// Changes a file.
type Damage = fn(&mut File);

#[test]
fn each_fault_is_refused_with_its_own_message() {
    let faults: [(&str, Damage); 21] = [
        ("its tolerance is negative", |file| {
            file.put_bytes(TOLERANCE, &(-1f64).to_le_bytes());
        }),
        ("precedes a face of an earlier polygon", |file| {
            file.put(FACES, 1);
            file.put(FACES + 12, 0);
        }),
        ("is not convex", |file| {
            let second = file.0[corner(1)..corner(2)].to_vec();
            file.0.copy_within(corner(2)..corner(3), corner(1));
            file.put_bytes(corner(2), &second);
        }),
        ("is not planar", |file| file.0[corner(1) + 16] ^= 4),
        ("has no area", |file| {
            file.0.copy_within(corner(0)..corner(1), corner(2));
            file.0.copy_within(corner(0)..corner(1), corner(3));
        }),
        ("corner 1 is outside the grid", |file| put_far(file, corner(1), 1)),
        ("corner 7 is outside the grid", |file| put_far(file, corner(7) + 16, -1)),
        // The number of corners of both faces together does not change.
        ("face 0 has too few corners", |file| {
            file.put(FACES + 4, 2);
            file.put(FACES + 12 + 4, 6);
        }),
        ("face 1 names corners that it does not have", |file| {
            file.put(FACES + 12 + 8, frame(3, 1, 4));
        }),
        ("names corners that it does not have", |file| file.put(FACES + 8, frame(3, 0, 2))),
        ("names corners that it does not have", |file| file.put(FACES + 8, frame(3, 2, 2))),
        ("is moved along the wrong axis", |file| file.put(FACES + 8, frame(0, 1, 2))),
        // The corner is off by a step, but moved by half a step at most.
        ("is not planar", |file| {
            file.0[corner(3) + 16] ^= 1;
            file.put(FACES + 8, frame(2, 1, 2));
        }),
        ("are impossible", |file| file.put(COUNTS, 3)),
        ("has a plane that separates no fragments", |file| file.put(NODES + 4, 1)),
        ("has a side of an unknown kind", |file| file.0[NODES + 4] |= 3),
        ("has more fragments than the tree", |file| file.put(NODES + 4, 9 << 4)),
        ("do not match its fragments", |file| file.put(NODES + 4, 2 << 4)),
        ("names a face or corner that does not exist", |file| file.put(NODES, 1 << 28 | 2)),
        // The plane of the other square, which contains no part of this square.
        ("node 0 does not have the fragments that its plane makes", |file| {
            file.put(NODES, 2 << 28)
        }),
        ("fragment 2 is listed with another face than its planes make", |file| {
            file.put(FRAGMENTS + 8, 0)
        }),
    ];
    assert!(BspTree::read(&file().0[..]).is_ok());
    for (expected, spoil) in faults {
        let mut file = file();
        spoil(&mut file);
        file.refused(expected);
    }
}

#[test]
fn triangles_are_checked() {
    let triangle = [[0.0, 0.0, 0.0], [4.0, 0.0, 1.0], [0.0, 4.0, 2.0]];
    let file = File::of(&BspTree::build([triangle]).unwrap());
    let corners = FACES + 12;
    let damage: [(&str, Damage); 4] = [
        ("corner 2 is outside the grid", |file| put_far(file, FACES + 12 + 48, -1)),
        ("face 0 has no area", |file| file.0.copy_within(FACES + 12..FACES + 36, FACES + 36)),
        ("face 0 is a triangle, but is stored as moved", |file| {
            file.put(FACES + 8, frame(2, 1, 2))
        }),
        ("names corners that it does not have", |file| file.put(FACES + 8, frame(3, 1, 3))),
    ];
    assert_eq!(file.get(corners + 72), 0, "no numbered faces");
    for (expected, spoil) in damage {
        let mut file = file.clone();
        spoil(&mut file);
        file.refused(expected);
    }
}

/// A length one above its limit is refused for this reason. The limit itself is refused for another reason:
/// the data are missing.
#[test]
fn documented_limits_are_exact() {
    let file = file();
    let (labels, fragments) = (1 << 28, (1 << 29) - 1);
    let lists = CORNERS + 8 * 24;
    let mut limits = vec![
        ("faces", FACES - 8, labels),
        ("numbered faces", lists, 2),
        ("moved corners", lists + 8, 8),
        ("dropped polygons", lists + 16, labels),
        ("nodes", NODES - 8, fragments),
        ("fragments", FRAGMENTS - 8, fragments),
    ];
    limits.extend((0..4).map(|k| ("counts of polygons", COUNTS + 8 * k, labels)));
    for (what, at, limit) in limits {
        for (len, is_too_many) in [(limit, false), (limit + 1, true), (u64::MAX, true)] {
            let mut file = file.clone();
            file.put_bytes(at, &u64::to_le_bytes(len));
            let message = file.read().expect_err(what);
            let says = message.contains(&format!("limit of {limit}:"));
            assert_eq!(says, is_too_many, "{what}, {len}: {message}");
        }
    }
    // The number of corners of all faces together is one less than the number of names.
    for (corners, is_too_many) in [(labels - 1, false), (labels, true)] {
        let mut file = file.clone();
        file.put(FACES + 4, corners as u32 - 4);
        let message = file.read().expect_err("corners");
        assert_eq!(message.contains("limit of 268435455:"), is_too_many, "{corners}: {message}");
    }
}

/// A corner's number may not exceed the largest number of corners of a polygon.
#[test]
fn corner_numbers_are_checked() {
    let bay = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [2.0, 1.0, 0.0], [0.0, 4.0, 0.0]];
    let tree = BspTree::build([bay]).unwrap();
    let file = File::of(&tree);
    let faces = file.get(FACES - 8) as usize;
    assert_eq!(faces, 3);
    let list = FACES + 12 * faces + 24 * 3 * faces;
    let numbered = file.get(list) as usize;
    assert!(numbered > 0);
    let first = list + 8 + 4 * numbered;
    for (value, is_refused) in
        [((1 << 28) - 1, false), (1 << 28, true), (1 << 31 | 1 << 28, true), (1 << 31 | 7, false)]
    {
        let mut file = file.clone();
        file.put(first, value);
        let read = file.read();
        assert_eq!(read.is_err(), is_refused, "{value:#x}: {read:?}");
        if let Err(error) = read {
            assert!(error.contains("corner number 0 is too large"), "{error}");
        }
    }
    // The last face with numbers gets the number of the face before it.
    assert!(numbered > 1);
    let mut file = file;
    let before = file.get(first - 8);
    file.put(first - 4, before);
    file.refused("is unknown or out of order");
}
