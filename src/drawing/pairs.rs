//! Pairs of polygons that overlap in the picture, so the painting order has to follow the depths of the
//! polygons.

use std::collections::HashSet;
use std::hash::BuildHasherDefault;
use std::ops::Range;

use smallvec::SmallVec;

use super::cell::{NOWHERE, Rect, are_apart};
use super::graph::{Interval, Pair, Wanted};
use super::lines::{HalfPlane, Mixer};
use super::map::{each, sort_unique};
use super::passes::Passing;
use super::primitives::{FEW_CORNERS, Primitives};
use super::quadtree::{
    CUT, Candidate, Candidates, Leaf, SubTile, TINIEST, Tile, TileList, VISITED, Visible, found_in,
};
use crate::Error;
use crate::memory::reserve;
use crate::progress::Watch;

/// Pairs that were found so far, each once.
pub(super) type Found = HashSet<Pair, BuildHasherDefault<Mixer>>;

/// All pairs of several sets, sorted and without repetitions.
pub(super) fn sorted(parts: Vec<Found>, watch: &Watch<'_>) -> Result<Vec<Pair>, Error> {
    let mut pairs: Vec<Pair> = parts.into_iter().flatten().collect();
    sort_unique(&mut pairs, watch)?;
    Ok(pairs)
}

/// Leaves, and the opaque faces and the translucent items that may reach into the leaves.
struct LeafLists<'l, 'p> {
    leaves: &'l [Leaf],
    /// The intervals of the polygons that are visible in each leaf.
    shown: &'l [Intervals],
    opaque: Candidates<'p>,
    translucent: Candidates<'p>,
}

/// The hulls of some polygons' intervals: of the intervals of one number, and of the others.
#[derive(Clone, Copy)]
struct Intervals([Interval; 2]);

impl Intervals {
    const NONE: Self = Self([Interval::NONE; 2]);

    fn of(interval: Interval) -> Self {
        match interval.is_one() {
            true => Self([interval, Interval::NONE]),
            false => Self([Interval::NONE, interval]),
        }
    }

    fn hull(self, other: &Self) -> Self {
        Self([0, 1].map(|kind: usize| self.0[kind].hull(&other.0[kind])))
    }

    /// Whether an interval may meet one of the intervals.
    fn may_meet(&self, interval: &Interval) -> bool {
        interval.meets(&self.0[1]) || !interval.is_one() && interval.meets(&self.0[0])
    }
}

/// A face that may be below a visible cell.
struct Below {
    face: Candidate,
    node: u32,
    interval: Interval,
}

/// Finds the requested pairs.
struct Search<'s, 'p> {
    primitives: &'p Primitives<'p>,
    /// A number for a face's polygon, or `u32::MAX` if the polygon is not visible.
    place: &'s (dyn Fn(u32) -> u32 + Sync),
    wanted: Wanted<'s>,
    watch: &'s Watch<'s>,
}

/// All requested pairs, sorted. `place` returns a number for a face's polygon, or `u32::MAX` if the polygon
/// is not visible. Pairs contain these numbers for opaque polygons, and item numbers for translucent items.
pub(super) fn pairs<'p>(
    primitives: &'p Primitives<'p>,
    leaves: &[Leaf],
    place: &(dyn Fn(u32) -> u32 + Sync),
    wanted: Wanted<'_>,
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let search = Search { primitives, place, wanted, watch };
    let is_opaque = |face: u32| primitives.views[face as usize].is_opaque;
    let is_below = |face: u32| {
        let node = place(face);
        is_opaque(face) && node != u32::MAX && !(wanted.below)(node).is_none()
    };
    let is_seen_through = |item: u32| {
        let face = primitives.face(item);
        !is_opaque(face) && place(face) != u32::MAX
    };
    let mut shown = Vec::new();
    reserve(&mut shown, leaves.len())?;
    for leaf in each(watch, VISITED, leaves) {
        let opaque = leaf?.cells.iter().filter(|visible| primitives.is_opaque(visible.item));
        let intervals = opaque.map(|visible| (wanted.above)(place(primitives.face(visible.item))));
        shown.push(intervals.map(Intervals::of).fold(Intervals::NONE, |a, b| a.hull(&b)));
    }
    let all = LeafLists {
        leaves,
        shown: &shown,
        opaque: Candidates::faces(primitives, is_below)?,
        translucent: Candidates::items(primitives, is_seen_through)?,
    };
    let halves = |part: &_| search.halves(part);
    let leaf = |part: &_, found: &mut Found| search.leaf(part, found);
    sorted(found_in(all, halves, leaf, watch)?, watch)
}

impl<'p> Search<'_, 'p> {
    /// The first and the second half of the leaves; `None` for a single leaf, and if nothing is below or above.
    fn halves<'l>(&self, all: &LeafLists<'l, 'p>) -> Result<Option<[LeafLists<'l, 'p>; 2]>, Error> {
        let LeafLists { leaves, shown, opaque, translucent } = all;
        if leaves.len() < 2 || opaque.list.is_empty() && translucent.list.is_empty() {
            return Ok(None);
        }
        let part = |range: Range<usize>| {
            let (leaves, shown) = (&leaves[range.clone()], &shown[range]);
            let around = around(leaves);
            let intervals = shown.iter().fold(Intervals::NONE, Intervals::hull);
            let may_meet = |face: u32| intervals.may_meet(&(self.wanted.below)((self.place)(face)));
            let opaque = opaque.narrowed(&around, may_meet, self.watch)?;
            let translucent = translucent.narrowed(&around, |_| true, self.watch)?;
            Ok(LeafLists { leaves, shown, opaque, translucent })
        };
        let middle = leaves.len() / 2;
        Ok(Some([part(0..middle)?, part(middle..leaves.len())?]))
    }

    /// Adds the pairs of a single leaf.
    fn leaf(&self, part: &LeafLists<'_, 'p>, found: &mut Found) -> Result<(), Error> {
        let LeafLists { leaves, opaque, translucent, .. } = part;
        if opaque.list.is_empty() && translucent.list.is_empty() {
            return Ok(());
        }
        let &Self { primitives, place, wanted, watch } = self;
        // No opaque face is visible above a face whose whole part in the tile is visible.
        let cells = || leaves.iter().flat_map(|leaf| &leaf.cells);
        let mut whole: Vec<u32> = Vec::new();
        for Leaf { tile, cells } in *leaves {
            for visible in cells {
                let face = primitives.face(visible.item);
                watch.work(primitives.edges_work(face))?;
                if is_whole(primitives, tile, visible) {
                    whole.push(face);
                }
            }
        }
        whole.sort_unstable();
        let is_below = |face: &&Candidate| whole.binary_search(&face.number).is_err();
        let below = opaque.list.iter().filter(is_below).map(|&face| {
            let node = place(face.number);
            Below { face, node, interval: (wanted.below)(node) }
        });
        // Those of one number come last.
        let (mut below, ones): (Vec<_>, Vec<_>) = below.partition(|face| !face.interval.is_one());
        let many = below.len();
        below.extend(ones);
        for visible in cells() {
            let Visible { item, cell } = visible;
            if !translucent.list.is_empty() {
                self.add_blended(translucent, visible, found)?;
            }
            if !primitives.is_opaque(*item) {
                continue;
            }
            let above = place(primitives.face(*item));
            let interval = (wanted.above)(above);
            let around = cell.around();
            let below = if interval.is_one() { &below[..many] } else { &below[..] };
            for below in each(watch, VISITED, below) {
                let Below { face, node, interval: other } = below?;
                let pair = Pair { below: *node, above };
                let is_apart = are_apart(&around, opaque.around(face.number));
                if is_apart
                    || pair.below == above
                    || !interval.meets(other)
                    || !(wanted.is_wanted)(pair)
                    || found.contains(&pair)
                {
                    continue;
                }
                watch.work(CUT)?;
                if cell.meets(&primitives.lines, opaque.halves_of(face), watch)? {
                    found.insert(pair);
                }
            }
        }
        Ok(())
    }

    /// Adds the pairs of a visible cell with translucent items. Two translucent items need one pair, which
    /// the cell of the rear item adds.
    fn add_blended(
        &self,
        translucent: &Candidates<'_>,
        &Visible { item, ref cell }: &Visible,
        found: &mut Found,
    ) -> Result<(), Error> {
        let &Self { primitives, place, watch, .. } = self;
        let (face, is_opaque) = (primitives.face(item), primitives.is_opaque(item));
        let own = if is_opaque { place(face) } else { item };
        let around = cell.around();
        for candidate in each(watch, CUT, &translucent.list) {
            let candidate = candidate?;
            let other = candidate.number;
            let pair = match other < item {
                true => Pair { below: own, above: other },
                false if is_opaque => Pair { below: other, above: own },
                false => break,
            };
            let is_apart = are_apart(&around, translucent.around(other));
            if is_apart || primitives.face(other) == face || found.contains(&pair) {
                continue;
            }
            if cell.meets(&primitives.lines, translucent.halves_of(candidate), watch)? {
                found.insert(pair);
            }
        }
        Ok(())
    }
}

/// Whether a visible cell is everything that a tile contains of the cell's face: each side of the cell lies
/// on a border of the tile or on an edge of the face.
fn is_whole(primitives: &Primitives<'_>, tile: &Tile, visible: &Visible) -> bool {
    let outline = primitives.outline(primitives.face(visible.item));
    let sides = visible.cell.sides.iter().map(|side| side.half);
    // Edges of other faces may lie on the borders of other tiles.
    let mut sides = sides.filter(|half| !tile.has_border(*half));
    // For most faces, comparing all edges is faster.
    if outline.len() <= FEW_CORNERS {
        return sides.all(|side| outline.iter().any(|half| half.line() == side.line()));
    }
    let mut own: Vec<_> = outline.iter().map(|half| half.line()).collect();
    own.sort_unstable();
    sides.all(|side| own.binary_search(&side.line()).is_ok())
}

/// The box around leaves.
pub(super) fn around(leaves: &[Leaf]) -> Rect {
    leaves.iter().fold(NOWHERE, |[low, high], leaf| {
        let [from, to] = leaf.tile.sides();
        let axes = [0, 1];
        [axes.map(|i: usize| low[i].min(from[i])), axes.map(|i: usize| high[i].max(to[i]))]
    })
}

/// A tile is not halved if at most this many items lie between any two consecutive items that cover the tile.
/// Too small: more tiles. Too large: more pairs are compared.
const FEW: usize = 8;

/// Sorted pairs of items that overlap in the picture, by item numbers. Not all overlapping pairs are listed,
/// but the listed pairs imply the order of all: where an item covers a part of the picture, items behind this
/// item are not paired with items in front of this item.
pub(super) fn overlaps<'p>(
    primitives: &'p Primitives<'_>,
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let halves = |list: &TileList<'p>| {
        let between = list.candidates.list.split(Candidate::covers);
        let most = between.map(<[_]>::len).max().unwrap_or(0);
        let is_leaf = most <= FEW || list.is_small(TINIEST);
        (!is_leaf).then(|| list.halves(watch)).transpose()
    };
    let leaf = |list: &TileList<'p>, found: &mut Found| {
        let whole = SubTile::new(list, Passing::nothing(primitives.lines.frame.faces), watch)?;
        whole.for_each_part(|part| add_overlaps(&part, primitives, found, watch), watch)
    };
    let all = TileList::picture(Candidates::items(primitives, |_| true)?, watch)?;
    sorted(found_in(all, halves, leaf, watch)?, watch)
}

/// Adds the pairs of a part of the picture.
fn add_overlaps(
    part: &SubTile<'_, '_>,
    primitives: &Primitives<'_>,
    found: &mut Found,
    watch: &Watch<'_>,
) -> Result<(), Error> {
    let mut add = |below: u32, above: u32| {
        found.insert(Pair { below, above });
    };
    // The last item that covers the part so far, and the items behind it.
    let mut cover: Option<u32> = None;
    let mut behind: Vec<&Visible> = Vec::new();
    for piece in &part.pieces {
        let (item, face) = (piece.item, primitives.face(piece.item));
        watch.work(behind.len() * CUT)?;
        if part.is_covered_by(piece) {
            if let (Some(cover), true) = (cover, behind.is_empty()) {
                add(item, cover);
            }
            behind.drain(..).for_each(|above| add(item, above.item));
            cover = Some(item);
            continue;
        }
        if let Some(cover) = cover {
            add(item, cover);
        }
        let halves: SmallVec<[HalfPlane; 8]> =
            piece.cell.sides.iter().map(|side| side.half).collect();
        for above in &behind {
            if primitives.face(above.item) != face
                && above.cell.meets(&primitives.lines, &halves, watch)?
            {
                add(item, above.item);
            }
        }
        behind.push(piece);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Interval, Intervals};
    use crate::random::SplitMix64;

    /// A face is left out of a part only if its interval meets none of the part. An interval of one number may be
    /// compared with other intervals of one number, of which no two polygons have the same.
    #[test]
    fn the_hulls_of_intervals_miss_none_that_is_met() {
        let mut random = SplitMix64::new(3);
        let mut seen = [0; 2];
        for round in 0..4000_usize {
            let mut interval = |most: u64| match random.next() % 8 {
                0 => Interval::NONE,
                _ => {
                    let first = (random.next() % 40) as u32;
                    Interval::new(first, first + (random.next() % most) as u32)
                }
            };
            let above: Vec<Interval> = (0..round % 6).map(|_| interval(4)).collect();
            let below = interval(3);
            let hull =
                above.iter().map(|&a| Intervals::of(a)).fold(Intervals::NONE, |a, b| a.hull(&b));
            let is_wanted =
                |a: &Interval| a.meets(&below) && !(a.is_one() && below.is_one()) && !a.is_none();
            let is_met = !below.is_none() && above.iter().any(is_wanted);
            let may_meet = hull.may_meet(&below);
            assert!(may_meet || !is_met, "{below:?} {above:?}");
            seen[usize::from(may_meet)] += 1;
        }
        assert!(seen[0] > 1000 && seen[1] > 500, "{seen:?}");
    }
}
