//! The lines of a picture, each known by what made it.

mod adopted;
mod of_halves;
#[cfg(test)]
mod tests;

pub(super) use adopted::Adopted;

use super::feet::{Feet, Foot};
use super::frame::{ExactLine, Frame, is_opposite, is_same_line};
use super::half::Half;
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
    /// The lines of edges, by where they are.
    edges: Feet,
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
            edges: Feet::default(),
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
        let half = match key {
            Key::Edge(_) | Key::Upright(..) => self.half_of_edge(key, rounded, points)?,
            Key::Cut(..) => Half::of(self.add(key, rounded, points)?),
        };
        insert(&mut self.halves, key, half)?;
        Ok(half)
    }

    /// The half of an edge that has no key yet. Edges on one line, as those of walls side by side, are one
    /// line of the picture: else it would be found out again and again that they meet everywhere.
    fn half_of_edge(
        &mut self,
        key: Key,
        rounded: Rounded,
        points: [u32; 2],
    ) -> Result<Half, Error> {
        let foot = Foot::of(&rounded, self.reach);
        for line in self.edges.near(&foot) {
            let [exact, other] = [key, self.key(line)].map(|key| self.exact_of(key));
            if is_same_line(&exact, &other) {
                return Ok(Half::of(line).flipped(is_opposite(&exact, &other)));
            }
        }
        let line = self.add(key, rounded, points)?;
        self.edges.add(&foot, line)?;
        Ok(Half::of(line))
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

    /// What made a line.
    pub(super) fn key(&self, line: u32) -> Key {
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
