//! The lists of faces: clear, copy, append, shrink, and search for duplicates.

use std::collections::HashSet;
use std::ops::Range;

use crate::error::{Error, Kind};
use crate::exact::faces::{Face, Thin};
use crate::exact::{Faces, MAX_NAMES, integers};
use crate::memory::{collect, reserve};
use crate::random::mix;

impl Faces {
    pub(super) fn clear(&mut self) {
        self.corners.clear();
        self.numbers.clear();
        self.numbered.clear();
        self.faces.clear();
        self.moved.clear();
        self.planes.clear();
        self.thin = Thin::default();
    }

    /// No faces, with the same lattice and tolerance.
    pub(crate) fn without_faces(&self) -> Self {
        let Self { lattice, tolerance, .. } = *self;
        Self { lattice, tolerance, ..Self::default() }
    }

    /// A copy, or an error where there is no memory for it.
    pub(crate) fn try_clone(&self) -> Result<Self, Error> {
        let Self { lattice, tolerance, ref corners, ref numbers, ref numbered, .. } = *self;
        let Self { ref faces, ref moved, ref planes, thin, .. } = *self;
        Ok(Self {
            lattice,
            tolerance,
            corners: collect(corners.iter().copied())?,
            numbers: collect(numbers.iter().copied())?,
            numbered: collect(numbered.iter().copied())?,
            faces: collect(faces.iter().copied())?,
            moved: collect(moved.iter().copied())?,
            planes: collect(planes.iter().copied())?,
            thin,
        })
    }

    /// Gives memory back that is not needed.
    pub(crate) fn shrink_to_fit(&mut self) {
        self.corners.shrink_to_fit();
        self.numbers.shrink_to_fit();
        self.numbered.shrink_to_fit();
        self.faces.shrink_to_fit();
        self.moved.shrink_to_fit();
        self.planes.shrink_to_fit();
    }

    /// Adds the faces of later polygons.
    pub(super) fn append(&mut self, next: Self) -> Result<(), Error> {
        let (corners, numbers) = (self.corners.len(), self.numbers.len() as u32);
        if corners + next.corners.len() >= MAX_NAMES {
            return Err(Kind::CornersInAll(MAX_NAMES).error());
        }
        let first = self.faces.len() as u32;
        reserve(&mut self.numbered, next.numbered.len())?;
        reserve(&mut self.numbers, next.numbers.len())?;
        let numbered = next.numbered.iter();
        self.numbered.extend(numbered.map(|&(face, at)| (first + face, numbers + at)));
        self.numbers.extend(next.numbers);
        reserve(&mut self.corners, next.corners.len())?;
        self.corners.extend(next.corners);
        reserve(&mut self.faces, next.faces.len())?;
        let moved = |face: Face| Face { start: face.start + corners as u32, ..face };
        self.faces.extend(next.faces.into_iter().map(moved));
        reserve(&mut self.moved, next.moved.len())?;
        let moved = next.moved.into_iter();
        self.moved.extend(moved.map(|(corner, given)| (corner + corners as u32, given)));
        Ok(())
    }

    /// How many polygons have the corners of an earlier one, in the same cyclic order or its reverse.
    /// Exact; takes O(n log n) time for n corners.
    ///
    /// A polygon's corners are those of its faces, before any was moved. Corners that no face has are
    /// unknown.
    #[doc(hidden)]
    pub fn duplicates(&self) -> usize {
        // Equal outlines have equal hashes. Polygons whose hash is unique are not compared.
        let (mut polygons, mut first) = (Vec::new(), 0);
        for own in self.faces.chunk_by(|a, b| a.polygon == b.polygon) {
            let faces = first..first + own.len() as u32;
            first = faces.end;
            polygons.push((hash(&self.outline(faces.clone())), faces));
        }
        polygons.sort_unstable_by_key(|&(hash, _)| hash);
        let alike = polygons.chunk_by(|a, b| a.0 == b.0).filter(|alike| alike.len() > 1);
        let duplicates = alike.map(|alike| {
            let outlines = alike.iter().map(|(_, faces)| canonical(self.outline(faces.clone())));
            alike.len() - outlines.collect::<HashSet<_>>().len()
        });
        duplicates.sum()
    }

    /// The corners of a polygon as they were given, by its faces.
    fn outline(&self, faces: Range<u32>) -> Vec<Corner> {
        let mut corners = Vec::new();
        for face in faces {
            corners.extend((0..).zip(self.corner_range(face)).map(|(k, corner)| {
                (self.corner_number(face, k), integers(self.given_corner(corner as u32)))
            }));
        }
        corners.sort_unstable();
        corners.dedup();
        corners.into_iter().map(|(_, corner)| corner).collect()
    }
}

type Corner = [i64; 3];

/// A hash of an outline that depends neither on its start nor on its direction.
fn hash(corners: &[Corner]) -> u64 {
    let of_corner = |corner: &Corner| corner.iter().fold(0, |hash, &c| mix(hash ^ c as u64));
    corners.iter().map(of_corner).fold(0, u64::wrapping_add)
}

/// The canonical form of an outline: the same list wherever the outline starts and in whichever
/// direction it runs.
fn canonical(corners: Vec<Corner>) -> Vec<Corner> {
    let reverse: Vec<Corner> = corners.iter().rev().copied().collect();
    let least = |mut corners: Vec<Corner>| {
        let start = least_rotation(&corners);
        corners.rotate_left(start);
        corners
    };
    least(corners).min(least(reverse))
}

/// The start of the lexicographically least rotation, in linear time (Shiloach, “Fast canonization
/// of circular strings”, 1981).
fn least_rotation(corners: &[Corner]) -> usize {
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
    use super::{Corner, canonical, least_rotation};

    /// All sequences of a length over three corners.
    fn sequences(len: u32) -> impl Iterator<Item = Vec<Corner>> {
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
            let form = canonical(corners.clone());
            let mut other: Vec<Corner> = corners.iter().rev().copied().collect();
            for _ in 0..corners.len() {
                other.rotate_left(1);
                assert_eq!(canonical(other.clone()), form);
            }
        }
    }
}
