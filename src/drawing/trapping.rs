//! Trapping: paths are extended under their later neighbours, which closes the seams between them in viewers.

use std::ops::{ControlFlow, Range};

use smallvec::SmallVec;

use super::map::{Reporter, finish_item};
use super::paths::{Drawing, Path};
use crate::memory::place;
use crate::progress::{Progress, Watch};
use crate::{Error, parallel_map};

type Point = [f64; 2];

/// The width of the strip under a neighbour, in pixels. Too small: the background shows where a viewer's
/// pixels and the edge meet obliquely. Too large: the neighbour's other sides clip more strips, which adds
/// corners.
const WIDTH: f64 = 1.0;
/// A path extends under at most this share of the neighbour's height. Too small: the background shows along
/// thin neighbours. Too large: the path protrudes on the other side where corners are rounded.
const SHARE: f64 = 0.6;
/// Sides that are closer to one another than this, in pixels, are one edge. Too small: rounded corners
/// separate edges. Too large: sides that only pass each other count as common edges.
const NEAR: f64 = 0.02;
/// A triangle replaces a strip if it covers at least this share of the strip's area. Too small: the
/// background shows near the ends of edges. Too large: most neighbours get strips, which have one corner
/// more.
const ENOUGH: f64 = 0.85;
/// Strips with less area than this, in square pixels, are left out. Too small: drawings of small polygons
/// have many corners without a visible effect. Too large: seams of small polygons are visible.
const SMALLEST: f64 = 0.1;
/// Nothing is extended under paths that are not convex and have more corners than this. Too large: the time
/// grows with the cube of this number. Too small: seams at polygons that are not convex.
const MOST_CORNERS: usize = 24;
/// The largest number of cells of the grid of sides in the whole picture. Too large: long sides pass through
/// many cells. Too small: many sides in a cell of drawings with millions of sides.
const MOST_CELLS: usize = 1 << 20;
/// The largest size of a cell, in mean lengths of sides. Too small: long sides pass through many cells. Too
/// large: many sides in a cell where small polygons are in a small part of the picture.
const LARGEST_CELL: f64 = 4.0;

type Outline = SmallVec<[Point; 8]>;
type Segment = [Point; 2];

impl Drawing {
    /// Extends the outlines of opaque polygons under their later opaque neighbours, so that almost no
    /// background shows in the seams.
    ///
    /// Viewers blend the border pixels of each path with the pixels below. Where two polygons share an edge
    /// and each polygon covers half of a pixel, a quarter of the background still shows. Printers close such
    /// gaps by *trapping* (ISO 32000-1, 14.11.6): the lower area is extended by about a pixel under the
    /// upper area. The upper area is opaque and painted later, so the extension is not visible. `is_opaque`
    /// returns whether the polygon with a given number is opaque. A side of an outline is extended if
    ///
    /// - its own polygon is opaque;
    /// - a polygon that is painted later touches the side, and is opaque; if exactly two polygons have the same side, only
    ///   the later one of these counts, even if it is translucent;
    /// - the outline of that polygon is convex or has at most 24 corners; and
    /// - the area of the extension is at least a tenth of a square pixel.
    ///
    /// No path is added, removed or moved; outlines only gain corners. An extended side is no longer an
    /// [edge](Path::edges) of its polygon.
    ///
    /// [`VectorPicture::add_drawing`](super::VectorPicture::add_drawing) traps drawings automatically. Takes
    /// O(n log n) for n corners, unless many sides are close to one another, and uses all threads.
    #[must_use]
    pub fn trapped(&self, is_opaque: impl Fn(usize) -> bool) -> Self {
        // Only a callback cancels. A drawing of too many corners stays as it is.
        self.trap(&Watch::default(), is_opaque).unwrap_or_else(|_| self.clone())
    }

    /// Traps like [`trapped`](Self::trapped), and reports progress to a callback that can cancel, like the
    /// [queries of a map](super::VisibilityMap#progress).
    ///
    /// # Errors
    ///
    /// If the callback cancels, or if there would be more than 2³² corners.
    pub fn trapped_with_progress(
        &self,
        is_opaque: impl Fn(usize) -> bool,
        progress: &(dyn Fn(Progress) -> ControlFlow<()> + Sync),
    ) -> Result<Self, Error> {
        Reporter::new(Some(progress)).watch(1, |watch| self.trap(watch, is_opaque))
    }

    fn trap(&self, watch: &Watch<'_>, is_opaque: impl Fn(usize) -> bool) -> Result<Self, Error> {
        let sides = PlacedSides::of(self, watch, is_opaque)?;
        let grid = Grid::new(self.size, &sides, watch)?;
        let trapper = Trapper { drawing: self, sides, grid };
        let paths: Vec<Path<'_>> = self.paths().collect();
        let chunks = (0..).step_by(PATHS_AT_ONCE).zip(paths.chunks(PATHS_AT_ONCE));
        let extended = |(first, paths)| trapper.extended(first, paths, watch);
        let mut trapped = Self::empty(self.size);
        for part in parallel_map::map(chunks.collect(), extended)? {
            trapped.append(part)?;
        }
        trapped.overlaid.clone_from(&self.overlaid);
        Ok(trapped)
    }
}

/// The number of paths that one thread extends at once. Too small: time to collect the results. Too large: threads wait
/// for one another.
const PATHS_AT_ONCE: usize = 256;

/// A drawing whose paths are extended.
struct Trapper<'d> {
    drawing: &'d Drawing,
    sides: PlacedSides<'d>,
    grid: Grid,
}

impl Trapper<'_> {
    /// Some paths of the drawing, extended, given the number of the first.
    fn extended(
        &self,
        first: usize,
        paths: &[Path<'_>],
        watch: &Watch<'_>,
    ) -> Result<Drawing, Error> {
        let Self { drawing, sides, .. } = self;
        let mut trapped = Drawing::empty(drawing.size);
        let (mut near, mut strips) = (Vec::new(), Vec::new());
        for (number, path) in (first..).zip(paths) {
            watch.work(path.outlines().map(<[Point]>::len).sum())?;
            let start = place(trapped.outlines.len())?;
            let turn = path.outlines().map(double_area).sum::<f64>().signum();
            for outline in path.ranges() {
                trapped.outlines.push(place(trapped.corners.len())?);
                for side in outline {
                    let ends = sides.ends(side);
                    trapped.corners.push(ends[0]);
                    trapped.edges.push(drawing.edges[side]);
                    // Strips at a shorter side are too small.
                    let frame = sides.is_opaque[number].then(|| SideFrame::outside_of(ends, turn));
                    let is_long = |frame: &SideFrame| frame.length * WIDTH >= SMALLEST;
                    let Some(frame) = frame.flatten().filter(is_long) else { continue };
                    self.find_strips(side, number, &frame, &mut near, &mut strips, watch)?;
                    if strips.is_empty() {
                        continue;
                    }
                    // An extended side no longer lies on its edge.
                    trapped.edges.pop();
                    // A strip may begin and end at the side's corners.
                    let within = NEAR..=frame.length - NEAR;
                    let is_new = |p: &&Point| p[1] > 0.0 || within.contains(&p[0]);
                    let added = strips.iter().flatten().filter(is_new);
                    trapped.corners.extend(added.map(|&point| frame.world(point)));
                    trapped.edges.resize(trapped.corners.len(), None);
                }
            }
            let outlines = start..place(trapped.outlines.len())?;
            trapped.paths.push(path.record.with_outlines(outlines));
            finish_item(watch, number, drawing.paths.len());
        }
        Ok(trapped)
    }

    /// Finds the strips under the neighbours of a side of a path, in the order along the side.
    fn find_strips(
        &self,
        side: usize,
        path: usize,
        frame: &SideFrame,
        near: &mut Vec<u32>,
        strips: &mut Vec<Outline>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let Self { sides, grid, .. } = self;
        near.clear();
        strips.clear();
        match sides.twins[side] {
            NONE => grid.find_along(sides, side, path, frame, near, watch)?,
            twin if sides.paths[twin as usize] as usize > path => near.push(twin),
            _ => {}
        }
        let part = |side: u32| sides.parts_of[side as usize];
        strips.extend(near.chunk_by(|&a, &b| part(a) == part(b)).filter_map(|near| {
            let common = near.iter().map(|&side| sides.ends(side as usize));
            strip(frame, sides.part(near[0] as usize)?, common)
        }));
        strips.sort_by(|a, b| a[0][0].total_cmp(&b[0][0]));
        Ok(())
    }
}

/// No number.
const NONE: u32 = u32::MAX;
/// The number of units in a pixel. Corners of two paths that round to the same unit are one corner. (Where two equal corners
/// round to different units, the grid finds their sides.) Too large: rounding separates common corners. Too small:
/// different corners count as one.
const UNITS: f64 = 4096.0;

/// The sides of a drawing's outlines. Each is numbered by the corner at which it begins.
struct PlacedSides<'d> {
    drawing: &'d Drawing,
    /// Whether each path is opaque.
    is_opaque: Vec<bool>,
    /// The path of each side, and the next corner of its outline.
    paths: Vec<u32>,
    next: Vec<u32>,
    /// The side of another path that has the same ends and lies on the other side of the line, if it is the only one.
    twins: Vec<u32>,
    /// The convex part, in its opaque path, that each side bounds, if a strip in the part may be large enough.
    parts_of: Vec<u32>,
    /// The corners of the parts, and the start of each.
    parts: Vec<u32>,
    corners: Vec<Point>,
}

impl<'d> PlacedSides<'d> {
    fn of(
        drawing: &'d Drawing,
        watch: &Watch<'_>,
        is_opaque: impl Fn(usize) -> bool,
    ) -> Result<Self, Error> {
        let n = drawing.corners.len();
        let is_opaque = drawing.paths().map(|path| is_opaque(path.polygon())).collect();
        let none = vec![NONE; n];
        let (paths, next) = (none.clone(), none.clone());
        let mut all = Self {
            drawing,
            is_opaque,
            paths,
            next,
            twins: none.clone(),
            parts_of: none,
            parts: vec![0],
            corners: vec![],
        };
        let mut keys: Vec<([u64; 2], u32)> = Vec::with_capacity(n);
        for (number, path) in drawing.paths().enumerate() {
            watch.work(path.outlines().map(<[Point]>::len).sum())?;
            for sides in path.ranges() {
                for side in sides.clone() {
                    let next = if side + 1 == sides.end { sides.start } else { side + 1 };
                    all.paths[side] = number as u32;
                    all.next[side] = next as u32;
                    let [from, to] = [side, next].map(|corner| key(drawing.corners[corner]));
                    if from != to {
                        keys.push(([from.min(to), from.max(to)], side as u32));
                    }
                }
            }
            if all.is_opaque[number] {
                all.add_parts(path);
            }
        }
        watch.work(keys.len())?;
        keys.sort_unstable();
        for same in keys.chunk_by(|(a, _), (b, _)| a == b) {
            let &[(_, a), (_, b)] = same else { continue };
            let [from, to] = [a, b].map(|side| key(all.ends(side as usize)[0]));
            if from != to && all.paths[a as usize] != all.paths[b as usize] {
                all.twins[a as usize] = b;
                all.twins[b as usize] = a;
            }
        }
        Ok(all)
    }

    /// The ends of a side.
    fn ends(&self, side: usize) -> Segment {
        [side, self.next[side] as usize].map(|corner| self.drawing.corners[corner])
    }

    /// The convex part that a side bounds.
    fn part(&self, side: usize) -> Option<&[Point]> {
        let part = self.parts_of[side];
        let range =
            (part != NONE).then(|| self.parts[part as usize]..self.parts[part as usize + 1])?;
        Some(&self.corners[range.start as usize..range.end as usize])
    }

    /// Adds convex parts inside a path. A convex path is its only part. Any other path has a triangle on each of its
    /// sides.
    fn add_parts(&mut self, path: Path<'_>) {
        let mut add = |sides: Range<usize>, corners: &[Point]| {
            if largest_strip(corners) >= SMALLEST {
                let part = self.parts.len() as u32 - 1;
                self.corners.extend_from_slice(corners);
                self.parts.push(self.corners.len() as u32);
                self.parts_of[sides].fill(part);
            }
        };
        if path.record.outlines.len() == 1 && path.outlines().all(is_convex) {
            path.ranges().zip(path.outlines()).for_each(|(sides, outline)| add(sides, outline));
            return;
        }
        let all: Vec<Segment> = path.outlines().flat_map(sides).collect();
        if all.len() > MOST_CORNERS {
            return;
        }
        let turn = path.outlines().map(double_area).sum::<f64>().signum();
        for (number, &side) in path.ranges().flatten().zip(&all) {
            if let Some(triangle) = triangle_on(side, turn, &all) {
                add(number..number + 1, &triangle);
            }
        }
    }
}

/// Coordinates in [`UNITS`], as a key. Round coordinates, which are frequent, are in the middle of a unit.
fn key(p: Point) -> u64 {
    let [x, y] = p.map(|c| u64::from((c * UNITS + 0.5) as i32 as u32));
    x << 32 | y
}

fn sides(outline: &[Point]) -> impl Iterator<Item = Segment> {
    (0..outline.len()).map(|i| [outline[i], outline[(i + 1) % outline.len()]])
}

/// A bound on the area of a [`strip`] under a convex neighbour: the strip is inside the neighbour, except that
/// it may reach beyond common edges by `NEAR`.
fn largest_strip(neighbour: &[Point]) -> f64 {
    let around: f64 = sides(neighbour).map(length).sum();
    0.5 * double_area(neighbour).abs() + NEAR * around
}

fn length([a, b]: Segment) -> f64 {
    let [x, y] = [b[0] - a[0], b[1] - a[1]];
    (x * x + y * y).sqrt()
}

fn double_area(outline: &[Point]) -> f64 {
    sides(outline).map(|[a, b]| cross(a, b)).sum()
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Square cells of a picture, each with the sides without a twin that pass through it.
struct Grid {
    cell: f64,
    columns: usize,
    rows: usize,
    /// The number of a cell and of a side that passes through the cell; sorted.
    entries: Vec<(u32, u32)>,
}

impl Grid {
    /// A grid of the sides that bound a part and have no twin. The whole picture has at most about as many cells as
    /// there are such sides, unless the sides are much shorter than those cells: then many sides may be in a small part
    /// of the picture.
    fn new(size: [u32; 2], sides: &PlacedSides<'_>, watch: &Watch<'_>) -> Result<Self, Error> {
        let all = (0..sides.twins.len())
            .filter(|&side| sides.twins[side] == NONE && sides.parts_of[side] != NONE);
        let [width, height] = size.map(f64::from);
        let (count, sum) = all
            .clone()
            .fold((0, 0.0), |(count, sum), side| (count + 1, sum + length(sides.ends(side))));
        let cell = (width * height / count.clamp(1, MOST_CELLS) as f64).sqrt();
        let largest = LARGEST_CELL * sum / count.max(1) as f64;
        let cell = cell.min(largest).max(1.0);
        let [columns, rows] = [width, height].map(|side| (side / cell) as usize + 1);
        let mut grid = Self { cell, columns, rows, entries: vec![] };
        for side in all {
            for cells in grid.passed(sides.ends(side), NEAR) {
                watch.work(cells.len())?;
                grid.entries.extend(cells.map(|cell| (cell as u32, side as u32)));
            }
        }
        grid.entries.sort_unstable();
        Ok(grid)
    }

    /// Finds the sides of later paths along a side, those of one convex part after another.
    fn find_along(
        &self,
        sides: &PlacedSides<'_>,
        side: usize,
        path: usize,
        frame: &SideFrame,
        found: &mut Vec<u32>,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let is_along = |&other: &u32| {
            let ends = sides.ends(other as usize).map(|end| frame.local(end));
            sides.paths[other as usize] > path as u32 && frame.along(ends).is_some()
        };
        found.clear();
        for cells in self.passed(sides.ends(side), WIDTH) {
            let first = self.entries.partition_point(|&(cell, _)| (cell as usize) < cells.start);
            let here = self.entries[first..].iter();
            let here = here.take_while(|&&(cell, _)| (cell as usize) < cells.end);
            let mut examined = 1;
            let numbers = here.inspect(|_| examined += 1).map(|&(_, number)| number);
            found.extend(numbers.filter(is_along));
            watch.work(examined)?;
        }
        found.sort_unstable();
        found.dedup();
        Ok(())
    }

    /// The cells with points within the distance `reach` of a side, row by row.
    fn passed(&self, [a, b]: Segment, reach: f64) -> impl Iterator<Item = Range<usize>> + use<> {
        let &Self { cell, columns, rows, .. } = self;
        let place = move |c: f64, most: usize| ((c.max(0.0) / cell) as usize).min(most - 1);
        let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
        // The change of x for each step down. Flat sides do not use this slope.
        let slope = (high[0] - low[0]) / (high[1] - low[1]).max(f64::MIN_POSITIVE);
        (place(low[1] - reach, rows)..=place(high[1] + reach, rows)).map(move |row| {
            let at = |y: f64| {
                let x = low[0] + (y.clamp(low[1], high[1]) - low[1]) * slope;
                x.clamp(a[0].min(b[0]), a[0].max(b[0]))
            };
            let is_flat = high[1] - low[1] < reach;
            let [x0, x1] = if is_flat {
                [a[0], b[0]]
            } else {
                // The first and the last row reach beyond the picture.
                let edge = |row: usize| row as f64 * cell;
                let top = if row == 0 { low[1] } else { edge(row) - reach };
                let is_last = row + 1 == rows;
                let bottom = if is_last { high[1] } else { edge(row + 1) + reach };
                [at(top), at(bottom)]
            };
            let [from, to] = [x0.min(x1) - reach, x0.max(x1) + reach].map(|x| place(x, columns));
            row * columns + from..row * columns + to + 1
        })
    }
}

fn is_convex(outline: &[Point]) -> bool {
    let turn = double_area(outline).signum();
    let n = outline.len();
    (0..n).all(|i| turn * area_of([0, 1, 2].map(|k| outline[(i + k) % n])) >= 0.0)
}

/// The highest triangle on a side. The apex is a corner of the path, and no side of the path enters the
/// triangle.
fn triangle_on([a, b]: Segment, turn: f64, sides: &[Segment]) -> Option<[Point; 3]> {
    let area = |p: Point| turn * area_of([a, b, p]);
    let mut apexes: Vec<[f64; 2]> = sides.iter().map(|side| side[0]).collect();
    apexes.retain(|&apex| area(apex) > 0.0);
    apexes.sort_by(|&p, &q| area(q).total_cmp(&area(p)));
    let is_free = |&apex: &[f64; 2]| !sides.iter().any(|&side| enters(side, [a, b, apex], turn));
    apexes.into_iter().find(is_free).map(|apex| [a, b, apex])
}

/// Whether a part of a segment lies inside a triangle that turns in the given sense.
fn enters(segment: Segment, triangle: [Point; 3], turn: f64) -> bool {
    let [mut from, mut to] = [0.0, 1.0];
    for k in 0..3 {
        let [p, q] = [triangle[k], triangle[(k + 1) % 3]];
        let [before, after] = segment.map(|end| turn * area_of([p, q, end]));
        if before <= 0.0 && after <= 0.0 {
            return false;
        }
        let share = before / (before - after);
        if before < 0.0 {
            from = share.max(from);
        } else if after < 0.0 {
            to = share.min(to);
        }
    }
    from < to
}

/// Twice the area of a triangle, positive if the corners turn from x to y.
fn area_of([a, b, c]: [Point; 3]) -> f64 {
    cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]])
}

/// Coordinates along a side, and outwards from the side.
struct SideFrame {
    start: Point,
    length: f64,
    along: Point,
    out: Point,
}

impl SideFrame {
    /// The frame of a side of an outline that turns in the given sense; `None` if the side has no length.
    fn outside_of([start, end]: Segment, turn: f64) -> Option<Self> {
        let step = [end[0] - start[0], end[1] - start[1]];
        let length = length([start, end]);
        let along = step.map(|c| c / length);
        let out = [turn * along[1], -turn * along[0]];
        (length > NEAR).then_some(Self { start, length, along, out })
    }

    fn local(&self, point: Point) -> Point {
        let arm = [point[0] - self.start[0], point[1] - self.start[1]];
        [self.along, self.out].map(|axis| axis[0] * arm[0] + axis[1] * arm[1])
    }

    fn world(&self, [along, out]: Point) -> Point {
        [0, 1].map(|axis| self.start[axis] + self.along[axis] * along + self.out[axis] * out)
    }

    /// The range of this side along which a neighbour's side, in local coordinates, lies on this side or
    /// inwards of it by less than a strip's width. In this range, viewers blend the neighbour's edge with the
    /// paths below both sides.
    fn along(&self, [a, b]: Segment) -> Option<[f64; 2]> {
        let [low, high] = [a[0].min(b[0]).max(0.0), a[0].max(b[0]).min(self.length)];
        if high - low <= NEAR {
            return None;
        }
        let out = |along: f64| a[1] + (b[1] - a[1]) * ((along - a[0]) / (b[0] - a[0]));
        let is_along = [low, high].map(out).iter().all(|out| (-WIDTH..=NEAR).contains(out));
        is_along.then_some([low, high])
    }

    /// The same range for a side of a neighbour that turns in a given sense, if the neighbour lies beyond that side.
    fn common(&self, ends: Segment, turn: f64) -> Option<[f64; 2]> {
        let is_outside = turn * (ends[1][0] - ends[0][0]) > 0.0;
        self.along(ends).filter(|_| is_outside)
    }
}

/// The extension of a path at a side into a convex neighbour, along those of the given sides of the neighbour that are
/// common edges of both. The corners of the extension are in local coordinates, from the lower to the upper end along the
/// side.
fn strip(
    frame: &SideFrame,
    neighbour: &[Point],
    near: impl Iterator<Item = Segment>,
) -> Option<Outline> {
    let corners: Outline = neighbour.iter().map(|&corner| frame.local(corner)).collect();
    let turn = double_area(&corners).signum();
    let near = near.map(|ends| ends.map(|end| frame.local(end)));
    let common = near.filter_map(|ends| frame.common(ends, turn));
    let hull = common.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
    let strip = band(frame, &corners, hull)?;
    if 0.5 * double_area(&strip).abs() < SMALLEST {
        return None;
    }
    Some(triangle(&corners, &strip).unwrap_or(strip))
}

/// A triangle on the edge of a strip that covers most of the strip and reaches further into the neighbour.
/// The triangle has one corner less than the strip, which makes drawings shorter.
fn triangle(neighbour: &[Point], strip: &[Point]) -> Option<Outline> {
    let [low, high] = [*strip.first()?, *strip.last()?];
    let length = high[0] - low[0];
    let far: Outline = neighbour.iter().copied().filter(|corner| corner[1] > NEAR).collect();
    // From the middle of the edge to the middle of the corners that are not on it.
    let apex = [0, 1].map(|axis: usize| {
        let end = far.iter().map(|corner| corner[axis]).sum::<f64>() / far.len() as f64;
        let start = 0.5 * (low[axis] + high[axis]);
        start + SHARE * (end - start)
    });
    let width = strip.iter().map(|corner| corner[1]).fold(0.0, f64::max);
    let covered = if apex[1] > width {
        length * width * (1.0 - 0.5 * width / apex[1])
    } else {
        0.5 * length * apex[1]
    };
    let is_enough = covered >= ENOUGH * 0.5 * double_area(strip).abs();
    is_enough.then(|| [low, apex, high].into_iter().collect())
}

/// A strip along a range of the side, clipped to the neighbour, which is given in local coordinates.
fn band(frame: &SideFrame, corners: &[Point], [low, high]: [f64; 2]) -> Option<Outline> {
    let turn = double_area(corners).signum();
    let height = corners.iter().map(|corner| corner[1]).fold(0.0, f64::max);
    if height <= NEAR {
        return None;
    }
    let width = WIDTH.min(SHARE * height);
    let mut strip: Outline =
        [[low, 0.0], [low, width], [high, width], [high, 0.0]].into_iter().collect();
    for [a, b] in sides(corners).filter(|&ends| frame.common(ends, turn).is_none()) {
        strip = inside(&strip, a, b, turn);
    }
    // The corners on the side are first and last, all other corners in between.
    let n = strip.len();
    let last = (0..n)
        .filter(|&i| strip[i][1] == 0.0)
        .max_by(|&i, &j| strip[i][0].total_cmp(&strip[j][0]))?;
    strip.rotate_left((last + 1) % n);
    strip.dedup();
    (strip.len() > 2 && strip[0][1] == 0.0).then_some(strip)
}

/// The part of a convex outline on the inner side of a line.
fn inside(outline: &[Point], a: Point, b: Point, turn: f64) -> Outline {
    let side = |p: Point| turn * cross([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let mut inner = Outline::new();
    for (i, &to) in outline.iter().enumerate() {
        let from = outline[(i + outline.len() - 1) % outline.len()];
        let [before, after] = [side(from), side(to)];
        if (before < 0.0) != (after < 0.0) {
            let share = before / (before - after);
            inner.push([0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share));
        }
        if after >= 0.0 {
            inner.push(to);
        }
    }
    inner
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ErrorKind;
    use crate::progress::one_at_a_time;
    use crate::random::SplitMix64;

    /// A drawing of one path for each outline.
    fn drawing(size: [u32; 2], outlines: &[Vec<Point>]) -> Drawing {
        let mut drawing = Drawing::empty(size);
        for (polygon, outline) in outlines.iter().enumerate() {
            drawing.push_outline(polygon, outline);
        }
        drawing
    }

    /// `n` × `n` squares of a size, each of two triangles. Corners are moved by up to `moved` sizes.
    fn tiles(n: usize, size: f64, moved: f64) -> Vec<Vec<Point>> {
        let mut random = SplitMix64::new(1);
        let mut corner = |k: usize| {
            [k % (n + 1), k / (n + 1)]
                .map(|c| 7.0 + size * (c as f64 + random.range(-moved, moved)))
        };
        let corners: Vec<Point> = (0..(n + 1) * (n + 1)).map(&mut corner).collect();
        let mut triangles = Vec::new();
        for first in (0..n).flat_map(|row| (0..n).map(move |column| row * (n + 1) + column)) {
            let [a, b, c, d] = [first, first + 1, first + n + 2, first + n + 1].map(|k| corners[k]);
            triangles.extend([vec![a, b, c], vec![a, c, d]]);
        }
        triangles
    }

    /// The corners of a trapped drawing, where each side is compared with all sides of all later paths. Corners of
    /// neighbours are equal.
    fn trapped_by_brute_force(drawing: &Drawing) -> Vec<Point> {
        let placed = PlacedSides::of(drawing, &Watch::default(), |_| true).unwrap();
        let all = 0..drawing.corners.len();
        let mut corners = Vec::new();
        for (number, path) in drawing.paths().enumerate() {
            let turn = path.outlines().map(double_area).sum::<f64>().signum();
            for side in path.ranges().flatten() {
                let ends = placed.ends(side);
                corners.push(ends[0]);
                let twins: Vec<usize> = all
                    .clone()
                    .filter(|&other| {
                        let other = placed.ends(other);
                        other == [ends[1], ends[0]] || other == ends
                    })
                    .collect();
                let twin = match twins[..] {
                    [a, b] if placed.ends(a) != placed.ends(b) => Some(a + b - side),
                    _ => None,
                };
                assert_eq!(placed.twins[side], twin.map_or(NONE, |twin| twin as u32));
                let Some(frame) = SideFrame::outside_of(ends, turn) else { continue };
                let later = all.clone().filter(|&other| {
                    placed.paths[other] as usize > number
                        && placed.part(other).is_some()
                        && twin.map_or(placed.twins[other] == NONE, |twin| other == twin)
                });
                let later: Vec<usize> = later.collect();
                let by_part = later.chunk_by(|&a, &b| placed.parts_of[a] == placed.parts_of[b]);
                let mut strips: Vec<_> = by_part
                    .filter_map(|sides| {
                        let ends = sides.iter().map(|&side| placed.ends(side));
                        strip(&frame, placed.part(sides[0])?, ends)
                    })
                    .collect();
                strips.sort_by(|a, b| a[0][0].total_cmp(&b[0][0]));
                let at_end = |p: &Point| p[1] == 0.0 && (p[0] < NEAR || p[0] > frame.length - NEAR);
                let added = strips.iter().flatten().filter(|p| !at_end(p));
                corners.extend(added.map(|&point| frame.world(point)));
            }
        }
        corners
    }

    #[test]
    fn the_grid_finds_all_neighbours_with_strips() {
        let mut added = 0;
        for (n, size) in [(3, 0.2), (20, 0.3), (20, 0.45), (15, 0.6), (12, 2.0), (4, 100.0)] {
            let mut outlines = tiles(n, size, 0.3);
            // Some large outlines above and below.
            outlines.insert(0, vec![[5.0, 5.0], [400.0, 9.0], [300.0, 400.0]]);
            outlines.push(vec![[7.0, 7.0], [9.0, 7.1], [300.0, 200.0]]);
            outlines.push(vec![[0.0, 0.0], [640.0, 0.0], [640.0, 7.0], [0.0, 7.0]]);
            let drawing = drawing([640, 480], &outlines);
            let trapped = drawing.trapped(|_| true);
            assert_eq!(trapped.corners, trapped_by_brute_force(&drawing), "{n} {size}");
            added += trapped.corners.len() - drawing.corners.len();
        }
        assert!(added > 1000, "{added}");
    }

    /// Triangles in a small part of a large picture, as of a scene that is far away. The largest number of
    /// sides within a pixel of a side follows from the least area of a strip.
    #[test]
    fn trapping_small_triangles_examines_no_more_sides_for_each_if_there_are_more() {
        // Ever smaller in the same place; of one size below the least strip, and above it.
        let sizes: [fn(usize) -> f64; 3] = [|n| 30.0 / n as f64, |_| 0.2, |_| 0.9];
        for size in sizes {
            for n in [24, 48, 96] {
                let outlines = tiles(n, size(n), 0.0);
                let callback = one_at_a_time(|_| ControlFlow::Continue(()));
                let watch = Watch::new(&callback);
                drawing([6400, 4800], &outlines).trap(&watch, |_| true).unwrap();
                let examined = watch.examined();
                assert!(examined < 3000 * outlines.len(), "{n} {}: {examined}", size(n));
            }
        }
    }

    #[test]
    fn trapping_can_be_cancelled() {
        let drawing = drawing([640, 480], &tiles(100, 2.0, 0.0));
        let calls = std::sync::atomic::AtomicUsize::new(0);
        let cancel = |_| match calls.fetch_add(1, std::sync::atomic::Ordering::Relaxed) {
            0 | 1 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        };
        let error = drawing.trapped_with_progress(|_| true, &cancel).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Cancelled);
        let done = drawing.trapped_with_progress(|_| true, &|_| ControlFlow::Continue(())).unwrap();
        assert_eq!(done.corners, drawing.trapped(|_| true).corners);
    }

    #[test]
    fn triangles_do_not_leave_the_outline() {
        // A square with a notch from above that reaches below its middle.
        let outline = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
        assert!(!is_convex(&outline) && is_convex(&outline[..3]));
        let all: Vec<Segment> = sides(&outline).collect();
        let apex = |side: usize| triangle_on(all[side], 1.0, &all).map(|triangle| triangle[2]);
        // From both ends of the lower side, only the notch's end is visible; for the side edges, the opposite
        // corner is behind the notch.
        assert_eq!(apex(0), Some([2.0, 1.0]));
        assert_eq!(apex(1), Some([2.0, 1.0]));
        assert_eq!(apex(2), Some([4.0, 0.0]));
        assert_eq!(apex(3), Some([0.0, 0.0]));
        let reversed: Vec<Segment> = all.iter().rev().map(|&[a, b]| [b, a]).collect();
        assert_eq!(triangle_on(reversed[4], -1.0, &reversed).map(|t| t[2]), Some([2.0, 1.0]));
    }

    #[test]
    fn strips_are_inside_of_the_neighbour() {
        // The side from (1, 2) to (5, 2) of a polygon that lies below the side, with y up.
        let frame = SideFrame::outside_of([[5.0, 2.0], [1.0, 2.0]], 1.0).unwrap();
        let strip = |outline: &[Point]| {
            let corners: Outline = outline.iter().map(|&corner| frame.local(corner)).collect();
            let turn = double_area(&corners).signum();
            let common = sides(&corners).filter_map(|ends| frame.common(ends, turn));
            let hull = common.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
            band(&frame, &corners, hull)
        };
        let triangle = [[1.0, 2.0], [5.0, 2.0], [3.0, 12.0]];
        assert_eq!(frame.along([[0.0, 0.0], [4.0, 0.0]]), Some([0.0, 4.0]));
        assert_eq!(frame.along([[4.0, 0.0], [2.0, 10.0]]), None);
        // Inwards by less than a pixel, and outwards by more than rounding.
        assert_eq!(frame.along([[-4.0, -0.8], [3.0, -0.5]]), Some([0.0, 3.0]));
        assert_eq!(frame.along([[0.0, 0.5], [3.0, 0.5]]), None);
        let found = strip(&triangle).unwrap();
        assert_eq!(found.len(), 4);
        for (found, expected) in found.iter().zip([[0.0, 0.0], [0.2, 1.0], [3.8, 1.0], [4.0, 0.0]])
        {
            assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-12), "{found:?}");
        }
        assert_eq!(frame.world([0.5, 1.0]), [4.5, 3.0]);
        // The neighbour's side has the opposite direction. A low neighbour has a narrow strip.
        let low = [[3.0, 2.5], [4.0, 2.0], [2.0, 2.0]];
        let found = strip(&low).unwrap();
        assert!(found.iter().all(|corner| corner[1] <= 0.3 + 1e-12), "{found:?}");
        assert_eq!(found.first(), Some(&[1.0, 0.0]));
        assert_eq!(found.last(), Some(&[3.0, 0.0]));
        // A wedge whose tip is on the side. Beyond the tip, the wedge leaves the side.
        let wedge = [[0.9, 2.01], [4.0, 1.5], [30.0, 9.0], [3.0, 2.005]];
        let found = strip(&wedge).unwrap();
        assert!(found.iter().all(|corner| corner[1] < 0.01), "{found:?}");
        // A neighbour on the same side of the edge gets no strip.
        assert_eq!(strip(&[[1.0, 2.0], [5.0, 2.0], [3.0, -9.0]]), None);
    }

    #[test]
    fn a_triangle_stands_for_a_strip_that_it_nearly_covers() {
        let frame = SideFrame::outside_of([[5.0, 2.0], [1.0, 2.0]], 1.0).unwrap();
        let strip = |outline: &[Point]| strip(&frame, outline, sides(outline));
        let found = strip(&[[1.0, 2.0], [5.0, 2.0], [3.0, 12.0]]).unwrap();
        assert_eq!(found.len(), 3);
        for (found, expected) in found.iter().zip([[0.0, 0.0], [2.0, 6.0], [4.0, 0.0]]) {
            assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-12), "{found:?}");
        }
        // For a low neighbour a triangle would leave out too much near the ends.
        let low = [[1.0, 2.0], [5.0, 2.0], [5.0, 2.8], [1.0, 2.8]];
        assert_eq!(strip(&low).unwrap().len(), 4);
    }
}
