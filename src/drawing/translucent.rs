//! Drawings of translucent polygons: nothing hidden, or what opaque ones hide.

use std::ops::ControlFlow;

use super::above::pairs;
use super::overlaps::overlaps;
use super::pairs::Pair;
use super::parts::Parts;
use super::paths::Drawing;
use super::stock::Stock;
use super::tile::Tile;
use super::visible::Leaf;
use crate::Error;
use crate::build::Progress;
use crate::build::progress::{Watch, one_at_a_time};
use crate::memory::{collect, push};
use crate::raster::Rays;
use crate::tree::BspTree;

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
        Self::with_all(tree, rays, &Watch::default())
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
        Self::with_all(tree, rays, &Watch::new(&progress))
    }

    fn with_all(tree: &BspTree, rays: Rays, watch: &Watch<'_>) -> Result<Self, Error> {
        let picture = Tile::picture(rays.size());
        let stock = Stock::new(tree, rays, vec![], watch)?;
        let overlaps = overlaps(&stock, picture, watch)?;
        let parts = Parts::new(&stock, &overlaps, watch)?;
        parts.drawing(&stock, &overlaps, None, watch)
    }
}

/// The drawing of a map where something shows through: opaque polygons are in one path each, translucent ones
/// as in [`Drawing::translucent`], and what shows nowhere is left out.
pub(super) fn mixed(
    stock: &Stock<'_>,
    leaves: &[Leaf],
    watch: &Watch<'_>,
) -> Result<Drawing, Error> {
    // Polygons that show are known by their first items.
    let polygon = |item: u32| stock.polygon(item);
    let count = (0..stock.items.len() as u32).map(polygon).max().map_or(0, |most| most + 1);
    let (mut shows, mut first): (Vec<bool>, Vec<u32>) =
        (collect((0..count).map(|_| false))?, collect((0..count).map(|_| u32::MAX))?);
    for visible in leaves.iter().flat_map(|leaf| &leaf.cells) {
        shows[polygon(visible.item)] = true;
    }
    for item in (0..stock.items.len() as u32).rev().filter(|&item| shows[polygon(item)]) {
        first[polygon(item)] = item;
    }
    let faces = stock.lines.frame.faces;
    let place = |seen: u32| {
        let polygon = faces.polygon(stock.seen[seen as usize].face);
        first.get(polygon).copied().unwrap_or(u32::MAX)
    };
    let pairs = pairs(stock, leaves, &place, watch)?;
    let is_blended = |pair: &&Pair| !stock.is_opaque(pair.above);
    let mut blended = Vec::new();
    for &pair in pairs.iter().filter(is_blended) {
        push(&mut blended, pair)?;
    }
    Parts::new(stock, &blended, watch)?.drawing(stock, &pairs, Some(leaves), watch)
}
