//! Any number of threads reads the same tree and finds the same fault.

use super::File;
use testkit::prelude::*;
use testkit::saved::bytes;

/// The start of the faces; each is 12 bytes.
const FACES: usize = 88;

/// The result of reading: the fault, or the file of the same tree.
fn read(file: &File) -> Result<Vec<u8>, String> {
    file.read().map(|tree| bytes(&tree))
}

/// The result of reading on some threads; without a number, on the calling thread.
fn read_on(threads: Option<usize>, file: &File) -> Result<Vec<u8>, String> {
    let Some(threads) = threads else { return read(file) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| read(file))
}

#[test]
fn any_number_of_threads_reads_the_same_tree() {
    let tree = BspTree::build(scene::terrain(30_000, 3).polygons()).expect("a tree");
    let file = File::of(&tree);
    let faces = file.len(FACES - 8);
    // Faces in several parts, which threads read while others read nodes.
    enough!(faces > 20_000; "{faces}");
    let corners = FACES + 12 * faces;
    // Triangles without numbers and without moved corners; none is dropped.
    let nodes = corners + 72 * faces + 3 * 8 + 6 * 8 + 8;
    assert_eq!(file.len(nodes - 8), tree.nodes().count());
    let far = (1_u64 << 52).to_le_bytes();
    let faults = [
        (corners + 72 * (faces - 1) + 16, "outside the grid"),
        (corners + 72 * (faces / 2), "outside the grid"),
        (corners + 72 * 5000, "corner 15000 is outside the grid"),
    ];
    // Faults are added from the last place to the first. Always the first fault of the file is reported.
    let mut forged = file.clone();
    forged.0[nodes + 4] |= 3;
    let mut cases = vec![(file.clone(), Ok(file.0.clone()))];
    cases.push((forged.clone(), Err("node 0 has a side of an unknown kind")));
    for (at, fault) in faults {
        forged.put_bytes(at, &far);
        cases.push((forged.clone(), Err(fault)));
    }
    for (file, expected) in cases {
        for threads in [None, Some(1), Some(2), Some(5)] {
            match (read_on(threads, &file), &expected) {
                (Ok(read), Ok(expected)) => assert!(read == *expected, "{threads:?}"),
                (Err(found), Err(fault)) => assert!(found.contains(fault), "{found}, not {fault}"),
                (found, expected) => panic!("{threads:?}: {:?}, not {expected:?}", found.err()),
            }
        }
    }
}
