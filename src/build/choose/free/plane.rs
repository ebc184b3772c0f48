//! A free plane, and the corner that names it.

use crate::build::choose::cost::{Candidate, Cost};
use crate::build::choose::set::Set;
use crate::build::piece::Piece;
use crate::exact::PlaneId;

/// A free plane, before it has a name.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreePlane {
    pub(super) cost: Cost,
    pub(super) axis: usize,
    pub(super) through: Through,
}

/// What a free plane goes through.
#[derive(Clone, Copy, Debug)]
pub(super) enum Through {
    /// A corner that is not known yet.
    Coordinate(f64),
    /// A corner, numbered over all faces.
    Corner(u32),
}

impl FreePlane {
    /// The plane by the name of a corner on it.
    pub(super) fn with_corner(&self, set: &Set<'_>) -> Option<Candidate> {
        let Self { cost, axis, through } = *self;
        let coordinate = match through {
            Through::Corner(corner) => {
                return Some(Candidate { plane: PlaneId::axis(axis, corner), cost });
            }
            Through::Coordinate(coordinate) => coordinate,
        };
        let touches = |piece: &&Piece| {
            piece.min[axis] == coordinate && piece.min_is_corner(axis)
                || piece.max[axis] == coordinate && piece.max_is_corner(axis)
        };
        let piece = set.pieces.iter().find(touches)?;
        let corner = piece.corner_at(set.faces, axis, coordinate)?;
        Some(Candidate { plane: PlaneId::axis(axis, corner), cost })
    }
}
