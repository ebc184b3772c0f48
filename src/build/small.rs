//! Builds the subtree of a small set from a table of the sides of all pieces at all planes.

use super::choose::{ChooseContext, Chosen, Mask, Set, Sides, Table};
use super::piece::{Piece, compact};
use super::subtree::{Builder, CUT, Shared};
use crate::error::Error;
use crate::exact::{PlaneId, PreparedPlane};
use crate::tree::parts::{RawChild, RawNode};

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

/// The table and the lists of a small set, reused.
#[derive(Debug, Default)]
pub(super) struct SmallSet {
    table: Table,
    /// A stack of the parts still to be divided, the next part on top.
    pending: Vec<Pending>,
    /// The cut pieces of pending parts: the place in the table, the part of the piece behind the plane, and the
    /// planes that cut the whole piece.
    cut: Vec<(usize, Piece, Mask)>,
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
        self.small.pending.clear();
        self.small.cut.clear();
        loop {
            let (part, depth) = match next {
                Some(next) => next,
                None => match self.resume(shared) {
                    Some(resumed) => resumed,
                    None => return Ok(()),
                },
            };
            let count = part.count();
            shared.rules.watch.work(count * count / 64)?;
            if self.arena.len() > self.compact_at {
                self.compact_small(shared, base, &part)?;
            }
            let set = shared.bare_set(&self.arena);
            let table = &mut self.small.table;
            let (plane, sides) = match table.choose(&shared.rules, &set, &part)? {
                Chosen::Axis(plane, sides) => (plane, sides),
                Chosen::Row(row) => {
                    let Sides { front, back, .. } = table.sides(row, &part);
                    if front.is_empty() || back.is_empty() {
                        let (rest, layers) = self.peel(shared, &part, depth)?;
                        if layers > 0 {
                            next = (rest.count() > 1).then_some((rest, depth + layers));
                            continue;
                        }
                    }
                    let set = shared.bare_set(&self.arena);
                    let table = &mut self.small.table;
                    let row = table.settled(&shared.rules, &set, row, &part)?;
                    (*table.plane(row), table.sides(row, &part))
                }
            };
            let (front, back) = self.divide_small(shared, (&plane, sides), &part, depth)?;
            self.small.pending.extend(back);
            next = front.map(|front| (front, depth + 1));
        }
    }

    /// Takes the next part from the stack, and puts the pieces that were cut to make the part into the table.
    fn resume(&mut self, shared: &Shared<'_>) -> Option<(Mask, usize)> {
        let SmallSet { table, pending, cut } = &mut self.small;
        let Pending { part, depth, arena, cut: first } = pending.pop()?;
        self.arena.truncate(arena);
        let set = shared.bare_set(&self.arena);
        for (place, piece, before) in cut.drain(first..) {
            table.replace(&set, (place, piece), before, &part);
        }
        Some((part, depth))
    }

    /// [Compacts](compact) the arena from `base` on, the arena's length before the first cut. `part` is the part
    /// that is divided next.
    fn compact_small(
        &mut self,
        shared: &Shared<'_>,
        base: usize,
        part: &Mask,
    ) -> Result<(), Error> {
        let SmallSet { table, pending, cut } = &mut self.small;
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
        let first = self.small.cut.len();
        let cuts = (front & back).count();
        if cuts > 0 {
            // The budget is checked before the cuts, so that a set with too many pieces is stopped in time.
            shared.budget.count(cuts)?;
            shared.rules.watch.work(cuts * CUT)?;
            for place in (front & back).iter() {
                let SmallSet { table, cut, .. } = &mut self.small;
                let whole = table.pieces[place];
                let parts = self.splitter.cut(shared.faces, plane, &whole, &mut self.arena)?;
                cut.push((place, parts[1], table.cut_by(place, part)));
                table.pieces[place] = parts[0];
            }
            self.output.parts.cuts += cuts;
        }
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
                if is_cut { self.small.cut[first].1 } else { self.small.table.pieces[place] };
            self.store(shared, &piece)?;
        }
        self.output.push_node(node)?;
        let SmallSet { table, cut, .. } = &mut self.small;
        let front = (node.front == RawChild::Node).then(|| front);
        if let Some(part) = &front {
            let set = shared.bare_set(&self.arena);
            for &(place, _, before) in &cut[first..] {
                let piece = table.pieces[place];
                table.replace(&set, (place, piece), before, part);
            }
        }
        let back = (node.back == RawChild::Node).then(|| {
            let arena = self.arena.len();
            Pending { part: back, depth, arena, cut: first }
        });
        if back.is_none() {
            cut.truncate(first);
        }
        Ok((front, back))
    }
}
