//! Back-face detection: the sides of faces that a viewpoint sees.

#[cfg(test)]
mod tests;

use dashu_int::IBig;
use std::cmp::Ordering;

use binspace::Viewpoint;
use binspace::internals::{Eye, Faces};

use crate::place::{self, Plane};

/// Counts of faces by the side that they show to a viewpoint. The sign of Ax + By + Cz + D at the eye
/// decides, computed in big integers. For parallel rays along the z axis this is the sign of C.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Facing {
    /// Faces that show their front.
    pub front: usize,
    /// Faces that show their back.
    pub back: usize,
    /// Faces whose plane goes through the eye: they cover no pixel.
    pub edge_on: usize,
}

impl Facing {
    /// Counts the faces of a scene.
    pub fn of(faces: &Faces, viewpoint: Viewpoint) -> Self {
        let eye = place::eye(&Eye::new(viewpoint, faces.lattice()));
        let mut facing = Self::default();
        for face in 0..faces.len() as u32 {
            match Plane::of_face(faces, face).at_eye(&eye).cmp(&IBig::ZERO) {
                Ordering::Greater => facing.front += 1,
                Ordering::Less => facing.back += 1,
                Ordering::Equal => facing.edge_on += 1,
            }
        }
        facing
    }

    /// Returns the faces that need not be drawn: all except front faces.
    pub fn removed(&self) -> usize {
        self.back + self.edge_on
    }
}
