//! Segments and points of the scene in the picture, and where they are behind a face.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::cell::{Cell, Corner, NOWHERE, Rect, are_apart, side_on_line};
use super::edges::SHORTEST;
use super::lines::{ExactLine, Image, LineTable, Rounded, meeting, side_at, value_at};
use super::primitives::Primitives;
use super::quadtree::Tile;
use crate::exact::{Faces, Int, PlaneId, PreparedPlane};

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
    pub(super) fn meets(&self, lines: &LineTable<'_>, cell: &Cell) -> bool {
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
    /// A segment from the picture's corner along its side.
    #[cfg(test)]
    pub(super) const TEN_ALONG_X: Self =
        Self { foot: [0.0; 2], direction: [1.0, 0.0], places: [0.0, 10.0] };

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
