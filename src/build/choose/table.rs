//! The sides of all pieces of a small set at the planes of its pieces, as bits. Planes across an axis are searched
//! where all of these cut.
//!
//! Each piece is classified once at each plane. From then on, bits tell how a plane divides any part of the set.
//! Only the two parts of a cut piece are classified again, at the planes that cut the whole piece: a part of a
//! piece that is on one side is on the same side.

use std::array::from_fn;
use std::cmp::Ordering;
use std::mem::take;
use std::ops::{BitAnd, BitOr, Not, Range};

use smallvec::SmallVec;

use super::ChooseContext;
use super::axis_planes::FreePlanes;
use super::coplanar::{follow_rivals, larger};
use super::cost::{Cost, Counts, PricedPlane, work_of_one_more};
use super::peel::arrange;
use super::set::{LANES, PackedBox, PackedPieces, Reach, Set};
use super::tuning::Tuning;
use crate::Error;
use crate::build::piece::Piece;
use crate::exact::{PlaneId, PreparedPlane, Side};

/// The number of words of a mask.
const WORDS: usize = 4;

/// The most pieces of a table.
const MOST_PIECES: usize = 64 * WORDS;

/// The most corners of all pieces of a table. Too large: a long wait for a cancelled build to end. Too small: sets
/// of polygons with many corners are divided with less care.
const MOST_CORNERS: usize = 1 << 16;

/// The number of groups of pieces that are compared with a plane together, if a box around them is on one side.
const BLOCK: usize = 4;
/// The bits of the pieces of such groups.
const WHOLE_BLOCK: u64 = (1 << (BLOCK * LANES)) - 1;

/// Some pieces of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::build) struct Mask([u64; WORDS]);

impl Mask {
    /// The first `n` pieces.
    fn first(n: usize) -> Self {
        Self(from_fn(|word| match n.saturating_sub(64 * word) {
            0 => 0,
            count @ 1..64 => (1 << count) - 1,
            _ => u64::MAX,
        }))
    }

    pub(in crate::build) fn count(self) -> usize {
        self.0.iter().map(|word| word.count_ones()).sum::<u32>() as usize
    }

    pub(in crate::build) fn is_empty(self) -> bool {
        self == Self::default()
    }

    pub(in crate::build) fn contains(self, piece: usize) -> bool {
        self.0[piece / 64] >> (piece % 64) & 1 == 1
    }

    fn set(&mut self, piece: usize, is_in: bool) {
        let (word, bit) = (&mut self.0[piece / 64], 1 << (piece % 64));
        *word = if is_in { *word | bit } else { *word & !bit };
    }

    /// The pieces, from the first.
    #[inline]
    pub(in crate::build) fn iter(self) -> impl Iterator<Item = usize> + Clone {
        let Self(mut words) = self;
        let mut word = 0;
        std::iter::from_fn(move || {
            while words[word] == 0 {
                word += 1;
                if word == WORDS {
                    word = 0;
                    return None;
                }
            }
            let bit = words[word].trailing_zeros() as usize;
            words[word] &= words[word] - 1;
            Some(64 * word + bit)
        })
    }

    /// The words that are not empty.
    fn words(self) -> Range<usize> {
        let is_full = |&word: &usize| self.0[word] != 0;
        let first = (0..WORDS).find(is_full).unwrap_or(0);
        first..(0..WORDS).rfind(is_full).map_or(first, |last| last + 1)
    }
}

impl FromIterator<usize> for Mask {
    fn from_iter<I: IntoIterator<Item = usize>>(pieces: I) -> Self {
        let mut mask = Self::default();
        pieces.into_iter().for_each(|piece| mask.set(piece, true));
        mask
    }
}

impl BitAnd for Mask {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|word| self.0[word] & other.0[word]))
    }
}

impl BitOr for Mask {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|word| self.0[word] | other.0[word]))
    }
}

impl Not for Mask {
    type Output = Self;

    fn not(self) -> Self {
        Self(self.0.map(Not::not))
    }
}

/// The pieces on the sides of a piece's plane, and the planes that cut the piece.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    /// The pieces that reach in front of the plane. A piece that is also in `back` is cut by the plane; one that
    /// is in neither lies on the plane.
    front: Mask,
    /// The pieces that reach behind the plane.
    back: Mask,
    /// The pieces that may come within twice the tolerance of the plane, when they were whole.
    near: Mask,
    /// The pieces whose planes cut the piece of this row.
    cut_by: Mask,
}

impl Row {
    /// The effect of the plane on some pieces, and the number of these whose planes cut the piece of this row. All
    /// pieces are in `N` words from `first`.
    #[inline]
    fn counts<const N: usize>(&self, mask: &Mask, first: usize) -> (Counts, u32) {
        let mut counts = [0_u64; 4];
        for word in first..first + N {
            let mask = mask.0[word];
            let (front, back) = (self.front.0[word] & mask, self.back.0[word] & mask);
            let words = [front, back, front & back, self.cut_by.0[word] & mask];
            for (count, word) in counts.iter_mut().zip(words) {
                *count += u64::from(word.count_ones());
            }
        }
        let [front, back, splits, cut_by] = counts.map(|count| count as u32);
        (Counts { front: front - splits, back: back - splits, splits }, cut_by)
    }

    /// Whether the plane cuts a piece.
    #[inline]
    fn cuts_some<const N: usize>(&self, mask: &Mask, first: usize) -> bool {
        let cut = |word: usize| self.front.0[word] & self.back.0[word] & mask.0[word];
        (first..first + N).fold(0, |cuts, word| cuts | cut(word)) != 0
    }

    /// The number of pieces that the plane cuts.
    #[inline]
    fn cuts<const N: usize>(&self, mask: &Mask, first: usize) -> u32 {
        let cut = |word: usize| self.front.0[word] & self.back.0[word] & mask.0[word];
        (first..first + N).map(|word| cut(word).count_ones()).sum()
    }
}

/// How a plane divides a part: the pieces that reach in front of it, that reach behind it, and on it.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::build) struct Sides {
    pub(in crate::build) front: Mask,
    pub(in crate::build) back: Mask,
    pub(in crate::build) on: Mask,
}

impl Sides {
    /// The pieces that the plane cuts.
    pub(in crate::build) fn cuts(&self) -> Mask {
        self.front & self.back
    }

    fn counts(&self) -> Counts {
        let splits = self.cuts().count() as u32;
        let [front, back] = [self.front, self.back].map(|side| side.count() as u32 - splits);
        Counts { front, back, splits }
    }
}

/// A plane, and how it divides a part.
#[derive(Clone, Copy, Debug)]
pub(in crate::build) struct Divided {
    pub(in crate::build) plane: PreparedPlane,
    pub(in crate::build) sides: Sides,
}

/// The plane that divides a part.
#[derive(Clone, Copy, Debug)]
pub(in crate::build) enum Chosen {
    /// The plane of a row.
    Row(usize),
    /// A plane across an axis.
    Axis(Divided),
}

/// A row whose plane may divide a part.
#[derive(Clone, Copy, Debug)]
struct Priced {
    cost: f64,
    /// The number of pieces that the plane cuts.
    cuts: u32,
    /// The number of planes that cut the plane's own piece.
    risk: u32,
    row: u32,
}

impl Priced {
    fn cmp(&self, other: &Self) -> Ordering {
        self.cost.total_cmp(&other.cost).then(self.row.cmp(&other.row))
    }
}

/// The plane of lowest cost for a whole table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cheapest {
    /// The plane's own piece, by its number in the set.
    pub(super) piece: usize,
    /// The work left on both sides.
    pub(super) amount: f64,
    /// What the cost is less than the amount, because planes cut the plane's own piece.
    pub(super) reward: f64,
}

/// The pieces of a small set, and their sides at the planes that may divide it.
#[derive(Debug, Default)]
pub(in crate::build) struct Table {
    pub(in crate::build) pieces: Vec<Piece>,
    /// The planes of the pieces, in the order of the pieces.
    rows: Vec<Row>,
    planes: Vec<PreparedPlane>,
    packed: PackedPieces,
    /// A box around each block of packed pieces.
    boxes: Vec<PackedBox>,
    priced: Vec<Priced>,
    /// The places, pieces and rows of a part before a trial.
    saved: Vec<(usize, Piece, Row)>,
    /// The numbers of the set's pieces in the order of the table.
    order: Vec<usize>,
    /// The pieces of a part.
    gathered: Vec<Piece>,
    free: FreePlanes,
    /// The pieces on a plane, and those beside it.
    on: Vec<u32>,
    beside: Vec<u32>,
}

impl Table {
    /// Whether a set is small enough for a table.
    pub(in crate::build) fn holds(set: &Set<'_>, tuning: &Tuning) -> bool {
        set.len() <= tuning.small && Self::fitting(set, 0..set.len()).count() == set.len()
    }

    /// The first of some pieces of a set, as many as a table holds.
    pub(super) fn fitting(
        set: &Set<'_>,
        pieces: impl Iterator<Item = usize>,
    ) -> impl Iterator<Item = usize> {
        let mut corners = 0;
        pieces.take(MOST_PIECES).take_while(move |&piece| {
            corners += set.vertices(piece);
            corners <= MOST_CORNERS
        })
    }

    /// Fills the table with a set, and returns the whole set.
    pub(in crate::build) fn fill(&mut self, set: &Set<'_>) -> Mask {
        let n = set.len();
        let mut pieces = take(&mut self.pieces);
        pieces.clear();
        // Pieces near one another are in one block.
        arrange(set, BLOCK, &mut self.order);
        pieces.extend(self.order.iter().map(|&piece| set.pieces[piece]));
        let set = &set.over(&pieces);
        self.packed.reset(set);
        self.packed.extend(set, 0..n);
        let groups = self.packed.groups();
        self.boxes.clear();
        let blocks = (0..groups).step_by(BLOCK);
        self.boxes.extend(blocks.map(|first| self.packed.bounds(first..groups.min(first + BLOCK))));
        self.rows.clear();
        self.planes.clear();
        for piece in 0..n {
            self.add_row(set, piece);
        }
        for row in 0..n {
            for piece in (self.rows[row].front & self.rows[row].back).iter() {
                self.rows[piece].cut_by.set(row, true);
            }
        }
        self.pieces = pieces;
        Mask::first(n)
    }

    /// Classifies all pieces at the plane of a piece.
    fn add_row(&mut self, set: &Set<'_>, own: usize) {
        let packed = &self.packed.plane(set, own);
        let mut row = Row::default();
        let groups = self.packed.groups();
        for (first, around) in (0..).step_by(BLOCK).zip(&self.boxes) {
            let (word, shift) = (first / 16, first % 16 * 4);
            match self.packed.side_of_box(packed, around) {
                Some(0) => row.front.0[word] |= WHOLE_BLOCK << shift,
                Some(_) => row.back.0[word] |= WHOLE_BLOCK << shift,
                None => {
                    let block = first..groups.min(first + BLOCK);
                    self.packed.for_each_reach(packed, block, |group, reach| {
                        let Reach { front, back, near } = reach;
                        let shift = group % 16 * 4;
                        row.front.0[word] |= u64::from(front) << shift;
                        row.back.0[word] |= u64::from(back) << shift;
                        row.near.0[word] |= u64::from(near) << shift;
                    });
                }
            }
        }
        let mut all = Mask::first(set.len());
        all.set(own, false);
        let prepared = set.prepare(set.own_plane(own));
        row.front = row.front & all;
        row.back = row.back & all;
        row.near = row.near & all;
        for piece in (row.near & !(row.front & row.back)).iter() {
            let side = set.classify(&prepared, piece);
            row.front.set(piece, matches!(side, Side::Front | Side::Spanning));
            row.back.set(piece, matches!(side, Side::Back | Side::Spanning));
        }
        self.rows.push(row);
        self.planes.push(prepared);
    }

    /// The plane of a row.
    pub(in crate::build) fn plane(&self, row: usize) -> &PreparedPlane {
        &self.planes[row]
    }

    /// The plane of a row, and how it divides a part.
    pub(in crate::build) fn divided(&self, row: usize, part: &Mask) -> Divided {
        Divided { plane: self.planes[row], sides: self.sides(row, part) }
    }

    /// How the plane of a row divides a part.
    pub(in crate::build) fn sides(&self, row: usize, part: &Mask) -> Sides {
        let Row { front, back, .. } = self.rows[row];
        Sides { front: front & *part, back: back & *part, on: *part & !front & !back }
    }

    /// Chooses the plane that divides a part: a row without cuts; otherwise an axis plane without cuts; otherwise the
    /// cheapest of both. Rows come first because their costs are in the table, and an axis plane has to be searched.
    pub(in crate::build) fn choose(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        part: &Mask,
    ) -> Result<Chosen, Error> {
        self.priced.clear();
        let words = part.words();
        match words.len() {
            0 | 1 => self.choose_in::<1>(rules, set, part, words.start),
            2 => self.choose_in::<2>(rules, set, part, words.start),
            _ => self.choose_in::<WORDS>(rules, set, part, 0),
        }
    }

    /// The same, for a part with all pieces in `N` words from `first`.
    fn choose_in<const N: usize>(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        part: &Mask,
        first: usize,
    ) -> Result<Chosen, Error> {
        if let Some(row) = self.best_without_cuts::<N>(part, first) {
            return Ok(Chosen::Row(row));
        }
        let (free, tuning) = (self.axis_plane(rules, set, part)?, rules.tuning);
        let mut axis = match free {
            Some(free) if !free.cost.cuts => self.divide(rules, set, part, free.plane)?,
            _ => None,
        };
        if let Some(axis) = axis
            && axis.sides.cuts().is_empty()
        {
            return Ok(Chosen::Axis(axis));
        }
        let density = self.price::<N>(part, first, tuning);
        let few = if density < tuning.risk_at { tuning.pairs } else { 1 };
        let few = few.clamp(1, self.priced.len());
        self.priced.select_nth_unstable_by(few - 1, Priced::cmp);
        if let Some(free) = free
            && free.cost.cuts
            && free.cost.amount < self.priced[few - 1].cost
        {
            axis = self.divide(rules, set, part, free.plane)?;
        }
        Ok(self.best_of::<N>(few, part, first, tuning, axis))
    }

    /// Of all rows, the one of lowest cost; `None` if there are no rows.
    pub(super) fn cheapest(&mut self, tuning: &Tuning) -> Option<Cheapest> {
        let part = Mask::first(self.rows.len());
        self.priced.clear();
        self.price::<WORDS>(&part, 0, tuning);
        let best = self.priced.iter().min_by(|a, b| a.cmp(b))?;
        let amount = Cost::of(&self.sides(best.row as usize, &part).counts()).amount;
        Some(Cheapest { piece: self.order[best.row as usize], amount, reward: amount - best.cost })
    }

    /// The number of rows whose planes have all pieces on one side.
    pub(super) fn one_sided(&self) -> usize {
        self.rows.iter().filter(|row| row.front.is_empty() || row.back.is_empty()).count()
    }

    /// The rows of lowest cost that the last choice compared; none if it was a plane without cuts.
    pub(in crate::build) fn rows_of_low_cost(&mut self, count: usize) -> SmallVec<[usize; 8]> {
        self.priced.sort_unstable_by(Priced::cmp);
        self.priced.iter().take(count).map(|priced| priced.row as usize).collect()
    }

    /// Keeps copies of the pieces and the rows of a part.
    pub(in crate::build) fn save(&mut self, part: &Mask) {
        self.saved.clear();
        self.saved.extend(part.iter().map(|place| (place, self.pieces[place], self.rows[place])));
    }

    /// Takes back the copies.
    pub(in crate::build) fn restore(&mut self) {
        for &(place, piece, row) in &self.saved {
            (self.pieces[place], self.rows[place]) = (piece, row);
        }
    }

    /// Of the rows whose planes cut nothing, the first of lowest cost.
    fn best_without_cuts<const N: usize>(&self, part: &Mask, first: usize) -> Option<usize> {
        let mut best = (f64::INFINITY, None);
        for row in part.iter() {
            let this = &self.rows[row];
            if !this.cuts_some::<N>(part, first) {
                let cost = Cost::of(&this.counts::<N>(part, first).0).amount;
                if cost < best.0 {
                    best = (cost, Some(row));
                }
            }
        }
        best.1
    }

    /// Finds the costs of all rows of a part. Returns the mean share of the part that a plane cuts.
    fn price<const N: usize>(&mut self, part: &Mask, first: usize, tuning: &Tuning) -> f64 {
        let (count, mut cuts) = (part.count(), 0);
        for row in part.iter() {
            let (counts, risk) = self.rows[row].counts::<N>(part, first);
            cuts += u64::from(counts.splits);
            let cost = Cost::of(&counts).amount;
            self.priced.push(Priced { cost, cuts: counts.splits, risk, row: row as u32 });
        }
        let density = cuts as f64 / (count * count) as f64;
        let share = density / (density + tuning.risk_at);
        let weight = tuning.risk * share * work_of_one_more(count);
        for priced in &mut self.priced {
            priced.cost -= weight * f64::from(priced.risk);
        }
        density
    }

    /// Of the `few` planes of lowest cost, the one that cuts the fewest pieces together with the next planes.
    fn best_of<const N: usize>(
        &mut self,
        few: usize,
        part: &Mask,
        first: usize,
        tuning: &Tuning,
        axis: Option<Divided>,
    ) -> Chosen {
        let next = |sides: &Sides| {
            let mut next = 0;
            for side in [sides.front, sides.back] {
                for row in side.iter() {
                    next += self.rows[row].cuts::<N>(&side, first);
                }
            }
            next
        };
        let score = |cuts: usize, sides: &Sides| match few {
            1 => 0.0,
            _ => cuts as f64 + tuning.next_cuts * f64::from(next(sides)),
        };
        let mut best = (f64::INFINITY, f64::INFINITY, u32::MAX);
        for priced in &self.priced[..few] {
            let score = score(priced.cuts as usize, &self.sides(priced.row as usize, part));
            let this = (score, priced.cost, priced.row);
            if this < best {
                best = this;
            }
        }
        if let Some(axis) = axis {
            let cost = Cost::of(&axis.sides.counts()).amount;
            if (score(axis.sides.cuts().count(), &axis.sides), cost) < (best.0, best.1) {
                return Chosen::Axis(axis);
            }
        }
        Chosen::Row(best.2 as usize)
    }

    /// The best axis plane of a part, by rounded ends of pieces.
    fn axis_plane(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        part: &Mask,
    ) -> Result<Option<PricedPlane>, Error> {
        self.gathered.clear();
        self.gathered.extend(part.iter().map(|piece| self.pieces[piece]));
        self.free.find(&Set::new(set.faces, &self.gathered, set.arena), rules)
    }

    /// How any plane divides a part; `None` if it has all pieces on one side, or separates coplanar pieces.
    fn divide(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        part: &Mask,
        plane: PlaneId,
    ) -> Result<Option<Divided>, Error> {
        let plane = set.prepare(plane);
        let (mut sides, mut near) = (Sides::default(), Mask::default());
        for place in part.iter() {
            let (side, is_near) = self.pieces[place].side_and_reach(set.faces, &plane, set.arena);
            match side {
                Side::Front => sides.front.set(place, true),
                Side::Back => sides.back.set(place, true),
                Side::Coplanar => sides.on.set(place, true),
                Side::Spanning => {
                    sides.front.set(place, true);
                    sides.back.set(place, true);
                }
            }
            near.set(place, is_near);
        }
        if sides.front == *part || sides.back == *part {
            return Ok(None);
        }
        let rival = self.rival_of(rules, set, (&plane, sides, near), &[])?;
        Ok(rival.is_none().then_some(Divided { plane, sides }))
    }

    /// The row that replaces a row, so that coplanar pieces stay together; see [`settle`](super::settle).
    pub(in crate::build) fn settled(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        row: usize,
        part: &Mask,
    ) -> Result<usize, Error> {
        follow_rivals(row, |row, tried| {
            let rival = self.rival(rules, set, row, part, tried)?;
            Ok((Some(self.pieces[row].face), rival))
        })
    }

    /// The row of the largest piece of a pair of coplanar pieces that the plane of a row separates.
    pub(in crate::build) fn rival(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        row: usize,
        part: &Mask,
        tried: &[u32],
    ) -> Result<Option<usize>, Error> {
        let (plane, near) = (self.planes[row], self.rows[row].near);
        self.rival_of(rules, set, (&plane, self.sides(row, part), near), tried)
    }

    /// The same for any plane; `near` are the pieces near it.
    fn rival_of(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        (plane, Sides { front, back, on }, near): (&PreparedPlane, Sides, Mask),
        tried: &[u32],
    ) -> Result<Option<usize>, Error> {
        let beside = near & (front | back);
        if !self.are_paired(on, beside) {
            return Ok(None);
        }
        self.on.clear();
        self.on.extend(on.iter().map(|piece| piece as u32));
        self.beside.clear();
        self.beside.extend(beside.iter().map(|piece| piece as u32));
        let is_cut = |piece: u32| (front & back).contains(piece as usize);
        let set = set.over(&self.pieces);
        let lists: [&[u32]; 2] = [&self.on, &self.beside];
        let face = larger(&set, plane, lists, is_cut, tried, rules.watch)?;
        let is_of = |face: u32| (on | beside).iter().find(|&piece| self.pieces[piece].face == face);
        Ok(face.and_then(is_of))
    }

    /// Whether some piece on a plane and some piece beside it are coplanar: the plane of one contains the other.
    fn are_paired(&self, on: Mask, beside: Mask) -> bool {
        let has_some_of = |piece: usize, others: Mask| {
            let Row { front, back, .. } = self.rows[piece];
            !(others & !front & !back).is_empty()
        };
        beside.iter().any(|piece| has_some_of(piece, on))
            || on.iter().any(|piece| has_some_of(piece, beside))
    }

    /// The rows of a part whose planes cut a piece.
    pub(in crate::build) fn cut_by(&self, piece: usize, part: &Mask) -> Mask {
        self.rows[piece].cut_by & *part
    }

    /// Replaces a piece by a part of it. `before` are the rows whose planes cut the whole piece.
    pub(in crate::build) fn replace(
        &mut self,
        set: &Set<'_>,
        (piece, new): (usize, Piece),
        before: Mask,
        part: &Mask,
    ) {
        self.pieces[piece] = new;
        let mut still = Mask::default();
        for row in (before & *part).iter() {
            let cut = new.side(set.faces, &self.planes[row], set.arena);
            let Row { front, back, .. } = &mut self.rows[row];
            front.set(piece, matches!(cut, Side::Front | Side::Spanning));
            back.set(piece, matches!(cut, Side::Back | Side::Spanning));
            still.set(row, cut == Side::Spanning);
        }
        self.rows[piece].cut_by = still;
    }
}

#[cfg(test)]
mod tests;
