//! Planes chosen by the caller's function.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::set::Set;
use crate::Error;
use crate::build::piece::Division;
use crate::exact::{Faces, PlaneId, Side};
use crate::progress::Watch;

/// A set of two or more pieces of polygons that the builder divides by a plane: the input of your own
/// heuristic, [`BuildOptions::with_chooser`](crate::BuildOptions::with_chooser).
///
/// Each piece has a number below [`piece_count`](Self::piece_count). A piece is a convex part of a polygon,
/// already cut by the planes that separated this set from the rest of the scene. (Polygons that are not
/// convex or not planar are first divided into triangles.) Positions are in the polygons' unit, rounded like
/// [`Fragment::vertices`](crate::Fragment::vertices).
///
/// # Panics
///
/// All methods that take a piece number panic if the number is not below [`piece_count`](Self::piece_count).
#[derive(Clone, Copy, Debug)]
pub struct PieceSet<'a> {
    set: &'a Set<'a>,
    corners: &'a SortedCorners,
}

/// A plane that divides a [`PieceSet`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SplitPlane {
    /// The plane of a piece, given by the piece's number. The piece lies on its plane, so this plane always
    /// divides the set.
    OfPiece(usize),
    /// A plane perpendicular to an axis. The plane's front is the side of larger coordinates.
    ///
    /// Every plane of a tree goes through a corner of a polygon. So the builder moves this plane along the
    /// axis to the corner nearest to `coordinate`. All corners of all polygons count, at their positions
    /// after rounding to the [grid](crate::BspTree::grid) and [flattening](crate::Preparation::flattened)
    /// within the [tolerance](crate::Tolerance).
    Axis {
        /// 0, 1 or 2 for x, y or z.
        axis: usize,
        /// The position on the axis, in the polygons' unit.
        coordinate: f64,
    },
}

impl<'a> PieceSet<'a> {
    /// Returns the number of pieces, two or more.
    pub fn piece_count(&self) -> usize {
        self.set.len()
    }

    /// Returns the number of planes that have already separated the pieces of this set from other pieces: 0
    /// at the root.
    pub fn depth(&self) -> usize {
        self.set.depth
    }

    /// Returns the index, in input order, of the polygon that a piece is a part of. O(1).
    pub fn polygon(&self, piece: usize) -> usize {
        self.set.faces.polygon(self.set.pieces[piece].face)
    }

    /// Returns the number of planes that cut the piece out of its polygon, at most 255. O(1).
    pub fn cuts(&self, piece: usize) -> usize {
        self.set.pieces[piece].cuts.into()
    }

    /// Returns the bounding box of a piece: its smallest and its largest coordinates. O(1).
    pub fn bounds(&self, piece: usize) -> [DVec3; 2] {
        let lattice = self.set.faces.lattice();
        let piece = &self.set.pieces[piece];
        [piece.min, piece.max].map(|corner| lattice.to_world(corner))
    }

    /// Returns the vertices of a piece, three or more, counter-clockwise seen from its front.
    pub fn vertices(
        &self,
        piece: usize,
    ) -> impl DoubleEndedIterator<Item = DVec3> + ExactSizeIterator + Clone + use<'a> {
        let Set { faces, arena, pieces, .. } = *self.set;
        let (lattice, piece) = (faces.lattice(), &pieces[piece]);
        let (cut, corners) = (piece.cut_vertices(arena), faces.corners(piece.face));
        // A cut piece may have more vertices than its face has corners.
        let vertex = move |i: usize| match cut {
            None => corners[i],
            Some(cut) => cut[i].position(),
        };
        (0..cut.map_or(corners.len(), <[_]>::len)).map(move |i| lattice.to_world(vertex(i)))
    }

    /// Returns the unit normal of the piece's plane, which points to the front. This normal equals the
    /// [normal](crate::Fragment::normal) of the piece's fragments. O(1).
    pub fn normal(&self, piece: usize) -> DVec3 {
        let plane = PlaneId::face(self.set.pieces[piece].face);
        self.set.faces.plane(plane).normal_f64().normalize()
    }

    /// Returns the side of a plane on which each piece lies, in the order of the pieces' numbers. Returns
    /// `None` if the plane's piece or axis does not exist, or the plane's coordinate is NaN or infinite.
    ///
    /// The sides are exact, except for the [tolerance](crate::Tolerance), and the builder uses the same
    /// sides. Exception: if the plane would separate coplanar pieces, the builder replaces it by the plane of
    /// the larger piece (see [`Heuristic`](crate::Heuristic)). Takes O(n) time for n vertices. For an axis plane, a binary search
    /// first finds the nearest corner; the first search along an axis sorts all corners.
    pub fn sides(
        &self,
        plane: SplitPlane,
    ) -> Option<impl ExactSizeIterator<Item = Side> + use<'a>> {
        let set = self.set;
        let prepared = set.prepare(self.plane(plane)?);
        Some((0..set.len()).map(move |piece| set.classify(&prepared, piece)))
    }

    /// The name of a plane, if it exists.
    fn plane(&self, plane: SplitPlane) -> Option<PlaneId> {
        match plane {
            SplitPlane::OfPiece(piece) => {
                (piece < self.set.len()).then(|| self.set.own_plane(piece))
            }
            SplitPlane::Axis { axis, coordinate } => {
                if axis > 2 || !coordinate.is_finite() {
                    return None;
                }
                let corner = self.corners.nearest(self.set.faces, axis, coordinate)?;
                Some(PlaneId::axis(axis, corner))
            }
        }
    }
}

type Function = dyn Fn(&PieceSet<'_>) -> Option<SplitPlane> + Send + Sync;

/// The caller's function that chooses planes. Two functions are equal if one is a clone of the other.
#[derive(Clone)]
pub(in crate::build) struct GivenChooser(pub(in crate::build) Arc<Function>);

impl PartialEq for GivenChooser {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for GivenChooser {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a function")
    }
}

impl GivenChooser {
    /// The plane that the function chooses for a set; `None` if the function declines, or names a plane that
    /// leaves all pieces on one side. Writes the pieces' sides to `division` if the function names a plane.
    pub(super) fn plane(
        &self,
        set: &Set<'_>,
        corners: &SortedCorners,
        watch: &Watch<'_>,
        division: &mut Division,
    ) -> Result<Option<PlaneId>, Error> {
        let pieces = PieceSet { set, corners };
        // A panic stops the other threads, which would otherwise continue to call the function.
        let chosen = catch_unwind(AssertUnwindSafe(|| (self.0)(&pieces))).unwrap_or_else(|panic| {
            watch.stop();
            resume_unwind(panic)
        });
        let Some(plane) = chosen.and_then(|chosen| pieces.plane(chosen)) else { return Ok(None) };
        watch.work(set.len())?;
        set.divide(plane, usize::MAX, division);
        Ok(division.makes_progress().then_some(plane))
    }
}

/// The corners of all faces of a build along each axis, sorted at the first use.
#[derive(Debug, Default)]
pub(in crate::build) struct SortedCorners([OnceLock<Vec<u32>>; 3]);

impl SortedCorners {
    /// Returns the corner nearest a world coordinate. Of several nearest corners, returns the corner with the
    /// smallest coordinate, and among these the smallest number. Takes O(log n) time for n corners, and O(n
    /// log n) at the first call for an axis.
    fn nearest(&self, faces: &Faces, axis: usize, coordinate: f64) -> Option<u32> {
        let at = faces.lattice().to_lattice(DVec3::splat(coordinate))[axis];
        let along = |corner: u32| faces.corner(corner)[axis];
        let sorted = self.0[axis].get_or_init(|| {
            let all = faces.corners_of_cell()..faces.corner_count();
            let mut sorted: Vec<u32> = all.map(|corner| corner as u32).collect();
            sorted.sort_unstable_by(|&a, &b| along(a).total_cmp(&along(b)).then(a.cmp(&b)));
            sorted.dedup_by(|a, b| along(*a) == along(*b));
            sorted
        });
        let next = sorted.partition_point(|&corner| along(corner) < at);
        let distance = |corner: u32| (along(corner) - at).abs();
        let beside = next.saturating_sub(1)..sorted.len().min(next + 1);
        sorted[beside].iter().copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    }
}
