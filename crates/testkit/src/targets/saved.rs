//! Files of trees, either forged or with any bytes. A tree that is read must be usable.

use super::super::decode;
use super::super::saved::{bytes, seal, use_all};
use arbitrary::{Result, Unstructured};
use binspace::{BspTree, BuildOptions, ErrorKind, FrameBuilder};

/// The largest file, in bytes, in which places are changed.
const MOST: usize = 20_000;

/// Reads a tree's file with some changes in half of the cases, and the bytes themselves in the other half.
/// The checksum is right.
pub fn run(data: &[u8]) {
    match data.split_first() {
        Some((kind, rest)) if kind % 2 == 1 => {
            // Too few bytes change nothing.
            let _ = forge(&mut Unstructured::new(rest));
        }
        Some((_, rest)) => {
            let mut file = rest.to_vec();
            seal(&mut file);
            try_file(&file);
        }
        None => {}
    }
}

/// Reads a file, and uses its tree in every way.
pub fn try_file(file: &[u8]) -> bool {
    match BspTree::read(file) {
        Ok(tree) => {
            if let Err(what) = use_all(&tree) {
                panic!("{what}: {file:?}");
            }
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty() && error.kind() != ErrorKind::Io);
            false
        }
    }
}

fn forge(bytes: &mut Unstructured<'_>) -> Result<()> {
    let (options, for_one_view) = (decode::options(bytes)?, bytes.arbitrary()?);
    let polygons = decode::polygons(bytes, 8)?;
    let Some(mut file) = file(&options, &polygons, for_one_view) else { return Ok(()) };
    while !bytes.is_empty() {
        change(bytes, &mut file)?;
        let mut sealed = file.clone();
        seal(&mut sealed);
        try_file(&sealed);
    }
    Ok(())
}

/// The file of a tree of some polygons, if it is not too long.
fn file<P: binspace::Polygon>(
    options: &BuildOptions,
    polygons: &[P],
    for_one_view: bool,
) -> Option<Vec<u8>> {
    let file = if for_one_view {
        bytes(FrameBuilder::new(options.clone()).build(polygons).ok()?)
    } else {
        bytes(&options.build(polygons).ok()?)
    };
    (file.len() < MOST).then_some(file)
}

/// Changes a number of the file slightly or completely, or copies one number over another.
fn change(bytes: &mut Unstructured<'_>, file: &mut [u8]) -> Result<()> {
    // Changes begin after the head, because a changed head is always refused.
    let place = |bytes: &mut Unstructured<'_>| bytes.int_in_range(16..=file.len() - 5);
    let at = place(bytes)?;
    let word = |at: usize| at & !3;
    match bytes.int_in_range(0..=6u8)? {
        0 => file[at] = bytes.arbitrary()?,
        1 => file[at] ^= 1 << bytes.int_in_range(0..=7u8)?,
        2 => file[at] = file[at].wrapping_add(1),
        3 => file[at] = file[at].wrapping_sub(1),
        4 => {
            let from = place(bytes)?;
            file.copy_within(word(from)..word(from) + 4, word(at));
        }
        5 => {
            let (from, len) = (place(bytes)?, bytes.int_in_range(1..=24usize)?);
            let len = len.min(file.len() - from.max(at));
            file.copy_within(from..from + len, at);
        }
        _ => {
            let other = word(place(bytes)?);
            for k in 0..4 {
                file.swap(word(at) + k, other + k);
            }
        }
    }
    Ok(())
}
