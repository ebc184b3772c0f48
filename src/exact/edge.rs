//! The edges of faces, as they are defined: between corners that may be moved onto the face's plane.

use super::faces::Faces;
use super::plane::Plane;

/// An edge of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExactEdge {
    /// The lattice points of its two corners.
    pub(super) ends: [[f64; 3]; 2],
    /// How they are moved onto the face's plane; `None` if both are on it.
    pub(super) moved: Option<Moved>,
}

/// How the ends of an edge are moved: along an axis, by half a step at most.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    pub(super) axis: usize,
    /// The face's plane at the ends, and what it gains with a step along the axis.
    pub(super) offs: [i128; 2],
    pub(super) slope: i128,
}

impl Faces {
    /// The edge of a face that begins at its corner `k`.
    #[inline]
    pub(super) fn edge(&self, face: u32, k: u32) -> ExactEdge {
        let corners = self.corners(face);
        let next = if k as usize + 1 == corners.len() { 0 } else { k + 1 };
        let ends = [k, next].map(|k| corners[k as usize]);
        let moved = self.upright_axis(face).and_then(|axis| {
            let is_on = [k, next].map(|k| self.is_on_triangle(face, k));
            if is_on == [true; 2] {
                return None;
            }
            let own = Plane::through(self.triangle(face));
            let off = |i: usize| if is_on[i] { 0 } else { own.last_bits_at(&ends[i]) };
            let (offs, slope) = ([off(0), off(1)], own.normal()[axis]);
            // An edge between two corners that are not moved must be treated as an edge, not as a cut
            // by an upright plane: the neighbour across it may have moved no corner, and both must
            // get the same bits.
            (offs != [0; 2]).then_some(Moved { axis, offs, slope })
        });
        ExactEdge { ends, moved }
    }

    /// The axis along which a corner is moved onto its face's plane, if it is off it.
    pub(super) fn axis_of_move(&self, face: u32, k: u32) -> Option<usize> {
        let axis = self.upright_axis(face).filter(|_| !self.is_on_triangle(face, k))?;
        let own = Plane::through(self.triangle(face));
        (own.last_bits_at(&self.corners(face)[k as usize]) != 0).then_some(axis)
    }

    /// Whether corner `k` is one of the three that define its face's plane. Others are within half a
    /// step of it along the axis, which 128 bits hold.
    fn is_on_triangle(&self, face: u32, k: u32) -> bool {
        let first = self.faces[face as usize].start;
        self.reference_triangle(face).contains(&(first + k))
    }
}
