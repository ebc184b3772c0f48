//! The lines of a picture, each known by what made it.

use std::cmp::Ordering;

use super::frame::{
    Exact, Frame, Sheet, is_opposite, is_same_line, line_modulo, meeting, orientation,
};
use super::half::{Half, STEP_BITS, STEPS};
use super::table::{Table, insert};
use crate::Error;
use crate::exact::exact_ray::scaled;
use crate::exact::lattice::exponent_of;
use crate::exact::{Int, PlaneId, PlaneKind};
use crate::memory::push;

/// What made a line. Equal keys are equal lines, up to their direction; those of other keys may be, too,
/// but for edges: edges on one line have its first key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Key {
    /// The edge between two points, the lower number first.
    Edge([u32; 2]),
    /// A face's edge from its corner to the next, one of which was moved onto the face's plane, or may have
    /// been.
    Upright(u32, u32),
    /// The cut of a face by a plane: of two faces' planes, of the lower by the higher.
    Cut(u32, PlaneId),
    /// The rays along a face's plane.
    Horizon(u32),
}

/// A line in floats, scaled so that the longer part of its slope is near 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub(super) k: [f64; 3],
    /// The largest error of its values anywhere in the picture, computed as `k[0] + x·k[1] + y·k[2]`.
    pub(super) error: f64,
    /// At least the length of its slope.
    pub(super) slope: f64,
}

impl Rounded {
    /// From exact coefficients, for a picture of this size.
    fn new(exact: &Exact, reach: [f64; 2]) -> Self {
        let k = exact.each_ref().map(|c| c.to_f64());
        let size = k[1].abs().max(k[2].abs());
        // A power of two: nothing is rounded. (A line without slope may have any scale.)
        let scale = if size > 0.0 { scaled(1.0, -exponent_of(size)) } else { 1.0 };
        let [k0, kx, ky] = k.map(|c| c * scale);
        let sum = k0.abs() + kx.abs() * reach[0] + ky.abs() * reach[1];
        Self {
            k: [k0, kx, ky],
            error: 8.0 * UNIT * sum,
            slope: 1.01 * kx.abs().max(ky.abs()) * 1.42,
        }
    }

    /// The value at a point, rounded.
    #[inline]
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.k[0] + (self.k[1] * x + self.k[2] * y)
    }
}

/// The number of no point.
const NOWHERE: u32 = u32::MAX;
/// Faces of more corners are not searched for one that a line goes through.
const FEW: usize = 8;

/// The relative error of one rounding.
const UNIT: f64 = f64::EPSILON / 2.0;

/// All lines that a picture was asked for.
#[derive(Debug)]
pub(super) struct Lines<'t> {
    pub(super) frame: Frame<'t>,
    /// The largest coordinates in the picture.
    reach: [f64; 2],
    keys: Vec<Key>,
    rounded: Vec<Rounded>,
    /// Points that each line is known to go through; [`NOWHERE`] for none.
    through: Vec<[u32; 2]>,
    /// The half of each key on which it is positive.
    halves: Table<Key, Half>,
    /// The lines of edges, by [`line_modulo`].
    edges: Table<[u32; 2], u32>,
    /// Equal corners have equal numbers.
    points: Table<[u64; 3], u32>,
    /// The numbers of where corners were moved to.
    moved: Table<u32, u32>,
    /// A corner of each number.
    corners: Vec<u32>,
}

impl<'t> Lines<'t> {
    /// No lines yet.
    pub(super) fn new(frame: Frame<'t>) -> Self {
        let reach = frame.rays.size().map(|side| f64::from(side) + 1.0);
        Self {
            frame,
            reach,
            keys: vec![],
            rounded: vec![],
            through: vec![],
            halves: Table::default(),
            edges: Table::default(),
            points: Table::default(),
            moved: Table::default(),
            corners: vec![],
        }
    }

    /// The half of a line on which its key is positive. The line is added if it is new; it goes through the
    /// points.
    fn half(&mut self, key: Key, points: [u32; 2]) -> Result<Half, Error> {
        if let Some(&half) = self.halves.get(&key) {
            return Ok(half);
        }
        let exact = self.exact_of(key);
        let half = match key {
            Key::Edge(_) | Key::Upright(..) => self.half_of_edge(key, &exact, points)?,
            _ => Half::of(self.add(key, &exact, points)?),
        };
        insert(&mut self.halves, key, half)?;
        Ok(half)
    }

    /// The half of an edge that has no key yet. Edges on one line, as those of walls side by side, are one
    /// line of the picture: else it would be found out again and again that they meet everywhere.
    fn half_of_edge(&mut self, key: Key, exact: &Exact, points: [u32; 2]) -> Result<Half, Error> {
        let modulo = line_modulo(exact);
        if let Some(&line) = self.edges.get(&modulo) {
            let other = self.exact_of(self.key(line));
            if is_same_line(exact, &other) {
                return Ok(Half::of(line).flipped(is_opposite(exact, &other)));
            }
        }
        let line = self.add(key, exact, points)?;
        insert(&mut self.edges, modulo, line)?;
        Ok(Half::of(line))
    }

    fn add(&mut self, key: Key, exact: &Exact, through: [u32; 2]) -> Result<u32, Error> {
        // A number takes less memory than its line.
        let number = u32::try_from(self.keys.len()).map_err(|_| Error::out_of_memory())?;
        push(&mut self.keys, key)?;
        push(&mut self.rounded, Rounded::new(exact, self.reach))?;
        push(&mut self.through, through)?;
        Ok(number)
    }

    /// The half of a face's edge `k` on which the face lies, by whether its front is seen.
    pub(super) fn edge(
        &mut self,
        face: u32,
        k: u32,
        sheet: &Sheet,
        front: bool,
    ) -> Result<Half, Error> {
        let faces = self.frame.faces;
        let range = faces.corner_range(face);
        let next = if k as usize + 1 == range.len() { 0 } else { k + 1 };
        let [a, b] = [k, next].map(|k| range.start as u32 + k);
        let flattened = faces.upright_axis(face);
        let certain = faces.reference_triangle(face);
        if let Some(axis) = flattened
            && !(certain.contains(&a) && certain.contains(&b))
        {
            // The upright plane faces outwards where the face's normal runs with the axis.
            let normal = faces.plane(PlaneId::face(face)).normal()[axis];
            let flip = sheet.side().is_gt() == (normal > 0);
            let mut points = [a, b];
            for point in &mut points {
                let is_certain = certain.contains(point);
                *point = if is_certain { self.point(*point)? } else { self.moved(*point)? };
            }
            return Ok(self.half(Key::Upright(face, k), points)?.flipped(flip));
        }
        let [a, b] = [self.point(a)?, self.point(b)?];
        let points = [a.min(b), a.max(b)];
        Ok(self.half(Key::Edge(points), points)?.flipped(front == (a < b)))
    }

    /// The half of a face's cut by a plane on which a piece lies that is behind the plane, or in front.
    pub(super) fn cut(
        &mut self,
        face: u32,
        plane: PlaneId,
        behind: bool,
        sheet: &Sheet,
    ) -> Result<Half, Error> {
        let own = PlaneId::face(face);
        let (key, swapped) = match plane.kind() {
            PlaneKind::Face(other) if other < face => (Key::Cut(other, own), true),
            _ => (Key::Cut(face, plane), false),
        };
        let half = match self.halves.get(&key) {
            Some(&half) => half,
            None => {
                let other = self.frame.sheet(plane);
                let exact = if swapped { other.cut(sheet) } else { sheet.cut(&other) };
                let through = self.on_cut(face, plane)?;
                let half = Half::of(self.add(key, &exact, through)?);
                insert(&mut self.halves, key, half)?;
                half
            }
        };
        Ok(half.flipped(sheet.side().is_gt() == (behind != swapped)))
    }

    /// Corners of a face that are known to lie on a plane that cuts it: those of the other face, or with
    /// the coordinate of an axis plane. (Of faces whose corners all lie on their planes, and are few.)
    fn on_cut(&mut self, face: u32, plane: PlaneId) -> Result<[u32; 2], Error> {
        let faces = self.frame.faces;
        let own = faces.corners(face);
        let is_exact = |face: u32| faces.upright_axis(face).is_none();
        let mut found = [NOWHERE; 2];
        if own.len() > FEW || !is_exact(face) {
            return Ok(found);
        }
        let other = match plane.kind() {
            PlaneKind::Face(other) if is_exact(other) => faces.corners(other),
            _ => &[],
        };
        let is_on = |corner: &[f64; 3]| match plane.kind() {
            PlaneKind::Face(_) => other.len() <= FEW && other.contains(corner),
            PlaneKind::Axis(axis, at) => corner[axis] == faces.corner(at)[axis],
        };
        let start = faces.corner_range(face).start as u32;
        let on = (start..).zip(own).filter(|(_, corner)| is_on(corner));
        for (place, (corner, _)) in found.iter_mut().zip(on) {
            *place = self.point(corner)?;
        }
        Ok(found)
    }

    /// The half of the picture in which rays meet a face's plane ahead of the eye.
    pub(super) fn ahead(&mut self, face: u32, sheet: &Sheet) -> Result<Half, Error> {
        Ok(self.half(Key::Horizon(face), [NOWHERE; 2])?.flipped(sheet.side().is_gt()))
    }

    fn point(&mut self, corner: u32) -> Result<u32, Error> {
        let place = self.frame.faces.corner(corner).map(|c| (c + 0.0).to_bits());
        if let Some(&number) = self.points.get(&place) {
            return Ok(number);
        }
        let number = self.corners.len() as u32;
        push(&mut self.corners, corner)?;
        insert(&mut self.points, place, number)?;
        Ok(number)
    }

    /// The number of the point onto which a corner was moved that was off its face's plane. Edges of no
    /// other face end there.
    fn moved(&mut self, corner: u32) -> Result<u32, Error> {
        if let Some(&number) = self.moved.get(&corner) {
            return Ok(number);
        }
        let number = self.corners.len() as u32;
        push(&mut self.corners, corner)?;
        insert(&mut self.moved, corner, number)?;
        Ok(number)
    }

    /// What made a line.
    pub(super) fn key(&self, line: u32) -> Key {
        self.keys[line as usize]
    }

    /// A half's line in floats.
    #[inline]
    pub(super) fn rounded(&self, half: Half) -> Rounded {
        match half.number() {
            Some(line) => self.rounded[line as usize],
            None => {
                let (axis, steps) = half.border();
                let mut k = [-(steps as f64) / STEPS, 0.0, 0.0];
                k[axis + 1] = 1.0;
                Rounded { k, error: 4.0 * UNIT * self.reach[axis], slope: 1.0 }
            }
        }
    }

    /// A line in floats that is none of these.
    pub(super) fn rounded_of(&self, exact: &Exact) -> Rounded {
        Rounded::new(exact, self.reach)
    }

    /// Whether a point is in the picture or at most a pixel beyond: where errors are bounded.
    pub(super) fn shows(&self, at: [f64; 2]) -> bool {
        (0..2).all(|axis| -1.0 <= at[axis] && at[axis] <= self.reach[axis])
    }

    /// On which side of a half's line the point lies where two others meet, the second turning to the
    /// left of the first as seen from their halves: exact.
    #[cold]
    pub(super) fn exact_side(&self, half: Half, [first, second]: [Half; 2]) -> Ordering {
        let lines = [first, second, half];
        if half.line() == first.line() || half.line() == second.line() || self.share_point(lines) {
            return Ordering::Equal;
        }
        let exact = lines.map(|half| self.exact(half));
        let side = orientation(exact.each_ref());
        let flips = lines.iter().filter(|half| half.is_negative()).count();
        if flips % 2 == 1 { side.reverse() } else { side }
    }

    /// On which side of a line, which may be none of these, the point lies where two others meet: exact.
    #[cold]
    pub(super) fn exact_side_of(&self, line: &Exact, corner: [Half; 2]) -> Ordering {
        let [a, b] = corner.map(|half| self.exact(half));
        let side = orientation([&a, &b, line]);
        if corner[0].is_negative() == corner[1].is_negative() { side } else { side.reverse() }
    }

    /// Where two lines meet, from integers, and how far off that may be by rounding.
    #[cold]
    pub(super) fn exact_meeting(&self, halves: [Half; 2]) -> ([f64; 2], f64) {
        let exact = halves.map(|half| self.exact(half));
        let at = meeting(exact.each_ref());
        let radius = 8.0 * UNIT * self.reach[0].max(self.reach[1]);
        if self.shows(at) { (at, radius) } else { ([0.0; 2], f64::INFINITY) }
    }

    /// Whether three lines are known to go through one point.
    fn share_point(&self, lines: [Half; 3]) -> bool {
        let through = lines.map(|half| half.number().map(|line| self.through[line as usize]));
        let [Some(a), Some(b), Some(c)] = through else { return false };
        a.iter().any(|point| *point != NOWHERE && b.contains(point) && c.contains(point))
    }

    /// A line in integers.
    fn exact_of(&self, key: Key) -> Exact {
        let (frame, faces) = (&self.frame, self.frame.faces);
        match key {
            Key::Edge(points) => {
                frame.edge(points.map(|point| faces.corner(self.corners[point as usize])))
            }
            Key::Upright(face, k) => {
                let corners = faces.corners(face);
                let next = if k as usize + 1 == corners.len() { 0 } else { k as usize + 1 };
                let axis = faces.upright_axis(face).unwrap_or_default();
                let upright = frame.upright([corners[k as usize], corners[next]], axis);
                frame.sheet(PlaneId::face(face)).cut(&upright)
            }
            Key::Cut(face, plane) => frame.sheet(PlaneId::face(face)).cut(&frame.sheet(plane)),
            Key::Horizon(face) => frame.sheet(PlaneId::face(face)).horizon(),
        }
    }

    /// The line of a half, in integers.
    pub(super) fn exact(&self, half: Half) -> Exact {
        match half.number() {
            Some(line) => self.exact_of(self.key(line)),
            None => {
                let (axis, steps) = half.border();
                let mut k = [-steps, 0, 0];
                k[axis + 1] = 1 << STEP_BITS;
                k.map(Int::from)
            }
        }
    }
}
