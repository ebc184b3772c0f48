//! Builds the subtree of a small set from a table of the sides of all pieces at all planes.

use super::choose::{ChooseContext, Chosen, Mask, Row, Set, Sides, Table};
use super::piece::{Piece, Splitter, compact};
use super::subtree::{Builder, CUT, Shared};
use crate::error::Error;
use crate::exact::{PlaneId, PreparedPlane, Vertex};
use crate::tree::parts::{RawChild, RawNode};

/// The most pieces of a part for which subtrees are tried. Too large: time. Too small: more fragments.
const MOST_TRIED: usize = 64;

/// A part of the set that is still to be divided.
#[derive(Debug)]
struct Pending {
    part: Mask,
    /// The number of nodes above the part.
    depth: usize,
    /// The length of the arena that the part needs.
    arena: usize,
    /// The first of the pieces that were cut to make the part.
    cut: usize,
}

/// The parts that are still to be divided.
#[derive(Debug, Default)]
pub(super) struct Parts {
    /// A stack, the next part on top.
    pending: Vec<Pending>,
    /// The cut pieces of pending parts: the place in the table, the part of the piece behind the plane, and the
    /// planes that cut the whole piece.
    cut: Vec<(usize, Piece, Mask)>,
}

impl Parts {
    pub(super) fn clear(&mut self) {
        self.pending.clear();
        self.cut.clear();
    }

    /// Cuts pieces of a part by a plane: the parts in front take their places in the table. Returns the first of the
    /// pieces in the list of cut pieces.
    fn cut(
        &mut self,
        shared: &Shared<'_>,
        (table, splitter, arena): (&mut Table, &mut Splitter, &mut Vec<Vertex>),
        (plane, places): (&PreparedPlane, Mask),
        part: &Mask,
    ) -> Result<usize, Error> {
        let first = self.cut.len();
        for place in places.iter() {
            let whole = table.pieces[place];
            let parts = splitter.cut(shared.faces, plane, &whole, arena)?;
            self.cut.push((place, parts[1], table.cut_by(place, part)));
            table.pieces[place] = parts[0];
        }
        Ok(first)
    }

    /// Classifies the parts in front of the pieces from `first` on.
    fn update(
        &self,
        shared: &Shared<'_>,
        table: &mut Table,
        arena: &[Vertex],
        first: usize,
        front: &Mask,
    ) {
        let set = shared.bare_set(arena);
        for &(place, _, before) in &self.cut[first..] {
            let piece = table.pieces[place];
            table.replace(&set, (place, piece), before, front);
        }
    }

    /// Takes the next part from the stack, and puts the pieces that were cut to make the part into the table.
    fn resume(
        &mut self,
        shared: &Shared<'_>,
        table: &mut Table,
        arena: &mut Vec<Vertex>,
    ) -> Option<(Mask, usize)> {
        let Pending { part, depth, arena: len, cut: first } = self.pending.pop()?;
        arena.truncate(len);
        let set = shared.bare_set(arena);
        for (place, piece, before) in self.cut.drain(first..) {
            table.replace(&set, (place, piece), before, &part);
        }
        Some((part, depth))
    }
}

/// The table and the lists of a small set, reused.
#[derive(Debug, Default)]
pub(super) struct SmallSet {
    table: Table,
    parts: Parts,
    /// The parts of a trial, and the places, pieces and rows before it.
    trial: Parts,
    saved: Vec<(usize, Piece, Row)>,
}

impl SmallSet {
    /// The best plane of a set, of which a table is filled for this purpose.
    pub(super) fn plane(
        &mut self,
        rules: &ChooseContext<'_>,
        set: &Set<'_>,
    ) -> Result<PlaneId, Error> {
        let part = self.table.fill(set);
        Ok(match self.table.choose(rules, set, &part)? {
            Chosen::Row(row) => self.table.plane(row).id(),
            Chosen::Axis(plane, _) => plane.id(),
        })
    }
}

impl Builder {
    /// Builds the subtree of the set on top of the stack, and removes the set.
    #[inline(never)]
    pub(super) fn build_small(
        &mut self,
        shared: &Shared<'_>,
        start: usize,
        depth: usize,
    ) -> Result<(), Error> {
        let set = Set::new(shared.faces, &self.pieces[start..], &self.arena).with(shared.planes);
        let work = set.len() * set.len() / 8;
        shared.rules.watch.work(work)?;
        let base = self.arena.len();
        let mut next = Some((self.small.table.fill(&set), depth));
        self.pieces.truncate(start);
        self.small.parts.clear();
        loop {
            let (part, depth) = match next {
                Some(next) => next,
                None => {
                    match self.small.parts.resume(shared, &mut self.small.table, &mut self.arena) {
                        Some(resumed) => resumed,
                        None => return Ok(()),
                    }
                }
            };
            let count = part.count();
            shared.rules.watch.work(count * count / 64)?;
            if self.arena.len() > self.compact_at {
                self.compact_small(shared, base, &part)?;
            }
            let set = shared.bare_set(&self.arena);
            let chosen = self.small.table.choose(&shared.rules, &set, &part)?;
            if let Chosen::Row(row) = chosen {
                let Sides { front, back, .. } = self.small.table.sides(row, &part);
                if front.is_empty() || back.is_empty() {
                    let (rest, layers) = self.peel(shared, &part, depth)?;
                    if layers > 0 {
                        next = (rest.count() > 1).then_some((rest, depth + layers));
                        continue;
                    }
                }
            }
            let (mut plane, mut sides) = self.settled(shared, &part, chosen)?;
            if shared.options.trials > 1 && count <= MOST_TRIED && !sides.cuts().is_empty() {
                (plane, sides) = self.best_by_trials(shared, &part, (plane, sides))?;
            }
            let (front, back) = self.divide_small(shared, (&plane, sides), &part, depth)?;
            self.small.parts.pending.extend(back);
            next = front.map(|front| (front, depth + 1));
        }
    }

    /// The plane that replaces a chosen plane of a part, so that coplanar pieces stay together.
    fn settled(
        &mut self,
        shared: &Shared<'_>,
        part: &Mask,
        chosen: Chosen,
    ) -> Result<(PreparedPlane, Sides), Error> {
        let (table, set) = (&mut self.small.table, shared.bare_set(&self.arena));
        match chosen {
            Chosen::Axis(plane, sides) => Ok((plane, sides)),
            Chosen::Row(row) => {
                let row = table.settled(&shared.rules, &set, row, part)?;
                Ok((*table.plane(row), table.sides(row, part)))
            }
        }
    }

    /// Of a chosen plane and the rows of lowest cost, the plane after which the fewest cuts follow in the subtree of a
    /// part.
    fn best_by_trials(
        &mut self,
        shared: &Shared<'_>,
        part: &Mask,
        chosen: (PreparedPlane, Sides),
    ) -> Result<(PreparedPlane, Sides), Error> {
        let rows = self.small.table.cheapest(shared.options.trials);
        let mut best = (self.cuts_after(shared, part, chosen, usize::MAX)?, chosen);
        for row in rows {
            let this = self.settled(shared, part, Chosen::Row(row))?;
            if this.0.id() != chosen.0.id() {
                let cuts = self.cuts_after(shared, part, this, best.0)?;
                if cuts < best.0 {
                    best = (cuts, this);
                }
            }
        }
        Ok(best.1)
    }

    /// The number of cuts in the subtree of a part that a plane divides; `most` if there are as many or more.
    fn cuts_after(
        &mut self,
        shared: &Shared<'_>,
        part: &Mask,
        first: (PreparedPlane, Sides),
        most: usize,
    ) -> Result<usize, Error> {
        let arena = self.arena.len();
        self.small.table.save(part, &mut self.small.saved);
        self.small.trial.clear();
        let cuts = self.try_subtree(shared, part, first, most);
        self.small.table.restore(&self.small.saved);
        self.arena.truncate(arena);
        cuts
    }

    fn try_subtree(
        &mut self,
        shared: &Shared<'_>,
        part: &Mask,
        first: (PreparedPlane, Sides),
        most: usize,
    ) -> Result<usize, Error> {
        let (mut cuts, mut first) = (0, Some(first));
        let mut next = Some(*part);
        loop {
            let SmallSet { table, trial, .. } = &mut self.small;
            let resumed = || trial.resume(shared, table, &mut self.arena).map(|(part, _)| part);
            let Some(part) = next.take().or_else(resumed) else { return Ok(cuts) };
            shared.rules.watch.work(part.count() * part.count() / 64)?;
            let (plane, sides) = match first.take() {
                Some(first) => first,
                None => {
                    let set = shared.bare_set(&self.arena);
                    let chosen = self.small.table.choose(&shared.rules, &set, &part)?;
                    self.settled(shared, &part, chosen)?
                }
            };
            cuts += sides.cuts().count();
            if cuts >= most {
                return Ok(most);
            }
            shared.rules.watch.work(sides.cuts().count() * CUT)?;
            let Self { small: SmallSet { table, trial, .. }, splitter, arena, .. } = self;
            let cut = trial.cut(shared, (table, splitter, arena), (&plane, sides.cuts()), &part)?;
            if sides.front.count() > 1 {
                trial.update(shared, table, arena, cut, &sides.front);
                next = Some(sides.front);
            }
            if sides.back.count() > 1 {
                trial.pending.push(Pending { part: sides.back, depth: 0, arena: arena.len(), cut });
            } else {
                trial.cut.truncate(cut);
            }
        }
    }

    /// [Compacts](compact) the arena from `base` on, the arena's length before the first cut. `part` is the part
    /// that is divided next.
    fn compact_small(
        &mut self,
        shared: &Shared<'_>,
        base: usize,
        part: &Mask,
    ) -> Result<(), Error> {
        let SmallSet { table, parts: Parts { pending, cut }, .. } = &mut self.small;
        // Each place in the table is used by one part at most: a pending part whose piece was cut has it in the list.
        let (mut used, mut end) = (*part, cut.len());
        for pending in pending.iter().rev() {
            let is_cut: Mask = cut[pending.cut..end].iter().map(|&(place, ..)| place).collect();
            used = used | pending.part & !is_cut;
            end = pending.cut;
        }
        let whole = table.pieces.iter_mut().enumerate();
        let whole = whole.filter(|(place, _)| used.contains(*place)).map(|(_, piece)| piece);
        let pieces = whole.chain(cut.iter_mut().map(|(_, piece, _)| piece));
        let lens = pending.iter_mut().map(|pending| &mut pending.arena);
        compact(&mut self.arena, base, pieces, lens)?;
        self.compacted(shared)
    }

    /// Separates pieces whose planes have all other pieces of a part on one side, in one pass: see
    /// `choose/peel.rs`. Returns the remaining pieces and the number of nodes.
    fn peel(
        &mut self,
        shared: &Shared<'_>,
        part: &Mask,
        depth: usize,
    ) -> Result<(Mask, usize), Error> {
        let (mut rest, mut layers) = (*part, 0);
        for row in part.iter() {
            if rest.count() < 2 {
                break;
            }
            let table = &mut self.small.table;
            let Sides { front, back, .. } = table.sides(row, &rest);
            if !rest.contains(row) || !front.is_empty() && !back.is_empty() {
                continue;
            }
            let set = shared.bare_set(&self.arena);
            if table.rival(&shared.rules, &set, row, &rest, &[])?.is_some() {
                continue;
            }
            let (plane, sides) = (*table.plane(row), table.sides(row, &rest));
            self.divide_small(shared, (&plane, sides), &rest, depth + layers)?;
            rest = front | back;
            layers += 1;
        }
        Ok((rest, layers))
    }

    /// Writes the node of a part that a plane divides. Returns the parts in front of the plane and
    /// behind it, unless they are leaves.
    fn divide_small(
        &mut self,
        shared: &Shared<'_>,
        (plane, Sides { front, back, on }): (&PreparedPlane, Sides),
        part: &Mask,
        depth: usize,
    ) -> Result<(Option<Mask>, Option<Pending>), Error> {
        let depth = depth + 1;
        shared.budget.check_depth(depth)?;
        let cuts = (front & back).count();
        if cuts > 0 {
            // The budget is checked before the cuts, so that a set with too many pieces is stopped in time.
            shared.budget.count(cuts)?;
            shared.rules.watch.work(cuts * CUT)?;
        }
        let Self { small: SmallSet { table, parts, .. }, splitter, arena, .. } = self;
        let first = parts.cut(shared, (table, splitter, arena), (plane, front & back), part)?;
        self.output.parts.cuts += cuts;
        self.own.clear();
        self.own.extend(on.iter().map(|place| self.small.table.pieces[place]));
        let own = self.store_own(shared)?;
        let child = |pieces: Mask| match pieces.count() {
            count @ 0..=1 => RawChild::Leaf(count as u32),
            _ => RawChild::Node,
        };
        let node = RawNode { plane: plane.id(), own, front: child(front), back: child(back) };
        // Leaves are stored directly after the node's own fragments and front before back.
        if node.front == RawChild::Leaf(1)
            && let Some(place) = front.iter().next()
        {
            let piece = self.small.table.pieces[place];
            self.store(shared, &piece)?;
        }
        if node.back == RawChild::Leaf(1)
            && let Some(place) = back.iter().next()
        {
            let is_cut = front.contains(place);
            let piece =
                if is_cut { self.small.parts.cut[first].1 } else { self.small.table.pieces[place] };
            self.store(shared, &piece)?;
        }
        self.output.push_node(node)?;
        let SmallSet { table, parts, .. } = &mut self.small;
        let front = (node.front == RawChild::Node).then_some(front);
        if let Some(front) = &front {
            parts.update(shared, table, &self.arena, first, front);
        }
        let back = (node.back == RawChild::Node).then(|| {
            let arena = self.arena.len();
            Pending { part: back, depth, arena, cut: first }
        });
        if back.is_none() {
            parts.cut.truncate(first);
        }
        Ok((front, back))
    }
}
