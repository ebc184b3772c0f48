//! The lines of a picture: what made each, its number, and lines found by where they are.

use std::cell::OnceCell;
use std::cmp::Ordering;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hash, Hasher};

use smallvec::SmallVec;

use super::exact_lines::{ExactLine, Frame, ROUNDING, Rounded, compare, is_opposite};
use crate::Error;
use crate::exact::{Int, PlaneId, PlaneKind};
use crate::random::mix;
use crate::raster::{Sheet, edge};

/// The number of no point.
pub(super) const NOWHERE: u32 = u32::MAX;
/// Faces of more corners are not searched for one that a line goes through.
const FEW: usize = 8;
/// Borders of tiles are not so far out, in steps.
const FURTHEST: f64 = (1u64 << 50) as f64;

/// The lines of a picture: of the edges of all faces that it may show, and of the cuts of their pieces.
#[derive(Clone, Debug)]
pub(super) struct LineTable<'t> {
    pub(super) frame: Frame<'t>,
    /// The largest coordinates in the picture.
    pub(super) reach: [f64; 2],
    keys: Vec<Key>,
    rounded: Vec<Rounded>,
    /// Points that each line is known to go through; [`NOWHERE`] for none.
    pub(super) through: Vec<[u32; 2]>,
    /// The half of each key on which it is positive.
    halves: Table<Key, HalfPlane>,
    /// All lines, by where they are.
    feet: LineIndex,
    /// The lines of cuts, by their halves that are positive.
    cuts: Table<HalfPlane, ()>,
    /// Equal corners have equal numbers.
    points: Table<[u64; 3], u32>,
    /// The numbers of where corners were moved to.
    moved: Table<u32, u32>,
    /// A corner of each number, and where it is.
    corners: Vec<(u32, [f64; 3])>,
}

impl<'t> LineTable<'t> {
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
            feet: LineIndex::default(),
            cuts: Table::default(),
            points: Table::default(),
            moved: Table::default(),
            corners: vec![],
        }
    }

    /// The half of a line on which its key is positive. The line is added if it is new; it goes through the
    /// points.
    fn half(&mut self, key: Key, points: [u32; 2]) -> Result<HalfPlane, Error> {
        if let Some(&half) = self.halves.get(&key) {
            return Ok(half);
        }
        self.new_half(key, self.rounded_of(key), points)
    }

    /// The same of a key that is new.
    fn new_half(
        &mut self,
        key: Key,
        rounded: Rounded,
        points: [u32; 2],
    ) -> Result<HalfPlane, Error> {
        let half = self.half_of_line(key, rounded, points)?;
        if matches!(key, Key::Cut(..)) {
            self.cuts.insert(half.positive(), ());
        }
        self.halves.insert(key, half);
        Ok(half)
    }

    /// The half of a line that has no key yet. What makes one line of the picture, as edges of walls side by side, cuts
    /// along them, and borders of tiles, has one half: else sides of cells would not be known to lie on one line, and it
    /// would be found out again and again that they meet everywhere.
    fn half_of_line(
        &mut self,
        key: Key,
        rounded: Rounded,
        points: [u32; 2],
    ) -> Result<HalfPlane, Error> {
        let exact = OnceCell::new();
        let exact = || exact.get_or_init(|| self.exact_of(key));
        if let Some(border) = self.near_border(&rounded) {
            let other = self.exact(border);
            if compare(exact(), &other).is_eq() {
                return Ok(border.flipped(is_opposite(exact(), &other)));
            }
        }
        let foot = Foot::of(&rounded, self.reach);
        match self.feet.search(&foot, |line| compare(&self.exact_of(self.key(line)), exact())) {
            Ok(line) => {
                let is_opposite = is_opposite(exact(), &self.exact_of(self.key(line)));
                self.remember(line, points);
                Ok(HalfPlane::of(line).flipped(is_opposite))
            }
            Err(at) => {
                let line = self.add(key, rounded, points)?;
                self.feet.add(&foot, at, line);
                Ok(HalfPlane::of(line))
            }
        }
    }

    /// The border on which a line may lie.
    fn near_border(&self, line: &Rounded) -> Option<HalfPlane> {
        let [k0, kx, ky] = line.k;
        let (axis, [along, across]) =
            if kx.abs() > ky.abs() { (0, [ky, kx]) } else { (1, [kx, ky]) };
        let steps = -k0 / across * STEPS;
        let is_near = along.abs() <= self.slope_error(line)
            && (steps - steps.round()).abs() <= 2.0 * line.error * STEPS
            && steps.abs() < FURTHEST;
        is_near.then(|| HalfPlane::beyond(axis, steps.round() as i64))
    }

    /// Points through which a line is known to go, if there is room for them.
    fn remember(&mut self, line: u32, points: [u32; 2]) {
        let known = &mut self.through[line as usize];
        for point in points.into_iter().filter(|&point| point != NOWHERE) {
            if let Some(free) = known.iter().position(|&known| known == NOWHERE)
                && !known.contains(&point)
            {
                known[free] = point;
            }
        }
    }

    fn add(&mut self, key: Key, rounded: Rounded, through: [u32; 2]) -> Result<u32, Error> {
        // A number takes less memory than its line.
        let number = u32::try_from(self.keys.len()).map_err(|_| Error::out_of_memory())?;
        self.keys.push(key);
        self.rounded.push(rounded);
        self.through.push(through);
        Ok(number)
    }

    /// The half of a face's edge `k` on which the face lies, by whether its κ is positive.
    pub(super) fn edge(
        &mut self,
        face: u32,
        k: u32,
        is_positive: bool,
        is_as_given: bool,
    ) -> Result<HalfPlane, Error> {
        let faces = self.frame.faces;
        let range = faces.corner_range(face);
        let next = if k as usize + 1 == range.len() { 0 } else { k + 1 };
        let [a, b] = [k, next].map(|k| range.start as u32 + k);
        let flattened = faces.moved_axis(face).filter(|_| !is_as_given);
        let certain = faces.reference_triangle(face);
        if let Some(axis) = flattened
            && !(certain.contains(&a) && certain.contains(&b))
        {
            // The upright plane faces outwards where the face's normal runs with the axis.
            let normal = faces.plane(PlaneId::face(face)).normal()[axis];
            let flip = is_positive == (normal > 0);
            let mut points = [a, b];
            for point in &mut points {
                let is_certain = certain.contains(point);
                *point = match is_certain {
                    true => self.point(*point, faces.corner(*point)),
                    false => self.moved(*point),
                };
            }
            return Ok(self.half(Key::Upright(face, k), points)?.flipped(flip));
        }
        let is_moved = faces.moved_axis(face).is_some();
        let points = [a, b].map(|corner| match is_moved {
            true => self.point(corner, faces.given_corner(corner)),
            false => self.point(corner, faces.corner(corner)),
        });
        let is_front = is_positive == self.frame.rays.is_perspective();
        Ok(self.edge_between(points)?.flipped(is_front))
    }

    /// The half on which the edge from one point to another is positive.
    fn edge_between(&mut self, [a, b]: [u32; 2]) -> Result<HalfPlane, Error> {
        let points = [a.min(b), a.max(b)];
        Ok(self.half(Key::Edge(points), points)?.flipped(a > b))
    }

    /// The half of a face's cut by a plane on which a piece lies that is behind the plane, or in front; by
    /// whether the face's κ is positive.
    pub(super) fn cut(
        &mut self,
        face: u32,
        plane: PlaneId,
        behind: bool,
        is_positive: bool,
    ) -> Result<HalfPlane, Error> {
        let own = PlaneId::face(face);
        let (key, swapped) = match plane.kind() {
            PlaneKind::Face(other) if other < face => (Key::Cut(other, own), true),
            _ => (Key::Cut(face, plane), false),
        };
        let half = match self.halves.get(&key) {
            Some(&half) => half,
            None => {
                let through = self.on_cut(face, plane);
                self.new_half(key, self.rounded_of(key), through)?
            }
        };
        Ok(half.flipped(is_positive == (behind != swapped)))
    }

    /// Corners of a face that are known to lie on a plane that cuts it: those of the other face, or with
    /// the coordinate of an axis plane. (Of faces whose corners all lie on their planes, and are few.)
    fn on_cut(&mut self, face: u32, plane: PlaneId) -> [u32; 2] {
        let faces = self.frame.faces;
        let own = faces.corners(face);
        let is_exact = |face: u32| faces.moved_axis(face).is_none();
        let mut found = [NOWHERE; 2];
        if own.len() > FEW || !is_exact(face) {
            return found;
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
            *place = self.point(corner, faces.corner(corner));
        }
        found
    }

    fn point(&mut self, corner: u32, at: [f64; 3]) -> u32 {
        let place = at.map(|c| (c + 0.0).to_bits());
        if let Some(&number) = self.points.get(&place) {
            return number;
        }
        let number = self.corners.len() as u32;
        self.corners.push((corner, at));
        self.points.insert(place, number);
        number
    }

    /// The number of the point onto which a corner was moved that was off its face's plane. Edges of no
    /// other face end there.
    fn moved(&mut self, corner: u32) -> u32 {
        if let Some(&number) = self.moved.get(&corner) {
            return number;
        }
        let number = self.corners.len() as u32;
        self.corners.push((corner, self.frame.faces.corner(corner)));
        self.moved.insert(corner, number);
        number
    }

    /// Whether a cut was made along a half's line.
    pub(super) fn is_cut(&self, half: HalfPlane) -> bool {
        self.cuts.contains_key(&half.positive())
    }

    /// Whether the cut of a face by another's plane, the lower number first, is known to have been made along a half's
    /// line.
    pub(super) fn is_cut_of(&self, half: HalfPlane, [one, other]: [u32; 2]) -> bool {
        let cut = self.halves.get(&Key::Cut(one, PlaneId::face(other)));
        cut.is_some_and(|cut| cut.line() == half.line())
    }

    /// How many lines there are, borders not counted.
    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.keys.len()
    }

    /// What made a line first.
    fn key(&self, line: u32) -> Key {
        self.keys[line as usize]
    }

    /// A line in floats.
    fn rounded_of(&self, key: Key) -> Rounded {
        key.rounded(&self.frame, &self.corners, self.reach)
    }

    /// A line in integers.
    fn exact_of(&self, key: Key) -> ExactLine {
        key.exact(&self.frame, &self.corners)
    }
}

impl LineTable<'_> {
    /// A half's line in floats.
    #[inline]
    pub(in crate::drawing) fn rounded(&self, half: HalfPlane) -> Rounded {
        match half.number() {
            Some(line) => self.rounded[line as usize],
            None => {
                let (axis, steps) = half.border();
                let mut k = [-(steps as f64) / STEPS, 0.0, 0.0];
                k[axis + 1] = 1.0;
                Rounded { k, error: 4.0 * ROUNDING * self.reach[axis], slope: 1.0 }
            }
        }
    }

    /// How much the parts of a line's slope may be off.
    pub(in crate::drawing) fn slope_error(&self, line: &Rounded) -> f64 {
        line.error / self.reach[0].min(self.reach[1])
    }

    /// The edge from one lattice point to another in floats, whether its line is one of these or not.
    pub(in crate::drawing) fn rounded_edge(&self, ends: [[f64; 3]; 2]) -> Rounded {
        rounded_edge(&self.frame, ends, self.reach)
    }

    /// A line in floats that is none of these.
    pub(in crate::drawing) fn rounded_other(&self, exact: &ExactLine) -> Rounded {
        Rounded::new(exact, self.reach)
    }

    /// Whether a point is in the picture or at most a pixel beyond: where errors are bounded.
    pub(in crate::drawing) fn shows(&self, at: [f64; 2]) -> bool {
        (0..2).all(|axis| -1.0 <= at[axis] && at[axis] <= self.reach[axis])
    }

    /// The line of a half, in integers.
    pub(in crate::drawing) fn exact(&self, half: HalfPlane) -> ExactLine {
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
}

impl Key {
    /// The line in floats, in a picture that reaches so far. Points have the numbers of these corners.
    pub(super) fn rounded(
        self,
        frame: &Frame<'_>,
        corners: &[(u32, [f64; 3])],
        reach: [f64; 2],
    ) -> Rounded {
        let Frame { rays, faces } = frame;
        let sheet = |plane| Sheet::new(rays, faces, plane);
        let (k, error) = match self {
            Self::Edge(points) => return rounded_edge(frame, ends(corners, points), reach),
            Self::Upright(face, k) => {
                let ([a, b], axis) = upright(frame, face, k);
                sheet(PlaneId::face(face)).cut(&Sheet::upright(rays, a, b, axis))
            }
            Self::Cut(face, plane) => sheet(PlaneId::face(face)).cut(&sheet(plane)),
        };
        // Lines are looked at up to a pixel beyond the picture that the error is for.
        let rounded = Rounded::scaled(k, 4.0 * error);
        if rounded.is_fine() { rounded } else { Rounded::new(&self.exact(frame, corners), reach) }
    }

    /// The line in integers.
    pub(super) fn exact(self, frame: &Frame<'_>, corners: &[(u32, [f64; 3])]) -> ExactLine {
        match self {
            Self::Edge(points) => frame.edge(ends(corners, points)),
            Self::Upright(face, k) => {
                let (ends, axis) = upright(frame, face, k);
                frame.sheet(PlaneId::face(face)).cut(&frame.upright(ends, axis))
            }
            Self::Cut(face, plane) => frame.sheet(PlaneId::face(face)).cut(&frame.sheet(plane)),
        }
    }
}

/// The edge from one lattice point to another in floats, in a picture that reaches so far.
pub(super) fn rounded_edge(frame: &Frame<'_>, ends: [[f64; 3]; 2], reach: [f64; 2]) -> Rounded {
    let (k, error) = edge(&frame.rays, ends);
    let rounded = Rounded::scaled(k, 4.0 * error);
    if rounded.is_fine() { rounded } else { Rounded::new(&frame.edge(ends), reach) }
}

/// The ends of an edge.
fn ends(corners: &[(u32, [f64; 3])], points: [u32; 2]) -> [[f64; 3]; 2] {
    points.map(|point| corners[point as usize].1)
}

/// The ends of a face's edge `k`, and the axis along which they were moved onto the face's plane.
fn upright(frame: &Frame<'_>, face: u32, k: u32) -> ([[f64; 3]; 2], usize) {
    let corners = frame.faces.corners(face);
    let next = if k as usize + 1 == corners.len() { 0 } else { k as usize + 1 };
    let axis = frame.faces.moved_axis(face).unwrap_or_default();
    ([corners[k as usize], corners[next]], axis)
}

/// A table whose keys are made of numbers. Nothing depends on the order of its entries.
pub(super) type Table<K, V> = HashMap<K, V, BuildHasherDefault<Mixer>>;

/// 2⁶⁴ divided by the golden ratio: odd, and without a pattern in its bits.
const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;

/// Mixes the numbers of a key.
#[derive(Debug, Default)]
pub(super) struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        mix(self.0)
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_le_bytes(word));
        }
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(u64::from(number));
    }

    fn write_usize(&mut self, number: usize) {
        self.write_u64(number as u64);
    }

    fn write_i64(&mut self, number: i64) {
        self.write_u64(number as u64);
    }

    fn write_isize(&mut self, number: isize) {
        self.write_u64(number as u64);
    }

    fn write_u64(&mut self, number: u64) {
        self.0 = (self.0.rotate_left(23) ^ number).wrapping_mul(FACTOR);
    }
}

/// The point of a line that is next to the middle of the picture, and the cosine of twice the line's angle:
/// the same for both directions. Of a line that the picture shows, they are off by less than a
/// [`MARGIN`] of a [`STEP`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    point: [f64; 2],
    cosine: f64,
}

/// The numbers of lines, by their feet; those of one place in an order of lines that is exact: in a picture that
/// shows a scene from very far, all are in one place.
#[derive(Clone, Debug, Default)]
pub(super) struct LineIndex(Table<Place, SmallVec<[u32; 2]>>);

type Place = [i64; 3];

/// Places are so large, in pixels and of the cosine. Too small: feet of one line are in several; too large: more
/// lines are compared in integers.
const STEP: f64 = 1.0 / (1u64 << 20) as f64;
/// Feet are looked for in neighbouring places if they are nearer to these than this share of a step. (Values of lines
/// that the picture shows are off by less than 2⁻³¹ pixels, feet by less than four times as much: 2⁻⁹ of a
/// step.)
const MARGIN: f64 = 1.0 / 256.0;

impl Foot {
    /// That of a line in a picture of this size.
    pub(super) fn of(line: &Rounded, size: [f64; 2]) -> Self {
        let [_, kx, ky] = line.k;
        let middle = size.map(|side| 0.5 * side);
        let square = kx * kx + ky * ky;
        let off = line.at(middle) / square;
        let point = [middle[0] - off * kx, middle[1] - off * ky];
        Self { point, cosine: (kx * kx - ky * ky) / square }
    }

    fn numbers(&self) -> [f64; 3] {
        [self.point[0], self.point[1], self.cosine]
    }

    fn place(&self) -> Place {
        self.numbers().map(step_of)
    }

    /// The places where a line may be whose foot this is.
    fn places(&self) -> impl Iterator<Item = Place> {
        let [xs, ys, cosines] = self.numbers().map(|number| {
            let [low, high] = [-STEP, STEP].map(|step| step_of(number + step * MARGIN));
            std::iter::once(low).chain((high != low).then_some(high))
        });
        let planes = xs.flat_map(move |x| ys.clone().map(move |y| [x, y]));
        planes.flat_map(move |[x, y]| cosines.clone().map(move |c| [x, y, c]))
    }
}

impl LineIndex {
    /// The line with this foot that a comparison of lines with another one says is the same; or else where to
    /// [`add`](Self::add) that one.
    pub(super) fn search(
        &self,
        foot: &Foot,
        compare: impl Fn(u32) -> Ordering,
    ) -> Result<u32, usize> {
        let mut free = 0;
        for place in foot.places() {
            let Some(lines) = self.0.get(&place) else { continue };
            match lines.binary_search_by(|&line| compare(line)) {
                Ok(at) => return Ok(lines[at]),
                Err(at) if place == foot.place() => free = at,
                Err(_) => {}
            }
        }
        Err(free)
    }

    /// Adds a line that was sought without success.
    pub(super) fn add(&mut self, foot: &Foot, at: usize, line: u32) {
        self.0.reserve(1);
        let lines = self.0.entry(foot.place()).or_default();
        lines.reserve(1);
        lines.insert(at, line);
    }
}

fn step_of(number: f64) -> i64 {
    (number / STEP).floor() as i64
}

/// Borders of tiles are at multiples of 1/`STEPS` of a pixel.
pub(super) const STEPS: f64 = (1u64 << STEP_BITS) as f64;
pub(super) const STEP_BITS: u32 = 24;

/// A line, and which of its sides is meant.
///
/// The last bit is set for the side on which the line is negative. Above it is the number of the line;
/// or, with the first bit set, what a border of a tile is: so these need no list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct HalfPlane(u64);

const BORDER: u64 = 1 << 63;
/// Borders are this many steps from where their number is 0, so that all numbers are positive.
const OFFSET: i64 = 1 << 60;

impl HalfPlane {
    /// The side of a line on which it is positive.
    pub(super) const fn of(line: u32) -> Self {
        Self((line as u64) << 1)
    }

    /// The points whose coordinate (axis 0, 1 for x, y) is at least so many [`STEPS`] of a pixel.
    pub(super) const fn beyond(axis: usize, steps: i64) -> Self {
        Self(BORDER | (((steps + OFFSET) as u64) << 1 | axis as u64) << 1)
    }

    /// The same for all halves of a line.
    pub(super) const fn line(self) -> u64 {
        self.0 >> 1
    }

    /// The half of the same line on which it is positive.
    pub(super) const fn positive(self) -> Self {
        Self(self.0 & !1)
    }

    /// The number of the line; `None` for a border.
    pub(super) const fn number(self) -> Option<u32> {
        if self.0 & BORDER == 0 { Some((self.0 >> 1) as u32) } else { None }
    }

    /// The axis of a border, and where it is.
    pub(super) const fn border(self) -> (usize, i64) {
        let number = (self.0 & !BORDER) >> 1;
        ((number & 1) as usize, (number >> 1) as i64 - OFFSET)
    }

    /// Whether the side is meant on which the line is negative.
    pub(super) const fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    /// The other side, if `flip`.
    pub(super) const fn flipped(self, flip: bool) -> Self {
        Self(self.0 ^ flip as u64)
    }
}

#[cfg(test)]
mod names;
#[cfg(test)]
pub(super) mod tests;
