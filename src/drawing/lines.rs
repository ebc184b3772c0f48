//! The lines of a picture, each known by what made it.

mod adopted;
#[cfg(test)]
mod names;
mod of_halves;
#[cfg(test)]
pub(super) mod tests;

pub(super) use adopted::Adopted;

use std::cell::OnceCell;

use super::feet::{Feet, Foot};
use super::frame::{ExactLine, Frame, compare, is_opposite};
use super::half::{Half, STEPS};
use super::key::Key;
use super::rounded::Rounded;
use super::table::{Table, insert};
use super::twofold::Twofold;
use crate::Error;
use crate::exact::{PlaneId, PlaneKind};
use crate::memory::push;

/// The number of no point.
pub(super) const NOWHERE: u32 = u32::MAX;
/// Faces of more corners are not searched for one that a line goes through.
const FEW: usize = 8;
/// Borders of tiles are not so far out, in steps.
const FURTHEST: f64 = (1u64 << 50) as f64;

/// All lines that a picture was asked for.
#[derive(Debug)]
pub(super) struct Lines<'t> {
    pub(super) frame: Frame<'t>,
    /// The largest coordinates in the picture.
    pub(super) reach: [f64; 2],
    keys: Vec<Key>,
    rounded: Vec<Rounded>,
    /// Points that each line is known to go through; [`NOWHERE`] for none.
    pub(super) through: Vec<[u32; 2]>,
    /// Edges of faces of which corners were moved, by their numbers: floats often cannot tell on which side
    /// of them others meet.
    pub(super) twofold: Table<u32, Twofold>,
    /// The half of each key on which it is positive.
    halves: Table<Key, Half>,
    /// All lines, by where they are.
    feet: Feet,
    /// The lines of cuts, by their halves that are positive.
    cuts: Table<Half, ()>,
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
            twofold: Table::default(),
            halves: Table::default(),
            feet: Feet::default(),
            cuts: Table::default(),
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
        self.new_half(key, self.rounded_of(key), points)
    }

    /// The same of a key that is new.
    fn new_half(&mut self, key: Key, rounded: Rounded, points: [u32; 2]) -> Result<Half, Error> {
        let half = self.half_of_line(key, rounded, points)?;
        if matches!(key, Key::Cut(..)) {
            insert(&mut self.cuts, half.positive(), ())?;
        }
        insert(&mut self.halves, key, half)?;
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
    ) -> Result<Half, Error> {
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
                Ok(Half::of(line).flipped(is_opposite))
            }
            Err(at) => {
                let line = self.add(key, rounded, points)?;
                self.feet.add(&foot, at, line)?;
                Ok(Half::of(line))
            }
        }
    }

    /// The border on which a line may lie.
    fn near_border(&self, line: &Rounded) -> Option<Half> {
        let [k0, kx, ky] = line.k;
        let (axis, [along, across]) =
            if kx.abs() > ky.abs() { (0, [ky, kx]) } else { (1, [kx, ky]) };
        let steps = -k0 / across * STEPS;
        let is_near = along.abs() <= self.slope_error(line)
            && (steps - steps.round()).abs() <= 2.0 * line.error * STEPS
            && steps.abs() < FURTHEST;
        is_near.then(|| Half::beyond(axis, steps.round() as i64))
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
        push(&mut self.keys, key)?;
        push(&mut self.rounded, rounded)?;
        push(&mut self.through, through)?;
        Ok(number)
    }

    /// The half of a face's edge `k` on which the face lies, by whether its κ is positive.
    pub(super) fn edge(&mut self, face: u32, k: u32, is_positive: bool) -> Result<Half, Error> {
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
            let flip = is_positive == (normal > 0);
            let mut points = [a, b];
            for point in &mut points {
                let is_certain = certain.contains(point);
                *point = if is_certain { self.point(*point)? } else { self.moved(*point)? };
            }
            let half = self.half(Key::Upright(face, k), points)?;
            self.keep_twofold(half)?;
            return Ok(half.flipped(flip));
        }
        let points = [self.point(a)?, self.point(b)?];
        let is_front = is_positive == self.frame.rays.is_perspective();
        let half = self.edge_between(points)?;
        if flattened.is_some() {
            self.keep_twofold(half)?;
        }
        Ok(half.flipped(is_front))
    }

    /// The half on which the edge from one point to another is positive.
    fn edge_between(&mut self, [a, b]: [u32; 2]) -> Result<Half, Error> {
        let points = [a.min(b), a.max(b)];
        Ok(self.half(Key::Edge(points), points)?.flipped(a > b))
    }

    /// Keeps a line in pairs of floats, if it is not kept yet.
    fn keep_twofold(&mut self, half: Half) -> Result<(), Error> {
        match half.number() {
            Some(line) if !self.twofold.contains_key(&line) => {
                let twofold = Twofold::of(&self.exact_of(self.key(line)));
                insert(&mut self.twofold, line, twofold)
            }
            _ => Ok(()),
        }
    }

    /// The half of a face's cut by a plane on which a piece lies that is behind the plane, or in front; by
    /// whether the face's κ is positive.
    pub(super) fn cut(
        &mut self,
        face: u32,
        plane: PlaneId,
        behind: bool,
        is_positive: bool,
    ) -> Result<Half, Error> {
        let own = PlaneId::face(face);
        let (key, swapped) = match plane.kind() {
            PlaneKind::Face(other) if other < face => (Key::Cut(other, own), true),
            _ => (Key::Cut(face, plane), false),
        };
        let half = match self.halves.get(&key) {
            Some(&half) => half,
            None => {
                let through = self.on_cut(face, plane)?;
                self.new_half(key, self.rounded_of(key), through)?
            }
        };
        Ok(half.flipped(is_positive == (behind != swapped)))
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

    /// Whether a cut was made along a half's line.
    pub(super) fn is_cut(&self, half: Half) -> bool {
        self.cuts.contains_key(&half.positive())
    }

    /// Whether the cut of a face by another's plane, the lower number first, is known to have been made along a half's
    /// line.
    pub(super) fn is_cut_of(&self, half: Half, [one, other]: [u32; 2]) -> bool {
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
