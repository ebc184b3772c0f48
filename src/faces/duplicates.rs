//! Counts polygons that are given more than once.

use std::collections::HashSet;

use crate::Error;
use crate::exact::integers;
use crate::memory::{collect, reserve};

/// The polygons seen, each with a hash of its corners that does not depend on their order.
#[derive(Debug, Default)]
pub(super) struct Outlines {
    pub(super) seen: Vec<(u64, u32)>,
    /// Working space: a hash table of the numbers from 1 on of those seen; 0 is none.
    places: Vec<u32>,
}

impl Outlines {
    /// Forgets all polygons.
    pub(super) fn clear(&mut self) {
        self.seen.clear();
    }

    /// Adds a polygon by its corners on the lattice.
    pub(super) fn add(&mut self, polygon: usize, corners: impl Iterator<Item = [f64; 3]>) {
        self.seen.push((hash(corners), polygon as u32));
    }

    /// Adds the polygons of another list.
    pub(super) fn append(&mut self, other: Self) -> Result<(), Error> {
        reserve(&mut self.seen, other.seen.len())?;
        self.seen.extend(other.seen);
        Ok(())
    }

    /// Whether any two have the same hash.
    fn has_alike(&mut self) -> Result<bool, Error> {
        let Self { seen, places } = self;
        let size = (2 * seen.len()).next_power_of_two();
        places.clear();
        reserve(places, size)?;
        places.resize(size, 0);
        for (&(hash, _), number) in seen.iter().zip(1..) {
            let mut place = (hash >> 32) as usize & (size - 1);
            while places[place] != 0 {
                if seen[places[place] as usize - 1].0 == hash {
                    return Ok(true);
                }
                place = (place + 1) & (size - 1);
            }
            places[place] = number;
        }
        Ok(false)
    }

    /// Counts the polygons that have the same corners as an earlier one, in the same cyclic order
    /// or its reverse. Exact, in O(n log n), and O(n) if there are none; `corners` must return the corners
    /// of a polygon again.
    pub(super) fn duplicates(
        &mut self,
        corners: impl FnMut(usize) -> Result<Vec<[f64; 3]>, Error>,
    ) -> Result<usize, Error> {
        if !self.has_alike()? {
            return Ok(0);
        }
        self.seen.sort_unstable();
        let nothing = |_| std::iter::empty::<Result<Vec<[f64; 3]>, Error>>();
        self.duplicates_of(nothing, corners)
    }

    /// The same of polygons in the order of their hashes, where others came before: `earlier` gives the
    /// corners of those with some hash.
    pub(super) fn duplicates_of<I: Iterator<Item = Result<Vec<[f64; 3]>, Error>>>(
        &self,
        mut earlier: impl FnMut(u64) -> I,
        mut corners: impl FnMut(usize) -> Result<Vec<[f64; 3]>, Error>,
    ) -> Result<usize, Error> {
        let mut duplicates = 0;
        for polygons in self.seen.chunk_by(|a, b| a.0 == b.0) {
            let mut earlier = earlier(polygons[0].0).peekable();
            if polygons.len() == 1 && earlier.peek().is_none() {
                continue;
            }
            let mut outlines = HashSet::new();
            for corners in earlier {
                add(&mut outlines, corners?)?;
            }
            for &(_, polygon) in polygons {
                duplicates += usize::from(!add(&mut outlines, corners(polygon as usize)?)?);
            }
        }
        Ok(duplicates)
    }
}

/// A hash of a polygon's corners that does not depend on their order.
pub(super) fn hash(corners: impl Iterator<Item = [f64; 3]>) -> u64 {
    corners.fold(0, |sum, corner| sum.wrapping_add(mix(corner)))
}

type Snapped = [i64; 3];

/// Adds an outline to others; whether it is a new one.
fn add(outlines: &mut HashSet<Vec<Snapped>>, corners: Vec<[f64; 3]>) -> Result<bool, Error> {
    let outline = canonical(collect(corners.into_iter().map(integers))?)?;
    outlines.try_reserve(1).map_err(|_| Error::out_of_memory())?;
    Ok(outlines.insert(outline))
}

fn mix(corner: [f64; 3]) -> u64 {
    let [x, y, z] = corner.map(f64::to_bits);
    let sum = x.wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ y.wrapping_mul(0xbf58_476d_1ce4_e5b9).rotate_left(21)
        ^ z.wrapping_mul(0x94d0_49bb_1331_11eb).rotate_left(42);
    (sum ^ sum >> 31).wrapping_mul(0xd6e8_feb8_6659_fd93)
}

/// The canonical form of an outline: the same list wherever the outline starts and in whichever
/// direction it runs.
fn canonical(mut corners: Vec<Snapped>) -> Result<Vec<Snapped>, Error> {
    let start = least_rotation(&corners);
    corners.rotate_left(start);
    let mut reverse = collect(corners.iter().rev().copied())?;
    let start = least_rotation(&reverse);
    reverse.rotate_left(start);
    Ok(corners.min(reverse))
}

/// The start of the lexicographically least rotation, in linear time (Shiloach, “Fast canonization
/// of circular strings”, 1981).
fn least_rotation(corners: &[Snapped]) -> usize {
    let n = corners.len();
    let (mut i, mut j, mut same) = (0, 1, 0);
    while i < n && j < n && same < n {
        let [a, b] = [i, j].map(|start| corners[(start + same) % n]);
        match a.cmp(&b) {
            std::cmp::Ordering::Equal => {
                same += 1;
                continue;
            }
            std::cmp::Ordering::Less => j += same + 1,
            std::cmp::Ordering::Greater => i += same + 1,
        }
        j += usize::from(i == j);
        same = 0;
    }
    i.min(j)
}

#[cfg(test)]
mod tests {
    use super::{Snapped, canonical, least_rotation};

    /// All sequences of a length over three corners.
    fn sequences(len: u32) -> impl Iterator<Item = Vec<Snapped>> {
        (0..3i64.pow(len)).map(move |code| (0..len).map(|k| [code / 3i64.pow(k) % 3; 3]).collect())
    }

    #[test]
    fn the_least_rotation_is_the_least_of_all() {
        for corners in (1..7).flat_map(sequences) {
            let rotated = |start: usize| {
                let mut corners = corners.clone();
                corners.rotate_left(start);
                corners
            };
            let least = (0..corners.len()).map(rotated).min();
            assert_eq!(Some(rotated(least_rotation(&corners))), least);
        }
    }

    #[test]
    fn every_start_and_direction_has_one_form() {
        for corners in (1..7).flat_map(sequences) {
            let form = canonical(corners.clone()).unwrap();
            let mut other: Vec<Snapped> = corners.iter().rev().copied().collect();
            for _ in 0..corners.len() {
                other.rotate_left(1);
                assert_eq!(canonical(other.clone()).unwrap(), form);
            }
        }
    }
}
