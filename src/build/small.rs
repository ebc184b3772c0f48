//! Builds the subtree of a small set from a table of the sides of all pieces, and makes trials of subtrees.

use smallvec::{SmallVec, smallvec};

use super::choose::{ChooseContext, Chosen, Divided, Mask, Set, Sides, Table};
use super::piece::{Piece, Splitter, compact};
use super::subtree::{Builder, CUT, Shared};
use crate::error::Error;
use crate::exact::{PlaneId, Vertex};
use crate::tree::parts::{RawChild, RawNode};

/// A part of the set that is still to be divided.
#[derive(Debug)]
struct Pending {
    part: Mask,
    /// The number of nodes above the part; 0 in trials.
    depth: usize,
    /// The length of the arena that the part needs.
    arena: usize,
    /// The first of the pieces that were cut to make the part.
    first_cut: usize,
}

/// A piece of a pending part that was cut.
#[derive(Debug)]
struct CutPiece {
    /// The place in the table.
    place: usize,
    /// The part of the piece behind the plane.
    behind: Piece,
    /// The rows whose planes cut the whole piece.
    cut_by: Mask,
}

/// The parts still to be divided, the next part on top, and their pieces that were cut.
#[derive(Debug, Default)]
struct Stack {
    pending: Vec<Pending>,
    cut_pieces: Vec<CutPiece>,
}

impl Stack {
    fn clear(&mut self) {
        self.pending.clear();
        self.cut_pieces.clear();
    }

    /// Cuts pieces of a part by a plane: the parts in front take their places in the table. Returns the place of the
    /// first of them in the list of cut pieces.
    fn cut(
        &mut self,
        shared: &Shared<'_>,
        (table, splitter, arena): (&mut Table, &mut Splitter, &mut Vec<Vertex>),
        Divided { plane, sides }: &Divided,
        part: &Mask,
    ) -> Result<usize, Error> {
        let first = self.cut_pieces.len();
        for place in sides.cuts().iter() {
            let whole = table.pieces[place];
            let [in_front, behind] = splitter.cut(shared.faces, plane, &whole, arena)?;
            let cut_by = table.cut_by(place, part);
            self.cut_pieces.push(CutPiece { place, behind, cut_by });
            table.pieces[place] = in_front;
        }
        Ok(first)
    }

    /// Classifies the parts in front, of the cut pieces from `first` on, in the part with them.
    fn classify_front(
        &self,
        shared: &Shared<'_>,
        (table, arena): (&mut Table, &[Vertex]),
        first: usize,
        part: &Mask,
    ) {
        let set = shared.bare_set(arena);
        for &CutPiece { place, cut_by, .. } in &self.cut_pieces[first..] {
            let piece = table.pieces[place];
            table.replace(&set, (place, piece), cut_by, part);
        }
    }

    /// Takes the next part and its depth, and puts the parts behind of its cut pieces into the table.
    fn resume(
        &mut self,
        shared: &Shared<'_>,
        table: &mut Table,
        arena: &mut Vec<Vertex>,
    ) -> Option<(Mask, usize)> {
        let Pending { part, depth, arena: len, first_cut } = self.pending.pop()?;
        arena.truncate(len);
        let set = shared.bare_set(arena);
        for CutPiece { place, behind, cut_by } in self.cut_pieces.drain(first_cut..) {
            table.replace(&set, (place, behind), cut_by, &part);
        }
        Some((part, depth))
    }
}

/// The table and the lists of a small set, reused.
#[derive(Debug, Default)]
pub(super) struct SmallSet {
    table: Table,
    stack: Stack,
    /// The parts of a trial.
    trial: Stack,
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
            Chosen::Axis(axis) => axis.plane.id(),
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
        self.small.stack.clear();
        loop {
            let SmallSet { table, stack, .. } = &mut self.small;
            let resumed = || stack.resume(shared, table, &mut self.arena);
            let Some((part, depth)) = next.take().or_else(resumed) else { return Ok(()) };
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
            let mut divided = self.settled(shared, &part, chosen)?;
            if shared.rules.trials > 1
                && count <= shared.rules.tuning.most_tried
                && !divided.sides.cuts().is_empty()
            {
                divided = self.best_by_trials(shared, &part, divided)?;
            }
            let (front, back) = self.divide_small(shared, &divided, &part, depth)?;
            self.small.stack.pending.extend(back);
            next = front.map(|front| (front, depth + 1));
        }
    }

    /// The plane that replaces a chosen plane of a part, so that coplanar pieces stay together.
    fn settled(
        &mut self,
        shared: &Shared<'_>,
        part: &Mask,
        chosen: Chosen,
    ) -> Result<Divided, Error> {
        let (table, set) = (&mut self.small.table, shared.bare_set(&self.arena));
        match chosen {
            Chosen::Axis(divided) => Ok(divided),
            Chosen::Row(row) => {
                let row = table.settled(&shared.rules, &set, row, part)?;
                Ok(table.divided(row, part))
            }
        }
    }

    /// Of the plane that was chosen last and the planes of other rows of low cost, the plane whose subtree of a part
    /// has the fewest cuts.
    fn best_by_trials(
        &mut self,
        shared: &Shared<'_>,
        part: &Mask,
        chosen: Divided,
    ) -> Result<Divided, Error> {
        let trials = shared.rules.trials;
        let rows = self.small.table.rows_of_low_cost(trials);
        if rows.is_empty() {
            return Ok(chosen);
        }
        let most = part.count() * shared.rules.tuning.most_cuts;
        let mut best = (self.cuts_after(shared, part, &chosen, most)?, chosen);
        if best.0 == most {
            return Ok(chosen);
        }
        let mut tried: SmallVec<[PlaneId; 8]> = smallvec![chosen.plane.id()];
        for row in rows {
            let this = self.settled(shared, part, Chosen::Row(row))?;
            if tried.len() == trials {
                break;
            }
            if !tried.contains(&this.plane.id()) {
                tried.push(this.plane.id());
                let cuts = self.cuts_after(shared, part, &this, best.0)?;
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
        first: &Divided,
        most: usize,
    ) -> Result<usize, Error> {
        let arena = self.arena.len();
        self.small.table.save(part);
        self.small.trial.clear();
        let cuts = self.try_subtree(shared, part, first, most);
        self.small.table.restore();
        self.arena.truncate(arena);
        cuts
    }

    /// The same; leaves the table and the arena as they are after the subtree.
    fn try_subtree(
        &mut self,
        shared: &Shared<'_>,
        part: &Mask,
        first: &Divided,
        most: usize,
    ) -> Result<usize, Error> {
        let (mut cuts, mut next, mut first) = (0, Some(*part), Some(*first));
        loop {
            let SmallSet { table, trial, .. } = &mut self.small;
            let resumed = || trial.resume(shared, table, &mut self.arena).map(|(part, _)| part);
            let Some(part) = next.take().or_else(resumed) else { return Ok(cuts) };
            shared.rules.watch.work(part.count() * part.count() / 64)?;
            let divided = match first.take() {
                Some(first) => first,
                None => {
                    let set = shared.bare_set(&self.arena);
                    let chosen = self.small.table.choose(&shared.rules, &set, &part)?;
                    self.settled(shared, &part, chosen)?
                }
            };
            let Sides { front, back, .. } = divided.sides;
            cuts += divided.sides.cuts().count();
            if cuts >= most {
                return Ok(most);
            }
            shared.rules.watch.work(divided.sides.cuts().count() * CUT)?;
            let Self { small: SmallSet { table, trial, .. }, splitter, arena, .. } = self;
            let first_cut = trial.cut(shared, (table, splitter, arena), &divided, &part)?;
            if front.count() > 1 {
                trial.classify_front(shared, (table, arena), first_cut, &front);
                next = Some(front);
            }
            if back.count() > 1 {
                let arena = arena.len();
                trial.pending.push(Pending { part: back, depth: 0, arena, first_cut });
            } else {
                trial.cut_pieces.truncate(first_cut);
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
        let SmallSet { table, stack: Stack { pending, cut_pieces }, .. } = &mut self.small;
        // Each place in the table is used by one part at most: a pending part whose piece was cut has it in the list.
        let (mut used, mut end) = (*part, cut_pieces.len());
        for pending in pending.iter().rev() {
            let cut = &cut_pieces[pending.first_cut..end];
            let is_cut: Mask = cut.iter().map(|piece| piece.place).collect();
            used = used | pending.part & !is_cut;
            end = pending.first_cut;
        }
        let whole = table.pieces.iter_mut().enumerate();
        let whole = whole.filter(|(place, _)| used.contains(*place)).map(|(_, piece)| piece);
        let pieces = whole.chain(cut_pieces.iter_mut().map(|piece| &mut piece.behind));
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
            let divided = table.divided(row, &rest);
            self.divide_small(shared, &divided, &rest, depth + layers)?;
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
        divided: &Divided,
        part: &Mask,
        depth: usize,
    ) -> Result<(Option<Mask>, Option<Pending>), Error> {
        let Sides { front, back, on } = divided.sides;
        let depth = depth + 1;
        shared.budget.check_depth(depth)?;
        let cuts = (front & back).count();
        if cuts > 0 {
            // The budget is checked before the cuts, so that a set with too many pieces is stopped in time.
            shared.budget.count(cuts)?;
            shared.rules.watch.work(cuts * CUT)?;
        }
        let Self { small: SmallSet { table, stack, .. }, splitter, arena, .. } = self;
        let first_cut = stack.cut(shared, (table, splitter, arena), divided, part)?;
        self.output.parts.cuts += cuts;
        self.own.clear();
        self.own.extend(on.iter().map(|place| self.small.table.pieces[place]));
        let own = self.store_own(shared)?;
        let child = |pieces: Mask| match pieces.count() {
            count @ 0..=1 => RawChild::Leaf(count as u32),
            _ => RawChild::Node,
        };
        let node =
            RawNode { plane: divided.plane.id(), own, front: child(front), back: child(back) };
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
            let piece = if is_cut {
                self.small.stack.cut_pieces[first_cut].behind
            } else {
                self.small.table.pieces[place]
            };
            self.store(shared, &piece)?;
        }
        self.output.push_node(node)?;
        let SmallSet { table, stack, .. } = &mut self.small;
        let front = (node.front == RawChild::Node).then_some(front);
        if let Some(front) = &front {
            stack.classify_front(shared, (table, &self.arena), first_cut, front);
        }
        let arena = self.arena.len();
        let pending = Pending { part: back, depth, arena, first_cut };
        let back = (node.back == RawChild::Node).then_some(pending);
        if back.is_none() {
            stack.cut_pieces.truncate(first_cut);
        }
        Ok((front, back))
    }
}
