//! Keeps coplanar pieces together: a plane that would separate two of them gives way to the plane of the
//! larger one.

use std::ops::Range;

use glam::DVec3;
use smallvec::SmallVec;

use super::ChooseContext;
use super::set::Set;
use crate::Error;
use crate::build::piece::{Division, Piece};
use crate::exact::{Faces, PlaneId, PlaneKind, PreparedPlane, RoundedNormal, Side, Vertex};
use crate::progress::Watch;

/// The largest number of faces whose planes are tried, including the first plane if it is a face's. Too small:
/// of several pieces, each coplanar only with the next, two lose input order. Too large: an adversarial set
/// is classified that many times.
const MOST_PLANES: usize = 32;

/// Classifies a set by a plane. If the plane would separate coplanar pieces that overlap, or cut one of them,
/// classifies the set by the plane of the larger piece instead.
///
/// Coplanar polygons come in input order, so they have to lie in one node. But the plane of a small polygon,
/// extended across a large polygon in the same plane, can deviate from it by more than the tolerance, on one
/// side or on both. [`Faces::are_coplanar`](crate::exact::Faces::are_coplanar) decides what is coplanar. A
/// piece can be coplanar with several that are not coplanar with each other. Then there may be no plane that
/// keeps all of them together: the search ends when every larger face was tried, or after [`MOST_PLANES`]
/// faces, and the last plane is used.
pub(in crate::build) fn settle(
    rules: &ChooseContext<'_>,
    set: &Set<'_>,
    division: &mut Division,
    plane: PlaneId,
) -> Result<(), Error> {
    let mut on: SmallVec<[u32; 16]> = SmallVec::new();
    follow_rivals(plane, |plane, tried| {
        if division.plane.is_none_or(|divided| divided.id() != plane) {
            rules.watch.work(set.pieces.len())?;
            set.divide(plane, usize::MAX, division);
        }
        let face = match plane.kind() {
            PlaneKind::Face(face) => Some(face),
            PlaneKind::Axis(..) => None,
        };
        let Some(prepared) = &division.plane else { return Ok((face, None)) };
        on.clear();
        if division.count(Side::Coplanar) > 0 && !division.near.is_empty() {
            let sides = (0..).zip(&division.sides);
            on.extend(sides.filter(|(_, side)| **side == Side::Coplanar).map(|(piece, _)| piece));
        }
        let is_cut = |piece: u32| division.sides[piece as usize] == Side::Spanning;
        let rival = match on.is_empty() {
            true => None,
            false => larger(set, prepared, [&on, &division.near], is_cut, tried, rules.watch)?,
        };
        Ok((face, rival.map(PlaneId::face)))
    })?;
    Ok(())
}

/// Follows planes from rival to rival, and returns the last one: see [`settle`]. The function returns the face
/// of a plane, if the plane is a face's, and the plane that replaces it. It is also given the faces that were
/// tried.
pub(super) fn follow_rivals<P: Copy>(
    mut plane: P,
    mut rival: impl FnMut(P, &[u32]) -> Result<(Option<u32>, Option<P>), Error>,
) -> Result<P, Error> {
    let mut tried: SmallVec<[u32; MOST_PLANES]> = SmallVec::new();
    loop {
        let (face, next) = rival(plane, &tried)?;
        tried.extend(face);
        match next {
            Some(next) if tried.len() < MOST_PLANES => plane = next,
            _ => return Ok(plane),
        }
    }
}

/// The largest face of a pair of coplanar pieces that a plane separates: a piece `on` the plane, and a piece
/// of `near`, which the plane cuts or which overlaps the first piece. `near` contains all pieces within twice
/// the tolerance of the plane, except those on it. Faces that were `tried` do not count.
pub(super) fn larger(
    set: &Set<'_>,
    plane: &PreparedPlane,
    [on, near]: [&[u32]; 2],
    is_cut: impl Fn(u32) -> bool,
    tried: &[u32],
    watch: &Watch<'_>,
) -> Result<Option<u32>, Error> {
    let (faces, tolerance) = (set.faces, set.faces.tolerance());
    let on = SortedPieces::of(set.pieces, on);
    let own = on
        .pieces
        .iter()
        .find(|&&piece| plane.id() == PlaneId::face(set.pieces[piece as usize].face));
    let normal = plane.normal();
    let mut best = None;
    for &beside in near {
        let other = &set.pieces[beside as usize];
        let is_cut = is_cut(beside);
        if !is_cut && !on.around.touches(other, tolerance) {
            continue;
        }
        if is_steep(faces, other.face, normal, STEEP) {
            continue;
        }
        let mut compared = 0;
        let touching = on.touching(set.pieces, other, tolerance).inspect(|_| compared += 1);
        let touching =
            touching.filter(|&&piece| set.pieces[piece as usize].touches(other, tolerance));
        // A piece that is coplanar with the set's own face is never cut, even far from it.
        for &piece in touching.chain(own.filter(|_| is_cut)) {
            let piece = &set.pieces[piece as usize];
            let is_larger = faces.is_larger(other.face, piece.face);
            // The smaller of the two is on this plane already.
            if !is_larger && plane.id() == PlaneId::face(piece.face) {
                continue;
            }
            let [large, small] = if is_larger { [other, piece] } else { [piece, other] };
            if tried.contains(&large.face)
                || best.is_some_and(|best| !faces.is_larger(large.face, best))
                || !set.prepare(PlaneId::face(large.face)).contains(faces, small.face)
            {
                continue;
            }
            if is_cut || overlap(faces, set.arena, large, small) {
                best = Some(large.face);
            }
        }
        watch.work(compared)?;
    }
    Ok(best)
}

/// The sine of the largest angle between a plane and a face that may be coplanar with a piece on the plane.
/// (Only pieces less than twenty times as wide as the tolerance lie on planes at larger angles.) Too small:
/// wider pieces lose input order. Too large: neighbours in a mesh are examined in vain.
const STEEP: f64 = 0.1;

/// Whether a polygon, a segment or a point may be coplanar with a piece that is within twice the tolerance of a plane
/// with a normal.
pub(crate) fn is_along(faces: &Faces, face: u32, normal: DVec3) -> bool {
    match faces.corners(face)[..faces.reach(face)] {
        [_] => true,
        [p, q] => {
            let along = DVec3::from(q) - DVec3::from(p);
            let most = 4.0 * STEEP * STEEP * normal.length_squared() * along.length_squared();
            normal.dot(along).powi(2) <= most
        }
        _ => !is_steep(faces, face, normal, 2.0 * STEEP),
    }
}

/// Whether a face is at an angle of more than a given sine to a plane with a normal.
fn is_steep(faces: &Faces, face: u32, normal: DVec3, sine: f64) -> bool {
    let other = DVec3::from_array(RoundedNormal::through(faces.triangle(face)).normal);
    let cross = normal.cross(other).length_squared();
    cross > sine * sine * normal.length_squared() * other.length_squared()
}

/// A box.
#[derive(Clone, Copy)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

impl Bounds {
    fn include(&mut self, piece: &Piece) {
        for axis in 0..3 {
            // Not `min` and `max`, which take more instructions because of NaN.
            let (min, max) = (piece.min[axis], piece.max[axis]);
            self.min[axis] = if min < self.min[axis] { min } else { self.min[axis] };
            self.max[axis] = if max > self.max[axis] { max } else { self.max[axis] };
        }
    }

    /// Whether a piece's box comes within a distance of this box.
    fn touches(&self, piece: &Piece, distance: f64) -> bool {
        (0..3).all(|axis| {
            piece.min[axis] <= self.max[axis] + distance
                && self.min[axis] <= piece.max[axis] + distance
        })
    }
}

/// Lists of at most this many pieces are not sorted. Too small: time to sort. Too large: time to compare all.
const FEW: usize = 32;

/// Some pieces, divided by size and sorted along an axis if there are many: those that touch a piece are found without
/// a comparison of all.
pub(crate) struct SortedPieces {
    pieces: SmallVec<[u32; FEW]>,
    around: Bounds,
    axis: usize,
    /// The pieces of about one size along the axis, in the order of their least coordinates.
    classes: SmallVec<[Class; 1]>,
}

/// Pieces of about one size.
struct Class {
    range: Range<usize>,
    /// The largest size of a piece along the axis; infinite if the pieces are not sorted.
    widest: f64,
}

impl SortedPieces {
    pub(crate) fn of(all: &[Piece], pieces: &[u32]) -> Self {
        let mut around = Bounds { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };
        pieces.iter().for_each(|&piece| around.include(&all[piece as usize]));
        let size = |axis: &usize| around.max[*axis] - around.min[*axis];
        let axis = (0..3).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
        let mut sorted = Self { pieces: pieces.into(), around, axis, classes: SmallVec::new() };
        if pieces.len() <= FEW {
            sorted.classes.push(Class { range: 0..pieces.len(), widest: f64::INFINITY });
            return sorted;
        }
        let start = |piece: u32| all[piece as usize].min[axis];
        let size = |piece: u32| all[piece as usize].max[axis] - start(piece);
        // Twice as large for each class.
        let class = |piece: u32| size(piece).max(1.0).to_bits() >> (f64::MANTISSA_DIGITS - 1);
        sorted.pieces.sort_unstable_by(|&a, &b| {
            class(a).cmp(&class(b)).then(start(a).total_cmp(&start(b))).then(a.cmp(&b))
        });
        let mut first = 0;
        for class in sorted.pieces.chunk_by(|&a, &b| class(a) == class(b)) {
            let widest = class.iter().map(|&piece| size(piece)).fold(0.0, f64::max);
            sorted.classes.push(Class { range: first..first + class.len(), widest });
            first += class.len();
        }
        sorted
    }

    /// The pieces whose boxes may come within a distance of a piece.
    pub(crate) fn touching(
        &self,
        all: &[Piece],
        other: &Piece,
        distance: f64,
    ) -> impl Iterator<Item = &u32> {
        let axis = self.axis;
        let (low, high) = (other.min[axis] - distance, other.max[axis] + distance);
        let start = move |piece: u32| all[piece as usize].min[axis];
        self.classes.iter().flat_map(move |Class { range, widest }| {
            let class = &self.pieces[range.clone()];
            if *widest == f64::INFINITY {
                return class;
            }
            let first = class.partition_point(|&piece| start(piece) + widest < low);
            let end = class.partition_point(|&piece| start(piece) <= high);
            &class[first..end.max(first)]
        })
    }
}

/// Whether two coplanar pieces overlap.
fn overlap(faces: &Faces, arena: &[Vertex], large: &Piece, small: &Piece) -> bool {
    let [a, b] = [large, small].map(|piece| piece.outline(faces, arena));
    faces.overlap(large.face, [&a, &b])
}
