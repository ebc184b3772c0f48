//! Numbers that no tree has: each is refused, with a message that names the number.

use super::File;
use binspace::partition::Extent;
use testkit::prelude::*;
use testkit::shapes::sheet;

/// The place of the number of faces; `BspTree::write` describes the layout.
const FACES: usize = 80;
/// The start of the flags.
const FLAGS: usize = 16;
/// Steps from the middle of the grid to its border, and to the side of a cell without a plane.
const LIMIT: i64 = 1 << 51;
const OPEN: i64 = LIMIT + (1 << 44);

/// The places of the parts of a file.
struct Places {
    corners: usize,
    moved: usize,
    lengths: usize,
    nodes: usize,
}

impl File {
    /// A coordinate of a point.
    fn put_step(&mut self, point: usize, axis: usize, step: i64) {
        self.put_bytes(point + 8 * axis, &step.to_le_bytes());
    }

    fn step(&self, point: usize, axis: usize) -> i64 {
        let at = point + 8 * axis;
        i64::from_le_bytes(self.0[at..at + 8].try_into().expect("eight"))
    }

    fn places(&self) -> Places {
        let faces = self.len(FACES);
        let sides = |face: usize| self.get(FACES + 8 + 12 * face + 4) as usize;
        let corners = FACES + 8 + 12 * faces;
        let of_cell = if self.get(FLAGS) & 2 == 0 { 0 } else { 2 };
        let count = of_cell + (0..faces).map(sides).sum::<usize>();
        let numbered = corners + 24 * count;
        let with_numbers = (0..self.len(numbered)).map(|k| self.get(numbered + 8 + 4 * k) as usize);
        let numbers = with_numbers.map(sides).sum::<usize>();
        let moved = numbered + 8 + 4 * self.len(numbered) + 4 * numbers;
        let dropped = moved + 8 + 28 * self.len(moved);
        let lengths = dropped + 8 + 4 * self.len(dropped) + 4 * 8;
        Places { corners, moved, lengths, nodes: lengths + 2 * 8 }
    }
}

fn square(z: f64) -> [[f64; 3]; 4] {
    sheet(2, z, 4.0)
}

/// Without a node, the fragment has no place in an order.
#[test]
fn a_fragment_without_a_node_is_refused() {
    let mut file = File::of(&BspTree::build([square(0.0)]).expect("a tree"));
    let nodes = file.places().nodes;
    assert_eq!((file.len(nodes), file.message()), (1, String::new()));
    file.put_bytes(nodes, &0_u64.to_le_bytes());
    file.0.drain(nodes + 8..nodes + 16);
    file.refused("its nodes do not match its fragments");
    // Without the node and the fragment, the face has no fragment.
    file.put_bytes(nodes + 8, &0_u64.to_le_bytes());
    file.0.drain(nodes + 16..nodes + 20);
    file.refused("its nodes do not match its fragments");
    // An empty tree has no node and no fragment.
    let empty = BspTree::build::<[[f64; 3]; 3]>([]).expect("a tree");
    assert_eq!(File::of(&empty).message(), "");
}

#[test]
fn unknown_flags_are_refused() {
    let file = File::of(&BspTree::build([square(0.0)]).expect("a tree"));
    assert_eq!(file.get(FLAGS), 0);
    for bit in 0..32 {
        let mut file = file.clone();
        file.put(FLAGS, 1 << bit);
        match bit {
            // The file is read as the tree of one view.
            0 => assert_eq!(file.message(), ""),
            // The file contains no cell.
            1 => file.refused(""),
            _ => file.refused("its flags are unknown"),
        }
    }
}

#[test]
fn lengths_that_are_none_are_refused() {
    let file = File::of(&BspTree::build([square(0.0)]).expect("a tree"));
    let lengths = file.places().lengths;
    for at in [lengths, lengths + 8] {
        for (length, is_one) in [
            (0.0, true),
            (1e300, true),
            (f64::NAN, false),
            (f64::INFINITY, false),
            (-1e-9, false),
            (f64::NEG_INFINITY, false),
        ] {
            let mut file = file.clone();
            file.put_bytes(at, &f64::to_le_bytes(length));
            if is_one {
                assert_eq!(file.message(), "", "{length}");
            } else {
                file.refused("its counts of polygons are impossible");
            }
        }
    }
}

/// A cell, with planes on some of its sides.
fn cell() -> File {
    let mut extent = Extent::default();
    let polygons = [0.0, 1.0, 2.0].map(square);
    polygons.iter().for_each(|polygon| extent.include(polygon));
    let samples = polygons.iter().flatten().copied();
    let options = BuildOptions::DEFAULT;
    let partition = options.partition(&extent, samples, 4).expect("cells");
    let trees = (0..4).map(|cell| options.build_cell(&partition, cell, polygons).expect("a tree"));
    let tree = trees.into_iter().find(|tree| !tree.is_empty()).expect("something in some cell");
    File::of(&tree)
}

#[test]
fn the_box_of_a_cell_is_checked_on_each_side() {
    let file = cell();
    let [low, high] = [0, 1].map(|corner| file.places().corners + 24 * corner);
    assert_eq!(file.message(), "");
    for axis in 0..3 {
        for (corner, open) in [(low, -OPEN), (high, OPEN)] {
            let outside = [open + open.signum(), -open, LIMIT + 1, -LIMIT - 1, i64::MAX, i64::MIN];
            for step in outside {
                let mut file = file.clone();
                file.put_step(corner, axis, step);
                file.refused("its cell is outside the grid");
            }
            for step in [open, open.signum() * LIMIT] {
                let mut file = file.clone();
                file.put_step(corner, axis, step);
                let message = file.message();
                assert!(!message.contains("its cell"), "{message}");
            }
        }
        // The lower corner must be below the upper corner.
        let mut file = file.clone();
        file.put_step(low, axis, 8);
        file.put_step(high, axis, 7);
        file.refused("its cell has its lower corner above its upper corner");
        file.put_step(high, axis, 8);
        assert!(!file.message().contains("its cell"), "{}", file.message());
    }
}

/// A bent quad whose plane faces along an axis, beside one that is flat.
fn bent(axis: usize) -> File {
    let turned = |[x, y, z]: [f64; 3]| {
        let mut point = [x, y, z];
        point.rotate_right((axis + 1) % 3);
        point
    };
    let mut bent = square(1.0);
    bent[2][2] += 1e-6;
    let polygons = [square(0.0), bent].map(|square| square.map(turned));
    let tree = BuildOptions::DEFAULT.with_tolerance(1e-5).build(polygons).expect("a tree");
    assert_eq!(tree.preparation().flattened, 1);
    File::of(&tree)
}

#[test]
fn a_corner_is_moved_along_its_faces_axis_and_from_the_grid() {
    for axis in 0..3 {
        let file = bent(axis);
        let moved = file.places().moved;
        assert_eq!((file.len(moved), file.message()), (1, String::new()));
        let (corner, given) = (file.get(moved + 8), moved + 12);
        for other in 0..3 {
            for by in [1, -1, 1 << 30] {
                let mut file = file.clone();
                file.put_step(given, other, file.step(given, other) + by);
                if other == axis {
                    assert_eq!(file.message(), "", "{axis} {by}");
                } else {
                    file.refused(&format!("moved corner {corner} was not moved along its face's"));
                }
            }
        }
        for step in [LIMIT + 1, -LIMIT - 1, i64::MAX, i64::MIN] {
            let mut file = file.clone();
            file.put_step(given, axis, step);
            file.refused(&format!("moved corner {corner} was outside the grid"));
        }
        for step in [LIMIT, -LIMIT] {
            let mut file = file.clone();
            file.put_step(given, axis, step);
            assert_eq!(file.message(), "", "on its border");
        }
        // A corner of the flat square, even if it is not moved; and a corner that does not exist.
        let mut flat = file.clone();
        let corners = file.places().corners;
        let first = flat.0[corners..corners + 24].to_vec();
        flat.put(moved + 8, 0);
        flat.put_bytes(given, &first);
        flat.refused("moved corner 0 was not moved along its face's axis");
        for number in [8, u32::MAX] {
            let mut file = file.clone();
            file.put(moved + 8, number);
            file.refused(&format!("moved corner {number} is unknown or out of order"));
        }
        // The same corner twice.
        let mut twice = file.clone();
        let entry = twice.0[moved + 8..moved + 36].to_vec();
        twice.put_bytes(moved, &2_u64.to_le_bytes());
        twice.0.splice(moved + 8..moved + 8, entry);
        twice.refused(&format!("moved corner {corner} is unknown or out of order"));
    }
}
