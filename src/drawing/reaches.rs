//! Convex pieces in a part of the picture.

use smallvec::SmallVec;

use super::half::Half;
use super::halving::NARROWED;
use super::lines::Lines;
use super::rect::{Rect, are_apart, is_within};
use super::reporter::each;
use super::tile::Across;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{place, push, reserve};

/// A piece, with those of its lines that may cross a part of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// What the caller gave it: the number of an item, or of a face that is taken whole.
    pub(super) number: u32,
    halves: [u32; 2],
}

impl Reach {
    /// Whether it covers the whole part.
    pub(super) const fn covers(&self) -> bool {
        self.halves[0] == self.halves[1]
    }
}

/// The pieces that may reach into a part of the picture.
#[derive(Debug, Default)]
pub(super) struct Reaches {
    pub(super) list: Vec<Reach>,
    halves: Vec<Half>,
}

impl Reaches {
    /// Adds a piece.
    pub(super) fn push(&mut self, number: u32, halves: &[Half]) -> Result<(), Error> {
        let start = place(self.halves.len())?;
        reserve(&mut self.halves, halves.len())?;
        self.halves.extend_from_slice(halves);
        push(&mut self.list, Reach { number, halves: [start, place(self.halves.len())?] })
    }

    pub(super) fn halves_of(&self, reach: &Reach) -> &[Half] {
        let [start, end] = reach.halves;
        &self.halves[start as usize..end as usize]
    }

    /// Those that may reach into a box; `around` gives a box around a piece.
    pub(super) fn narrowed(
        &self,
        lines: &Lines<'_>,
        sides: &Rect,
        around: impl Fn(u32) -> Rect,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let mut part = Self::default();
        'pieces: for reach in each(watch, NARROWED, &self.list) {
            let reach = reach?;
            let around = around(reach.number);
            if are_apart(sides, &around) {
                continue;
            }
            if is_within(&around, sides) {
                part.push(reach.number, self.halves_of(reach))?;
                continue;
            }
            let mut kept: SmallVec<[Half; 8]> = SmallVec::new();
            for &half in self.halves_of(reach) {
                match lines.across(half, sides) {
                    Across::Inside => {}
                    Across::Outside => continue 'pieces,
                    Across::Maybe => kept.push(half),
                }
            }
            part.push(reach.number, &kept)?;
        }
        Ok(part)
    }
}
