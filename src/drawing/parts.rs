//! Parts of polygons that are painted at once.

use std::cmp::Reverse;

use super::cell::Cell;
use super::halving::{CUT, VISITED};
use super::join::Groups;
use super::order::{Ordered, cycles, order};
use super::outline::Area;
use super::pairs::Pair;
use super::paths::{Drawing, add_piece};
use super::reporter::{each, finish_item, sort_by, sort_unique};
use super::rims::Rims;
use super::stock::Stock;
use super::visible::{Leaf, Visible};
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{collect, filled, push, reserve};

/// Each piece of a polygon is joined, if it can be, with so many at most that come next in the order.
const NEXT: usize = 16;

/// What is painted at once: items of one polygon.
pub(super) struct Parts {
    of_item: Vec<u32>,
    /// The items of each, one face after another.
    items: Vec<Vec<u32>>,
    /// Pairs of items that touch, which an order of the parts can keep beside those that overlap.
    touching: Vec<Pair>,
}

impl Parts {
    /// Parts of which an order is left that keeps the pairs of items that overlap, and as many as can be of
    /// others that only touch: those the order of the tree may not keep.
    pub(super) fn new(
        stock: &Stock<'_>,
        overlaps: &[Pair],
        touching: &[Pair],
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let units = units(stock, overlaps, watch)?;
        let count = units.iter().max().map_or(0, |&most| most as usize + 1);
        let all = overlaps.iter().chain(touching);
        let cycles = cycles(count, &contracted(all, &units, watch)?, watch)?;
        // Units in no cycle are whole. The pieces of the others start by themselves.
        let mut nodes: Vec<u32> = Vec::new();
        for item in each(watch, 1, 0..units.len() as u32) {
            let item = item?;
            if cycles[units[item as usize] as usize].is_some() {
                push(&mut nodes, item)?;
            }
        }
        // What is further back has a higher number as an item, and a lower one as a node.
        let cycle = |item: u32| cycles[units[item as usize] as usize];
        let key = |item: u32| (cycle(item), Reverse(item));
        sort_by(&mut nodes, watch, |&a, &b| key(a).cmp(&key(b)))?;
        let mut node_of: Vec<u32> = collect(units.iter().map(|_| u32::MAX))?;
        for (node, &item) in (0..).zip(&nodes) {
            node_of[item as usize] = node;
        }
        let in_nodes = |pair: &Pair| {
            let [a, b] = [pair.below, pair.above].map(cycle);
            (a.is_some() && a == b).then(|| pair.map(|item| node_of[item as usize]))
        };
        let mut pairs = Vec::new();
        for pair in each(watch, VISITED, overlaps) {
            if let Some(pair) = in_nodes(pair?) {
                push(&mut pairs, pair)?;
            }
        }
        let mut groups = Groups::new(nodes.len(), &pairs, watch)?;
        let mut kept = Vec::new();
        for pair in each(watch, VISITED, touching) {
            let pair = pair?;
            let is_kept = match in_nodes(pair) {
                Some(pair) => groups.add(pair, watch)?,
                None => true,
            };
            if is_kept {
                push(&mut kept, *pair)?;
            }
        }
        for (a, b) in candidates(&nodes, &units, watch)? {
            groups.join(a, b, watch)?;
        }
        // A part for each unit that is whole, and for each group.
        let mut of_item = units;
        for (node, &item) in (0..).zip(&nodes) {
            of_item[item as usize] = count as u32 + groups.group(node);
        }
        let mut items: Vec<Vec<u32>> = collect((0..count + nodes.len()).map(|_| Vec::new()))?;
        for placed in each(watch, VISITED, (0..).zip(&of_item)) {
            let (item, &part) = placed?;
            push(&mut items[part as usize], item)?;
        }
        for items in &mut items {
            sort_by(items, watch, |&a, &b| stock.face(a).cmp(&stock.face(b)))?;
        }
        Ok(Self { of_item, items, touching: kept })
    }

    /// An order to paint the parts in: it keeps all pairs of items, and else that of the tree. Where something is
    /// hidden, `leaves` have what shows, and opaque polygons in cycles are clipped.
    pub(super) fn order(
        &self,
        stock: &Stock<'_>,
        pairs: &[Pair],
        leaves: Option<&[Leaf]>,
        watch: &Watch<'_>,
    ) -> Result<Ordered, Error> {
        let count = stock.items.len() as u32;
        let rank = |items: &Vec<u32>| items.iter().map(|item| count - item).min().unwrap_or(0);
        let ranks = collect(self.items.iter().map(rank))?;
        let is_opaque = |part: u32| {
            let first = self.items[part as usize].first();
            leaves.is_some() && first.is_some_and(|&item| stock.is_opaque(item))
        };
        let pairs = contracted(pairs.iter().chain(&self.touching), &self.of_item, watch)?;
        order(self.items.len(), &pairs, &ranks, &is_opaque, watch)
    }

    /// The place of each item's part in an order.
    pub(super) fn places(&self, ordered: &Ordered, watch: &Watch<'_>) -> Result<Vec<u32>, Error> {
        let mut places = filled(self.items.len(), 0)?;
        for placed in each(watch, 1, (0..).zip(&ordered.order)) {
            let (place, &part) = placed?;
            places[part as usize] = place;
        }
        watch.work(self.of_item.len())?;
        collect(self.of_item.iter().map(|&part| places[part as usize]))
    }

    /// The parts in order, as filled outlines: a phase. With them how many the first parts have, for each number
    /// of parts.
    pub(super) fn drawing(
        &self,
        stock: &Stock<'_>,
        rims: &Rims<'_>,
        ordered: &Ordered,
        leaves: Option<&[Leaf]>,
        watch: &Watch<'_>,
    ) -> Result<(Drawing, Vec<u32>), Error> {
        let cells = leaves.map(|leaves| self.cells(leaves, watch)).transpose()?;
        let mut drawing = Drawing::empty(stock.frame.rays.size());
        let count = ordered.order.len();
        reserve(&mut drawing.paths, count)?;
        let counts = Counts::of(stock)?;
        let mut paths = Vec::new();
        reserve(&mut paths, count + 1)?;
        paths.push(0);
        let mut area = Area::default();
        for (i, &part) in ordered.order.iter().enumerate() {
            watch.work(CUT)?;
            let items = &self.items[part as usize];
            let shown = cells.as_ref().map(|cells| &cells[part as usize]);
            let is_clipped = ordered.is_clipped[part as usize];
            area.clear();
            match shown {
                Some(cells) if cells.is_empty() => {}
                Some(cells) if is_clipped => {
                    for cell in each(watch, VISITED, cells) {
                        area.push(&cell?.sides)?;
                    }
                }
                _ => counts.add_pieces(stock, rims, items, &mut area, watch)?,
            }
            if !area.is_empty() {
                let polygon = stock.polygon(items[0]);
                let is_part = is_clipped || (items.len() as u32) < counts.of_polygon[polygon];
                drawing.push(polygon, is_part, &area, &rims.lines, watch)?;
            }
            paths.push(drawing.paths.len() as u32);
            finish_item(watch, i, count);
        }
        Ok((drawing, paths))
    }

    /// What shows of each.
    fn cells<'l>(
        &self,
        leaves: &'l [Leaf],
        watch: &Watch<'_>,
    ) -> Result<Vec<Vec<&'l Cell>>, Error> {
        let mut cells: Vec<Vec<&Cell>> = collect(self.items.iter().map(|_| vec![]))?;
        for visible in each(watch, VISITED, leaves.iter().flat_map(|leaf| &leaf.cells)) {
            let Visible { item, cell } = visible?;
            push(&mut cells[self.of_item[*item as usize] as usize], cell)?;
        }
        Ok(cells)
    }
}

/// How many items there are.
struct Counts {
    of_face: Vec<u32>,
    of_polygon: Vec<u32>,
}

impl Counts {
    fn of(stock: &Stock<'_>) -> Result<Self, Error> {
        let mut of_face: Vec<u32> = collect(stock.views.iter().map(|_| 0))?;
        stock.items.iter().for_each(|item| of_face[item.face as usize] += 1);
        let count = (0..stock.items.len() as u32).map(|item| stock.polygon(item) + 1).max();
        let mut of_polygon: Vec<u32> = collect((0..count.unwrap_or(0)).map(|_| 0))?;
        (0..stock.items.len() as u32).for_each(|item| of_polygon[stock.polygon(item)] += 1);
        Ok(Self { of_face, of_polygon })
    }

    /// Adds items to an area, those of one face after another.
    fn add_pieces(
        &self,
        stock: &Stock<'_>,
        rims: &Rims<'_>,
        items: &[u32],
        area: &mut Area,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        for same in items.chunk_by(|&a, &b| stock.face(a) == stock.face(b)) {
            let face = stock.face(same[0]);
            // The outline of a face is its own where none of its pieces is missing.
            if same.len() as u32 == self.of_face[face as usize] {
                add_piece(&rims.lines, rims.known_outline(face), area, watch)?;
                continue;
            }
            for item in each(watch, CUT, same) {
                add_piece(&rims.lines, rims.known_item(stock, *item?), area, watch)?;
            }
        }
        Ok(())
    }
}

/// The number of each item's polygon, or, of polygons that lie over themselves, of its face.
fn units(stock: &Stock<'_>, overlaps: &[Pair], watch: &Watch<'_>) -> Result<Vec<u32>, Error> {
    let polygon = |item: u32| stock.polygon(item);
    let count = (0..stock.items.len() as u32).map(polygon).max().map_or(0, |most| most + 1);
    let mut is_folded: Vec<bool> = collect((0..count).map(|_| false))?;
    for pair in each(watch, VISITED, overlaps) {
        let Pair { below, above } = *pair?;
        let [below, above] = [below, above].map(polygon);
        is_folded[below] |= below == above;
    }
    let (mut of_polygon, mut of_face): (Vec<Option<u32>>, Vec<Option<u32>>) =
        (collect((0..count).map(|_| None))?, collect(stock.views.iter().map(|_| None))?);
    let (mut units, mut next) = (Vec::new(), 0);
    reserve(&mut units, stock.items.len())?;
    for item in each(watch, 1, 0..stock.items.len() as u32) {
        let item = item?;
        let polygon = polygon(item);
        let unit = match is_folded[polygon] {
            true => &mut of_face[stock.face(item) as usize],
            false => &mut of_polygon[polygon],
        };
        let number = *unit.get_or_insert(next);
        next += u32::from(number == next);
        units.push(number);
    }
    Ok(units)
}

/// The pairs between what items belong to.
fn contracted<'p>(
    of_items: impl Iterator<Item = &'p Pair>,
    of_item: &[u32],
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let mut pairs = Vec::new();
    for pair in each(watch, 1, of_items) {
        let pair = pair?.map(|item| of_item[item as usize]);
        if pair.below != pair.above {
            push(&mut pairs, pair)?;
        }
    }
    sort_unique(&mut pairs, watch)?;
    Ok(pairs)
}

/// Nodes of one unit, two at a time, those first that are nearest in the order: they have the fewest
/// between them. (Which are joined first hardly matters to how many are left.)
fn candidates(nodes: &[u32], units: &[u32], watch: &Watch<'_>) -> Result<Vec<(u32, u32)>, Error> {
    let unit = |node: u32| units[nodes[node as usize] as usize];
    let mut by_unit: Vec<u32> = collect(0..nodes.len() as u32)?;
    sort_by(&mut by_unit, watch, |&a, &b| unit(a).cmp(&unit(b)))?;
    let mut pairs = Vec::new();
    for same in by_unit.chunk_by(|&a, &b| unit(a) == unit(b)) {
        for numbered in each(watch, NEXT, same.iter().enumerate()) {
            let (i, &a) = numbered?;
            for &b in same[i + 1..].iter().take(NEXT) {
                push(&mut pairs, (a, b))?;
            }
        }
    }
    let key = |&(a, b): &(u32, u32)| (b - a, a);
    sort_by(&mut pairs, watch, |a, b| key(a).cmp(&key(b)))?;
    Ok(pairs)
}
