//! Lines taken over from another list.

use super::{Lines, NOWHERE};
use crate::Error;
use crate::drawing::half::Half;
use crate::drawing::key::Key;
use crate::drawing::table::insert;
use crate::memory::filled;

/// The halves on which another list's lines are positive, by their numbers there, of those that were taken over.
pub(in crate::drawing) struct Adopted(Vec<Option<Half>>);

impl Adopted {
    /// None of another list's lines so far.
    pub(in crate::drawing) fn of(other: &Lines<'_>) -> Result<Self, Error> {
        Ok(Self(filled(other.keys.len(), None)?))
    }
}

impl Lines<'_> {
    /// The half that another list's half is in this one, to which its line is added if it is new.
    pub(in crate::drawing) fn adopted(
        &mut self,
        other: &Self,
        half: Half,
        Adopted(adopted): &mut Adopted,
    ) -> Result<Half, Error> {
        let Some(line) = half.number() else { return Ok(half) };
        let own = match adopted[line as usize] {
            Some(own) => own,
            None => self.adopted_line(other, line)?,
        };
        adopted[line as usize] = Some(own);
        Ok(own.flipped(half.is_negative()))
    }

    /// Takes over which of another list's lines, of those that were taken over and of borders, are lines of cuts.
    pub(in crate::drawing) fn adopt_cuts(
        &mut self,
        other: &Self,
        Adopted(adopted): &Adopted,
    ) -> Result<(), Error> {
        for half in other.cuts.keys() {
            let own = match half.number() {
                Some(line) => adopted[line as usize].map(Half::positive),
                None => Some(*half),
            };
            if let Some(own) = own {
                insert(&mut self.cuts, own, ())?;
            }
        }
        Ok(())
    }

    /// The half on which another list's line is positive.
    fn adopted_line(&mut self, other: &Self, line: u32) -> Result<Half, Error> {
        let mut points = other.through[line as usize];
        for point in points.iter_mut().filter(|point| **point != NOWHERE) {
            let corner = other.corners[*point as usize];
            *point = match other.moved.get(&corner) == Some(point) {
                true => self.moved(corner)?,
                false => self.point(corner)?,
            };
        }
        // Edges are positive by the order of their points, and the other list may number these the other way.
        let (key, flip) = match other.key(line) {
            Key::Edge(_) if points[0] > points[1] => {
                points.reverse();
                (Key::Edge(points), true)
            }
            Key::Edge(_) => (Key::Edge(points), false),
            key => (key, false),
        };
        let count = self.keys.len();
        let own = match self.halves.get(&key) {
            Some(&own) => own,
            None => self.new_half(key, other.rounded[line as usize].flipped(flip), points)?,
        };
        match other.twofold.get(&line) {
            Some(twofold) if count < self.keys.len() => {
                insert(&mut self.twofold, count as u32, twofold.flipped(flip))?;
            }
            Some(_) => self.keep_twofold(own)?,
            None => {}
        }
        Ok(own.flipped(flip))
    }
}
