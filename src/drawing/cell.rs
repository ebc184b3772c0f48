//! Convex cells of the picture.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::lines::{HalfPlane, LineTable, Rounded};
use super::primitives::FEW_CORNERS;
use super::quadtree::Tile;
use crate::Error;
use crate::progress::Watch;

/// A side of a cell, and the side's first corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// The half-plane that contains the cell.
    pub(super) half: HalfPlane,
    pub(super) start: Corner,
}

/// The corner where two sides of a cell meet, rounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: [f64; 2],
    /// A bound on the distance of `at` from the exact corner; infinite if the lines of the two sides are
    /// nearly equal.
    pub(super) radius: f64,
}

/// Corners with a radius above this, in pixels, are computed from integers. Too small: integers compute more
/// corners. Too large: integers decide more sides.
const FINE: f64 = 1e-6;

/// A convex polygon with area: a list of sides. Each side begins at the end of the previous side. The sides
/// turn from the x axis towards the y axis, which is clockwise in the picture.
///
/// The two lines that meet at a corner define the corner exactly. The corner's rounded position is for output
/// and for filters only. So a cell is as exact as its lines, however often the cell is cut.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) sides: SmallVec<[Side; 5]>,
}

impl Cell {
    /// A rectangle between borders. `low` and `high` are its least and largest coordinates, in steps.
    pub(super) fn rectangle(lines: &LineTable<'_>, low: [i64; 2], high: [i64; 2]) -> Self {
        let halves = [
            HalfPlane::beyond(1, low[1]),
            HalfPlane::beyond(0, high[0]).flipped(true),
            HalfPlane::beyond(1, high[1]).flipped(true),
            HalfPlane::beyond(0, low[0]),
        ];
        let sides = (0..4).map(|i| {
            let start = Corner::of(lines, [halves[(i + 3) % 4], halves[i]]);
            Side { half: halves[i], start }
        });
        Self { sides: sides.collect() }
    }

    /// The whole picture.
    pub(super) fn picture(lines: &LineTable<'_>) -> Self {
        let Tile { low, high } = Tile::picture(lines.frame.rays.size());
        Self::rectangle(lines, low, high)
    }

    /// The polygon between the edges of a convex face, in order, or in reverse order if the face's corners run
    /// counter-clockwise in the picture. Edges that follow one another on one line become one side.
    pub(super) fn of_outline(
        lines: &LineTable<'_>,
        outline: &[HalfPlane],
        is_reversed: bool,
    ) -> Self {
        let n = outline.len();
        let half = |i: usize| outline[if is_reversed { n - 1 - i } else { i }];
        let mut sides = SmallVec::new();
        let mut before = half(n - 1);
        for half in (0..n).map(half) {
            if half != before {
                sides.push(Side { half, start: Corner::of(lines, [before, half]) });
            }
            before = half;
        }
        Self { sides }
    }

    /// The part of the cell inside all half-planes; `None` if there is no such part. Appends convex parts of
    /// the rest of the cell to `outside`.
    pub(super) fn within(
        &self,
        lines: &LineTable<'_>,
        halves: &[HalfPlane],
        outside: Option<&mut Vec<Self>>,
        watch: &Watch<'_>,
    ) -> Result<Option<Self>, Error> {
        let part = self.common(lines, halves, outside, watch)?;
        Ok(part.map(|part| part.unwrap_or_else(|| self.clone())))
    }

    /// Whether any part of the cell is in all half-planes.
    pub(super) fn meets(
        &self,
        lines: &LineTable<'_>,
        halves: &[HalfPlane],
        watch: &Watch<'_>,
    ) -> Result<bool, Error> {
        Ok(self.common(lines, halves, None, watch)?.is_some())
    }

    /// Like [`within`](Self::within), but `Some(None)` is the whole cell. (Cells are large, and most calls
    /// end before a cell is made.)
    fn common(
        &self,
        lines: &LineTable<'_>,
        halves: &[HalfPlane],
        mut outside: Option<&mut Vec<Self>>,
        watch: &Watch<'_>,
    ) -> Result<Option<Option<Self>>, Error> {
        // Most cells lie outside one of the half-planes: test this before any cut.
        let mut near: SmallVec<[HalfPlane; 8]> = SmallVec::new();
        for &half in halves {
            watch.work(self.corners_work())?;
            let [inside, outside] = self.reaches(lines, half);
            if !inside {
                return Ok(None);
            }
            if outside {
                near.push(half);
            }
        }
        let mut part: Option<Self> = None;
        for half in near {
            let cell = part.as_ref().unwrap_or(self);
            watch.work(cell.corners_work())?;
            let signs = cell.signs(lines, half);
            if !signs.contains(&Ordering::Less) {
                continue;
            }
            if !signs.contains(&Ordering::Greater) {
                return Ok(None);
            }
            part = Some(match &mut outside {
                Some(outside) => {
                    let [inside, rest] = cell.parts(lines, half, &signs);
                    outside.push(rest);
                    inside
                }
                None => cell.part(lines, half, &signs, Ordering::Greater),
            });
        }
        Ok(Some(part))
    }

    /// Whether some corner is inside a half-plane, and whether some corner is outside.
    fn reaches(&self, lines: &LineTable<'_>, half: HalfPlane) -> [bool; 2] {
        let line = lines.rounded(half);
        let mut reaches = [false; 2];
        for i in 0..self.sides.len() {
            match self.sign(lines, half, &line, i) {
                Ordering::Greater => reaches[0] = true,
                Ordering::Less => reaches[1] = true,
                Ordering::Equal => {}
            }
            if reaches == [true; 2] {
                break;
            }
        }
        reaches
    }

    /// The cost of all corners, in pieces that a build examines. The cost is 0 for few corners, because the
    /// cost of the cell includes a few corners.
    fn corners_work(&self) -> usize {
        if self.sides.len() > FEW_CORNERS { self.sides.len() } else { 0 }
    }

    /// A box around the cell.
    pub(super) fn around(&self) -> Rect {
        let mut around = NOWHERE;
        for Corner { at, radius } in self.sides.iter().map(|side| side.start) {
            for axis in 0..2 {
                around[0][axis] = around[0][axis].min(at[axis] - radius);
                around[1][axis] = around[1][axis].max(at[axis] + radius);
            }
        }
        around
    }

    /// The position of each corner: inside a half-plane (`Greater`), on the half-plane's line (`Equal`) or
    /// outside (`Less`).
    pub(super) fn signs(&self, lines: &LineTable<'_>, half: HalfPlane) -> SmallVec<[Ordering; 8]> {
        let line = lines.rounded(half);
        (0..self.sides.len()).map(|i| self.sign(lines, half, &line, i)).collect()
    }

    /// The position of the corner where side `i` begins. Floats decide if the line's value at the rounded corner is
    /// larger than the sum of two bounds: the value's error, and the change of the value from the rounded to the exact
    /// corner. (The change is at most the distance of these two corners times the length of the slope.)
    #[inline]
    fn sign(&self, lines: &LineTable<'_>, half: HalfPlane, line: &Rounded, i: usize) -> Ordering {
        let side = &self.sides[i];
        let Corner { at, radius } = side.start;
        let value = line.at(at);
        if value.abs() > line.error + line.slope * radius {
            let is_in = (value > 0.0) != half.is_negative();
            return if is_in { Ordering::Greater } else { Ordering::Less };
        }
        let before = &self.sides[if i == 0 { self.sides.len() - 1 } else { i - 1 }];
        lines.exact_side(half, [before.half, side.half])
    }

    /// The part of the cell whose corners have the sign `keep`, with a new side along the line.
    pub(super) fn part(
        &self,
        lines: &LineTable<'_>,
        half: HalfPlane,
        signs: &[Ordering],
        keep: Ordering,
    ) -> Self {
        let range = self.range(signs, keep);
        let ends = [false, true]
            .map(|is_end| self.end(lines, half, signs, range[usize::from(is_end)], is_end));
        self.cut(half, range, ends)
    }

    /// The parts of the cell inside and outside of a half-plane that divides the cell.
    pub(super) fn parts(
        &self,
        lines: &LineTable<'_>,
        half: HalfPlane,
        signs: &[Ordering],
    ) -> [Self; 2] {
        let inside = self.range(signs, Ordering::Greater);
        let [start, end] = [false, true]
            .map(|is_end| self.end(lines, half, signs, inside[usize::from(is_end)], is_end));
        let outside = self.range(signs, Ordering::Less);
        // Where the outline leaves one part, it enters the other part, at the same corner.
        [self.cut(half, inside, [start, end]), self.cut(half.flipped(true), outside, [end, start])]
    }

    /// The first and the last side of the part whose corners have the sign `keep`. The cell is convex, so its
    /// outline enters the part once and leaves it once.
    fn range(&self, signs: &[Ordering], keep: Ordering) -> [usize; 2] {
        let n = self.sides.len();
        let next = |i: usize| if i + 1 == n { 0 } else { i + 1 };
        let enters = |&i: &usize| signs[i] != keep && signs[next(i)] == keep;
        let first = (0..n).find(enters).unwrap_or(0);
        let mut last = first;
        while signs[next(last)] == keep {
            last = next(last);
        }
        [first, last]
    }

    /// The corner where side `i` meets a line, at the side's start or end.
    fn end(
        &self,
        lines: &LineTable<'_>,
        half: HalfPlane,
        signs: &[Ordering],
        i: usize,
        is_end: bool,
    ) -> Corner {
        let corner = if is_end && i + 1 == self.sides.len() { 0 } else { i + usize::from(is_end) };
        match signs[corner] {
            Ordering::Equal => self.sides[corner].start,
            _ => Corner::of(lines, [self.sides[i].half, half]),
        }
    }

    /// The sides in a range, between new ends, with a new side along a line.
    fn cut(&self, half: HalfPlane, [first, last]: [usize; 2], [start, end]: [Corner; 2]) -> Self {
        let mut sides = SmallVec::new();
        sides.push(Side { half: self.sides[first].half, start });
        if first < last {
            sides.extend_from_slice(&self.sides[first + 1..=last]);
        } else if last < first {
            sides.extend_from_slice(&self.sides[first + 1..]);
            sides.extend_from_slice(&self.sides[..=last]);
        }
        sides.push(Side { half, start: end });
        Self { sides }
    }

    /// Twice the cell's area, in square pixels, rounded.
    pub(super) fn double_area(&self) -> f64 {
        let at = |i: usize| self.sides[i].start.at;
        let origin = at(0);
        let arm = |i: usize| [at(i)[0] - origin[0], at(i)[1] - origin[1]];
        (1..self.sides.len() - 1)
            .map(|i| {
                let ([ax, ay], [bx, by]) = (arm(i), arm(i + 1));
                ax * by - ay * bx
            })
            .sum()
    }
}

/// The side whose two ends are on a line.
pub(super) fn side_on_line(signs: &[Ordering]) -> Option<usize> {
    let next = |i: usize| if i + 1 == signs.len() { 0 } else { i + 1 };
    (0..signs.len()).find(|&i| signs[i].is_eq() && signs[next(i)].is_eq())
}

impl Corner {
    /// Computes the corner where two lines meet.
    ///
    /// Let a and b be the lines' slopes, and e the vector from the exact corner to the computed point. Then
    /// a·e and b·e are the exact values of the lines at that point. These values are at most α and β, the
    /// rounded values plus the lines' errors. So e = (β a⊥ − α b⊥) / (a × b), and the length of e is at most
    /// (|α| |b| + |β| |a|) / |a × b|.
    ///
    /// Rounding the products of a × b and their difference adds an error of at most 2 roundings of the
    /// products' sizes; 8 roundings are subtracted. If components of the slopes are off by s and t, a × b is
    /// off by s (|b₁| + |b₂|) + t (|a₁| + |a₂|) + 2 s t. A sum of two components is at most 1.4 times a
    /// line's `slope`; twice the `slope` is subtracted. A hundredth is added for the roundings of the bound
    /// itself.
    fn of(lines: &LineTable<'_>, [first, second]: [HalfPlane; 2]) -> Self {
        let [a, b] = [first, second].map(|half| lines.rounded(half));
        let ([a0, ax, ay], [b0, bx, by]) = (a.k, b.k);
        let (p, q) = (ax * by, ay * bx);
        let turn = p - q;
        let off = lines.slope_error(&a) * b.slope + lines.slope_error(&b) * a.slope;
        let least = turn.abs() - 4.0 * f64::EPSILON * (p.abs() + q.abs()) - 2.0 * off;
        if least.is_nan() || least <= 0.0 {
            return Self::exact(lines, [first, second]);
        }
        let at = [(ay * b0 - a0 * by) / turn, (a0 * bx - ax * b0) / turn];
        if !lines.shows(at) {
            return Self::exact(lines, [first, second]);
        }
        let off = [&a, &b].map(|line| line.at(at).abs() + line.error);
        let radius = 1.01 * (off[0] * b.slope + off[1] * a.slope) / least;
        if radius > FINE { Self::exact(lines, [first, second]) } else { Self { at, radius } }
    }

    fn exact(lines: &LineTable<'_>, halves: [HalfPlane; 2]) -> Self {
        let (at, radius) = lines.exact_meeting(halves);
        Self { at, radius }
    }
}

/// A box in the picture: its least and its largest coordinates, in pixels.
pub(super) type Rect = [[f64; 2]; 2];

/// Whether two boxes are apart.
pub(super) fn are_apart([low, high]: &Rect, [from, to]: &Rect) -> bool {
    (0..2).any(|axis| to[axis] < low[axis] || from[axis] > high[axis])
}

/// Whether a box is inside another box.
pub(super) fn is_within([low, high]: &Rect, [from, to]: &Rect) -> bool {
    (0..2).all(|axis| from[axis] <= low[axis] && high[axis] <= to[axis])
}

/// The empty box: apart from all other boxes.
pub(super) const NOWHERE: Rect = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];

/// Whether a box has no points.
pub(super) fn is_empty([low, high]: &Rect) -> bool {
    (0..2).any(|axis| low[axis] > high[axis])
}

/// The intersection of two boxes; if they are apart, an empty box.
pub(super) fn common(a: &Rect, b: &Rect) -> Rect {
    let axes = [0, 1];
    [axes.map(|i: usize| a[0][i].max(b[0][i])), axes.map(|i: usize| a[1][i].min(b[1][i]))]
}

#[cfg(test)]
mod tests {
    use super::{Cell, Corner};
    use crate::drawing::lines::HalfPlane;
    use crate::drawing::lines::meeting;
    use crate::drawing::lines::tests::{all_lines, quads};
    use crate::drawing::quadtree::Tile;
    use crate::progress::Watch;
    use crate::random::SplitMix64;
    use crate::tree::BspTree;
    use crate::view::Camera;
    use glam::DVec3;

    /// Faces inside the picture are the same, corner by corner, as if they were cut out of the picture; faces that
    /// reach beyond it are not counted as inside. Some corners lie on an edge.
    #[test]
    fn the_sides_of_a_face_in_the_picture_are_its_edges() {
        let mut random = SplitMix64::new(5);
        let (mut equal, mut beyond, mut collinear) = (0, 0, 0);
        for round in 0..60 {
            let faces: Vec<Vec<DVec3>> = (0..40)
                .map(|face| {
                    let [at, u, v] =
                        [(); 3].map(|()| (random.point(-1.0, 1.0) * 1024.0).round() / 1024.0);
                    let size = [1.0, 0.125, 1.0 / 1024.0][face % 3];
                    let corners = [at, at + u * size, at + (u + v) * size, at + v * size];
                    let middle = 0.5 * (corners[0] + corners[1]);
                    let [a, b, c, d] = corners;
                    if face % 4 == 0 { vec![a, middle, b, c, d] } else { vec![a, b, c, d] }
                })
                .collect();
            let tree = BspTree::build(&faces).unwrap();
            let eye = random.point(-1.0, 1.0).normalize() * 4.0;
            let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Y, 0.5, [320, 200]).unwrap();
            let primitives = all_lines(&tree, &camera).unwrap();
            let lines = &primitives.lines;
            let picture = Tile::picture([320, 200]).sides();
            for face in (0..tree.faces().len() as u32).filter(|&face| primitives.sees(face)) {
                let outline = primitives.outline(face);
                let watch = Watch::default();
                let cut = Cell::picture(lines).within(lines, outline, None, &watch).unwrap();
                let is_bounded_by_edges = cut
                    .as_ref()
                    .is_some_and(|cut| cut.sides.iter().all(|side| outline.contains(&side.half)));
                let Some(whole) = primitives.whole_in(face, &picture) else {
                    beyond += usize::from(!is_bounded_by_edges);
                    continue;
                };
                let cut = cut.expect("a face in the picture");
                let first = cut.sides.iter().position(|side| side.half == whole.sides[0].half);
                let mut sides = cut.sides.clone();
                sides.rotate_left(first.expect("the same sides"));
                let of = |side: &super::Side| (side.half, side.start.at);
                assert!(sides.iter().map(of).eq(whole.sides.iter().map(of)), "{round}: {face}");
                collinear += usize::from(sides.len() < outline.len());
                equal += 1;
            }
        }
        assert!(equal > 800 && beyond > 100 && collinear > 100, "{equal} {beyond} {collinear}");
    }

    /// The distance of each corner from the intersection in integers is at most the corner's radius. If
    /// floats decide on which side of a third line a corner lies, the side is correct.
    #[test]
    fn corners_are_as_near_as_they_say_and_on_the_sides_that_floats_tell() {
        let mut random = SplitMix64::new(3);
        let (mut corners, mut sides, mut rough) = (0, 0, 0);
        for round in 0..12 {
            let size = [1.0, 1e5][round % 2];
            let tree = BspTree::build(quads(&mut random, size, DVec3::ZERO)).unwrap();
            let eye = random.point(-1.0, 1.0) * size * [2.0, 1e3, 1e6][round % 3];
            let fov = [1.5, 3e-3, 3e-6][round % 3];
            let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, fov, [320, 200]).unwrap();
            let primitives = all_lines(&tree, &camera).unwrap();
            let lines = &primitives.lines;
            let halves: Vec<HalfPlane> = (0..lines.len() as u32).map(HalfPlane::of).collect();
            for (i, &a) in halves.iter().enumerate() {
                for &b in &halves[..i] {
                    let exact = [a, b].map(|half| lines.exact(half));
                    let at = meeting(exact.each_ref());
                    if !lines.shows(at) {
                        continue;
                    }
                    let corner = Corner::of(lines, [a, b]);
                    let off = (corner.at[0] - at[0]).hypot(corner.at[1] - at[1]);
                    // The exact meeting itself is rounded three times.
                    assert!(off <= corner.radius + 3e-13, "{off:e}, {corner:?}");
                    corners += 1;
                    rough += usize::from(corner.radius > 1e-9);
                    for &half in halves.iter().step_by(7) {
                        let line = lines.rounded(half);
                        let value = line.at(corner.at);
                        if value.abs() > line.error + line.slope * corner.radius {
                            let turn = lines.rounded(a).k[1] * lines.rounded(b).k[2]
                                - lines.rounded(a).k[2] * lines.rounded(b).k[1];
                            let side = lines.exact_side(half, [a, b]);
                            let side = if turn > 0.0 { side } else { side.reverse() };
                            assert_eq!(side, value.total_cmp(&0.0), "{corner:?}, {line:?}");
                            sides += 1;
                        }
                    }
                }
            }
        }
        assert!(corners > 10_000 && sides > 100_000 && rough > 50, "{corners} {sides} {rough}");
    }
}
