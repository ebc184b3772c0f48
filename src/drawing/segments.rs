//! Segments and points of the scene in the picture, and the pieces that are in front of them or behind them.
//!
//! The number of polygons in front of a segment is its quantitative invisibility (A. Appel, "The notion of
//! quantitative invisibility and the machine rendering of solids", 1967).

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::cell::{Cell, Corner, NOWHERE, Rect, are_apart, side_on_line};
use super::edges::SHORTEST;
use super::lines::{ExactLine, Image, LineTable, Rounded, meeting, side_at, value_at};
use super::map::{VisibilityMap, sort_by};
use super::pairs::around;
use super::primitives::Primitives;
use super::quadtree::{
    CUT, Candidates, Leaf, NARROWED, SubTile, TINIEST, Tile, TileList, VISITED, Visible, found_in,
};
use crate::Error;
use crate::exact::{Faces, Int, PlaneId, PreparedPlane};
use crate::progress::Watch;

/// A segment of the scene, projected and clipped to the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProjectedSegment {
    source: Source,
    /// The segment's line in the picture.
    rounded: Rounded,
    pub(super) course: ImageLine,
    /// The side of the segment's line on which the picture lies, if the line is a border of the picture;
    /// otherwise `Equal`.
    pub(super) picture: Ordering,
    /// A box around the part in the picture.
    around: Rect,
}

/// The position of a segment in the picture. The distance of a point along the segment's line is called
/// a *place*, in pixels. Places increase from the first end to the second, if the ends are lattice points.
#[derive(Clone, Copy, Debug)]
pub(super) struct ImageLine {
    /// The point of the line that is nearest to the origin.
    foot: [f64; 2],
    /// The direction of the line, of length 1.
    direction: [f64; 2],
    /// The places of the segment's start and end in the picture.
    pub(super) places: [f64; 2],
}

/// The origin of a segment.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// The segment leads from one lattice point to another.
    Points([[f64; 3]; 2]),
    /// The segment is a part of the line in which these faces cross each other.
    Crossing([u32; 2]),
}

/// All places.
const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Boxes are enlarged by this length, in pixels, which far exceeds rounding errors.
pub(super) const MARGIN: f64 = 1e-3;

impl ProjectedSegment {
    /// Projects a segment; `None` if the segment is not in the picture, or is a point in the picture.
    pub(super) fn new(lines: &LineTable<'_>, ends: [[f64; 3]; 2]) -> Option<Self> {
        let [low, high] = Tile::picture(lines.frame.rays.size()).sides();
        let images = ends.map(|end| lines.frame.image(end));
        let is_ahead = images.map(|[weight, ..]| weight.sign().is_gt());
        let at = images.map(|image| point_of(&image));
        // Rounding moves points by far less than a margin.
        let is_beyond = |axis: usize| {
            at.iter().all(|at| at[axis] < low[axis] - MARGIN)
                || at.iter().all(|at| at[axis] > high[axis] + MARGIN)
        };
        if is_ahead == [false; 2] || is_ahead == [true; 2] && (is_beyond(0) || is_beyond(1)) {
            return None;
        }
        let is_inside = |at: &[f64; 2]| {
            (0..2).all(|axis| low[axis] + MARGIN < at[axis] && at[axis] < high[axis] - MARGIN)
        };
        let mut segment = Self::along(lines.rounded_edge(ends), Source::Points(ends))?;
        let [from, to] = if is_ahead == [true; 2] && at.iter().all(is_inside) {
            at.map(|end| segment.course.place(end))
        } else {
            let all = Cell::picture(lines);
            segment.picture = beside(&segment.signs(lines, &all));
            let [mut from, mut to] = segment.chord(lines, &all)?;
            if is_ahead[0] {
                from = from.max(segment.course.place(at[0]));
            }
            if is_ahead[1] {
                to = to.min(segment.course.place(at[1]));
            }
            [from, to]
        };
        if (to - from).is_nan() || to - from < SHORTEST {
            return None;
        }
        segment.limit([from, to]);
        Some(segment)
    }

    /// Projects the line in which two faces cross each other, clipped to a cell.
    pub(super) fn crossing(lines: &LineTable<'_>, faces: [u32; 2], cell: &Cell) -> Option<Self> {
        let rounded = lines.rounded_other(&cut(lines, faces));
        let mut segment = Self::along(rounded, Source::Crossing(faces))?;
        segment.course.places = ALL;
        let is_divided = beside(&segment.signs(lines, cell)).is_eq();
        segment.within(segment.chord(lines, cell).filter(|_| is_divided)?)
    }

    /// The part of the segment between two places.
    pub(super) fn within(mut self, [from, to]: [f64; 2]) -> Option<Self> {
        let [first, last] = self.course.places;
        let (from, to) = (first.max(from), last.min(to));
        self.limit([from, to]);
        (to - from >= SHORTEST).then_some(self)
    }

    /// A line without ends.
    fn along(rounded: Rounded, source: Source) -> Option<Self> {
        let [k0, kx, ky] = rounded.k;
        let square = kx * kx + ky * ky;
        let slope = square.sqrt();
        let (foot, direction) = (-k0 / square, [ky / slope, -kx / slope]);
        let course = ImageLine { foot: [foot * kx, foot * ky], direction, places: [0.0; 2] };
        let picture = Ordering::Equal;
        (slope > 0.0).then_some(Self { source, rounded, course, picture, around: NOWHERE })
    }

    fn limit(&mut self, places: [f64; 2]) {
        self.course.places = places;
        let [a, b] = places.map(|place| self.course.at(place));
        let axes = [0, 1];
        self.around = [
            axes.map(|i: usize| a[i].min(b[i]) - MARGIN),
            axes.map(|i: usize| a[i].max(b[i]) + MARGIN),
        ];
    }

    fn exact(&self, lines: &LineTable<'_>) -> ExactLine {
        match self.source {
            Source::Points(ends) => lines.frame.edge(ends),
            Source::Crossing(faces) => cut(lines, faces),
        }
    }

    /// Whether the segment may meet a box.
    pub(super) fn may_meet(&self, around: &Rect) -> bool {
        if are_apart(around, &self.around) {
            return false;
        }
        let [low, high] = around;
        let half = |axis: usize| 0.5 * (high[axis] - low[axis]) + MARGIN;
        let middle = [0, 1].map(|axis: usize| 0.5 * (low[axis] + high[axis]));
        let [_, kx, ky] = self.rounded.k;
        let reach = kx.abs() * half(0) + ky.abs() * half(1);
        self.rounded.at(middle).abs() <= reach
    }

    /// Whether the line crosses a cell or lies along one of the cell's sides, decided exactly.
    fn meets(&self, lines: &LineTable<'_>, cell: &Cell) -> bool {
        let signs = self.signs(lines, cell);
        beside(&signs).is_eq() || side_on_line(&signs).is_some()
    }

    /// The places between which the line crosses a cell or lies along one of the cell's sides; `None` if the
    /// line does neither, which is decided exactly. The places are rounded.
    pub(super) fn chord(&self, lines: &LineTable<'_>, cell: &Cell) -> Option<[f64; 2]> {
        let n = cell.sides.len();
        let signs = self.signs(lines, cell);
        let next = |i: usize| if i + 1 == n { 0 } else { i + 1 };
        let mut ends: SmallVec<[f64; 2]> = SmallVec::new();
        if beside(&signs).is_eq() {
            for i in 0..n {
                if signs[i].is_eq() {
                    ends.push(self.course.place(cell.sides[i].start.at));
                } else if signs[i] == signs[next(i)].reverse() {
                    let side = lines.exact(cell.sides[i].half);
                    ends.push(self.course.place(meeting([&self.exact(lines), &side])));
                }
            }
        } else {
            let side = side_on_line(&signs)?;
            ends.extend([side, next(side)].map(|i| self.course.place(cell.sides[i].start.at)));
        }
        let [a, b] = ends[..] else { return None };
        Some([a.min(b), a.max(b)])
    }

    /// The side of the line on which each corner of a cell lies.
    fn signs(&self, lines: &LineTable<'_>, cell: &Cell) -> SmallVec<[Ordering; 8]> {
        (0..cell.sides.len()).map(|i| self.side(lines, cell, i)).collect()
    }

    fn side(&self, lines: &LineTable<'_>, cell: &Cell, corner: usize) -> Ordering {
        let Corner { at, radius } = cell.sides[corner].start;
        let value = self.rounded.at(at);
        if value.abs() > self.rounded.error + self.rounded.slope * radius {
            return value.total_cmp(&0.0);
        }
        let before = if corner == 0 { cell.sides.len() - 1 } else { corner - 1 };
        let halves = [before, corner].map(|i| cell.sides[i].half);
        lines.exact_side_of(&self.exact(lines), halves)
    }

    /// The places where the segment is behind a face: further away than the face's plane; `None` if there are no
    /// such places. If the whole part of the segment that passes the face is within the tolerance of `faces`, or in
    /// front, it is not behind. `chord` is where the segment passes a cell of the face.
    pub(super) fn behind(
        &self,
        primitives: &Primitives<'_>,
        faces: &Faces,
        (face, chord): (u32, [f64; 2]),
    ) -> Option<[f64; 2]> {
        match self.source {
            Source::Points(ends) => self.points_behind(primitives, faces, ends, (face, chord)),
            Source::Crossing([own, _]) => {
                let seen = primitives.views[face as usize].side;
                self.crossing_behind(&primitives.lines, own, face, seen)
            }
        }
    }

    /// Like [`behind`](Self::behind) for a crossing, one of whose faces is `own`. Along the cut of `own` by
    /// the plane of `face`, both planes are equally far away. (There is no tolerance, because the ends are
    /// not lattice points.)
    fn crossing_behind(
        &self,
        lines: &LineTable<'_>,
        own: u32,
        face: u32,
        seen: Ordering,
    ) -> Option<[f64; 2]> {
        let [line, cut] = [self.exact(lines), cut(lines, [own, face])];
        // Where the cut is positive, `own` is in front of the other face's plane if the κ of `own` is
        // positive.
        let side = lines.frame.sheet(PlaneId::face(own)).side();
        let is_behind = |sign: Ordering| {
            let at = if side.is_gt() { sign } else { sign.reverse() };
            at.is_ne() && at == seen.reverse()
        };
        let minor = |i: usize, j: usize| {
            let [a, b]: [Int<12>; 2] = [cut[i].times(&line[j]), cut[j].times(&line[i])];
            (a - b).sign()
        };
        // How the cut changes along the line.
        let rise = minor(1, 2);
        if rise.is_ne() {
            let place = self.course.place(meeting([&line, &cut]));
            let after = is_behind(rise);
            return Some(if after { [place, ALL[1]] } else { [ALL[0], place] })
                .filter(|_| after || is_behind(rise.reverse()));
        }
        // The cut is constant along the line: subtract the multiple of the line that has the cut's slope. The
        // difference has the sign of the cut.
        let axis = if line[1].sign().is_ne() { 1 } else { 2 };
        let sign = if line[axis].sign().is_gt() { minor(0, axis) } else { minor(axis, 0) };
        is_behind(sign).then_some(ALL)
    }

    fn points_behind(
        &self,
        primitives: &Primitives<'_>,
        faces: &Faces,
        ends: [[f64; 3]; 2],
        (face, chord): (u32, [f64; 2]),
    ) -> Option<[f64; 2]> {
        let lines = &primitives.lines;
        let prepared = PreparedPlane::new(faces, PlaneId::face(face));
        let sides = ends.map(|end| prepared.side_beyond(faces, &end));
        let behind = primitives.views[face as usize].side.reverse();
        let is_behind = sides.map(|side| side == behind);
        if is_behind == [false; 2] {
            return None;
        }
        if is_behind == [true; 2] {
            return Some(ALL);
        }
        let images = ends.map(|end| lines.frame.image(end));
        let places = if sides[0] == sides[1].reverse() {
            let plane = faces.plane(PlaneId::face(face));
            self.beyond(&images, ends.map(|end| plane.at(&end)), is_behind)?
        } else {
            ALL
        };
        if faces.tolerance() > 0.0 {
            let [[first, last], [begin, end]] = [self.course.places, chord];
            let (from, to) = (places[0].max(first).max(begin), places[1].min(last).min(end));
            let excess = ends.map(|end| prepared.excess(faces, &end, behind));
            let is_certain = self.is_positive_between([from, to], &images, &excess);
            if from >= to || !is_certain && !is_anywhere(primitives, face, &images, &excess) {
                return None;
            }
        }
        Some(places)
    }

    /// The places beyond a plane that the segment crosses: those on the side of one of the ends. `at` is the plane's
    /// values at the ends.
    fn beyond(
        &self,
        [a, b]: &[Image; 2],
        at: [Int<3>; 2],
        is_beyond: [bool; 2],
    ) -> Option<[f64; 2]> {
        // The segment crosses the plane at a weighted mean of its ends.
        let [second, first] = at.map(|at| if at.is_negative() { -at } else { at });
        let mean: [Int<6>; 3] = std::array::from_fn(|i| {
            let parts: [Int<6>; 2] = [a[i].times(&first), b[i].times(&second)];
            parts[0] + parts[1]
        });
        if mean[0].sign().is_gt() {
            let place = self.course.place(point_of(&mean));
            return Some(if is_beyond[0] { [ALL[0], place] } else { [place, ALL[1]] });
        }
        // The segment crosses the plane behind the eye: the part ahead of the eye lies on the side of the end
        // that is ahead.
        let ahead = if a[0].sign().is_gt() { 0 } else { 1 };
        is_beyond[ahead].then_some(ALL)
    }

    /// Whether a function is certainly positive halfway between two places of the segment. The function is linear along
    /// the segment, and given by its values at the ends, whose images are given.
    fn is_positive_between(
        &self,
        [from, to]: [f64; 2],
        images: &[Image; 2],
        function: &[Int<3>; 2],
    ) -> bool {
        /// More than the relative errors of the terms, which are largest if an end is a margin away.
        const SHARE: f64 = 1e-6;
        let middle = 0.5 * (from + to);
        let [first, second] = images.map(|image| {
            let [weight, x, y] = image.map(Int::to_f64);
            middle * weight - self.course.place([x, y])
        });
        let [a, b] = function.map(Int::to_f64);
        let terms = [-second * a, first * b];
        let certain = SHARE * (terms[0].abs() + terms[1].abs());
        to - from > 2.0 * MARGIN && terms[0] + terms[1] > certain
    }
}

impl ImageLine {
    /// The point of the line at a place.
    pub(super) fn at(&self, place: f64) -> [f64; 2] {
        [0, 1].map(|axis: usize| self.foot[axis] + self.direction[axis] * place)
    }

    /// The place of a point of the picture.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> f64 {
        x * self.direction[0] + y * self.direction[1]
    }

    /// The place of a point that lies on the segment up to rounding.
    pub(super) fn place_on(&self, point: [f64; 2]) -> f64 {
        self.place(point).clamp(self.places[0], self.places[1])
    }
}

/// The rounded position of a point of the scene in the picture.
fn point_of<const N: usize>(image: &[Int<N>; 3]) -> [f64; 2] {
    let [weight, x, y] = image.map(Int::to_f64);
    [x / weight, y / weight]
}

/// The side of a line on which a cell lies, given the sides of the cell's corners; `Equal` if the cell is on
/// both sides.
fn beside(signs: &[Ordering]) -> Ordering {
    let sides = [Ordering::Greater, Ordering::Less].map(|side| signs.contains(&side));
    sides[0].cmp(&sides[1])
}

/// Whether a function is positive somewhere on the part of a segment that passes a face in the picture. The
/// function is linear along the segment, and given by its values at the ends, whose images are given.
fn is_anywhere(
    primitives: &Primitives<'_>,
    face: u32,
    images: &[Image; 2],
    function: &[Int<3>; 2],
) -> bool {
    let lines = &primitives.lines;
    // The part that passes the face is where these functions are positive.
    let inside = primitives.outline(face).iter().map(|&half| {
        let line = lines.exact(half);
        let values = images.each_ref().map(|image| value_at(&line, image));
        if half.is_negative() { values.map(|value| -value) } else { values }
    });
    let ahead = images.each_ref().map(|image| image[0].resize());
    let all = inside.chain([ahead, function.each_ref().map(Int::resize)]);
    // A point of the segment is a weighted mean of the ends. Here are the weights where the common part begins and
    // where it ends, first that of the second end.
    let [none, one] = [0, 1].map(Int::<11>::from);
    let [mut from, mut to] = [[none, one], [one, none]];
    let is_before = |a: &[Int<11>; 2], b: &[Int<11>; 2]| {
        let [a, b]: [Int<22>; 2] = [a[0].times(&b[1]), b[0].times(&a[1])];
        (a - b).is_negative()
    };
    for [first, second] in all {
        match [first, second].map(|value| value.sign()) {
            [Ordering::Less, Ordering::Greater] => {
                let begin = [-first, second];
                if is_before(&from, &begin) {
                    from = begin;
                }
            }
            [Ordering::Greater, Ordering::Less] => {
                let end = [first, -second];
                if is_before(&end, &to) {
                    to = end;
                }
            }
            [Ordering::Less, _] | [_, Ordering::Less] => return false,
            _ => {}
        }
    }
    is_before(&from, &to)
}

/// The line of the rays that meet the planes of two faces in one point.
fn cut(lines: &LineTable<'_>, faces: [u32; 2]) -> ExactLine {
    let [one, other] = faces.map(|face| lines.frame.sheet(PlaneId::face(face)));
    one.cut(&other)
}

/// A point of the scene in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProjectedPoint {
    point: [f64; 3],
    pub(super) at: [f64; 2],
}

impl ProjectedPoint {
    /// Projects a point; `None` if the point is not in the picture.
    pub(super) fn new(lines: &LineTable<'_>, point: [f64; 3]) -> Option<Self> {
        let image = lines.frame.image(point);
        if !image[0].sign().is_gt() {
            return None;
        }
        let projected = Self { point, at: point_of(&image) };
        projected.is_in(lines, &Cell::picture(lines)).then_some(projected)
    }

    /// A box around the point.
    pub(super) fn around(&self) -> Rect {
        [self.at.map(|c| c - MARGIN), self.at.map(|c| c + MARGIN)]
    }

    /// Whether the point is in a cell or on one of the cell's sides, decided exactly.
    pub(super) fn is_in(&self, lines: &LineTable<'_>, cell: &Cell) -> bool {
        cell.sides.iter().all(|side| {
            let line = lines.rounded(side.half);
            let value = line.at(self.at);
            let is_outside = |side_of: Ordering| side_of.is_lt() != side.half.is_negative();
            // The coordinates are rounded three times.
            let off = 4.0 * f64::EPSILON * (self.at[0].abs() + self.at[1].abs());
            if value.abs() > line.error + line.slope * off {
                return !is_outside(value.total_cmp(&0.0));
            }
            let image: Image = lines.frame.image(self.point);
            let side = side_at(&lines.exact(side.half), &image);
            side.is_eq() || !is_outside(side)
        })
    }

    /// Whether the point is further away than a face's plane, by more than the tolerance of `faces`.
    pub(super) fn is_behind(&self, faces: &Faces, face: u32, seen: Ordering) -> bool {
        let prepared = PreparedPlane::new(faces, PlaneId::face(face));
        prepared.side_beyond(faces, &self.point) == seen.reverse()
    }
}

/// A part of a segment that passes in front of or behind an item or a face, over the inside or along the
/// border of that item or face in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass {
    /// The numbers of the segment and of the item or face.
    pub(super) segment: u32,
    pub(super) piece: u32,
    /// Whether the segment is behind the piece.
    pub(super) is_behind: bool,
    /// The places along the segment at which the part begins and ends.
    pub(super) places: [f64; 2],
}

/// A point that in the picture is inside an item or a face, or on the border of that item or face.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointPass {
    pub(super) point: u32,
    pub(super) piece: u32,
    /// Whether the point is behind the piece.
    pub(super) is_behind: bool,
}

/// Segments and points, and the numbers of the segments and points that may be in a part of the picture.
#[derive(Clone)]
pub(super) struct Passing<'a> {
    segments: &'a [ProjectedSegment],
    points: &'a [ProjectedPoint],
    /// The faces whose tolerance decides what lies on a plane: those of the tree, or of an overlay, which begin with
    /// those of the tree.
    faces: &'a Faces,
    near_segments: Vec<u32>,
    near_points: Vec<u32>,
}

impl<'a> Passing<'a> {
    /// No segments and no points.
    pub(super) fn nothing(faces: &'a Faces) -> Self {
        Self::new(&[], &[], faces)
    }

    pub(super) fn new(
        segments: &'a [ProjectedSegment],
        points: &'a [ProjectedPoint],
        faces: &'a Faces,
    ) -> Self {
        let near_segments = (0..segments.len() as u32).collect();
        let near_points = (0..points.len() as u32).collect();
        Self { segments, points, faces, near_segments, near_points }
    }

    fn is_empty(&self) -> bool {
        self.near_segments.is_empty() && self.near_points.is_empty()
    }

    /// The segments and points that may be in a box.
    fn near(&self, sides: &Rect) -> Self {
        self.filtered(|segment| segment.may_meet(sides), |point| !are_apart(sides, &point.around()))
    }

    /// The segments and points in a cell.
    pub(super) fn over(&self, lines: &LineTable<'_>, cell: &Cell) -> Self {
        self.filtered(|segment| segment.meets(lines, cell), |point| point.is_in(lines, cell))
    }

    fn filtered(
        &self,
        has_segment: impl Fn(&ProjectedSegment) -> bool,
        has_point: impl Fn(&ProjectedPoint) -> bool,
    ) -> Self {
        let (segments, points) = (self.near_segments.iter(), self.near_points.iter());
        let segments = segments.filter(|&&number| has_segment(&self.segments[number as usize]));
        let points = points.filter(|&&number| has_point(&self.points[number as usize]));
        let near_segments = segments.copied().collect();
        Self { near_segments, near_points: points.copied().collect(), ..*self }
    }
}

/// The passes found: one segment may pass a piece in several parts, and one point may be found twice.
#[derive(Default)]
pub(super) struct Passes {
    pub(super) segments: Vec<Pass>,
    pub(super) points: Vec<PointPass>,
}

/// Tiles are not halved if at most this many pieces reach into them without covering them. Too small: more
/// tiles, and more parts of segments (8: twice the time, for crossing triangles five times). Too large: more
/// segments are compared with more pieces (128: up to a sixth less time).
const FEW: usize = 64;

/// The passes of segments and points behind candidates and, unless `wants_behind_only`, in front of
/// candidates. Counts as one phase of the progress.
pub(super) fn passes<'p>(
    candidates: Candidates<'p>,
    passing: Passing<'p>,
    wants_behind_only: bool,
    watch: &Watch<'_>,
) -> Result<Passes, Error> {
    let primitives = candidates.primitives;
    type Part<'p> = (TileList<'p>, Passing<'p>);
    let halves = |(list, passing): &Part<'p>| {
        if passing.is_empty() || list.open() <= FEW || list.is_small(TINIEST) {
            return Ok(None);
        }
        watch.work((passing.near_segments.len() + passing.near_points.len()) * NARROWED)?;
        let halves = list.halves(watch)?;
        Ok(Some(halves.map(|half| {
            let passing = passing.near(&half.tile.sides());
            (half, passing)
        })))
    };
    let leaf = |(list, passing): &Part<'p>, found: &mut Passes| {
        if passing.is_empty() {
            return Ok(());
        }
        let whole = SubTile::new(list, passing.clone(), watch)?;
        let see = |part: SubTile<'_, '_>| {
            let face = |number: u32| part.candidates.face(number);
            found.add(primitives, &part.pieces, face, &part.passing, wants_behind_only, watch)
        };
        whole.for_each_part(see, watch)
    };
    let all = (TileList::picture(candidates, watch)?, passing);
    Ok(Passes::joined(found_in(all, halves, leaf, watch)?))
}

impl Passes {
    fn joined(parts: Vec<Self>) -> Self {
        let mut joined = Self::default();
        for mut part in parts {
            joined.segments.append(&mut part.segments);
            joined.points.append(&mut part.points);
        }
        joined
    }

    /// Adds the passes in front of or behind pieces. Pieces have the numbers of items or faces.
    fn add<'c>(
        &mut self,
        primitives: &Primitives<'_>,
        pieces: impl IntoIterator<Item = &'c Visible>,
        face: impl Fn(u32) -> u32,
        passing: &Passing<'_>,
        wants_behind_only: bool,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let Passing { segments, points, faces, near_segments, near_points } = passing;
        let lines = &primitives.lines;
        for Visible { item: piece, cell } in pieces {
            watch.work((near_segments.len() + near_points.len()) * CUT)?;
            let (around, face) = (cell.around(), face(*piece));
            let side = primitives.views[face as usize].side;
            for &number in near_segments {
                let segment = &segments[number as usize];
                if !segment.may_meet(&around) {
                    continue;
                }
                let Some(chord) = segment.chord(lines, cell) else { continue };
                let mut add = |is_behind: bool, [from, to]: [f64; 2]| {
                    let places = [from.max(chord[0]), to.min(chord[1])];
                    if places[0] < places[1] && (is_behind || !wants_behind_only) {
                        self.segments.push(Pass {
                            segment: number,
                            piece: *piece,
                            is_behind,
                            places,
                        });
                    }
                };
                let behind = segment.behind(primitives, faces, (face, chord));
                let [from, to] = behind.unwrap_or([f64::INFINITY; 2]);
                add(true, [from, to]);
                add(false, [f64::NEG_INFINITY, from]);
                add(false, [to, f64::INFINITY]);
            }
            for &number in near_points {
                let point = &points[number as usize];
                if are_apart(&around, &point.around()) || !point.is_in(lines, cell) {
                    continue;
                }
                let is_behind = point.is_behind(faces, face, side);
                if is_behind || !wants_behind_only {
                    self.points.push(PointPass { point: number, piece: *piece, is_behind });
                }
            }
        }
        Ok(())
    }
}

/// The number of polygons in front of a segment, from the place `from` to the next place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    from: f64,
    layers: u32,
}

/// The quantitative invisibility along segments, one list for each segment, and the start of each list.
/// Before the first place of a list, nothing is in front of the segment.
pub(super) struct Depths {
    depths: Vec<Depth>,
    begins: Vec<usize>,
}

impl Depths {
    /// The depths of `count` segments, by sorted passes. A segment's own faces do not count.
    pub(super) fn new(
        count: usize,
        passes: &[Pass],
        faces: &Faces,
        is_own: impl Fn(u32, u32) -> bool,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let mut all = Self { depths: vec![], begins: vec![0] };
        let (mut changes, mut rest) = (Vec::new(), passes);
        let polygon = |pass: &Pass| faces.polygon(pass.piece);
        for number in 0..count as u32 {
            let own = take_own(&mut rest, number);
            changes.clear();
            watch.work(own.len() * VISITED)?;
            for same in own.chunk_by(|a, b| polygon(a) == polygon(b)) {
                // Each polygon counts once, however many parts it has.
                let counts = |pass: &&Pass| !is_own(number, pass.piece);
                for [from, to] in merged(same.iter().filter(counts).map(|pass| pass.places)) {
                    changes.push((from, 1));
                    changes.push((to, -1));
                }
            }
            sort_by(&mut changes, watch, |a, b| a.0.total_cmp(&b.0))?;
            let mut layers = 0i64;
            for &(from, change) in &changes {
                layers += change;
                all.depths.push(Depth { from, layers: layers as u32 });
            }
            all.begins.push(all.depths.len());
        }
        Ok(all)
    }

    pub(super) fn of(&self, segment: usize) -> &[Depth] {
        &self.depths[self.begins[segment]..self.begins[segment + 1]]
    }
}

/// Removes the passes of a segment from the start of a list that is sorted by segments, and returns these
/// passes.
pub(super) fn take_own<'p>(passes: &mut &'p [Pass], segment: u32) -> &'p [Pass] {
    let (own, rest) = passes.split_at(passes.partition_point(|pass| pass.segment == segment));
    *passes = rest;
    own
}

impl VisibilityMap<'_> {
    /// The passes of segments behind faces, sorted by segments, polygons and places, and the passes of
    /// points. Hidden and translucent faces are included only if `wants_all`. Counts as one phase of the
    /// progress.
    pub(super) fn in_front<'l>(
        &'l self,
        passing: Passing<'l>,
        wants_all: bool,
        watch: &Watch<'_>,
    ) -> Result<Passes, Error> {
        let primitives = &self.primitives;
        let mut passes = match wants_all {
            true => passes(Candidates::faces(primitives, |_| true)?, passing, true, watch)?,
            false => self.behind_visible(passing, watch)?,
        };
        let key = |pass: &Pass| (pass.segment, primitives.lines.frame.faces.polygon(pass.piece));
        sort_by(&mut passes.segments, watch, |a, b| {
            key(a).cmp(&key(b)).then(a.places[0].total_cmp(&b.places[0]))
        })?;
        Ok(passes)
    }

    /// The passes of segments and points behind visible parts of opaque faces. Counts as one phase of the
    /// progress.
    fn behind_visible<'l>(
        &'l self,
        passing: Passing<'l>,
        watch: &Watch<'_>,
    ) -> Result<Passes, Error> {
        type Part<'l> = (&'l [Leaf], Passing<'l>);
        let primitives = &self.primitives;
        let halves = |(leaves, passing): &Part<'l>| {
            if leaves.len() < 2 || passing.is_empty() {
                return Ok(None);
            }
            watch.work((passing.near_segments.len() + passing.near_points.len()) * NARROWED)?;
            let (first, second) = leaves.split_at(leaves.len() / 2);
            Ok(Some([first, second].map(|leaves| (leaves, passing.near(&around(leaves))))))
        };
        let leaf = |(leaves, passing): &Part<'l>, found: &mut Passes| {
            let opaque = leaves.iter().flat_map(|leaf| &leaf.cells);
            let opaque = opaque.filter(|visible| primitives.is_opaque(visible.item));
            let face = |item: u32| primitives.face(item);
            found.add(primitives, opaque, face, passing, true, watch)
        };
        let all = (&self.leaves[..], passing);
        let mut passes = Passes::joined(found_in(all, halves, leaf, watch)?);
        passes.segments.iter_mut().for_each(|pass| pass.piece = primitives.face(pass.piece));
        Ok(passes)
    }
}

/// Merges intervals that overlap, or that meet up to rounding. The intervals are given in the order of their
/// starts.
pub(super) fn merged(intervals: impl Iterator<Item = [f64; 2]>) -> impl Iterator<Item = [f64; 2]> {
    let mut intervals = intervals.peekable();
    std::iter::from_fn(move || {
        let [from, mut to] = intervals.next()?;
        while let Some(next) = intervals.next_if(|next| next[0] <= to + SHORTEST) {
            to = to.max(next[1]);
        }
        Some([from, to])
    })
}

/// Divides a segment into parts inside and outside of intervals, which are given in the order of their
/// starts. Returns the ends of each part, and whether the part is inside.
pub(super) fn parts(
    course: &ImageLine,
    intervals: impl Iterator<Item = [f64; 2]>,
) -> SmallVec<[([[f64; 2]; 2], bool); 4]> {
    let mut found = SmallVec::new();
    let mut add = |from: f64, to: f64, is_inside: bool| {
        if to - from >= SHORTEST {
            found.push(([course.at(from), course.at(to)], is_inside));
        }
    };
    let [mut done, end] = course.places;
    for [from, to] in merged(intervals) {
        let (from, to) = (from.max(done), to.min(end));
        if to - from < SHORTEST {
            continue;
        }
        add(done, from, false);
        add(from, to, true);
        done = to;
    }
    add(done, end, false);
    found
}

/// Both ends of a run.
type Ends = [[f64; 2]; 2];

/// The parts of a run, and the number of layers in front of each: at least one for a hidden run. Parts that
/// are only due to rounding are merged with the previous parts.
pub(super) fn in_layers(
    ends: Ends,
    is_visible: bool,
    depths: Option<(&ProjectedSegment, &[Depth])>,
    watch: &Watch<'_>,
) -> Result<Vec<(Ends, u32)>, Error> {
    let Some((segment, depths)) = depths.filter(|_| !is_visible) else {
        return Ok(vec![(ends, u32::from(!is_visible))]);
    };
    let [a, b] = ends.map(|end| segment.course.place(end));
    let (low, high) = (a.min(b), a.max(b));
    // The start of each part, as a place along the segment, and its layers.
    let mut parts: Vec<(f64, u32)> = Vec::new();
    let first = depths.partition_point(|depth| depth.from <= low);
    let before = first.checked_sub(1).map_or(0, |before| depths[before].layers);
    let inside = depths[first..].iter().take_while(|depth| depth.from < high);
    let begins = inside.map(|depth| (depth.from, depth.layers));
    let mut begins = [(low, before)].into_iter().chain(begins).peekable();
    while let Some((from, layers)) = begins.next() {
        watch.work(1)?;
        let to = begins.peek().map_or(high, |next| next.0);
        let layers = layers.max(1);
        let goes_on = parts.last().is_some_and(|last| last.1 == layers);
        if to - from >= SHORTEST && !goes_on {
            // (The first part begins where the run does.)
            parts.push((from, layers));
        }
    }
    if parts.is_empty() {
        return Ok(vec![(ends, before.max(1))]);
    }
    let at = |place: f64| {
        let share = (place - a) / (b - a);
        [0, 1].map(|i: usize| ends[0][i] + (ends[1][i] - ends[0][i]) * share)
    };
    let count = parts.len();
    let cut = |i: usize| if i == 0 || i == count { None } else { Some(at(parts[i].0)) };
    let end = |i: usize| cut(i).unwrap_or(ends[usize::from((i == 0) != (a < b))]);
    let mut all: Vec<_> = (0..count).map(|i| ([end(i), end(i + 1)], parts[i].1)).collect();
    if a > b {
        all.reverse();
        all.iter_mut().for_each(|(ends, _)| ends.swap(0, 1));
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COURSE: ImageLine =
        ImageLine { foot: [0.0; 2], direction: [1.0, 0.0], places: [0.0, 10.0] };

    /// The ends of parts, and whether each is inside.
    fn parts_of(intervals: &[[f64; 2]]) -> Vec<([f64; 2], bool)> {
        let parts = parts(&COURSE, intervals.iter().copied()).into_iter();
        parts.map(|([[a, _], [b, _]], is_inside)| ([a, b], is_inside)).collect()
    }

    #[test]
    fn intervals_and_gaps_of_rounding_make_no_parts() {
        let [low, high] = [3.0, 3.0 + 1e-9];
        assert_eq!(parts_of(&[[low, high]]), [([0.0, 10.0], false)]);
        let whole = [([0.0, 2.0], false), ([2.0, 4.0], true), ([4.0, 10.0], false)];
        assert_eq!(parts_of(&[[2.0, low], [high, 4.0]]), whole);
        assert_eq!(parts_of(&[[2.0, 4.0], [low, high]]), whole);
        assert_eq!(parts_of(&[[-1.0, 1e-9], [10.0 - 1e-9, 11.0]]), [([0.0, 10.0], false)]);
    }

    /// The starts and layers of the parts of a run from place 0 to 10.
    fn layers_of(depths: &[(f64, u32)]) -> Vec<([f64; 2], u32)> {
        let rounded = Rounded { k: [0.0, 0.0, -1.0], error: 0.0, slope: 1.0 };
        let source = Source::Points([[0.0; 3]; 2]);
        let mut segment = ProjectedSegment::along(rounded, source).expect("a line");
        segment.course = COURSE;
        let depths: Vec<Depth> =
            depths.iter().map(|&(from, layers)| Depth { from, layers }).collect();
        let ends = [[0.0; 2], [10.0, 0.0]];
        let known = Some((&segment, &depths[..]));
        let parts = in_layers(ends, false, known, &Watch::default()).expect("not cancelled");
        parts.into_iter().map(|([[a, _], [b, _]], layers)| ([a, b], layers)).collect()
    }

    #[test]
    fn layers_over_a_stretch_of_rounding_belong_to_the_part_before() {
        let parts = layers_of(&[(-5.0, 1), (4.0, 3), (4.0 + 1e-9, 2), (12.0, 0)]);
        assert_eq!(parts, [([0.0, 4.0 + 1e-9], 1), ([4.0 + 1e-9, 10.0], 2)]);
        // At the start, there is no part before.
        assert_eq!(layers_of(&[(-5.0, 1), (1e-9, 2), (12.0, 0)]), [([0.0, 10.0], 2)]);
        assert_eq!(layers_of(&[(-5.0, 0), (12.0, 0)]), [([0.0, 10.0], 1)]);
    }
}
