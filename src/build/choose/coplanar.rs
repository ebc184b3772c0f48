//! Keeps coplanar pieces together: a plane that would separate two of them gives way to the plane of the
//! larger one.

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::ChooseContext;
use super::set::Set;
use crate::Error;
use crate::build::piece::{Division, Piece};
use crate::exact::{PlaneId, PlaneKind, PreparedPlane, Side};
use crate::progress::Watch;

/// The largest number of planes that are tried in place of one plane. Too small: of several pieces, each
/// coplanar only with the next, two lose input order. Too large: a set that is made for it is classified so
/// often.
const MOST_PLANES: usize = 8;

/// Classifies a set by a plane. If the plane would separate coplanar pieces that overlap, or cut one of them,
/// classifies the set by the plane of the larger piece instead.
///
/// Coplanar polygons come in input order, so they have to lie in one node. But the plane of a small polygon,
/// extended across a large polygon in the same plane, can deviate from it by more than the tolerance, on one
/// side or on both. [`Faces::are_coplanar`](crate::exact::Faces::are_coplanar) decides what is coplanar. A
/// piece can be coplanar with several that are not coplanar with each other: if every plane separates some of
/// them, the largest is used.
pub(in crate::build) fn settle(
    rules: &ChooseContext<'_>,
    set: &Set<'_>,
    division: &mut Division,
    mut plane: PlaneId,
) -> Result<(), Error> {
    let mut tried: SmallVec<[u32; MOST_PLANES]> = SmallVec::new();
    let mut on: Vec<u32> = Vec::new();
    loop {
        if division.plane.is_none() {
            rules.watch.work(set.pieces.len())?;
            set.divide(plane, usize::MAX, division);
        }
        let Some(prepared) = &division.plane else { return Ok(()) };
        on.clear();
        if division.count(Side::Coplanar) > 0 && !division.near.is_empty() {
            let sides = (0..).zip(&division.sides);
            on.extend(sides.filter(|(_, side)| **side == Side::Coplanar).map(|(piece, _)| piece));
        }
        let is_cut = |piece: u32| division.sides[piece as usize] == Side::Spanning;
        let mut rival = larger(set, prepared, [&on, &division.near], is_cut, &tried, rules.watch)?;
        if let PlaneKind::Face(face) = plane.kind() {
            tried.push(face);
            if rules.tuning.frames.is_some() {
                rules.watch.work(set.pieces.len())?;
                rival = largest_around(set, face, division).or(rival);
            }
        }
        let Some(rival) = rival else { return Ok(()) };
        division.plane = None;
        plane = PlaneId::face(rival);
        if tried.len() == MOST_PLANES || tried.contains(&rival) {
            break;
        }
    }
    let largest = tried
        .iter()
        .copied()
        .reduce(|best, face| if set.faces.is_larger(face, best) { face } else { best });
    set.divide(largest.map_or(plane, PlaneId::face), usize::MAX, division);
    Ok(())
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
    let steepest = Steepest::new(set, plane, on);
    let (mut best, mut at) = (None, 0);
    for &beside in near {
        let other = &set.pieces[beside as usize];
        let is_cut = is_cut(beside);
        if !steepest.may_be_on(set, other, is_cut) {
            continue;
        }
        watch.work(on.len())?;
        // Pieces of a large floor are met from the last place where one was found: neighbours in the set are
        // often neighbours in space.
        let touching = (at..on.len()).chain(0..at).filter(|&k| {
            let piece = &set.pieces[on[k] as usize];
            is_cut || touch(piece, other, set.faces.tolerance())
        });
        for k in touching {
            let piece = &set.pieces[on[k] as usize];
            let is_larger = set.faces.is_larger(other.face, piece.face);
            let [large, small] = if is_larger { [other, piece] } else { [piece, other] };
            if tried.contains(&large.face)
                || best.is_some_and(|best| !set.faces.is_larger(large.face, best))
            {
                continue;
            }
            let prepared = set.prepare(PlaneId::face(large.face));
            if prepared.contains(set.faces, small.face) && (is_cut || overlap(set, large, small)) {
                (best, at) = (Some(large.face), k);
            }
        }
    }
    Ok(best)
}

/// The largest face of the pieces beside a plane, if the given face is on its plane. In frames, all planes are
/// known, so it takes little time to use the most certain plane of those that are meant to be one: small cards
/// of `f32` separate each other elsewhere.
fn largest_around(set: &Set<'_>, face: u32, division: &Division) -> Option<u32> {
    let beside =
        set.pieces.iter().zip(&division.sides).filter(|(_, side)| **side != Side::Coplanar);
    beside.map(|(piece, _)| piece.face).fold(None, |best, other| {
        let least = best.unwrap_or(face);
        let is_better = set.prepare(PlaneId::face(other)).contains(set.faces, face)
            && set.faces.is_larger(other, least);
        if is_better { Some(other) } else { best }
    })
}

/// How steep a face may be against a plane and still be coplanar with a piece on the plane.
struct Steepest {
    /// The unit normal of the plane.
    normal: DVec3,
    /// The sine of the largest angle.
    sine: f64,
    /// The box around the pieces on the plane.
    min: [f64; 3],
    max: [f64; 3],
}

impl Steepest {
    fn new(set: &Set<'_>, plane: &PreparedPlane, on: &[u32]) -> Self {
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut width = f64::INFINITY;
        for &piece in on {
            let piece = &set.pieces[piece as usize];
            for axis in 0..3 {
                min[axis] = min[axis].min(piece.min[axis]);
                max[axis] = max[axis].max(piece.max[axis]);
            }
            width = width.min(set.faces.width(piece.face));
        }
        // A face is within τ of both planes along its width, so these differ by at most 4 τ there. The factor
        // leaves room for rounding.
        let sine = 8.0 * set.faces.tolerance() / width + 1e-9;
        Self { normal: plane.unit_normal(), sine, min, max }
    }

    /// Whether a piece may be coplanar with a piece on the plane, and touch it unless it may be anywhere.
    fn may_be_on(&self, set: &Set<'_>, piece: &Piece, anywhere: bool) -> bool {
        let tolerance = set.faces.tolerance();
        let is_beside = |axis: usize| {
            piece.max[axis] + tolerance < self.min[axis]
                || self.max[axis] + tolerance < piece.min[axis]
        };
        if !anywhere && (0..3).any(is_beside) {
            return false;
        }
        self.sine >= 1.0 || {
            let normal = set.faces.normal(piece.face);
            let sine = normal.cross(self.normal).length_squared();
            sine <= self.sine * self.sine * normal.length_squared()
        }
    }
}

/// Whether the boxes of two pieces come within a distance of each other.
fn touch(a: &Piece, b: &Piece, distance: f64) -> bool {
    (0..3)
        .all(|axis| a.min[axis] <= b.max[axis] + distance && b.min[axis] <= a.max[axis] + distance)
}

/// If outlines have more pairs of corners, they count as overlapping. Too small: planes give way without
/// need. Too large: time.
const MANY: usize = 1 << 12;

/// Whether two coplanar pieces overlap by more than the tolerance, seen along an axis: no side of one has the
/// other entirely outside (the separating axes of convex polygons). Neighbours in a mesh, which share an edge,
/// do not overlap.
fn overlap(set: &Set<'_>, large: &Piece, small: &Piece) -> bool {
    let normal = set.faces.normal(large.face).abs();
    let axis = (0..3).max_by(|&a, &b| normal[a].total_cmp(&normal[b])).unwrap_or(0);
    let outline = |piece: &Piece| {
        let mut outline: SmallVec<[DVec2; 8]> = SmallVec::new();
        piece.for_each_vertex(set.faces, set.arena, |p| {
            outline.push(DVec2::new(p[(axis + 1) % 3], p[(axis + 2) % 3]));
        });
        outline
    };
    let [a, b] = [large, small].map(outline);
    a.len() * b.len() > MANY || {
        let margin = set.faces.tolerance();
        !has_outside(&a, &b, margin) && !has_outside(&b, &a, margin)
    }
}

/// Whether some side of a convex outline has no point of another outline inside by more than a margin.
fn has_outside(outline: &[DVec2], other: &[DVec2], margin: f64) -> bool {
    let next = || outline.iter().cycle().skip(1);
    let area: f64 = outline.iter().zip(next()).map(|(a, b)| a.perp_dot(*b)).sum();
    outline.iter().zip(next()).any(|(&a, &b)| {
        let side = (b - a) * area.signum();
        let most = margin * side.length();
        side != DVec2::ZERO && other.iter().all(|&p| side.perp_dot(p - a) <= most)
    })
}
