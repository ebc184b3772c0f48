//! Drawings in which nothing is hidden: polygons may be translucent.

use std::ops::ControlFlow;

use super::between::{NO_PATH, between};
use super::halving::{CUT, LINES};
use super::join::Groups;
use super::opaque::{Drawing, add_edges};
use super::order::{Ordered, cycles, order};
use super::overlaps::overlaps;
use super::pairs::Pair;
use super::rims::Rims;
use super::stock::Stock;
use super::tile::Tile;
use crate::Error;
use crate::build::Progress;
use crate::build::progress::{Watch, one_at_a_time};
use crate::memory::{collect, push, reserve};
use crate::overlay::Overlay;
use crate::raster::Rays;
use crate::tree::BspTree;

/// Each piece of a polygon is joined, if it can be, with so many at most that come next in the order.
const NEXT: usize = 16;

impl Drawing {
    /// The view of all polygons as filled outlines, nothing hidden: painted one over another, each with
    /// its polygon's opacity, they are the picture. Each point of each polygon is in one path.
    ///
    /// Polygons are whole where an order allows it. Of others, the pieces that the tree cut for all
    /// viewpoints are joined as far as an order of them is left for this one. A bent polygon that lies
    /// over itself in the picture has a path for each of its faces at least.
    ///
    /// The rays say whether polygons are drawn that are seen from behind; they have to be made for
    /// [`tree.faces()`](BspTree::faces). Where all polygons are opaque,
    /// [`VisibilityMap::drawing`](super::VisibilityMap::drawing) has fewer paths. Time and memory grow
    /// with the pairs of polygons that lie over one another with none between them.
    ///
    /// # Errors
    ///
    /// If there is not enough memory.
    pub fn translucent(tree: &BspTree, rays: Rays) -> Result<Self, Error> {
        Self::with_all(tree, rays, None, &Watch::default())
    }

    /// As [`translucent`](Self::translucent). Now and then `progress` is called with how far the drawing has
    /// come, by any thread, one at a time; if it returns `Break`, the drawing is cancelled.
    ///
    /// # Errors
    ///
    /// As for `translucent`, and [`Error`] if it was cancelled.
    pub fn translucent_with_progress(
        tree: &BspTree,
        rays: Rays,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<Self, Error> {
        let progress = one_at_a_time(progress);
        Self::with_all(tree, rays, None, &Watch::new(&progress))
    }

    /// As [`translucent`](Self::translucent), with the lines and points of an overlay of the same tree
    /// between the paths: see [`steps`](Self::steps). To have them above all, paint the runs of
    /// [`VisibilityMap::lines`](super::VisibilityMap::lines) last: nothing is cut then but what it says is
    /// hidden.
    ///
    /// No path is cut because of them; a segment is, where it goes from one place of the order to another.
    /// Each part comes after all that lies behind it, or that it lies on, and before what lies in front of
    /// it, as `lines` tells these apart. Lines and points in one place of the order come in input order, lines
    /// first, and so may those that cross in the picture.
    ///
    /// # Errors
    ///
    /// As for `translucent` and `lines`.
    pub fn translucent_with(tree: &BspTree, rays: Rays, overlay: &Overlay) -> Result<Self, Error> {
        overlay.expect_no_polygons(tree)?;
        Self::with_all(tree, rays, Some(overlay), &Watch::default())
    }

    fn with_all(
        tree: &BspTree,
        rays: Rays,
        overlay: Option<&Overlay>,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let size = rays.size();
        let stock = Stock::new(tree, rays, watch)?;
        let mut rims = Rims::new(&stock);
        for item in 0..stock.items.len() as u32 {
            watch.work(LINES)?;
            rims.item(&stock, item)?;
        }
        let overlaps = overlaps(&stock, &rims, Tile::picture(size), watch)?;
        let parts = Parts::new(&stock, &overlaps, watch)?;
        let Ordered { order, .. } = parts.order(&stock, &overlaps, watch)?;
        let mut pieces: Vec<u32> = collect(stock.views.iter().map(|_| 0))?;
        stock.items.iter().for_each(|item| pieces[item.face as usize] += 1);
        let count = (0..stock.items.len() as u32).map(|item| stock.polygon(item) + 1).max();
        let mut of_polygon: Vec<u32> = collect((0..count.unwrap_or(0)).map(|_| 0))?;
        (0..stock.items.len() as u32).for_each(|item| of_polygon[stock.polygon(item)] += 1);
        let mut drawing = Self::empty(size);
        reserve(&mut drawing.paths, order.len())?;
        let mut edges = Vec::new();
        let mut path_of: Vec<u32> = collect(stock.items.iter().map(|_| NO_PATH))?;
        for part in order {
            watch.work(CUT)?;
            let items = &parts.items[part as usize];
            edges.clear();
            for same in items.chunk_by(|&a, &b| stock.face(a) == stock.face(b)) {
                let face = stock.face(same[0]);
                // The outline of a face is its own where none of its pieces is missing.
                if same.len() as u32 == pieces[face as usize] {
                    add_edges(&rims.lines, rims.known_outline(face), &mut edges)?;
                    continue;
                }
                for &item in same {
                    add_edges(&rims.lines, rims.known_item(&stock, item), &mut edges)?;
                }
            }
            if !edges.is_empty() {
                let path = drawing.paths.len() as u32;
                items.iter().for_each(|&item| path_of[item as usize] = path);
                let polygon = stock.polygon(items[0]);
                let is_part = (items.len() as u32) < of_polygon[polygon];
                drawing.push(polygon, is_part, &edges)?;
            }
        }
        if let Some(overlay) = overlay {
            drawing.overlaid =
                between(&stock, &rims, &path_of, drawing.paths.len() as u32, overlay)?;
        }
        Ok(drawing)
    }
}

/// What is painted at once: items of one polygon.
struct Parts {
    of_item: Vec<u32>,
    /// The items of each, one face after another.
    items: Vec<Vec<u32>>,
}

impl Parts {
    fn new(stock: &Stock<'_>, overlaps: &[Pair], watch: &Watch<'_>) -> Result<Self, Error> {
        let units = units(stock, overlaps)?;
        let count = units.iter().max().map_or(0, |&most| most as usize + 1);
        let cycles = cycles(count, &contracted(overlaps, &units)?, watch)?;
        // Units in no cycle are whole. The pieces of the others start by themselves.
        let mut nodes: Vec<u32> = Vec::new();
        for item in 0..units.len() as u32 {
            if cycles[units[item as usize] as usize].is_some() {
                push(&mut nodes, item)?;
            }
        }
        // What is further back has a higher number as an item, and a lower one as a node.
        let cycle = |item: u32| cycles[units[item as usize] as usize];
        nodes.sort_unstable_by_key(|&item| (cycle(item), std::cmp::Reverse(item)));
        let mut node_of: Vec<u32> = collect(units.iter().map(|_| u32::MAX))?;
        for (node, &item) in (0..).zip(&nodes) {
            node_of[item as usize] = node;
        }
        let is_within = |pair: &&Pair| {
            let [a, b] = [pair.below, pair.above].map(cycle);
            a.is_some() && a == b
        };
        let mut pairs = Vec::new();
        for &Pair { below, above } in overlaps.iter().filter(is_within) {
            let [below, above] = [below, above].map(|item| node_of[item as usize]);
            push(&mut pairs, Pair { below, above })?;
        }
        let mut groups = Groups::new(nodes.len(), &pairs)?;
        for (a, b) in candidates(&nodes, &units)? {
            groups.join(a, b, watch)?;
        }
        // A part for each unit that is whole, and for each group.
        let mut of_item = units;
        for (node, &item) in (0..).zip(&nodes) {
            of_item[item as usize] = count as u32 + groups.group(node);
        }
        let mut items: Vec<Vec<u32>> = collect((0..count + nodes.len()).map(|_| Vec::new()))?;
        for (item, &part) in (0..).zip(&of_item) {
            push(&mut items[part as usize], item)?;
        }
        for items in &mut items {
            items.sort_by_key(|&item| stock.face(item));
        }
        Ok(Self { of_item, items })
    }

    /// An order to paint parts in: it keeps all pairs, and else that of the tree.
    fn order(
        &self,
        stock: &Stock<'_>,
        overlaps: &[Pair],
        watch: &Watch<'_>,
    ) -> Result<Ordered, Error> {
        let count = stock.items.len() as u32;
        let rank = |items: &Vec<u32>| items.iter().map(|item| count - item).min().unwrap_or(0);
        let ranks = collect(self.items.iter().map(rank))?;
        order(self.items.len(), &contracted(overlaps, &self.of_item)?, &ranks, watch)
    }
}

/// The number of each item's polygon, or, of polygons that lie over themselves, of its face.
fn units(stock: &Stock<'_>, overlaps: &[Pair]) -> Result<Vec<u32>, Error> {
    let polygon = |item: u32| stock.polygon(item);
    let count = (0..stock.items.len() as u32).map(polygon).max().map_or(0, |most| most + 1);
    let mut is_folded: Vec<bool> = collect((0..count).map(|_| false))?;
    for pair in overlaps.iter().filter(|pair| polygon(pair.below) == polygon(pair.above)) {
        is_folded[polygon(pair.below)] = true;
    }
    let (mut of_polygon, mut of_face): (Vec<Option<u32>>, Vec<Option<u32>>) =
        (collect((0..count).map(|_| None))?, collect(stock.views.iter().map(|_| None))?);
    let (mut units, mut next) = (Vec::new(), 0);
    reserve(&mut units, stock.items.len())?;
    for item in 0..stock.items.len() as u32 {
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
fn contracted(overlaps: &[Pair], of_item: &[u32]) -> Result<Vec<Pair>, Error> {
    let mut pairs = Vec::new();
    for pair in overlaps {
        let [below, above] = [pair.below, pair.above].map(|item| of_item[item as usize]);
        if below != above {
            push(&mut pairs, Pair { below, above })?;
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    Ok(pairs)
}

/// Nodes of one unit, two at a time, those first that are nearest in the order: they have the fewest
/// between them. (Which are joined first hardly matters to how many are left.)
fn candidates(nodes: &[u32], units: &[u32]) -> Result<Vec<(u32, u32)>, Error> {
    let unit = |node: u32| units[nodes[node as usize] as usize];
    let mut by_unit: Vec<u32> = collect(0..nodes.len() as u32)?;
    by_unit.sort_by_key(|&node| unit(node));
    let mut pairs = Vec::new();
    for same in by_unit.chunk_by(|&a, &b| unit(a) == unit(b)) {
        for (i, &a) in same.iter().enumerate() {
            for &b in same[i + 1..].iter().take(NEXT) {
                push(&mut pairs, (a, b))?;
            }
        }
    }
    pairs.sort_unstable_by_key(|&(a, b)| (b - a, a));
    Ok(pairs)
}
