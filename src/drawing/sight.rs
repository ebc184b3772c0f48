//! Segments of the scene as the picture shows them.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::cell::{Cell, Corner, side_on_line};
use super::certain::{Certain, certain_ends};
use super::edge_run::SHORTEST;
use super::frame::{ExactLine, meeting};
use super::lines::Lines;
use super::rect::{NOWHERE, Rect, are_apart};
use super::rounded::Rounded;
use super::tile::Tile;
use crate::exact::{Int, PlaneId, PreparedPlane};

/// A segment of the scene, as far as the picture has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    source: Source,
    /// The line of the picture that it is on.
    rounded: Rounded,
    pub(super) course: Course,
    /// On which side of its line the picture lies, if it runs along a border of it; else `Equal`.
    pub(super) picture: Ordering,
    /// A box around that part.
    around: Rect,
}

/// Where a segment is in the picture. How far along something is, is its place: in pixels, rising from the
/// first end to the second, if these are lattice points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    /// The point of its line that is nearest to the origin.
    foot: [f64; 2],
    /// Along that line; of length 1.
    direction: [f64; 2],
    /// Where it begins and ends in the picture.
    pub(super) places: [f64; 2],
}

/// Where a segment comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// It goes from one lattice point to another.
    Points([[f64; 3]; 2]),
    /// These faces go through one another there.
    Crossing([u32; 2]),
}

/// All places.
const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Boxes are larger than what they are around by this, in pixels: far more than rounding.
pub(super) const MARGIN: f64 = 1e-3;

impl Sight {
    /// `None` if it is not in the picture, or a point there.
    pub(super) fn new(lines: &Lines<'_>, ends: [[f64; 3]; 2]) -> Option<Self> {
        let picture = Tile::picture(lines.frame.rays.size()).sides();
        let certain = certain_ends(lines, ends, &picture);
        if certain == Certain::Outside {
            return None;
        }
        let mut sight = Self::along(lines.rounded_edge(ends), Source::Points(ends))?;
        let [from, to] = match certain {
            Certain::Inside(ends) => ends.map(|end| sight.course.place(end)),
            _ => {
                let Tile { low, high } = Tile::picture(lines.frame.rays.size());
                let picture = Cell::rectangle(lines, low, high);
                sight.picture = beside(&sight.signs(lines, &picture));
                sight.in_cell(lines, &picture, ends)?
            }
        };
        if (to - from).is_nan() || to - from < SHORTEST {
            return None;
        }
        sight.limit([from, to]);
        Some(sight)
    }

    /// The line in which two faces go through one another, between these points of the picture.
    pub(super) fn crossing(
        lines: &Lines<'_>,
        faces: [u32; 2],
        ends: [[f64; 2]; 2],
    ) -> Option<Self> {
        let rounded = lines.rounded_other(&cut(lines, faces));
        let mut sight = Self::along(rounded, Source::Crossing(faces))?;
        let [a, b] = ends.map(|end| sight.course.place(end));
        sight.limit([a.min(b), a.max(b)]);
        ((a - b).abs() >= SHORTEST).then_some(sight)
    }

    /// As much of it as lies between two places.
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
        let course = Course { foot: [foot * kx, foot * ky], direction, places: [0.0; 2] };
        let picture = Ordering::Equal;
        (slope > 0.0).then_some(Self { source, rounded, course, picture, around: NOWHERE })
    }

    /// From where to where it is in a cell, by its ends.
    fn in_cell(&self, lines: &Lines<'_>, cell: &Cell, ends: [[f64; 3]; 2]) -> Option<[f64; 2]> {
        let [mut from, mut to] = self.chord(lines, cell)?;
        let images = ends.map(|end| lines.frame.image(end));
        let is_ahead = images.map(|[weight, ..]| weight.sign().is_gt());
        if is_ahead[0] {
            from = from.max(self.place_of(&images[0]));
        }
        if is_ahead[1] {
            to = to.min(self.place_of(&images[1]));
        }
        (is_ahead != [false; 2]).then_some([from, to])
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

    fn place_of<const N: usize>(&self, image: &[Int<N>; 3]) -> f64 {
        let [weight, x, y] = image.map(Int::to_f64);
        self.course.place([x / weight, y / weight])
    }

    fn exact(&self, lines: &Lines<'_>) -> ExactLine {
        match self.source {
            Source::Points(ends) => lines.frame.edge(ends),
            Source::Crossing(faces) => cut(lines, faces),
        }
    }

    /// Whether it may meet a box.
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

    /// From where to where the line goes through a cell or along one of its sides: which of these it does is
    /// exact, where is rounded.
    pub(super) fn chord(&self, lines: &Lines<'_>, cell: &Cell) -> Option<[f64; 2]> {
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

    /// On which side of the line each corner of a cell lies.
    fn signs(&self, lines: &Lines<'_>, cell: &Cell) -> SmallVec<[Ordering; 8]> {
        (0..cell.sides.len()).map(|i| self.side(lines, cell, i)).collect()
    }

    fn side(&self, lines: &Lines<'_>, cell: &Cell, corner: usize) -> Ordering {
        let Corner { at, radius } = cell.sides[corner].start;
        let value = self.rounded.at(at);
        if value.abs() > self.rounded.error + self.rounded.slope * radius {
            return value.total_cmp(&0.0);
        }
        let before = if corner == 0 { cell.sides.len() - 1 } else { corner - 1 };
        let halves = [before, corner].map(|i| cell.sides[i].half);
        lines.exact_side_of(&self.exact(lines), halves)
    }

    /// The places where it is further away than a face's plane, which is seen from a side; `None` if it is
    /// nowhere. No further off than the tolerance it is on the plane, and not behind it.
    pub(super) fn behind(&self, lines: &Lines<'_>, face: u32, seen: Ordering) -> Option<[f64; 2]> {
        match self.source {
            Source::Points(ends) => self.points_behind(lines, ends, face, seen),
            Source::Crossing([own, _]) => self.crossing_behind(lines, own, face, seen),
        }
    }

    /// The same of a crossing, by one of its faces: that is as far away as another plane where the rays meet
    /// both in one line. (No tolerance: the ends are no lattice points.)
    fn crossing_behind(
        &self,
        lines: &Lines<'_>,
        own: u32,
        face: u32,
        seen: Ordering,
    ) -> Option<[f64; 2]> {
        let [line, cut] = [self.exact(lines), cut(lines, [own, face])];
        // Where the cut is positive, the own face is in front of the other's plane if its κ is positive.
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
        // It is the same all along: of the line that is left if as much of the other is taken away as has its
        // slope.
        let axis = if line[1].sign().is_ne() { 1 } else { 2 };
        let sign = if line[axis].sign().is_gt() { minor(0, axis) } else { minor(axis, 0) };
        is_behind(sign).then_some(ALL)
    }

    fn points_behind(
        &self,
        lines: &Lines<'_>,
        ends: [[f64; 3]; 2],
        face: u32,
        seen: Ordering,
    ) -> Option<[f64; 2]> {
        let faces = lines.frame.faces;
        let prepared = PreparedPlane::new(faces, PlaneId::face(face));
        let sides = ends.map(|end| prepared.side_beyond(faces, &end));
        let is_behind = sides.map(|side| side == seen.reverse());
        if is_behind == [false; 2] || sides[0] != sides[1].reverse() {
            return (is_behind != [false; 2]).then_some(ALL);
        }
        // It goes through the plane, at a mean of its ends.
        let plane = faces.plane(PlaneId::face(face));
        let [a, b] = ends.map(|end| lines.frame.image(end));
        let weights = [ends[1], ends[0]].map(|end| {
            let at = plane.at(&end);
            if at.is_negative() { -at } else { at }
        });
        let mean: [Int<6>; 3] = std::array::from_fn(|i| {
            let parts: [Int<6>; 2] = [a[i].times(&weights[0]), b[i].times(&weights[1])];
            parts[0] + parts[1]
        });
        if mean[0].sign().is_gt() {
            let place = self.place_of(&mean);
            return Some(if is_behind[0] { [ALL[0], place] } else { [place, ALL[1]] });
        }
        // Behind the eye: what is ahead is all on the side of the end that is.
        let ahead = if a[0].sign().is_gt() { 0 } else { 1 };
        is_behind[ahead].then_some(ALL)
    }
}

impl Course {
    /// The point of its line at a place.
    pub(super) fn at(&self, place: f64) -> [f64; 2] {
        [0, 1].map(|axis: usize| self.foot[axis] + self.direction[axis] * place)
    }

    /// How far along a point of the picture is.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> f64 {
        x * self.direction[0] + y * self.direction[1]
    }

    /// The same of a point that is on it, but for rounding.
    pub(super) fn place_on(&self, point: [f64; 2]) -> f64 {
        self.place(point).clamp(self.places[0], self.places[1])
    }
}

/// On which side of a line a cell is whose corners are on these sides of it; `Equal` if it is on both.
fn beside(signs: &[Ordering]) -> Ordering {
    let sides = [Ordering::Greater, Ordering::Less].map(|side| signs.contains(&side));
    sides[0].cmp(&sides[1])
}

/// The line in which rays meet the planes of two faces.
fn cut(lines: &Lines<'_>, faces: [u32; 2]) -> ExactLine {
    let [one, other] = faces.map(|face| lines.frame.sheet(PlaneId::face(face)));
    one.cut(&other)
}
