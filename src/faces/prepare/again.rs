//! Duplicates among polygons that are added to a finished scene.

use super::Preparer;
use crate::Error;
use crate::exact::Faces;
use crate::faces::duplicates::hash;
use crate::faces::listener::Listener;
use crate::memory::{collect, reserve};

impl Preparer {
    /// Counts the polygons just [appended](Self::append) that have the corners of an earlier one, in the
    /// same cyclic order or its reverse; `before` is how many faces there were. O(n log n).
    ///
    /// The corners of earlier polygons are those of their faces: a corner that no triangle has is not
    /// known, and then a duplicate is not found.
    pub(crate) fn duplicates_added(
        &mut self,
        faces: &Faces,
        before: usize,
        listener: &dyn Listener,
    ) -> Result<usize, Error> {
        let Self { input, builder, outlines, .. } = self;
        // The builder rounds corners to its faces' lattice.
        builder.faces.lattice = *faces.lattice();
        let earlier = Earlier { faces, before };
        // Of each earlier polygon whose hash an added one has: its first face.
        let mut alike = Vec::new();
        outlines.seen.sort_unstable();
        let mut face = 0;
        while face < before {
            let corners = earlier.corners(face)?;
            listener.work(corners.len())?;
            let hash = hash(corners.into_iter());
            if outlines.seen.binary_search_by_key(&hash, |&(hash, _)| hash).is_ok() {
                reserve(&mut alike, 1)?;
                alike.push((hash, face));
            }
            face = earlier.end(face);
        }
        alike.sort_unstable();
        outlines.duplicates_of(
            |hash| {
                let start = alike.partition_point(|&(other, _)| other < hash);
                let same = alike[start..].iter().take_while(move |&&(other, _)| other == hash);
                same.map(|&(_, face)| earlier.corners(face))
            },
            |polygon| builder.lattice_corners(input.polygon(polygon), listener),
        )
    }
}

/// The faces that were there before.
struct Earlier<'a> {
    faces: &'a Faces,
    before: usize,
}

impl Earlier<'_> {
    /// The first face behind those of a face's polygon.
    fn end(&self, first: usize) -> usize {
        let polygon = |face: usize| self.faces.polygon(face as u32);
        (first + 1..self.before)
            .find(|&face| polygon(face) != polygon(first))
            .unwrap_or(self.before)
    }

    /// The corners of a polygon as they were given, by its first face.
    fn corners(&self, first: usize) -> Result<Vec<[f64; 3]>, Error> {
        let mut numbered = Vec::new();
        for face in first as u32..self.end(first) as u32 {
            let range = self.faces.corner_range(face);
            reserve(&mut numbered, range.len())?;
            numbered.extend((0..).zip(range).map(|(k, corner)| {
                (self.faces.corner_number(face, k), self.faces.given_corner(corner as u32))
            }));
        }
        numbered.sort_unstable_by_key(|&(number, _)| number);
        numbered.dedup_by_key(|&mut (number, _)| number);
        collect(numbered.into_iter().map(|(_, corner)| corner))
    }
}
