//! The sides of all pieces of a small set at all planes that may divide the set, as bits.
//!
//! Each piece is classified once at each plane. From then on, bits tell how a plane divides any part of the set.
//! Only the two parts of a cut piece are classified again, at the planes that cut the whole piece: a part of a
//! piece that is on one side is on the same side.

use std::array::from_fn;
use std::mem::take;
use std::ops::{BitAnd, BitOr, Not, Range};

use smallvec::SmallVec;

use super::ChooseContext;
use super::axis_planes::FreePlanes;
use super::coplanar::{follow_rivals, larger};
use super::cost::{Cost, Counts, work};
use super::peel::arrange;
use super::set::{LANES, PackedBox, PackedPieces, PackedPlane, Reach, Set};
use super::tuning::Tuning;
use crate::Error;
use crate::bits::bits;
use crate::build::piece::Piece;
use crate::exact::{PlaneId, PreparedPlane, Side};

/// The number of words of a mask.
const WORDS: usize = 4;

/// The most pieces of a table.
const MOST_PIECES: usize = 64 * WORDS;

/// The most axis planes of a table, along each axis: a part has a bit for each, of 32.
const MOST_AXIS_PLANES: usize = 10;

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

/// A plane, and the pieces on its sides.
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

    /// The number of pieces that the plane cuts.
    #[inline]
    fn cuts<const N: usize>(&self, mask: &Mask, first: usize) -> u32 {
        let cut = |word: usize| self.front.0[word] & self.back.0[word] & mask.0[word];
        (first..first + N).map(|word| cut(word).count_ones()).sum()
    }
}

/// A part of a set: some pieces of the table, and the axis planes that may divide them.
#[derive(Clone, Copy, Debug)]
pub(in crate::build) struct Part {
    pub(in crate::build) pieces: Mask,
    /// A bit for each axis plane.
    axes: u32,
}

impl Part {
    /// Some pieces of the part, with the same axis planes.
    pub(in crate::build) fn of(&self, pieces: Mask) -> Self {
        Self { pieces, ..*self }
    }
}

/// How a plane divides a part: the pieces that reach in front of it, that reach behind it, and on it.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::build) struct Sides {
    pub(in crate::build) front: Mask,
    pub(in crate::build) back: Mask,
    pub(in crate::build) on: Mask,
}

/// The planes that cut a piece before it was cut.
#[derive(Clone, Copy, Debug)]
pub(in crate::build) struct CutBy {
    own: Mask,
    axes: u32,
}

/// A row whose plane may divide a part.
#[derive(Clone, Copy, Debug)]
struct Priced {
    cost: Cost,
    /// The number of pieces that the plane cuts.
    cuts: u32,
    /// The number of planes that cut the plane's own piece.
    risk: u32,
    row: u32,
}

/// The pieces of a small set, and their sides at the planes that may divide it.
#[derive(Debug, Default)]
pub(in crate::build) struct Table {
    pub(in crate::build) pieces: Vec<Piece>,
    /// The planes of the pieces, in the order of the pieces, and then the axis planes.
    rows: Vec<Row>,
    planes: Vec<PreparedPlane>,
    packed: PackedPieces,
    /// A box around each block of packed pieces.
    boxes: Vec<PackedBox>,
    priced: Vec<Priced>,
    /// The numbers of the set's pieces in the order of the table.
    order: Vec<usize>,
    /// The pieces of a part.
    gathered: Vec<Piece>,
    free: FreePlanes,
    /// The starts and the ends of the pieces along an axis.
    ends: [Vec<f64>; 2],
    /// The pieces on a plane, and those beside it.
    on: Vec<u32>,
    beside: Vec<u32>,
}

impl Table {
    /// Whether a set is small enough for a table.
    pub(in crate::build) fn holds(set: &Set<'_>, tuning: &Tuning) -> bool {
        set.len() <= MOST_PIECES.min(tuning.small)
            && (0..set.len()).map(|piece| set.vertices(piece)).sum::<usize>() <= MOST_CORNERS
    }

    /// Fills the table with a set, and returns the whole set.
    pub(in crate::build) fn fill(&mut self, set: &Set<'_>, tuning: &Tuning) -> Part {
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
            let plane = self.packed.plane(set, piece);
            self.add_row(set, set.own_plane(piece), &plane, piece);
        }
        for row in 0..n {
            for piece in (self.rows[row].front & self.rows[row].back).iter() {
                self.rows[piece].cut_by.set(row, true);
            }
        }
        for axis in 0..3 {
            self.add_axis_planes(set, axis, tuning.axis_planes.min(MOST_AXIS_PLANES));
        }
        self.pieces = pieces;
        Part { pieces: Mask::first(n), axes: ((1_u64 << (self.rows.len() - n)) - 1) as u32 }
    }

    /// Classifies all pieces at a plane. `own` is the piece of the plane, if any.
    fn add_row(&mut self, set: &Set<'_>, plane: PlaneId, packed: &PackedPlane, own: usize) {
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
        if own < set.len() {
            all.set(own, false);
        }
        let prepared = set.prepare(plane);
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

    /// Adds some planes across an axis, spread over the set: of the places where pieces begin, those that
    /// cut the fewest pieces.
    fn add_axis_planes(&mut self, set: &Set<'_>, axis: usize, count: usize) {
        let (n, [starts, ends]) = (set.len(), &mut self.ends);
        if n < 3 {
            return;
        }
        for (list, side) in [(&mut *starts, 0), (&mut *ends, 1)] {
            list.clear();
            list.extend(set.pieces.iter().map(|piece| [piece.min, piece.max][side][axis]));
            list.sort_unstable_by(f64::total_cmp);
        }
        let mut found: SmallVec<[f64; MOST_AXIS_PLANES]> = SmallVec::new();
        let mut ended = 0;
        for step in 0..count {
            let mut best = (usize::MAX, 0.0);
            for begun in (step * n / count).max(1)..(step + 1) * n / count {
                let at = starts[begun];
                // Of equal starts, the first.
                if at == starts[begun - 1] {
                    continue;
                }
                while ended < n && ends[ended] <= at {
                    ended += 1;
                }
                let cuts = begun - ended.min(begun);
                if cuts < best.0 {
                    best = (cuts, at);
                }
            }
            if best.0 < usize::MAX {
                found.push(best.1);
            }
        }
        for at in found {
            let touches = |piece: &&Piece| piece.min[axis] == at && piece.min_is_corner(axis);
            let corner = set
                .pieces
                .iter()
                .filter(touches)
                .find_map(|piece| piece.corner_at(set.faces, axis, at));
            if let Some(corner) = corner {
                let plane = PlaneId::axis(axis, corner);
                let packed = self.packed.axis_plane(axis, at);
                self.add_row(set, plane, &packed, usize::MAX);
            }
        }
    }

    /// The number of pieces of the whole set.
    fn len(&self) -> usize {
        self.pieces.len()
    }

    /// The plane of a row.
    pub(in crate::build) fn plane(&self, row: usize) -> &PreparedPlane {
        &self.planes[row]
    }

    /// How the plane of a row divides a part.
    pub(in crate::build) fn sides(&self, row: usize, part: &Part) -> Sides {
        let Row { front, back, .. } = self.rows[row];
        let pieces = part.pieces;
        Sides { front: front & pieces, back: back & pieces, on: pieces & !front & !back }
    }

    /// The row whose plane divides a part at the lowest cost. Forgets axis planes that do not divide the part.
    pub(in crate::build) fn best(&mut self, part: &mut Part, tuning: &Tuning) -> usize {
        let words = part.pieces.words();
        match words.len() {
            0 | 1 => self.best_in::<1>(part, words.start, tuning),
            2 => self.best_in::<2>(part, words.start, tuning),
            _ => self.best_in::<WORDS>(part, 0, tuning),
        }
    }

    /// The same, for a part with all pieces in `N` words from `first`.
    fn best_in<const N: usize>(&mut self, part: &mut Part, first: usize, tuning: &Tuning) -> usize {
        let (count, n) = (part.pieces.count(), self.len());
        self.priced.clear();
        let mut cuts = 0;
        for row in part.pieces.iter() {
            let (counts, risk) = self.rows[row].counts::<N>(&part.pieces, first);
            cuts += u64::from(counts.splits);
            let cost = Cost::of(&counts);
            self.priced.push(Priced { cost, cuts: counts.splits, risk, row: row as u32 });
        }
        for axis in bits(part.axes.into()) {
            let (counts, _) = self.rows[n + axis].counts::<N>(&part.pieces, first);
            let Counts { front, back, splits } = counts;
            if front + splits == count as u32 || back + splits == count as u32 {
                part.axes &= !(1 << axis);
            } else {
                let cost = Cost::of(&counts);
                self.priced.push(Priced { cost, cuts: splits, risk: 0, row: (n + axis) as u32 });
            }
        }
        let density = cuts as f64 / (count * count) as f64;
        let share = density / (density + tuning.risk_at);
        let weight = tuning.risk * share * 1.25 * work(count) / count as f64;
        for priced in &mut self.priced {
            priced.cost.amount -= weight * f64::from(priced.risk);
        }
        let less = |a: &&Priced, b: &&Priced| a.cost.cmp(&b.cost).then(a.row.cmp(&b.row));
        match self.priced.iter().min_by(less) {
            Some(best) if best.cost.cuts && density < tuning.risk_at => {
                self.best_of_pairs::<N>(part, first, tuning)
            }
            best => best.map_or(0, |best| best.row as usize),
        }
    }

    /// Of the rows of lowest cost, the one whose plane and the next planes together cut the fewest pieces.
    fn best_of_pairs<const N: usize>(
        &mut self,
        part: &Part,
        first: usize,
        tuning: &Tuning,
    ) -> usize {
        let few = tuning.pairs.clamp(1, self.priced.len());
        if few < self.priced.len() {
            let less = |a: &Priced, b: &Priced| a.cost.cmp(&b.cost).then(a.row.cmp(&b.row));
            self.priced.select_nth_unstable_by(few, less);
        }
        let score = |priced: &Priced| {
            let Sides { front, back, .. } = self.sides(priced.row as usize, part);
            let mut next = 0;
            for side in [front, back] {
                for row in side.iter() {
                    next += self.rows[row].cuts::<N>(&side, first);
                }
            }
            f64::from(priced.cuts) + tuning.next_cuts * f64::from(next)
        };
        let mut best = (f64::INFINITY, f64::INFINITY, u32::MAX);
        for priced in &self.priced[..few] {
            let this = (score(priced), priced.cost.amount, priced.row);
            if this < best {
                best = this;
            }
        }
        best.2 as usize
    }

    /// An axis plane that cuts nothing of a part and has fewer pieces on each side.
    pub(in crate::build) fn gap(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        part: &Part,
    ) -> Result<Option<(PreparedPlane, Sides)>, Error> {
        self.gathered.clear();
        self.gathered.extend(part.pieces.iter().map(|piece| self.pieces[piece]));
        let gathered = Set::new(set.faces, &self.gathered, set.arena).with(set.planes);
        let Some(free) = self.free.clean(&gathered, rules.tuning) else { return Ok(None) };
        let plane = gathered.prepare(free.plane);
        let (mut sides, mut near) = (Sides::default(), Mask::default());
        for place in part.pieces.iter() {
            let piece = &self.pieces[place];
            let cut = piece.cut_vertices(set.arena);
            let (side, is_near) = plane.classify_and_reach(set.faces, piece.face, cut);
            match side {
                Side::Front => sides.front.set(place, true),
                Side::Back => sides.back.set(place, true),
                Side::Coplanar => sides.on.set(place, true),
                // Rounded ends of pieces found the plane.
                Side::Spanning => return Ok(None),
            }
            near.set(place, is_near);
        }
        let divides = sides.front != part.pieces && sides.back != part.pieces;
        let keeps_pairs = self.rival_of(rules, set, (&plane, sides, near), &[])?.is_none();
        Ok((divides && keeps_pairs).then_some((plane, sides)))
    }

    /// The row that replaces a row, so that coplanar pieces stay together; see [`settle`](super::settle).
    pub(in crate::build) fn settled(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        row: usize,
        part: &Part,
    ) -> Result<usize, Error> {
        follow_rivals(row, |row, tried| {
            let rival = self.rival(rules, set, row, part, tried)?;
            Ok((self.pieces.get(row).map(|piece| piece.face), rival))
        })
    }

    /// The row of the largest piece of a pair of coplanar pieces that the plane of a row separates.
    pub(in crate::build) fn rival(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
        row: usize,
        part: &Part,
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

    /// The planes that cut a piece.
    pub(in crate::build) fn cut_by(&self, piece: usize, part: &Part) -> CutBy {
        let n = self.len();
        let cuts = |axis: &usize| {
            let Row { front, back, .. } = self.rows[n + axis];
            (front & back).contains(piece)
        };
        let axes = bits(part.axes.into()).filter(cuts).fold(0, |axes, axis| axes | 1 << axis);
        CutBy { own: self.rows[piece].cut_by, axes }
    }

    /// Replaces a piece by a part of it. `before` are the planes that cut the whole piece.
    pub(in crate::build) fn replace(
        &mut self,
        set: &Set<'_>,
        (piece, new): (usize, Piece),
        before: CutBy,
        part: &Part,
    ) {
        let n = self.len();
        self.pieces[piece] = new;
        let mut still = Mask::default();
        let own = (before.own & part.pieces).iter();
        for row in own.chain(bits((before.axes & part.axes).into()).map(|axis| n + axis)) {
            let cut = new.side(set.faces, &self.planes[row], set.arena);
            let Row { front, back, .. } = &mut self.rows[row];
            front.set(piece, matches!(cut, Side::Front | Side::Spanning));
            back.set(piece, matches!(cut, Side::Back | Side::Spanning));
            if cut == Side::Spanning && row < n {
                still.set(row, true);
            }
        }
        self.rows[piece].cut_by = still;
    }
}

#[cfg(test)]
mod tests;
