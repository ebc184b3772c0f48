//! Forged partitions with one wrong plane are refused, with a message that names the plane.

use binspace::partition::{Extent, Partition};
use testkit::prelude::*;
use testkit::saved::seal;

const LIMIT: i64 = 1 << 51;
/// The number of planes of the partition.
const PLANES: usize = 3;

/// Four cells, by planes of any axis and place: the first divides all, the second two of the cells, the third
/// the other two.
fn with_planes(planes: [(u32, i64); PLANES]) -> Result<Partition, String> {
    let mut extent = Extent::default();
    extent.include(&[DVec3::splat(-1.0), DVec3::splat(1.0)]);
    let samples = [DVec3::ZERO];
    let partition = BuildOptions::DEFAULT.partition(&extent, samples, PLANES + 1);
    let mut file = Vec::new();
    partition.expect("cells").write(&mut file).expect("a list takes all");
    let first = file.len() - 4 - 12 * PLANES;
    for (k, (axis, at)) in planes.into_iter().enumerate() {
        let place = first + 12 * k;
        file[place..place + 4].copy_from_slice(&axis.to_le_bytes());
        file[place + 4..place + 12].copy_from_slice(&at.to_le_bytes());
    }
    seal(&mut file);
    Partition::read(&file[..]).map_err(|error| error.to_string())
}

/// One more plane than a partition can have is refused for this reason. The largest number is refused because
/// the planes are missing.
#[test]
fn a_file_has_at_most_the_planes_that_a_partition_can_have() {
    let mut extent = Extent::default();
    extent.include(&[DVec3::splat(-1.0), DVec3::splat(1.0)]);
    let partition = BuildOptions::DEFAULT.partition(&extent, [DVec3::ZERO], 1).expect("one cell");
    let mut file = Vec::new();
    partition.write(&mut file).expect("a list takes all");
    let count = file.len() - 4 - 8;
    for (planes, says) in [
        (Partition::MAX_CELLS - 1, "it is truncated within its planes"),
        (Partition::MAX_CELLS, "above the limit of 16777215"),
    ] {
        file[count..count + 8].copy_from_slice(&(planes as u64).to_le_bytes());
        seal(&mut file);
        let message = Partition::read(&file[..]).expect_err("no planes follow").to_string();
        assert!(message.contains(says), "{planes}: {message}");
    }
}

#[test]
fn planes_are_within_the_grid() {
    for axis in 0..3 {
        for at in [LIMIT, -LIMIT, 0] {
            let partition =
                with_planes([(axis, at), (axis, at), (axis, at)]).expect("on its border");
            assert_eq!(partition.cells(), PLANES + 1);
        }
        for (number, says) in [(0, "plane 0"), (1, "plane 1"), (2, "plane 2")] {
            let side = if number == 1 { -1 } else { 1 };
            let mut planes = [(axis, 0); PLANES];
            for at in [side * (LIMIT + 1), side * (LIMIT + (1 << 44)), side * i64::MAX] {
                planes[number].1 = at;
                let message = with_planes(planes).expect_err("beyond the border");
                assert!(message.contains(says), "{at}: {message}");
                assert!(message.contains("is outside the grid"), "{at}: {message}");
            }
        }
    }
    for axis in [3, u32::MAX] {
        let message = with_planes([(0, 0), (0, 0), (axis, 0)]).expect_err("no axis");
        assert!(message.contains("plane 2 is outside the grid"), "{message}");
    }
}

#[test]
fn planes_are_within_the_sets_that_they_divide() {
    for axis in 0..3 {
        let at = |behind: i64, ahead: i64| with_planes([(axis, 10), (axis, behind), (axis, ahead)]);
        assert!(at(10, 10).is_ok() && at(-LIMIT, LIMIT).is_ok());
        let message = at(11, 12).expect_err("ahead of the first");
        assert!(message.contains("plane 1 is outside the part that it divides"), "{message}");
        let message = at(8, 9).expect_err("behind the first");
        assert!(message.contains("plane 2 is outside the part that it divides"), "{message}");
        // On another axis, the plane may be anywhere.
        let other = (axis + 1) % 3;
        assert!(with_planes([(axis, 10), (other, 11), (other, 9)]).is_ok());
    }
}
