//! A file allocates memory in proportion to its size, whatever lengths it claims.

use super::{count_from_here, counted, most_bytes};
use testkit::prelude::*;

#[test]
fn a_false_length_allocates_little_memory() {
    let written = |buildings: u32| {
        let mut file = Vec::new();
        BspTree::build(scene::city(buildings, 1).polygons()).unwrap().write(&mut file).unwrap();
        file
    };
    counted(|| {
        let (small, large) = (written(60), written(2000));
        count_from_here();
        read_forged(&small);
        // The limit also holds for correct files: the tree, the file, and a copy of each.
        count_from_here();
        assert!(BspTree::read(&large[..]).is_ok());
        let most = most_bytes();
        assert!(most < 8 * large.len(), "{most} bytes for {}", large.len());
    });
}

fn read_forged(file: &[u8]) {
    let mut refused = 0;
    // Most of these places are not lengths, but all lengths are among them.
    for at in (16..file.len() - 12).step_by(4) {
        for length in [(1_u64 << 27) - 1, (1 << 28) - 1, 1 << 50, u64::MAX] {
            let mut forged = file.to_vec();
            forged[at..at + 8].copy_from_slice(&length.to_le_bytes());
            refused += usize::from(BspTree::read(&forged[..]).is_err());
        }
    }
    assert!(BspTree::read(file).is_ok());
    let most = most_bytes();
    assert!(most < 8 * file.len() + (1 << 20), "{most} bytes for {}", file.len());
    enough!(refused > 1000; "{refused}");
}

/// The limits in `cli/src/memory.rs`: files of triangles take up to `READING` bytes for each byte, and faces
/// of many corners more. (A corner of two bytes has three coordinates, and may have a colour.)
#[test]
fn obj_faces_of_many_corners_take_memory_in_proportion() {
    let first = "v 0 0 0 1 1 1\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
    let vertices = "v 0.125 0.5 0.75\nv 0.25 0.5 0.75\nv 0.25 0.875 0.625\n";
    for (before, unit, most) in [
        ("", &format!("{vertices}f -1 -2 -3\nf -1 -2 -3\n")[..], 6),
        ("f 1 2 3\n", vertices, 6),
        ("v 0 0 0\nf", " 1", 16),
        ("v 0 0 0\nvt 0 0\nvn 0 0 1\nf", " 1/1/1", 16),
        ("f", " 1", 24),
        ("f", " 1/1", 24),
        ("", "f 1\n", 24),
        ("", "f\n", 24),
    ] {
        let first = if before.starts_with('v') { "" } else { first };
        counted(|| {
            let file = [first, before, &unit.repeat(600_000 / unit.len()), "\n"].concat();
            let read = binspace::scene::Scene::from_obj("memory", file.as_bytes(), |_| None);
            // Besides the file itself.
            let (bytes, len) = (most_bytes() - file.capacity(), file.len());
            assert!(read.is_ok() && bytes <= most * len, "{unit:?}: {bytes} bytes for {len}");
        });
    }
}
