//! The lists of faces: clear, append and shrink.

use crate::error::{Error, Limit};
use crate::exact::faces::{Face, Thin};
use crate::exact::{Faces, MAX_LABELS};
use crate::memory::{collect, reserve};

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

    /// Adds the faces of the polygons that follow.
    pub(super) fn append(&mut self, next: Self) -> Result<(), Error> {
        let (corners, numbers) = (self.corners.len(), self.numbers.len() as u32);
        if corners + next.corners.len() >= MAX_LABELS {
            return Err(Limit::Corners(MAX_LABELS).error());
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
}
