//! Partitions and trees of cells in files.

use crate::cells::polygons::{stars, tiles, triangles};
use binspace::partition::Partition;
use testkit::divided::Divided;
use testkit::prelude::*;
use testkit::saved::{bytes, seal, use_all};
use testkit::snapshot::Snapshot;
use testkit::targets;
use testkit::targets::cells::{try_file, written};

fn divided(seed: u64, cells: usize) -> Divided {
    let mut dice = Dice(seed);
    let mut polygons = triangles(&mut dice, 12, 20);
    polygons.extend(tiles(&mut dice, 12));
    polygons.extend(stars(&mut dice, 2));
    Divided::new(polygons, BuildOptions::DEFAULT, cells).unwrap()
}

#[test]
fn written_data_are_read_again() {
    for cells in 1..8 {
        let scene = divided(cells as u64, cells);
        let file = written(&scene.partition);
        assert_eq!(Partition::read(&file[..]).unwrap(), scene.partition);
        // Other data may follow.
        let mut rest = &[&file[..], b"more"].concat()[..];
        assert!(Partition::read(&mut rest).is_ok() && rest == b"more");
        for cell in &scene.cells {
            let again = BspTree::read(&bytes(&cell.tree)[..]).unwrap();
            assert_eq!(Snapshot::of(&again), Snapshot::of(&cell.tree));
            again.validate().unwrap();
            assert_eq!(again.preparation(), cell.tree.preparation());
            use_all(&again).unwrap();
        }
    }
}

#[test]
fn damaged_partitions_are_errors() {
    let file = written(&divided(3, 5).partition);
    for end in 0..file.len() {
        assert!(Partition::read(&file[..end]).is_err());
    }
    for bit in 0..8 * file.len() {
        let mut damaged = file.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(Partition::read(&damaged[..]).is_err(), "bit {bit}");
    }
}

/// Forged bytes with a right checksum: if a partition is read, it can be used.
#[test]
fn forged_partitions_are_errors_or_partitions() {
    let scene = divided(4, 4);
    let file = written(&scene.partition);
    let mut read = [0; 2];
    for at in 16..file.len() - 4 {
        for value in [0, 1, 0x7f, 0xff] {
            let mut forged = file.clone();
            forged[at] = value;
            seal(&mut forged);
            read[usize::from(try_file(&forged, &scene.polygons))] += 1;
        }
    }
    enough!(read[0] > 50, read[1] > 50; "{read:?}");
}

/// A tolerance that no partition has, with a right checksum.
#[test]
fn partitions_of_other_tolerances_are_refused() {
    let scene = divided(4, 4);
    let file = written(&scene.partition);
    // After the tolerance come the number of planes, three planes of 12 bytes, and the checksum.
    let at = file.len() - 4 - 3 * 12 - 8 - 8;
    let limit = (1_u64 << 51) as f64 / 128.0;
    let wrong = [-1.0, limit * 1.001, f64::INFINITY, f64::NAN];
    for (tolerances, is_right) in [(&[0.0, 1.0, limit][..], true), (&wrong[..], false)] {
        for tolerance in tolerances {
            let mut forged = file.clone();
            forged[at..at + 8].copy_from_slice(&tolerance.to_le_bytes());
            seal(&mut forged);
            assert_eq!(Partition::read(&forged[..]).is_ok(), is_right, "{tolerance}");
        }
    }
}

/// Forged trees of cells: nothing panics.
#[test]
fn forged_trees_of_cells_can_be_used() {
    let scene = divided(5, 3);
    let (mut dice, mut read) = (Dice(1), [0; 2]);
    for cell in &scene.cells {
        let file = bytes(&cell.tree);
        for _ in 0..times(200) {
            let mut forged = file.clone();
            let at = 16 + dice.below(file.len() - 20);
            forged[at] = if dice.below(2) == 0 { dice.below(256) as u8 } else { forged[at] ^ 1 };
            seal(&mut forged);
            read[usize::from(targets::saved::try_file(&forged))] += 1;
        }
    }
    enough!(read[0] > 120, read[1] > 20; "{read:?}");
}
