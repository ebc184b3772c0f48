//! Pairs of polygons that overlap in the picture, so the painting order has to follow the depths of the
//! polygons.

use std::collections::HashSet;
use std::hash::BuildHasherDefault;

use smallvec::SmallVec;

use super::cell::{NOWHERE, Rect, are_apart};
use super::graph::{Pair, Wanted};
use super::lines::{HalfPlane, Mixer};
use super::map::{each, sort_unique};
use super::passes::Passing;
use super::primitives::{FEW_CORNERS, Primitives};
use super::quadtree::{
    CUT, Candidate, Candidates, Leaf, SubTile, TINIEST, Tile, TileList, VISITED, Visible, found_in,
};
use crate::Error;
use crate::progress::Watch;

/// Pairs that were found so far, each once.
pub(super) type Found = HashSet<Pair, BuildHasherDefault<Mixer>>;

/// All pairs of several sets, sorted and without repetitions.
pub(super) fn sorted(parts: Vec<Found>, watch: &Watch<'_>) -> Result<Vec<Pair>, Error> {
    let mut pairs: Vec<Pair> = parts.into_iter().flatten().collect();
    sort_unique(&mut pairs, watch)?;
    Ok(pairs)
}

/// Leaves, and for each leaf the opaque faces and the translucent items that may reach into the leaf.
struct LeafLists<'l, 'p> {
    leaves: &'l [Leaf],
    opaque: Candidates<'p>,
    translucent: Candidates<'p>,
}

/// All requested pairs, sorted. `place` returns a number for a face's polygon, or `u32::MAX` if the polygon
/// is not visible. Pairs contain these numbers for opaque polygons, and item numbers for translucent items.
pub(super) fn pairs<'l, 'p>(
    primitives: &'p Primitives<'_>,
    leaves: &'l [Leaf],
    place: &(dyn Fn(u32) -> u32 + Sync),
    wanted: Wanted<'_>,
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let shows = |face: u32| place(face) != u32::MAX;
    let is_opaque = |face: u32| primitives.views[face as usize].is_opaque;
    let is_seen_through = |item: u32| {
        let face = primitives.face(item);
        !is_opaque(face) && shows(face)
    };
    let all = LeafLists {
        leaves,
        opaque: Candidates::faces(primitives, |face| is_opaque(face) && shows(face))?,
        translucent: Candidates::items(primitives, is_seen_through)?,
    };
    let halves = |part: &LeafLists<'l, 'p>| part.halves(watch);
    let leaf = |part: &LeafLists<'l, 'p>, found: &mut Found| {
        part.leaf(primitives, place, wanted, found, watch)
    };
    sorted(found_in(all, halves, leaf, watch)?, watch)
}

impl LeafLists<'_, '_> {
    /// The first and the second half of the leaves; `None` for a single leaf.
    fn halves(&self, watch: &Watch<'_>) -> Result<Option<[Self; 2]>, Error> {
        if self.leaves.len() < 2 {
            return Ok(None);
        }
        let (first, second) = self.leaves.split_at(self.leaves.len() / 2);
        let part = |leaves| {
            let around = around(leaves);
            let opaque = self.opaque.narrowed(&around, watch)?;
            let translucent = self.translucent.narrowed(&around, watch)?;
            Ok(Self { leaves, opaque, translucent })
        };
        Ok(Some([part(first)?, part(second)?]))
    }

    /// Adds the pairs of a single leaf.
    fn leaf(
        &self,
        primitives: &Primitives<'_>,
        place: &(dyn Fn(u32) -> u32 + Sync),
        wanted: Wanted<'_>,
        found: &mut Found,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let Self { leaves, opaque, .. } = self;
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
        let mut below: Vec<Candidate> = Vec::with_capacity(opaque.list.len());
        let is_below = |face: &&Candidate| whole.binary_search(&face.number).is_err();
        below.extend(opaque.list.iter().filter(is_below));
        let is_marked = |face: &&Candidate| (wanted.is_marked)(place(face.number));
        let marked: Vec<Candidate> = below.iter().filter(is_marked).copied().collect();
        for visible in cells() {
            let Visible { item, cell } = visible;
            if !self.translucent.list.is_empty() {
                self.add_blended(primitives, place, visible, found, watch)?;
            }
            if !primitives.is_opaque(*item) {
                continue;
            }
            let above = place(primitives.face(*item));
            let around = cell.around();
            let below = match ((wanted.is_marked)(above), wanted.needs_both) {
                (true, false) => &below,
                (true, true) | (false, false) => &marked,
                (false, true) => continue,
            };
            for face in each(watch, VISITED, below) {
                let face = face?;
                let pair = Pair { below: place(face.number), above };
                let is_apart = are_apart(&around, opaque.around(face.number));
                if is_apart
                    || pair.below == above
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
        primitives: &Primitives<'_>,
        place: &(dyn Fn(u32) -> u32 + Sync),
        &Visible { item, ref cell }: &Visible,
        found: &mut Found,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let (face, is_opaque) = (primitives.face(item), primitives.is_opaque(item));
        let own = if is_opaque { place(face) } else { item };
        let around = cell.around();
        for candidate in each(watch, CUT, &self.translucent.list) {
            let candidate = candidate?;
            let other = candidate.number;
            let pair = match other < item {
                true => Pair { below: own, above: other },
                false if is_opaque => Pair { below: other, above: own },
                false => break,
            };
            let is_apart = are_apart(&around, self.translucent.around(other));
            if is_apart || primitives.face(other) == face || found.contains(&pair) {
                continue;
            }
            if cell.meets(&primitives.lines, self.translucent.halves_of(candidate), watch)? {
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
