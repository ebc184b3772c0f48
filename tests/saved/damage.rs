//! Truncated, damaged and forged files, and files of other kinds.

use testkit::effort::effort;
use testkit::prelude::*;
use testkit::saved::{bytes, checksum, seal};
use testkit::targets::saved::try_file;

/// Files of small trees: with cuts, bent faces, triangulated and dropped polygons, and for one view.
fn files() -> Vec<Vec<u8>> {
    let bent = [[0.0, 0.0, 0.0], [4.0, 0.0, 1e-12], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
    let across = [[1.0, 1.0, -1.0], [3.0, 2.0, -1.0], [3.0, 2.0, 1.0], [1.0, 1.0, 1.0]];
    let arrow = [[0.0, 0.0, 3.0], [2.0, 2.0, 3.0], [0.0, 1.0, 3.0], [-2.0, 2.0, 3.0]];
    let line = [[1.0, 1.0, 1.0]; 4];
    let mixed = [bent, across, arrow, line];
    let build = |scene: scene::Scene| bytes(&BspTree::build(scene.polygons()).unwrap());
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    vec![
        bytes(&BspTree::build(mixed).unwrap()),
        bytes(builder.build(mixed).unwrap()),
        build(scene::crossing(3)),
        build(scene::random_triangles(6, 5)),
    ]
}

fn message(file: &[u8]) -> String {
    BspTree::read(file).expect_err("a file that is not right").to_string()
}

#[test]
fn every_truncated_file_is_refused() {
    for file in files() {
        for len in 0..file.len() {
            let message = message(&file[..len]);
            assert!(message.contains("truncated"), "{len}: {message}");
        }
    }
}

#[test]
fn a_checksum_shows_every_changed_byte() {
    for file in files() {
        let body = file.len() - 4;
        assert_eq!(file[body..], checksum(&file[..body]).to_le_bytes(), "the checksum of gzip");
        for at in 0..file.len() {
            for change in [0x01, 0x80, 0xff] {
                let mut damaged = file.clone();
                damaged[at] ^= change;
                let message = message(&damaged);
                let is_told = match at {
                    0..8 => message.contains("not a binspace file"),
                    8..12 => message.contains("but a \"tree\" is expected"),
                    12..16 => message.contains("version"),
                    _ => message.contains("damaged"),
                };
                assert!(is_told, "byte {at}: {message}");
            }
        }
    }
}

/// Every byte is changed, in one way or with more effort in several, and the checksum is corrected. The file
/// must be refused, or its tree must be usable.
#[test]
fn a_forged_file_is_refused_or_usable() {
    let (mut usable, mut refused) = (0, 0);
    let changes = [0x01, 0x02, 0x10, 0x80, 0xff];
    let step = changes.len().div_ceil(effort());
    for file in files() {
        for at in 16..file.len() - 4 {
            for change in changes.iter().skip(at % step).step_by(step) {
                let mut forged = file.clone();
                forged[at] ^= change;
                seal(&mut forged);
                let is_usable = try_file(&forged);
                usable += usize::from(is_usable);
                refused += usize::from(!is_usable);
            }
        }
    }
    // Corners may be slightly moved, and counts may be wrong.
    enough!(usable > 200, refused > 200; "{usable} {refused}");
}

#[test]
fn an_absurd_length_is_refused() {
    let file = &files()[0];
    // The lengths of lists: each is replaced by 2⁵⁶ and by the largest allowed value.
    let mut tried = 0;
    for at in (16..file.len() - 12).step_by(4) {
        for length in [1_u64 << 56, (1 << 28) - 1, (1 << 29) - 1, u64::MAX] {
            let mut forged = file.clone();
            forged[at..at + 8].copy_from_slice(&length.to_le_bytes());
            seal(&mut forged);
            try_file(&forged);
            tried += 1;
        }
    }
    assert!(tried > 100);
}

#[test]
fn another_version_is_named() {
    let mut file = files().swap_remove(0);
    for version in [2, 4] {
        file[12] = version;
        seal(&mut file);
        let message = message(&file);
        let is_named = message.contains(&format!("version {version},"));
        assert!(is_named && message.contains("reads only version 3"), "{message}");
    }
}

#[test]
fn other_kinds_of_files_are_named() {
    assert!(message(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").contains("not a binspace file"));
    assert!(message(b"binspacescene").contains("truncated"));
    assert!(message(b"binspacescen\x01\0\0\0").contains("it contains a \"scen\""));
    assert!(message(b"").contains("truncated"));
}
