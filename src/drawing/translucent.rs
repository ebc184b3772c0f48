//! Drawings of translucent polygons: nothing hidden, or what opaque ones hide.

use std::ops::ControlFlow;

use super::above::pairs;
use super::between::Between;
use super::halving::{LINES, VISITED};
use super::overlaid::Overlaid;
use super::overlaps::overlaps;
use super::pairs::{Found, Pair, add, sorted};
use super::parts::Parts;
use super::paths::Drawing;
use super::reporter::{Reporter, each, finish_item, sort_by};
use super::rims::Rims;
use super::stock::Stock;
use super::tile::Tile;
use super::visible::Leaf;
use crate::Error;
use crate::build::Progress;
use crate::build::progress::Watch;
use crate::memory::{collect, push};
use crate::overlay::Overlay;
use crate::raster::Rays;
use crate::tree::BspTree;

/// So often at most an order is sought that has room for an overlay. One is enough for nearly all scenes and
/// views; heaps of rectangles in a grid, seen along its diagonal with all their edges, need up to five.
const ROUNDS: usize = 8;

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
    /// As for [`VisibilityMap::of`](super::VisibilityMap::of).
    pub fn translucent(tree: &BspTree, rays: Rays) -> Result<Self, Error> {
        Self::with_all(tree, rays, None, &Reporter::default())
    }

    /// As [`translucent`](Self::translucent). Now and then `progress` is called with how far the drawing has
    /// come, and may cancel it, as in [an operation of a map](super::VisibilityMap#progress).
    ///
    /// # Errors
    ///
    /// As for `translucent`, and [`Error`] if it was cancelled.
    pub fn translucent_with_progress(
        tree: &BspTree,
        rays: Rays,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<Self, Error> {
        Self::with_all(tree, rays, None, &Reporter::new(progress))
    }

    /// As [`translucent`](Self::translucent), with the lines and points of an overlay of the same tree
    /// between the paths: see [`display_list`](Self::display_list). To have them above all, paint the runs of
    /// [`VisibilityMap::lines`](super::VisibilityMap::lines) last: nothing is cut then but what it says is
    /// hidden.
    ///
    /// A segment is cut where it goes from one place of the order to another. Each part comes after all that
    /// lies behind it, or that it lies on, and before what lies in front of it, as `lines` tells these apart.
    /// Lines and points in one place of the order come in input order, lines first, and so may those that
    /// cross in the picture.
    ///
    /// Paths are those without them, but where a line runs along a border between polygons that only touch
    /// there, one behind it and the other in front: these are then painted in that order too, and polygons may
    /// be in more paths for it, or in fewer. Where such pairs close a cycle, or do not come to an end in a few
    /// rounds, a part comes after what lies behind it, and what lies in front may be painted before it. So may
    /// a bent polygon that lies behind a line with one face and in front with another: it is one path.
    ///
    /// All runs and points in the drawing are said to be visible, whatever lies in front of them.
    ///
    /// # Errors
    ///
    /// As for `translucent` and `lines`.
    pub fn translucent_with_overlay(
        tree: &BspTree,
        rays: Rays,
        overlay: &Overlay,
    ) -> Result<Self, Error> {
        Self::with_all(tree, rays, Some(overlay), &Reporter::default())
    }

    /// As [`translucent_with_overlay`](Self::translucent_with_overlay), with `progress` as in
    /// [`translucent_with_progress`](Self::translucent_with_progress).
    ///
    /// # Errors
    ///
    /// As for `translucent_with_overlay`, and [`Error`] if it was cancelled.
    pub fn translucent_with_overlay_and_progress(
        tree: &BspTree,
        rays: Rays,
        overlay: &Overlay,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<Self, Error> {
        Self::with_all(tree, rays, Some(overlay), &Reporter::new(progress))
    }

    fn with_all(
        tree: &BspTree,
        rays: Rays,
        overlay: Option<&Overlay>,
        reporter: &Reporter<'_>,
    ) -> Result<Self, Error> {
        if let Some(overlay) = overlay {
            overlay.expect_no_polygons(tree)?;
        }
        reporter.watch(if overlay.is_some() { 4 } else { 3 }, |watch| {
            let picture = Tile::picture(rays.size());
            let stock = Stock::new(tree, rays, vec![], watch)?;
            let (mut rims, count) = (Rims::new(&stock), stock.items.len());
            for item in 0..count {
                watch.work(LINES)?;
                rims.item(&stock, item as u32)?;
                finish_item(watch, item, count);
            }
            let overlaps = overlaps(&stock, &rims, picture, watch)?;
            let between = overlay.map(|overlay| Between::of(&stock, &rims, overlay, watch));
            let between = between.transpose()?;
            let (mut touching, mut known) = (Vec::new(), Found::default());
            let mut rounds = 0;
            let (parts, ordered, placed) = loop {
                let parts = Parts::new(&stock, &overlaps, &touching, watch)?;
                let ordered = parts.order(&stock, &overlaps, None, watch)?;
                let Some(between) = &between else { break (parts, ordered, vec![]) };
                let places = parts.places(&ordered, watch)?;
                let (placed, missed) = between.placed(&places, ordered.order.len(), watch)?;
                // Again with all that was missed so far, until that is nothing new. What was kept stays so: new
                // pairs come last.
                let mut new = sorted(vec![missed], watch)?;
                new.retain(|pair| !known.contains(pair));
                rounds += 1;
                if new.is_empty() || rounds == ROUNDS {
                    break (parts, ordered, placed);
                }
                for pair in each(watch, VISITED, new) {
                    let pair = pair?;
                    add(&mut known, pair)?;
                    push(&mut touching, pair)?;
                }
            };
            let (mut drawing, paths) = parts.drawing(&stock, &rims, &ordered, None, watch)?;
            for placed in each(watch, 1, placed) {
                let (parts, what): (u32, Overlaid) = placed?;
                push(&mut drawing.overlaid, (paths[parts as usize], what))?;
            }
            sort_by(&mut drawing.overlaid, watch, |(a, _), (b, _)| a.cmp(b))?;
            Ok(drawing)
        })
    }
}

/// The drawing of a map where something shows through: opaque polygons are in one path each, translucent ones
/// as in [`Drawing::translucent`], and what shows nowhere is left out. Two phases.
pub(super) fn mixed(
    stock: &Stock<'_>,
    rims: &Rims<'_>,
    leaves: &[Leaf],
    watch: &Watch<'_>,
) -> Result<Drawing, Error> {
    // Polygons that show are known by their first items.
    let polygon = |item: u32| stock.polygon(item);
    let count = (0..stock.items.len() as u32).map(polygon).max().map_or(0, |most| most + 1);
    let (mut shows, mut first): (Vec<bool>, Vec<u32>) =
        (collect((0..count).map(|_| false))?, collect((0..count).map(|_| u32::MAX))?);
    for visible in each(watch, 1, leaves.iter().flat_map(|leaf| &leaf.cells)) {
        shows[polygon(visible?.item)] = true;
    }
    for item in each(watch, 1, (0..stock.items.len() as u32).rev()) {
        let item = item?;
        if shows[polygon(item)] {
            first[polygon(item)] = item;
        }
    }
    let faces = stock.frame.faces;
    let place = |face: u32| {
        let polygon = faces.polygon(face);
        first.get(polygon).copied().unwrap_or(u32::MAX)
    };
    let pairs = pairs(stock, rims, leaves, &place, watch)?;
    let mut blended: Vec<Pair> = Vec::new();
    for pair in each(watch, 1, &pairs) {
        let pair = *pair?;
        if !stock.is_opaque(pair.above) {
            push(&mut blended, pair)?;
        }
    }
    let parts = Parts::new(stock, &blended, &[], watch)?;
    let ordered = parts.order(stock, &pairs, Some(leaves), watch)?;
    let (drawing, _) = parts.drawing(stock, rims, &ordered, Some(leaves), watch)?;
    Ok(drawing)
}
