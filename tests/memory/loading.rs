//! A file allocates memory in proportion to its size, whatever lengths it claims.

use super::{counted, most_bytes};
use testkit::prelude::*;

#[test]
fn a_false_length_allocates_little_memory() {
    let tree = BspTree::build(scene::city(2000, 1).polygons()).unwrap();
    let mut file = Vec::new();
    tree.write(&mut file).unwrap();
    counted(|| read_forged(&file));
}

fn read_forged(file: &[u8]) {
    let mut refused = 0;
    // Most of these places are not lengths, but all lengths are among them.
    let places = (16..2000).chain(file.len() - 2000..file.len() - 12).step_by(4);
    for at in places.chain((2000..file.len() - 2000).step_by(3372)) {
        for length in [(1_u64 << 27) - 1, (1 << 28) - 1, 1 << 50, u64::MAX] {
            let mut forged = file.to_vec();
            forged[at..at + 8].copy_from_slice(&length.to_le_bytes());
            refused += usize::from(BspTree::read(&forged[..]).is_err());
        }
    }
    // The limit also holds for correct files: the tree, the file, and a copy of each.
    assert!(BspTree::read(file).is_ok());
    let most = most_bytes();
    assert!(most < 8 * file.len() + (1 << 20), "{most} bytes for {} ", file.len());
    enough!(refused > 1000; "{refused}");
}
