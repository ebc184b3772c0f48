//! Outlines of areas that are given in parts.
//!
//! Which sides of parts lie on one line, and which corners are one point, is exact: outlines are closed, and have nothing
//! that goes there and back, however corners are rounded.

use std::cmp::Ordering;

use super::cell::{Corner, Side};
use super::half::Half;
use super::halving::VISITED;
use super::lines::Lines;
use super::reporter::{each, sort_by};
use super::rounded::{ROUNDING, Rounded};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{collect, filled, place, push, reserve};
use crate::union::Union;

/// Convex parts of an area, by their sides.
#[derive(Default)]
pub(super) struct Area {
    sides: Vec<Side>,
    /// Where each part ends.
    ends: Vec<u32>,
}

/// The cost of following an outline to its next piece, in work units: pieces that a build examines.
const FOLLOWED: usize = 16;
/// No piece.
const NONE: u32 = u32::MAX;

/// Sides of parts, by numbers; corners have the numbers of the sides that begin there.
struct Sides<'a> {
    lines: &'a Lines<'a>,
    sides: &'a [Side],
    /// The side before each and the one after it.
    before: Vec<u32>,
    after: Vec<u32>,
}

/// An end of a side on a line.
#[derive(Clone, Copy)]
struct End {
    corner: u32,
    /// Where it is, in the direction of the line's positive half.
    place: f64,
    radius: f64,
    /// The other half that meets there.
    across: Half,
    is_start: bool,
    /// Whether that half lies ahead.
    is_ahead: bool,
}

/// A part of an outline on one line, from one corner to another, in the direction of a half.
#[derive(Clone, Copy)]
struct Piece {
    half: Half,
    from: u32,
    to: u32,
}

impl Area {
    pub(super) fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    pub(super) fn clear(&mut self) {
        self.sides.clear();
        self.ends.clear();
    }

    pub(super) fn push(&mut self, part: &[Side]) -> Result<(), Error> {
        reserve(&mut self.sides, part.len())?;
        self.sides.extend_from_slice(part);
        push(&mut self.ends, place(self.sides.len())?)
    }

    pub(super) fn part(&self, i: usize) -> &[Side] {
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.sides[start as usize..self.ends[i] as usize]
    }

    /// The closed outlines of all parts, each with the area on its left. Sides that two neighbouring parts share in
    /// opposite directions cancel. Where parts overlap, outlines wind around both.
    pub(super) fn outlines(
        &self,
        lines: &Lines<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<Vec<[f64; 2]>>, Error> {
        if let [_] = self.ends[..] {
            let corners = self.sides.iter().map(|side| side.start.at);
            return Ok(vec![collect(corners)?]);
        }
        let sides = Sides::new(lines, self)?;
        // Corners that are one point.
        let mut points = Union::new(place(self.sides.len())?)?;
        let pieces = sides.pieces(&mut points, watch)?;
        // The first of the pieces that begin at each point, and the one after each.
        let (mut begin, mut others) =
            (filled(self.sides.len(), NONE)?, filled(pieces.len(), NONE)?);
        for numbered in each(watch, VISITED, pieces.iter().enumerate().rev()) {
            let (i, piece) = numbered?;
            let point = points.root(piece.from) as usize;
            others[i] = std::mem::replace(&mut begin[point], i as u32);
        }
        let (mut is_used, mut outlines) = (filled(pieces.len(), false)?, Vec::new());
        for (i, first) in pieces.iter().enumerate() {
            if is_used[i] {
                continue;
            }
            let (start, mut outline, mut next) = (points.root(first.from), Vec::new(), Some(i));
            while let Some(i) = next {
                watch.work(FOLLOWED)?;
                is_used[i] = true;
                let piece = &pieces[i];
                // Pieces of one line follow one another where others meet it.
                if outline.last().is_none_or(|last: &Piece| last.half != piece.half) {
                    push(&mut outline, *piece)?;
                }
                let point = points.root(piece.to);
                if point == start {
                    break;
                }
                let some = |piece: u32| (piece != NONE).then_some(piece as usize);
                let from_here =
                    std::iter::successors(some(begin[point as usize]), |&i| some(others[i]));
                let left = from_here.filter(|&i| !is_used[i]);
                // Of several the one that turns furthest to the left, so that outlines that touch in a point stay apart.
                let turn = |i: usize| sides.turn(piece.half, pieces[i].half);
                next = left.max_by(|&a, &b| turn(a).total_cmp(&turn(b)));
                debug_assert!(next.is_some(), "an outline is open");
            }
            let is_one_line = outline.first().map(|p| p.half) == outline.last().map(|p| p.half);
            let corner = |piece: &Piece| self.sides[piece.from as usize].start.at;
            let corners = outline[usize::from(is_one_line)..].iter().map(corner);
            push(&mut outlines, collect(corners)?)?;
        }
        Ok(outlines)
    }
}

impl<'a> Sides<'a> {
    fn new(lines: &'a Lines<'a>, area: &'a Area) -> Result<Self, Error> {
        let count = place(area.sides.len())?;
        let mut before = collect((0..count).map(|side| side.wrapping_sub(1)))?;
        let mut after = collect((0..count).map(|side| side + 1))?;
        let mut start = 0;
        for &end in &area.ends {
            (before[start as usize], after[end as usize - 1]) = (end - 1, start);
            start = end;
        }
        Ok(Self { lines, sides: &area.sides, before, after })
    }

    /// The sides without what two of them have in common, in opposite directions.
    fn pieces(&self, points: &mut Union, watch: &Watch<'_>) -> Result<Vec<Piece>, Error> {
        let half = |side: u32| self.sides[side as usize].half;
        let mut by_line: Vec<u32> = collect(0..self.sides.len() as u32)?;
        sort_by(&mut by_line, watch, |&a, &b| half(a).line().cmp(&half(b).line()))?;
        let (mut pieces, mut ends) = (Vec::new(), Vec::new());
        for group in by_line.chunk_by(|&a, &b| half(a).line() == half(b).line()) {
            watch.work(group.len() * VISITED)?;
            if let [side] = *group {
                let to = self.after[side as usize];
                push(&mut pieces, Piece { half: half(side), from: side, to })?;
                continue;
            }
            let line = half(group[0]).positive();
            let rounded = self.lines.rounded(line);
            ends.clear();
            reserve(&mut ends, 2 * group.len())?;
            ends.extend(group.iter().flat_map(|&side| self.ends(side, &rounded)));
            sort_by(&mut ends, watch, |a, b| self.compare(&rounded, a, b))?;
            self.add_pieces(line, &ends, points, &mut pieces)?;
        }
        Ok(pieces)
    }

    /// Both ends of a side.
    fn ends(&self, side: u32, line: &Rounded) -> [End; 2] {
        let [before, after] = [&self.before, &self.after].map(|list| list[side as usize]);
        let half = |side: u32| self.sides[side as usize].half;
        let end = |corner: u32, across: Half, is_start: bool| {
            let Corner { at: [x, y], radius } = self.sides[corner as usize].start;
            let place = x * line.k[2] - y * line.k[1];
            let is_ahead = is_start != half(side).is_negative();
            End { corner, place, radius, across, is_start, is_ahead }
        };
        [end(side, half(before), true), end(after, half(after), false)]
    }

    /// In which order two ends of sides lie on their line, in the direction of its positive half: exact.
    fn compare(&self, line: &Rounded, a: &End, b: &End) -> Ordering {
        // A corner is off by its radius at most, which changes its place by so much, and the place is rounded three
        // times.
        let size: f64 = self.lines.reach.iter().sum();
        let off = line.slope * (a.radius + b.radius + 8.0 * ROUNDING * size);
        if (a.place - b.place).abs() > off {
            return a.place.total_cmp(&b.place);
        }
        let corner = [self.before[a.corner as usize], a.corner];
        let halves = corner.map(|side| self.sides[side as usize].half);
        let side = self.lines.exact_side(b.across, halves);
        if b.is_ahead { side } else { side.reverse() }
    }

    /// Adds the pieces that remain of the sides on a line after opposite ones have cancelled. `ends` are the ends of
    /// these sides in order along the line; ends in one place become one point.
    fn add_pieces(
        &self,
        line: Half,
        ends: &[End],
        points: &mut Union,
        pieces: &mut Vec<Piece>,
    ) -> Result<(), Error> {
        let rounded = self.lines.rounded(line);
        // How many more sides run forwards than backwards, and from where.
        let (mut count, mut from) = (0i32, 0);
        for place in ends.chunk_by(|a, b| self.compare(&rounded, a, b).is_eq()) {
            let point = place[0].corner;
            place[1..].iter().for_each(|end| points.unite(point, end.corner));
            let steps = place.iter().map(|end| if end.is_start { 1 } else { -1 });
            let after = count + steps.sum::<i32>();
            if after == count {
                continue;
            }
            let is_back = count < 0;
            let [start, end] = if is_back { [point, from] } else { [from, point] };
            let piece = Piece { half: line.flipped(is_back), from: start, to: end };
            reserve(pieces, count.unsigned_abs() as usize)?;
            pieces.extend((0..count.abs()).map(|_| piece));
            (count, from) = (after, point);
        }
        Ok(())
    }

    /// By how much an outline turns to the left where it goes from one half to another.
    fn turn(&self, from: Half, to: Half) -> f64 {
        let [[ax, ay], [bx, by]] = [from, to].map(|half| {
            let [_, kx, ky] = self.lines.rounded(half).flipped(half.is_negative()).k;
            [ky, -kx]
        });
        (ax * by - ay * bx).atan2(ax * bx + ay * by)
    }
}
