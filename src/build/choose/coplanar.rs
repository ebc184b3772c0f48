//! Keeps coplanar pieces together: a plane that would separate two of them gives way to the plane of the
//! larger one.

use glam::DVec3;
use smallvec::SmallVec;

use super::ChooseContext;
use super::set::Set;
use crate::Error;
use crate::build::piece::{Division, Piece};
use crate::exact::{Outline, PlaneId, PlaneKind, PreparedPlane, RoundedNormal, Side};
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
    let on = SortedPieces::of(set, on);
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
        let rounded = RoundedNormal::through(faces.triangle(other.face));
        let other_normal = DVec3::from_array(rounded.normal);
        let sine = normal.cross(other_normal).length_squared();
        if sine > STEEP * STEEP * normal.length_squared() * other_normal.length_squared() {
            continue;
        }
        let touching = on.touching(set, other, tolerance);
        watch.work(touching.len())?;
        let touching = touching
            .iter()
            .filter(|&&piece| Bounds::of(&set.pieces[piece as usize]).touches(other, tolerance));
        // The set's own plane cuts no coplanar piece, wherever that is.
        for &piece in touching.chain(own.filter(|_| is_cut)) {
            let piece = &set.pieces[piece as usize];
            let is_larger = faces.is_larger(other.face, piece.face);
            // A piece that is on the plane of the set's own face was classified so.
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
            if is_cut || overlap(set, large, small) {
                best = Some(large.face);
            }
        }
    }
    Ok(best)
}

/// A piece of a set that lies within twice the tolerance of a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearPiece {
    /// Its number in the set.
    pub(crate) piece: u32,
    /// Whether a polygon outside the set decided its side.
    pub(crate) is_decided: bool,
}

/// Moves pieces `near` a plane, unless their sides are decided, to the side of the largest piece that is coplanar with
/// the piece and overlaps it, unless the plane cuts that piece.
pub(crate) fn follow_larger(
    set: &Set<'_>,
    near: &mut [NearPiece],
    sides: &mut [Side],
    watch: &Watch<'_>,
) -> Result<(), Error> {
    let side = |sides: &[Side], near: &NearPiece| sides[near.piece as usize];
    if near.windows(2).all(|two| side(sides, &two[0]) == side(sides, &two[1])) {
        return Ok(());
    }
    let (faces, pieces, tolerance) = (set.faces, set.pieces, set.faces.tolerance());
    let face = |piece: u32| pieces[piece as usize].face;
    near.sort_unstable_by(|a, b| {
        faces.largest_first(face(a.piece), face(b.piece)).then(a.piece.cmp(&b.piece))
    });
    let numbers: Vec<u32> = near.iter().map(|near| near.piece).collect();
    let sorted = SortedPieces::of(set, &numbers);
    for &NearPiece { piece: small, is_decided } in near.iter() {
        if is_decided {
            continue;
        }
        let piece = &pieces[small as usize];
        let touching = sorted.touching(set, piece, tolerance);
        watch.work(touching.len())?;
        let mut largest = None;
        for &other in touching {
            let is_larger = |than: u32| faces.largest_first(face(other), face(than)).is_lt();
            if Bounds::of(&pieces[other as usize]).touches(piece, tolerance)
                && is_larger(largest.unwrap_or(small))
                && faces.are_coplanar(face(other), face(small))
                && overlap(set, &pieces[other as usize], piece)
            {
                largest = Some(other);
            }
        }
        // A plane that cuts the larger piece need not meet the smaller one.
        if let Some(side) = largest.map(|largest| sides[largest as usize])
            && side != Side::Spanning
        {
            sides[small as usize] = side;
        }
    }
    Ok(())
}

/// The sine of the largest angle between a plane and a face that may be coplanar with a piece on the plane.
/// (Only pieces less than twenty times as wide as the tolerance lie on planes at larger angles.) Too small:
/// wider pieces lose input order. Too large: neighbours in a mesh are examined in vain.
const STEEP: f64 = 0.1;

/// A box.
#[derive(Clone, Copy)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

impl Bounds {
    fn of(piece: &Piece) -> Self {
        Self { min: piece.min, max: piece.max }
    }

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

/// Some pieces, in the order of their least coordinates along an axis if there are many.
struct SortedPieces {
    pieces: SmallVec<[u32; FEW]>,
    around: Bounds,
    axis: usize,
    /// The largest size of a piece along the axis; infinite if the pieces are not sorted.
    widest: f64,
}

impl SortedPieces {
    fn of(set: &Set<'_>, pieces: &[u32]) -> Self {
        let mut around = Bounds { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };
        pieces.iter().for_each(|&piece| around.include(&set.pieces[piece as usize]));
        let mut sorted = Self { pieces: pieces.into(), around, axis: 0, widest: f64::INFINITY };
        if pieces.len() > FEW {
            let size = |axis: &usize| around.max[*axis] - around.min[*axis];
            let axis = (0..3).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
            let at = |piece: u32| &set.pieces[piece as usize];
            sorted.axis = axis;
            sorted.pieces.sort_unstable_by(|&a, &b| at(a).min[axis].total_cmp(&at(b).min[axis]));
            let sizes = pieces.iter().map(|&piece| at(piece).max[axis] - at(piece).min[axis]);
            sorted.widest = sizes.fold(0.0, f64::max);
        }
        sorted
    }

    /// The pieces whose boxes may come within a distance of a piece.
    fn touching(&self, set: &Set<'_>, other: &Piece, distance: f64) -> &[u32] {
        if self.widest == f64::INFINITY {
            return &self.pieces;
        }
        let start = |&piece: &u32| set.pieces[piece as usize].min[self.axis];
        let (low, high) = (other.min[self.axis] - distance, other.max[self.axis] + distance);
        let first = self.pieces.partition_point(|piece| start(piece) + self.widest < low);
        let end = self.pieces.partition_point(|piece| start(piece) <= high);
        &self.pieces[first..end.max(first)]
    }
}

/// Whether two coplanar pieces overlap.
fn overlap(set: &Set<'_>, large: &Piece, small: &Piece) -> bool {
    let outline = |piece: &Piece| {
        let mut outline = Outline::new();
        piece.for_each_vertex(set.faces, set.arena, |p| outline.push(p));
        outline
    };
    let [a, b] = [large, small].map(outline);
    set.faces.overlap(large.face, [&a, &b])
}
