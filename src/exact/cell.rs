//! The cell of a larger scene that faces are cut to: a box between lattice planes.
//!
//! The box's two corners come before the corners of all faces, and belong to none. So planes through
//! them have names as those through corners of faces, and a cell costs nothing where there is none.

use smallvec::SmallVec;

use super::classify::{PreparedPlane, Side};
use super::lattice::{LIMIT, MAX_TOLERANCE};
use super::names::PlaneId;
use super::split::Vertex;
use super::{Faces, Lattice, split};

/// A box by its lower and its upper corner, in lattice units.
pub(crate) type CellBox = [[f64; 3]; 2];

/// The coordinate, with either sign, of a side without a plane. Beyond all lattice points, and within
/// what the predicates hold.
const OPEN: f64 = LIMIT + MAX_TOLERANCE;
/// A cell without planes: all of the lattice.
pub(crate) const EVERYWHERE: CellBox = [[-OPEN; 3], [OPEN; 3]];

impl Faces {
    /// No faces so far: those to come are to be cut to a cell.
    pub(crate) fn of_cell(lattice: Lattice, tolerance: f64, cell: CellBox) -> Self {
        Self { lattice, tolerance, corners: cell.to_vec(), ..Self::default() }
    }

    /// The number of corners that belong to no face: they come first.
    pub(crate) fn corners_of_cell(&self) -> usize {
        self.faces.first().map_or(self.corners.len(), |face| face.start as usize)
    }

    /// The two corners of the cell; none if these faces are not of one.
    pub(crate) fn cell(&self) -> &[[f64; 3]] {
        &self.corners[..self.corners_of_cell()]
    }

    /// The planes that bound the cell, and on which side of each it lies.
    pub(crate) fn planes_of_cell(&self) -> impl Iterator<Item = (PlaneId, Side)> {
        self.cell().iter().zip([(0, Side::Front), (1, Side::Back)]).flat_map(
            |(corner, (k, side))| {
                let axes = (0..3).filter(|&axis| corner[axis].abs() < OPEN);
                axes.map(move |axis| (PlaneId::axis(axis, k), side))
            },
        )
    }

    /// Whether some corners can be those of a cell.
    #[cfg(feature = "save")]
    pub(crate) fn is_cell(corners: &[[f64; 3]]) -> bool {
        let is_side = |c: f64, open: f64| c.abs() <= LIMIT || c == open;
        match corners {
            [low, high] => {
                low.iter().all(|&c| is_side(c, -OPEN)) && high.iter().all(|&c| is_side(c, OPEN))
            }
            _ => corners.is_empty(),
        }
    }

    /// Removes all faces but those listed, in ascending order.
    pub(crate) fn keep(&mut self, kept: &[u32]) {
        let mut corners = self.corners_of_cell();
        let (mut numbers, mut numbered, mut moved) = (0, 0, 0);
        let (mut next_numbered, mut next_moved) = (0, 0);
        // Everything is moved down in place, so nothing unread is overwritten.
        for (new, &face) in kept.iter().enumerate() {
            let range = self.corner_range(face);
            next_numbered += count_while(&self.numbered[next_numbered..], |&(f, _)| f < face);
            if let Some(&(_, at)) = self.numbered.get(next_numbered).filter(|(f, _)| *f == face) {
                self.numbered[numbered] = (new as u32, numbers as u32);
                self.numbers.copy_within(at as usize..at as usize + range.len(), numbers);
                numbers += range.len();
                (numbered, next_numbered) = (numbered + 1, next_numbered + 1);
            }
            let is_before = |&(corner, _): &(u32, _)| (corner as usize) < range.start;
            next_moved += count_while(&self.moved[next_moved..], is_before);
            while let Some(&(corner, given)) = self.moved.get(next_moved)
                && (corner as usize) < range.end
            {
                self.moved[moved] = ((corner as usize - range.start + corners) as u32, given);
                (moved, next_moved) = (moved + 1, next_moved + 1);
            }
            self.faces[new] = self.faces[face as usize];
            self.faces[new].start = corners as u32;
            self.corners.copy_within(range.clone(), corners);
            corners += range.len();
        }
        self.faces.truncate(kept.len());
        self.corners.truncate(corners);
        self.numbered.truncate(numbered);
        self.numbers.truncate(numbers);
        self.moved.truncate(moved);
    }
}

fn count_while<T>(items: &[T], is_counted: impl Fn(&T) -> bool) -> usize {
    items.iter().take_while(|item| is_counted(item)).count()
}

/// Cuts faces to their cell.
///
/// Each plane of the cell decides as a partition plane of a tree does, by the rules of [`classify`](super::classify). What
/// is coplanar with it belongs to the cell in front. So do the planes of all cells of a scene, which
/// therefore have each point of each face in one cell; and both cells beside a plane name the vertices
/// that it makes by the same points.
pub(crate) struct Clipper<'f> {
    faces: &'f Faces,
    planes: SmallVec<[(PreparedPlane, Side); 6]>,
    outline: Vec<Vertex>,
    front: Vec<Vertex>,
    back: Vec<Vertex>,
}

impl<'f> Clipper<'f> {
    pub(crate) fn new(faces: &'f Faces) -> Self {
        let planes = faces.planes_of_cell();
        let planes = planes.map(|(plane, side)| (PreparedPlane::new(faces, plane), side)).collect();
        Self { faces, planes, outline: vec![], front: vec![], back: vec![] }
    }

    /// The part of a face in the cell, by its vertices: an empty list is the whole face, `None` no part.
    pub(crate) fn clip(&mut self, face: u32) -> Option<&[Vertex]> {
        let Self { faces, planes, outline, front, back } = self;
        outline.clear();
        for (prepared, own) in planes {
            let cut = (!outline.is_empty()).then_some(&outline[..]);
            match prepared.classify(faces, face, cut) {
                Side::Spanning => {
                    if outline.is_empty() {
                        let corners = 0..faces.corners(face).len() as u32;
                        outline.extend(corners.map(|k| Vertex::corner(faces, face, k)));
                    }
                    front.clear();
                    back.clear();
                    split(faces, prepared, face, outline, front, back);
                    std::mem::swap(outline, if *own == Side::Front { front } else { back });
                }
                Side::Coplanar if *own == Side::Front => {}
                side if side == *own => {}
                _ => return None,
            }
        }
        Some(&self.outline)
    }
}
