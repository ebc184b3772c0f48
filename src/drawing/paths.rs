//! Drawings: filled outlines in painting order.
//!
//! Each outline is made from an area that consists of convex parts. Collinear sides and equal corners of the
//! parts are found exactly. So outlines are closed, and no outline traverses a line in both directions,
//! however corners are rounded.

use std::cmp::Ordering;
use std::ops::Range;

use smallvec::SmallVec;

use super::cell::{Cell, Corner, Side};
use super::graph::{Ordered, Ranks, Wanted, order_by_rank};
use super::lines::{HalfPlane, LineTable, ROUNDING, Rounded, ViewFrame};
use super::map::{VisibilityMap, finish_item, sort_by};
use super::overlaid::{LineRun, MarkerView, Overlaid};
use super::pairs::pairs;
use super::primitives::Primitives;
use super::quadtree::{CUT, Leaf, Tile, VISITED, Visible};
use super::translucent::mixed;
use crate::memory::place;
use crate::progress::Watch;
use crate::union::Union;
use crate::{Error, parallel_map};

/// A view as filled outlines, in painting order, from [`VisibilityMap::drawing`] or
/// [`Drawing::translucent`].
#[derive(Clone, Debug)]
pub struct Drawing {
    pub(super) size: [u32; 2],
    pub(super) paths: Vec<Record>,
    /// The start of each outline, and all corners.
    pub(super) outlines: Vec<u32>,
    pub(super) corners: Vec<[f64; 2]>,
    /// For each corner, the edge of the polygon along the side that begins there.
    pub(super) edges: Vec<Option<u32>>,
    /// Lines and points in painting order, each with the number of paths that precede it.
    pub(super) overlaid: Vec<(u32, Overlaid)>,
}

#[derive(Clone, Debug)]
pub(super) struct Record {
    polygon: usize,
    is_clipped: bool,
    pub(super) outlines: Range<u32>,
}

impl Record {
    /// The record of the same path with other outlines.
    pub(super) fn with_outlines(&self, outlines: Range<u32>) -> Self {
        Self { outlines, ..*self }
    }
}

/// The filled area of a polygon, or of a part of a polygon, in a [`Drawing`].
#[derive(Clone, Copy, Debug)]
pub struct Path<'d> {
    drawing: &'d Drawing,
    pub(super) record: &'d Record,
}

impl Drawing {
    /// A drawing without paths.
    pub(super) fn empty(size: [u32; 2]) -> Self {
        Self {
            size,
            paths: vec![],
            outlines: vec![],
            corners: vec![],
            edges: vec![],
            overlaid: vec![],
        }
    }

    /// Adds a path that fills an area. The area consists of parts of the given faces of the polygon.
    pub(super) fn push(
        &mut self,
        polygon: usize,
        is_clipped: bool,
        area: &Area,
        faces: impl Iterator<Item = u32>,
        primitives: &Primitives<'_>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let start = self.outlines.len() as u32;
        let edges = PolygonEdges::of(primitives, is_clipped, faces);
        for outline in area.outlines(&primitives.lines, watch)? {
            self.outlines.push(self.corners.len() as u32);
            for (i, side) in outline.iter().enumerate() {
                let end = outline[if i + 1 == outline.len() { 0 } else { i + 1 }].start.at;
                self.corners.push(side.start.at);
                self.edges.push(edges.along(side, end));
            }
        }
        let outlines = start..self.outlines.len() as u32;
        self.paths.push(Record { polygon, is_clipped, outlines });
        Ok(())
    }

    /// Adds a path of one outline.
    #[cfg(test)]
    pub(super) fn push_outline(&mut self, polygon: usize, outline: &[[f64; 2]]) {
        let start = self.outlines.len() as u32;
        self.outlines.push(self.corners.len() as u32);
        self.corners.extend_from_slice(outline);
        self.edges.resize(self.corners.len(), None);
        self.paths.push(Record { polygon, is_clipped: false, outlines: start..start + 1 });
    }

    /// Appends the paths of another drawing.
    pub(super) fn append(&mut self, mut other: Self) -> Result<(), Error> {
        let [outlines, corners] = [place(self.outlines.len())?, place(self.corners.len())?];
        self.paths.extend(other.paths.into_iter().map(|record| {
            let Range { start, end } = record.outlines;
            Record { outlines: start + outlines..end + outlines, ..record }
        }));
        self.outlines.extend(other.outlines.iter().map(|start| start + corners));
        self.corners.append(&mut other.corners);
        self.edges.append(&mut other.edges);
        Ok(())
    }

    /// Returns the picture's width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the paths, in painting order.
    pub fn paths(&self) -> impl DoubleEndedIterator<Item = Path<'_>> + ExactSizeIterator + Clone {
        self.paths.iter().map(|record| Path { drawing: self, record })
    }
}

impl<'d> Path<'d> {
    /// Returns the index of the polygon, in input order.
    pub fn polygon(&self) -> usize {
        self.record.polygon
    }

    /// Returns whether the path is only a part of its polygon. Such a part is the visible part of a polygon
    /// in a cycle of polygons that hide one another, or one of several parts of a translucent polygon.
    pub fn is_clipped(&self) -> bool {
        self.record.is_clipped
    }

    /// Returns the outlines of the path, at least one, clipped to the picture. Fill them together by the
    /// nonzero rule.
    ///
    /// Each outline is a list of at least three corners in pixels: x to the right, y down, and the corner of
    /// the first pixel at (0, 0). Outer outlines are clockwise, and holes counter-clockwise. The outlines of
    /// a folded polygon overlap. Only the corners are rounded, by less than a millionth of a pixel; corners
    /// of thin slivers may coincide.
    pub fn outlines(&self) -> impl Iterator<Item = &'d [[f64; 2]]> + Clone + use<'d> {
        let corners = &self.drawing.corners;
        self.ranges().map(move |range| &corners[range])
    }

    /// Returns one list for each of the [`outlines`](Self::outlines). Entry `i` of a list is the number of
    /// the polygon's edge that contains the outline's side from corner `i` to the next corner.
    ///
    /// The number of an edge is the number of the polygon's corner where the edge begins. `None` stands for
    /// sides along the border of the picture, along other polygons, and along edges that triangulation made.
    /// If a side contains several collinear edges, the entry is the edge at the middle of the side.
    pub fn edges(&self) -> impl Iterator<Item = &'d [Option<u32>]> + Clone + use<'d> {
        let edges = &self.drawing.edges;
        self.ranges().map(move |range| &edges[range])
    }

    /// The range of corners of each outline.
    pub(super) fn ranges(&self) -> impl Iterator<Item = Range<usize>> + Clone + use<'d> {
        let Drawing { outlines, corners, .. } = self.drawing;
        self.record.outlines.clone().map(move |outline| {
            let start = outlines[outline as usize] as usize;
            let end = outlines.get(outline as usize + 1).map_or(corners.len(), |&end| end as usize);
            start..end
        })
    }
}

/// A side is part of an edge if its middle is at most this far beyond the edge's ends, in pixels. Too small:
/// edges are lost to rounding. Too large: sides along collinear edges of other polygons count as edges.
const BEYOND: f64 = 1e-3;

/// The edges of a polygon's faces, sorted by line.
struct PolygonEdges<'s, 't> {
    primitives: &'s Primitives<'t>,
    /// The line, the face, and the number of the edge in the face; sorted.
    edges: SmallVec<[(u64, u32, u32); 8]>,
    /// Whether the polygon is one face that is drawn whole. Then sides lie on no other edges than its own.
    is_whole: bool,
}

impl<'s, 't> PolygonEdges<'s, 't> {
    fn of(
        primitives: &'s Primitives<'t>,
        is_clipped: bool,
        faces: impl Iterator<Item = u32>,
    ) -> Self {
        let mut count = 0;
        let edges_of = |face: u32| {
            count += 1;
            let numbered = (0..).zip(primitives.outline(face));
            numbered.map(move |(k, half)| (half.line(), face, k))
        };
        let mut edges: SmallVec<_> = faces.flat_map(edges_of).collect();
        edges.sort_unstable();
        let is_whole = !is_clipped && count == 1;
        Self { primitives, edges, is_whole }
    }

    /// The polygon's edge along a side; `None` if the polygon has no edge there.
    fn along(&self, side: &Side, end: [f64; 2]) -> Option<u32> {
        let line = side.half.line();
        let first = self.edges.partition_point(|edge| edge.0 < line);
        let count = self.edges[first..].iter().take_while(|edge| edge.0 == line).count();
        if self.is_whole && count == 1 {
            let (_, face, k) = self.edges[first];
            return self.primitives.lines.frame.faces.outline_edge(face, k);
        }
        let middle = [0, 1].map(|i: usize| 0.5 * (side.start.at[i] + end[i]));
        let alike = self.edges[first..first + count].iter();
        let offs = alike.map(|&(_, face, k)| (self.off(face, k, middle), face, k));
        let (off, face, k) = offs.min_by(|a, b| a.0.total_cmp(&b.0))?;
        // Another polygon's edge may be on the same line, beyond this polygon's edge.
        if off > BEYOND {
            return None;
        }
        self.primitives.lines.frame.faces.outline_edge(face, k)
    }

    /// The rounded distance, in pixels, of a point on an edge's line from the edge; 0 between the edge's
    /// ends.
    fn off(&self, face: u32, k: u32, at: [f64; 2]) -> f64 {
        let ViewFrame { rays, faces } = &self.primitives.lines.frame;
        let arms = faces.ends(face, k).map(|end| {
            let ([x, y, weight], _) = rays.project(end);
            // An end behind the eye is beyond the picture.
            (weight > 0.0).then(|| [x / weight - at[0], y / weight - at[1]])
        });
        match arms {
            [Some(a), Some(b)] if a[0] * b[0] + a[1] * b[1] > 0.0 => {
                a[0].hypot(a[1]).min(b[0].hypot(b[1]))
            }
            _ => 0.0,
        }
    }
}

/// Adds the part of a face in the picture to an area.
pub(super) fn add_face(
    primitives: &Primitives<'_>,
    face: u32,
    area: &mut Area,
    watch: &Watch<'_>,
) -> Result<(), Error> {
    let (lines, outline) = (&primitives.lines, primitives.outline(face));
    let picture = Tile::picture(lines.frame.rays.size());
    match primitives.whole_in(face, &picture.sides()) {
        Some(whole) => {
            watch.work(outline.len())?;
            area.push(&whole.sides)
        }
        None => add_piece(lines, outline, area, watch),
    }
}

/// Adds the part of a convex piece in the picture to an area.
pub(super) fn add_piece(
    lines: &LineTable<'_>,
    halves: &[HalfPlane],
    area: &mut Area,
    watch: &Watch<'_>,
) -> Result<(), Error> {
    watch.work(halves.len())?;
    match Cell::picture(lines).within(lines, halves, None, watch)? {
        Some(cell) => area.push(&cell.sides),
        None => Ok(()),
    }
}

/// The convex parts of an area, each a list of sides.
#[derive(Default)]
pub(super) struct Area {
    sides: Vec<Side>,
    /// The end of each part.
    ends: Vec<u32>,
}

/// The cost of following an outline to its next piece, in work units: pieces that a build examines.
const FOLLOWED: usize = 16;
/// The number that stands for no piece.
const NONE: u32 = u32::MAX;

/// The numbered sides of all parts. A corner has the number of the side that begins at the corner.
struct Sides<'a> {
    lines: &'a LineTable<'a>,
    sides: &'a [Side],
    /// The previous and the next side of each side.
    before: Vec<u32>,
    after: Vec<u32>,
}

/// An end of a side on a line.
#[derive(Clone, Copy)]
struct End {
    corner: u32,
    /// The place of the end, in the direction of the line's positive half.
    place: f64,
    radius: f64,
    /// The half-plane of the other side that ends at the corner.
    across: HalfPlane,
    is_start: bool,
    /// Whether `across` contains the points ahead, in the direction of the line's positive half.
    is_ahead: bool,
}

/// A part of an outline on one line, from one corner to another, in the direction of a half-plane.
#[derive(Clone, Copy)]
struct Piece {
    half: HalfPlane,
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
        self.sides.extend_from_slice(part);
        self.ends.push(place(self.sides.len())?);
        Ok(())
    }

    pub(super) fn part(&self, i: usize) -> &[Side] {
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.sides[start as usize..self.ends[i] as usize]
    }

    /// The closed outlines of all parts, as lists of sides. The area is on the left of each outline. Sides
    /// that two neighbouring parts share in opposite directions cancel. Where parts overlap, outlines wind
    /// around both parts.
    pub(super) fn outlines(
        &self,
        lines: &LineTable<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<Vec<Side>>, Error> {
        if let [_] = self.ends[..] {
            return Ok(vec![self.sides.clone()]);
        }
        let sides = Sides::new(lines, self)?;
        // Corners that are one point.
        let mut points = Union::new(place(self.sides.len())?)?;
        let pieces = sides.pieces(&mut points, watch)?;
        // For each point, the first piece that begins there; for each piece, the next piece that begins at
        // the same point.
        let (mut begin, mut others) = (vec![NONE; self.sides.len()], vec![NONE; pieces.len()]);
        for (i, piece) in pieces.iter().enumerate().rev() {
            let point = points.root(piece.from) as usize;
            others[i] = std::mem::replace(&mut begin[point], i as u32);
        }
        let (mut is_used, mut outlines) = (vec![false; pieces.len()], Vec::new());
        for (i, first) in pieces.iter().enumerate() {
            if is_used[i] {
                continue;
            }
            let (start, mut outline, mut next) = (points.root(first.from), Vec::new(), Some(i));
            while let Some(i) = next {
                watch.work(FOLLOWED)?;
                is_used[i] = true;
                let piece = &pieces[i];
                // Collinear pieces of one line follow one another where other lines meet the line.
                if outline.last().is_none_or(|last: &Piece| last.half != piece.half) {
                    outline.push(*piece);
                }
                let point = points.root(piece.to);
                if point == start {
                    break;
                }
                let some = |piece: u32| (piece != NONE).then_some(piece as usize);
                let from_here =
                    std::iter::successors(some(begin[point as usize]), |&i| some(others[i]));
                let left = from_here.filter(|&i| !is_used[i]);
                // If several pieces begin here, continue with the piece that turns furthest to the left, so
                // that outlines that touch in a point stay separate.
                let turn = |i: usize| sides.turn(piece.half, pieces[i].half);
                next = left.max_by(|&a, &b| turn(a).total_cmp(&turn(b)));
                debug_assert!(next.is_some(), "an outline is open");
            }
            let is_one_line = outline.first().map(|p| p.half) == outline.last().map(|p| p.half);
            // (An outline that begins in the middle of a side ends with the first part of that side.)
            let side = |piece: &Piece| Side {
                half: piece.half,
                start: self.sides[piece.from as usize].start,
            };
            outlines.push(outline[usize::from(is_one_line)..].iter().map(side).collect());
        }
        Ok(outlines)
    }
}

impl<'a> Sides<'a> {
    fn new(lines: &'a LineTable<'a>, area: &'a Area) -> Result<Self, Error> {
        let count = place(area.sides.len())?;
        let mut before: Vec<_> = (0..count).map(|side| side.wrapping_sub(1)).collect();
        let mut after: Vec<_> = (0..count).map(|side| side + 1).collect();
        let mut start = 0;
        for &end in &area.ends {
            (before[start as usize], after[end as usize - 1]) = (end - 1, start);
            start = end;
        }
        Ok(Self { lines, sides: &area.sides, before, after })
    }

    /// The pieces of all sides, without the common parts of sides in opposite directions.
    fn pieces(&self, points: &mut Union, watch: &Watch<'_>) -> Result<Vec<Piece>, Error> {
        let half = |side: u32| self.sides[side as usize].half;
        let mut by_line: Vec<u32> = (0..self.sides.len() as u32).collect();
        sort_by(&mut by_line, watch, |&a, &b| half(a).line().cmp(&half(b).line()))?;
        let (mut pieces, mut ends) = (Vec::new(), Vec::new());
        for group in by_line.chunk_by(|&a, &b| half(a).line() == half(b).line()) {
            watch.work(group.len() * VISITED)?;
            if let [side] = *group {
                let to = self.after[side as usize];
                pieces.push(Piece { half: half(side), from: side, to });
                continue;
            }
            let line = half(group[0]).positive();
            let rounded = self.lines.rounded(line);
            ends.clear();
            ends.extend(group.iter().flat_map(|&side| self.ends(side, &rounded)));
            sort_by(&mut ends, watch, |a, b| self.compare(&rounded, a, b))?;
            self.add_pieces(line, &ends, points, &mut pieces);
        }
        Ok(pieces)
    }

    /// Both ends of a side.
    fn ends(&self, side: u32, line: &Rounded) -> [End; 2] {
        let [before, after] = [&self.before, &self.after].map(|list| list[side as usize]);
        let half = |side: u32| self.sides[side as usize].half;
        let end = |corner: u32, across: HalfPlane, is_start: bool| {
            let Corner { at: [x, y], radius } = self.sides[corner as usize].start;
            let place = x * line.k[2] - y * line.k[1];
            let is_ahead = is_start != half(side).is_negative();
            End { corner, place, radius, across, is_start, is_ahead }
        };
        [end(side, half(before), true), end(after, half(after), false)]
    }

    /// The exact order of two ends of sides along a line, in the direction of the line's positive half.
    fn compare(&self, line: &Rounded, a: &End, b: &End) -> Ordering {
        // A corner is off by at most its radius. So the corner's place is off by at most the radius times the
        // slope. The place is rounded three times.
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

    /// Adds the pieces that remain of the sides on a line after opposite sides have cancelled. `ends` are the
    /// ends of these sides in order along the line; ends in one place become one point.
    fn add_pieces(
        &self,
        line: HalfPlane,
        ends: &[End],
        points: &mut Union,
        pieces: &mut Vec<Piece>,
    ) {
        let rounded = self.lines.rounded(line);
        // The number of forward sides minus the number of backward sides, and the corner where this number
        // last changed.
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
            pieces.extend((0..count.abs()).map(|_| piece));
            (count, from) = (after, point);
        }
    }

    /// The angle by which an outline turns to the left from one half-plane to another.
    fn turn(&self, from: HalfPlane, to: HalfPlane) -> f64 {
        let [[ax, ay], [bx, by]] = [from, to].map(|half| {
            let [_, kx, ky] = self.lines.rounded(half).flipped(half.is_negative()).k;
            [ky, -kx]
        });
        (ax * by - ay * bx).atan2(ax * bx + ay * by)
    }
}

/// The number of paths in one job of a thread.
const SHARE: usize = 256;

impl VisibilityMap<'_> {
    /// Returns the view as filled outlines, one path for each visible opaque polygon.
    ///
    /// Polygons are drawn whole. Each polygon is drawn before the polygons that are visible in front of it.
    /// If polygons hide one another in a cycle, only their visible parts are drawn. Most scenes have no such
    /// cycles. Polygons whose visible area is less than
    /// [`ViewOptions::least_area`](super::ViewOptions::least_area) are left out.
    ///
    /// A [translucent](super::ViewOptions::opacities) polygon is drawn after the polygons behind it. If the
    /// polygon is in a cycle, it has several paths, as in [`Drawing::translucent`]; each visible point of
    /// the polygon is in one path. Time and memory are quadratic in the number of translucent polygons that
    /// overlap one another. If all polygons are translucent, `Drawing::translucent` takes less time and
    /// memory.
    ///
    /// # Errors
    ///
    /// If the operation was [cancelled](Self#progress).
    pub fn drawing(&self) -> Result<Drawing, Error> {
        self.reporter.watch(2, |watch| self.drawn(watch))
    }

    fn drawn(&self, watch: &Watch<'_>) -> Result<Drawing, Error> {
        let Self { primitives, leaves, .. } = self;
        if primitives.has_translucent() {
            return mixed(primitives, leaves, &self.left_out(), watch);
        }
        let size = self.size();
        let shown = Nodes::of(primitives, leaves);
        let place = |face: u32| shown.places[face as usize];
        let pairs = |wanted: Wanted<'_>| pairs(primitives, leaves, &place, wanted, watch);
        let Ordered { order, is_clipped } = order_by_rank(&shown.ranks, pairs, watch)?;
        let cells = match is_clipped.contains(&true) {
            true => shown.cells(primitives, leaves, &is_clipped),
            false => vec![],
        };
        let left_out = self.left_out();
        let is_drawn =
            |node: &u32| left_out.binary_search(&shown.polygons[*node as usize]).is_err();
        let order: Vec<u32> = order.into_iter().filter(is_drawn).collect();
        let shares: Vec<_> = order.chunks(SHARE).enumerate().collect();
        let count = shares.len();
        let part = |(i, nodes): (usize, &[u32])| {
            let (mut part, mut area) = (Drawing::empty(size), Area::default());
            for &node in nodes {
                watch.work(CUT)?;
                let index = node as usize;
                area.clear();
                if is_clipped[index] {
                    for cell in &cells[index] {
                        area.push(&cell.sides)?;
                    }
                } else {
                    for &face in &shown.faces[index] {
                        watch.work(CUT)?;
                        add_face(primitives, face, &mut area, watch)?;
                    }
                }
                let polygon = shown.polygons[index];
                let faces = shown.faces[index].iter().copied();
                part.push(polygon, is_clipped[index], &area, faces, primitives, watch)?;
            }
            finish_item(watch, i, count);
            Ok(part)
        };
        let mut drawing = Drawing::empty(size);
        for part in parallel_map::map(shares, part)? {
            watch.work(SHARE)?;
            drawing.append(part)?;
        }
        Ok(drawing)
    }
}

/// The visible polygons.
struct Nodes {
    polygons: Vec<usize>,
    /// The place of each face's polygon in the list; `u32::MAX` for polygons that are not visible.
    places: Vec<u32>,
    /// The faces of each polygon that may be visible, even if other polygons hide them.
    faces: Vec<Vec<u32>>,
    ranks: Vec<Ranks>,
}

impl Nodes {
    fn of(primitives: &Primitives<'_>, leaves: &[Leaf]) -> Self {
        let faces = primitives.lines.frame.faces;
        let none = Ranks { all: [u32::MAX, 0], shown: [u32::MAX, 0] };
        let mut ranks = vec![none; primitives.polygon_count()];
        let rank = |item: u32| primitives.items.len() as u32 - item;
        let extend = |[first, last]: [u32; 2], rank: u32| [first.min(rank), last.max(rank)];
        for item in 0..primitives.items.len() as u32 {
            let Ranks { all, .. } = &mut ranks[primitives.polygon(item)];
            *all = extend(*all, rank(item));
        }
        for &Visible { item, .. } in leaves.iter().flat_map(|leaf| &leaf.cells) {
            let Ranks { shown, .. } = &mut ranks[primitives.polygon(item)];
            *shown = extend(*shown, rank(item));
        }
        let mut polygons: Vec<usize> = (0..ranks.len()).collect();
        polygons.retain(|&polygon| ranks[polygon].shown[1] > 0);
        let mut numbers: Vec<u32> = vec![u32::MAX; ranks.len()];
        for (number, &polygon) in (0..).zip(&polygons) {
            numbers[polygon] = number;
        }
        let place = |face: u32| match primitives.sees(face) {
            true => numbers[faces.polygon(face)],
            false => u32::MAX,
        };
        let places: Vec<u32> = (0..faces.len() as u32).map(place).collect();
        let mut of_polygons = vec![vec![]; polygons.len()];
        for (face, &place) in (0..).zip(&places).filter(|&(_, &place)| place != u32::MAX) {
            of_polygons[place as usize].push(face);
        }
        let ranks = polygons.iter().map(|&polygon| ranks[polygon]).collect();
        Self { polygons, places, faces: of_polygons, ranks }
    }

    /// The cells of the polygons that are clipped.
    fn cells<'l>(
        &self,
        primitives: &Primitives<'_>,
        leaves: &'l [Leaf],
        is_clipped: &[bool],
    ) -> Vec<Vec<&'l Cell>> {
        let mut cells: Vec<Vec<&Cell>> = vec![vec![]; self.polygons.len()];
        for Visible { item, cell } in leaves.iter().flat_map(|leaf| &leaf.cells) {
            let place = self.places[primitives.face(*item) as usize] as usize;
            if is_clipped[place] {
                cells[place].push(cell);
            }
        }
        cells
    }
}

/// An element of a [display list](Drawing::display_list).
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum DisplayItem<'d> {
    /// A polygon, or a part of a polygon.
    Path(Path<'d>),
    /// A part of a segment of a line of an [overlay](crate::overlay::Overlay).
    Line(LineRun),
    /// A point of an [overlay](crate::overlay::Overlay).
    Marker(MarkerView),
}

impl Drawing {
    /// Returns the [`paths`](Self::paths) in painting order, with the lines and points of the
    /// [overlay](Self::translucent) between them.
    pub fn display_list(&self) -> impl Iterator<Item = DisplayItem<'_>> + Clone {
        let mut overlaid = self.overlaid.iter().peekable();
        let mut paths = self.paths();
        let count = self.paths.len();
        std::iter::from_fn(move || {
            let painted = (count - paths.len()) as u32;
            if let Some((_, next)) = overlaid.next_if(|(below, _)| *below <= painted) {
                return Some(match next {
                    Overlaid::Line(run) => DisplayItem::Line(*run),
                    Overlaid::Marker(marker) => DisplayItem::Marker(*marker),
                });
            }
            paths.next().map(DisplayItem::Path)
        })
    }
}
