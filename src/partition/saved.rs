//! Writes and reads partitions.

use std::io::{self, Read, Write};

use super::{Partition, SplitPlane};
use crate::error::Error;
use crate::exact::faces::EVERYWHERE;
use crate::exact::lattice::MAX_TOLERANCE;
use crate::exact::{LATTICE_LIMIT, Lattice};
use crate::save::{Kind, Reader, Writer, damaged, invalid, u32_at, u64_at};

const KIND: Kind = Kind { name: *b"part", version: 1 };

impl Partition {
    /// Writes the partition. [`read`](Self::read) returns an equal partition.
    ///
    /// # Layout
    ///
    /// Version 1. Numbers and lists are as in the file of a [tree](crate::BspTree::write).
    ///
    /// | part | type | content |
    /// |---|---|---|
    /// | kind | 12 bytes | `binspacepart` |
    /// | version | `u32` | 1 |
    /// | grid, tolerance | | as in the file of a tree |
    /// | planes | list of `u32` and `i64` | the axis (0, 1, 2 for x, y, z) and the coordinate on the grid |
    /// | checksum | | as in the file of a tree |
    ///
    /// There is one plane less than there are cells. The planes form a binary tree, and are listed depth
    /// first: each plane is followed by the planes behind it, then by the planes in front of it. Of n cells
    /// that a plane divides, n / 2 (rounded down) are behind the plane.
    ///
    /// # Errors
    ///
    /// The errors of the writer.
    pub fn write(&self, output: impl Write) -> io::Result<()> {
        let mut file = Writer::new(output, KIND)?;
        self.lattice.write(&mut file)?;
        file.f64(self.tolerance)?;
        file.list(self.planes.iter(), |file, plane| {
            file.u32(plane.axis as u32)?;
            file.u64(plane.at as i64 as u64)
        })?;
        file.finish()
    }

    /// Reads a partition that [`write`](Self::write) has written. Reads only the partition's bytes, so other
    /// data may follow.
    ///
    /// Any file is safe to read, and memory grows only with the bytes read. Even with a forged file, each
    /// point of a polygon is in exactly one cell. But forged planes can put all points into one cell.
    ///
    /// # Errors
    ///
    /// - The data cannot be read.
    /// - The data are not a partition, have another version, or are truncated or damaged.
    /// - A plane, the grid or the tolerance is invalid.
    /// - Memory runs out.
    pub fn read(input: impl Read) -> Result<Self, Error> {
        let mut file = Reader::new(input, KIND)?;
        let lattice = Lattice::read(&mut file)?;
        let tolerance = file.f64("tolerance")?;
        let planes = file.list("planes", Self::MAX_CELLS - 1, |bytes: &[u8; 12]| SplitPlane {
            axis: u32_at(bytes, 0) as usize,
            at: u64_at(bytes, 4) as i64 as f64,
        })?;
        file.finish()?;
        lattice.check()?;
        if !(0.0..=MAX_TOLERANCE).contains(&tolerance) {
            return Err(damaged("tolerance", "is negative, too large or NaN"));
        }
        let is_wrong = |plane: &SplitPlane| plane.axis > 2 || plane.at.abs() > LATTICE_LIMIT;
        if let Some(plane) = planes.iter().position(is_wrong) {
            return Err(invalid("plane", plane, "is outside the grid"));
        }
        let partition = Self { lattice, tolerance, planes };
        partition.check_planes()?;
        Ok(partition)
    }

    /// Returns an error unless each plane is inside the box that it divides.
    fn check_planes(&self) -> Result<(), Error> {
        let mut rest = vec![(self.root(), EVERYWHERE)];
        while let Some((subtree, part)) = rest.pop() {
            if subtree.cells.len() == 1 {
                continue;
            }
            let SplitPlane { axis, at } = self.planes[subtree.plane];
            if !(part[0][axis]..=part[1][axis]).contains(&at) {
                return Err(invalid("plane", subtree.plane, "is outside the part that it divides"));
            }
            let [mut behind, mut ahead] = [part; 2];
            behind[1][axis] = at;
            ahead[0][axis] = at;
            let [back, front] = subtree.sides();
            rest.extend([(back, behind), (front, ahead)]);
        }
        Ok(())
    }
}
