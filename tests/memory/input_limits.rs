//! Wrong size hints, and endless polygons.

use super::{counted, most_bytes};
use binspace::Error;
use binspace::internals::MAX_CORNERS;
use std::cell::Cell;
use std::iter;
use testkit::hinted::Hinted;
use testkit::prelude::*;

const TRIANGLE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// A polygon of `len` repeating corners, with a size hint of `claim`.
fn round(len: usize, claim: usize, read: &Cell<usize>) -> impl Polygon {
    let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let items = (0..len).map(move |k| {
        read.set(read.get() + 1);
        square[k % 4]
    });
    claimed(items, claim)
}

fn claimed<I>(items: I, claim: usize) -> Hinted<I> {
    Hinted { items, hint: (claim, Some(claim)) }
}

/// The result of a function, and the largest memory in use while it ran.
fn peak<T>(run: impl FnOnce() -> T) -> (T, usize) {
    (run(), most_bytes())
}

fn unlimited() -> BuildOptions {
    BuildOptions::DEFAULT.with_max_fragments(usize::MAX)
}

fn endless_with_hint(claim: usize) -> impl Iterator<Item = [[f64; 3]; 3]> {
    claimed(iter::repeat(TRIANGLE), claim)
}

#[test]
fn hints_and_polygons_without_end_take_little_memory() {
    counted(read_too_much);
}

/// The cases, in the order of the allowed memory.
fn read_too_much() {
    // A claim beyond every limit is an error after a million polygons.
    let claims: [fn() -> Option<Error>; 5] = [
        || unlimited().build(endless_with_hint(1 << 40)).err(),
        || unlimited().build(iter::repeat(TRIANGLE)).err(),
        || BspTree::build(iter::repeat(TRIANGLE)).err(),
        || Faces::new(iter::repeat(TRIANGLE), None).err(),
        || Faces::new(endless_with_hint(1 << 60), None).err(),
    ];
    for claim in claims {
        let (error, bytes) = peak(claim);
        let error = error.expect("a limit");
        assert!(error.to_string().starts_with("there are more than "), "{error}");
        assert!(bytes < 100 << 20, "{bytes} bytes");
    }

    // Claims within the limits are not trusted: no memory is reserved for polygons that may not come.
    for claim in [1 << 25, 1 << 28] {
        let polygons = claimed(iter::repeat_n(TRIANGLE, 3), claim);
        let (tree, bytes) = peak(|| unlimited().build(polygons));
        assert_eq!(tree.expect("three triangles").len(), 3);
        assert!(bytes < 100 << 20, "{bytes} bytes for {claim} polygons");
    }

    // Corners of one polygon are read up to the limit.
    let few = [0, 3, 64].map(|claim| (20_000_000, claim));
    let right = [MAX_CORNERS + 1, 20_000_000, usize::MAX].map(|len| (len, len));
    for (len, claim) in few.into_iter().chain(right) {
        let read = Cell::new(0);
        let polygons = [(3, 3), (len, claim)].map(|(len, claim)| round(len, claim, &read));
        let (error, bytes) = peak(|| BspTree::build(polygons).err());
        let error = error.expect("a limit");
        assert_eq!(error.polygon(), Some(1));
        assert!(error.to_string().contains("corners"), "{error}");
        // The triangle before it is read a second time, for its precision.
        assert_eq!(read.get(), 2 * 3 + MAX_CORNERS + 1);
        assert!(bytes < 300 << 20, "{bytes} bytes");
    }

    // The limit does not reserve memory: half a million corners take some hundred bytes each.
    let (read, len) = (Cell::new(0), 1 << 19);
    let (faces, bytes) = peak(|| Faces::new([round(len, len, &read)], None));
    assert_eq!(faces.expect("a square").0.len(), 2);
    assert!(bytes < len * 512, "{bytes} bytes");
}
