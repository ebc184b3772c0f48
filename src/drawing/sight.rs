//! Segments of the scene as the picture shows them.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::cell::{Cell, Corner, side_on_line};
use super::edge_run::SHORTEST;
use super::frame::{Exact, Image, meeting};
use super::lines::Lines;
use super::rect::{NOWHERE, Rect, are_apart};
use super::rounded::Rounded;
use super::tile::Tile;
use crate::exact::{Exact as Exactly, Int, Kernel, PlaneId};

/// A segment of the scene, as far as the picture has it. How far along something is, is its
/// place: in pixels, rising from the first end to the second, if these are lattice points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    source: Source,
    /// The line of the picture that it is on.
    rounded: Rounded,
    /// Along that line; of length 1.
    direction: [f64; 2],
    /// Where it begins and ends in the picture.
    pub(super) places: [f64; 2],
    /// A box around that part.
    region: Rect,
}

/// Where a segment comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// It goes from one lattice point to another.
    Points([[f64; 3]; 2]),
    /// These faces go through one another there.
    Crossing([u32; 2]),
}

/// What floats tell of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Certain {
    /// Both ends are in the picture, here.
    Inside([[f64; 2]; 2]),
    /// No point is in the picture.
    Outside,
    Nothing,
}

/// All places.
const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Boxes are larger than what they are around by this, in pixels: far more than rounding.
const MARGIN: f64 = 1e-3;

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
            Certain::Inside(ends) => ends.map(|end| sight.place(end)),
            _ => sight.in_picture(lines, ends)?,
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
        let [a, b] = ends.map(|end| sight.place(end));
        sight.limit([a.min(b), a.max(b)]);
        ((a - b).abs() >= SHORTEST).then_some(sight)
    }

    /// As much of it as lies between two places.
    pub(super) fn within(mut self, [from, to]: [f64; 2]) -> Option<Self> {
        self.limit([self.places[0].max(from), self.places[1].min(to)]);
        (self.places[1] - self.places[0] >= SHORTEST).then_some(self)
    }

    /// A line without ends.
    fn along(rounded: Rounded, source: Source) -> Option<Self> {
        let [_, kx, ky] = rounded.k;
        let slope = (kx * kx + ky * ky).sqrt();
        let direction = [ky / slope, -kx / slope];
        let sight = Self { source, rounded, direction, places: [0.0; 2], region: NOWHERE };
        (slope > 0.0).then_some(sight)
    }

    /// From where to where it is in the picture, by its ends.
    fn in_picture(&self, lines: &Lines<'_>, ends: [[f64; 3]; 2]) -> Option<[f64; 2]> {
        let Tile { low, high } = Tile::picture(lines.frame.rays.size());
        let [mut from, mut to] = self.chord(lines, &Cell::rectangle(lines, low, high))?;
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
        self.places = places;
        let [a, b] = places.map(|place| self.at(place));
        let axes = [0, 1];
        self.region = [
            axes.map(|i: usize| a[i].min(b[i]) - MARGIN),
            axes.map(|i: usize| a[i].max(b[i]) + MARGIN),
        ];
    }

    /// The point of its line at a place.
    pub(super) fn at(&self, place: f64) -> [f64; 2] {
        let [k0, kx, ky] = self.rounded.k;
        // From the point of the line that is nearest to the origin.
        let foot = -k0 / (kx * kx + ky * ky);
        [foot * kx + self.direction[0] * place, foot * ky + self.direction[1] * place]
    }

    /// How far along a point of the picture is.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> f64 {
        x * self.direction[0] + y * self.direction[1]
    }

    /// The same of a point that is on it, but for rounding.
    pub(super) fn place_on(&self, point: [f64; 2]) -> f64 {
        self.place(point).clamp(self.places[0], self.places[1])
    }

    fn place_of<const N: usize>(&self, image: &[Int<N>; 3]) -> f64 {
        let [weight, x, y] = image.map(Int::to_f64);
        self.place([x / weight, y / weight])
    }

    fn exact(&self, lines: &Lines<'_>) -> Exact {
        match self.source {
            Source::Points(ends) => lines.frame.edge(ends),
            Source::Crossing(faces) => cut(lines, faces),
        }
    }

    /// Whether it may meet a box.
    pub(super) fn may_meet(&self, region: &Rect) -> bool {
        if are_apart(region, &self.region) {
            return false;
        }
        let [low, high] = region;
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
        let signs: SmallVec<[Ordering; 8]> = (0..n).map(|i| self.side(lines, cell, i)).collect();
        let next = |i: usize| if i + 1 == n { 0 } else { i + 1 };
        let mut ends: SmallVec<[f64; 2]> = SmallVec::new();
        if signs.contains(&Ordering::Greater) && signs.contains(&Ordering::Less) {
            for i in 0..n {
                if signs[i].is_eq() {
                    ends.push(self.place(cell.sides[i].start.at));
                } else if signs[i] == signs[next(i)].reverse() {
                    let side = lines.exact(cell.sides[i].half);
                    ends.push(self.place(meeting([&self.exact(lines), &side])));
                }
            }
        } else {
            let side = side_on_line(&signs)?;
            ends.extend([side, next(side)].map(|i| self.place(cell.sides[i].start.at)));
        }
        let [a, b] = ends[..] else { return None };
        Some([a.min(b), a.max(b)])
    }

    /// On which side of the line a corner of a cell lies.
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
            let place = self.place(meeting([&line, &cut]));
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
        let splitter = Exactly.splitter(faces, PlaneId::face(face));
        let sides = ends.map(|end| splitter.side_beyond(faces, &end));
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

/// The line in which rays meet the planes of two faces.
fn cut(lines: &Lines<'_>, faces: [u32; 2]) -> Exact {
    let [one, other] = faces.map(|face| lines.frame.sheet(PlaneId::face(face)));
    one.cut(&other)
}

/// One over the largest error of a projected point, in pixels, that counts as none.
const FAR: f64 = (1u64 << 30) as f64;

/// What floats tell of the segment between two lattice points. (Most are inside or outside.)
fn certain_ends(lines: &Lines<'_>, ends: [[f64; 3]; 2], [low, high]: &Rect) -> Certain {
    let projected = ends.map(|end| lines.frame.rays.project(end));
    // What is positive in the picture and ahead of the eye, and how far off that may be.
    let inside = |([x, y, z], [ex, ey, ez]): ([f64; 3], [f64; 3])| {
        let side = |at: f64, error: f64, border: f64, sign: f64| {
            let off = error + border.abs() * ez;
            (sign * (at - border * z), off + 4.0 * f64::EPSILON * (at.abs() + (border * z).abs()))
        };
        let beyond = |at, error, axis: usize| side(at, error, low[axis], 1.0);
        let before = |at, error, axis: usize| side(at, error, high[axis], -1.0);
        [(z, ez), beyond(x, ex, 0), before(x, ex, 0), beyond(y, ey, 1), before(y, ey, 1)]
    };
    let [a, b] = projected.map(inside);
    let is_out = |&(value, off): &(f64, f64)| value < -off;
    if a.iter().zip(&b).any(|(a, b)| is_out(a) && is_out(b)) {
        return Certain::Outside;
    }
    let is_in = |&(value, off): &(f64, f64)| value > off;
    // Near the eye, errors that are small for the scene are large in the picture.
    let is_fine = |([_, _, z], errors): &([f64; 3], [f64; 3])| errors.iter().all(|e| e * FAR < *z);
    match a.iter().chain(&b).all(is_in) && projected.iter().all(is_fine) {
        true => Certain::Inside(projected.map(|([x, y, z], _)| [x / z, y / z])),
        false => Certain::Nothing,
    }
}

/// A point of the scene as the picture shows it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    point: [f64; 3],
    pub(super) at: [f64; 2],
}

impl Spot {
    /// `None` if it is not in the picture.
    pub(super) fn new(lines: &Lines<'_>, point: [f64; 3]) -> Option<Self> {
        let image = lines.frame.image(point);
        if !image[0].sign().is_gt() {
            return None;
        }
        let [weight, x, y] = image.map(Int::to_f64);
        let spot = Self { point, at: [x / weight, y / weight] };
        let Tile { low, high } = Tile::picture(lines.frame.rays.size());
        spot.is_in(lines, &Cell::rectangle(lines, low, high)).then_some(spot)
    }

    /// A box around it.
    pub(super) fn region(&self) -> Rect {
        [self.at.map(|c| c - MARGIN), self.at.map(|c| c + MARGIN)]
    }

    /// Whether it is in a cell, or on one of its sides: exact.
    pub(super) fn is_in(&self, lines: &Lines<'_>, cell: &Cell) -> bool {
        cell.sides.iter().all(|side| {
            let line = lines.rounded(side.half);
            let value = line.at(self.at);
            let is_outside = |side_of: Ordering| side_of.is_lt() != side.half.is_negative();
            // Its coordinates are rounded three times.
            let off = 4.0 * f64::EPSILON * (self.at[0].abs() + self.at[1].abs());
            if value.abs() > line.error + line.slope * off {
                return !is_outside(value.total_cmp(&0.0));
            }
            let image: Image = lines.frame.image(self.point);
            let exact = super::frame::side_at(&lines.exact(side.half), &image);
            exact.is_eq() || !is_outside(exact)
        })
    }

    /// Whether it is further away than a face's plane.
    pub(super) fn is_behind(&self, lines: &Lines<'_>, face: u32, seen: Ordering) -> bool {
        let faces = lines.frame.faces;
        let splitter = Exactly.splitter(faces, PlaneId::face(face));
        splitter.side_beyond(faces, &self.point) == seen.reverse()
    }
}
