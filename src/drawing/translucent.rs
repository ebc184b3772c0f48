//! Drawings of translucent polygons: the pieces that overlap, and the parts that are painted at once.

use std::cmp::Reverse;

use super::cell::Cell;
use super::graph::{Groups, Ordered, Pair, Wanted, contracted, cycles, order};
use super::map::{Reporter, ViewOptions, checked, drawing_rays, each, finish_item, sort_by};
use super::overlaid::Between;
use super::pairs::{Found, overlaps, pairs, sorted};
use super::paths::{Area, Drawing, add_face, add_piece};
use super::primitives::Primitives;
use super::quadtree::{CUT, Leaf, Visible};
use crate::Error;
use crate::overlay::Overlay;
use crate::progress::Watch;
use crate::tree::BspTree;
use crate::view::Camera;

/// The largest number of rounds of the search for an order with a place for each line and point of an
/// overlay. One round is enough for nearly all scenes and views; many rectangles in a grid, seen along its
/// diagonal with all their edges, need up to five. Too small: lines without a place. Too large: time.
const ROUNDS: usize = 8;

impl Drawing {
    /// Returns all polygons as filled outlines, including the parts behind other polygons. Paint the paths in
    /// order, each with its polygon's opacity. Each point of each polygon is in one path.
    ///
    /// A polygon is split only if no painting order of whole polygons is found. The parts of the polygon are
    /// the tree's [fragments](crate::Fragment), joined where the joined parts still have a painting order
    /// from this viewpoint. A polygon that is not planar and overlaps itself in the picture has at least one
    /// path for each of its triangles.
    ///
    /// The option [`front_faces_only`](ViewOptions::front_faces_only) applies. Polygons with opacity 0 are
    /// left out; other opacities, and the [least area](ViewOptions::least_area), have no effect. If all
    /// polygons are opaque, [`VisibilityMap::drawing`](super::VisibilityMap::drawing) returns fewer paths.
    /// Time and memory grow with the number of pairs of polygons that overlap in the picture without a third
    /// polygon between them.
    ///
    /// # Lines and points
    ///
    /// The lines and points of an [overlay](Overlay) of the same tree are placed between the paths: see
    /// [`display_list`](Self::display_list). To paint them above all paths, paint the runs of
    /// [`VisibilityMap::lines`](super::VisibilityMap::lines) last.
    ///
    /// A segment is cut where its place in the order changes. Each part of the segment is painted after the
    /// polygons behind the part and the polygons that the part lies on, and before the polygons in front of
    /// the part. The rules of `VisibilityMap::lines` decide which polygons are in front. Lines and points
    /// with the same place in the order are painted in input order, lines first. Two lines that cross in the
    /// picture may also be painted in input order, whichever is nearer. All lines and points are marked as
    /// visible.
    ///
    /// An overlay does not change the paths, with one exception. Consider two polygons that touch in the
    /// picture only along a common border, and a line along this border, with one polygon behind the line and
    /// the other polygon in front of it. The polygon behind the line is then painted before the other
    /// polygon. This may change the number of paths.
    ///
    /// A part of a line is always painted after all polygons behind the part. Polygons in front of the part
    /// may also be painted before the part in two cases:
    ///
    /// - several pairs of polygons such as the pair above form a cycle, or there are too many such pairs to
    ///   find all;
    /// - a polygon that is not planar is one path, and one part of this polygon is behind the line and
    ///   another part is in front of the line.
    ///
    /// # Errors
    ///
    /// As for [`BspTree::visibility`]; with an overlay, also as for
    /// [`VisibilityMap::lines`](super::VisibilityMap::lines).
    pub fn translucent(
        tree: &BspTree,
        camera: &Camera,
        options: &ViewOptions<'_>,
        overlay: Option<&Overlay>,
    ) -> Result<Self, Error> {
        let rays = drawing_rays(tree, camera, options.front_faces_only)?;
        let mut opacities = checked(tree, &options.opacities)?;
        opacities.iter_mut().for_each(|opacity| *opacity = f64::from(u8::from(*opacity > 0.0)));
        let reporter = Reporter::new(options.progress);
        if let Some(overlay) = overlay {
            overlay.expect_no_polygons(tree)?;
        }
        reporter.watch(if overlay.is_some() { 4 } else { 3 }, |watch| {
            let primitives = Primitives::new(tree, rays, opacities, watch)?;
            // Without cut polygons and lines, the tree's order is a painting order, whatever overlaps.
            let is_sorted = overlay.is_none() && !Counts::of(&primitives).has_pieces();
            let overlaps = if is_sorted {
                finish_item(watch, 0, 1);
                vec![]
            } else {
                overlaps(&primitives, watch)?
            };
            let between = overlay.map(|overlay| Between::of(&primitives, overlay, watch));
            let between = between.transpose()?;
            let (mut touching, mut known) = (Vec::new(), Found::default());
            let mut rounds = 0;
            let (parts, ordered, placed) = loop {
                let parts = Parts::new(&primitives, &overlaps, &touching, watch)?;
                let ordered = parts.order(&primitives, &overlaps, None, watch)?;
                let Some(between) = &between else { break (parts, ordered, vec![]) };
                let places = parts.places(&ordered);
                let (placed, missed) = between.placed(&places, ordered.order.len(), watch)?;
                // Repeat with all pairs missed so far, until there are no new pairs. Pairs that were kept are
                // still kept, because new pairs are added last.
                let mut new = sorted(vec![missed], watch)?;
                new.retain(|pair| !known.contains(pair));
                rounds += 1;
                if new.is_empty() || rounds == ROUNDS {
                    break (parts, ordered, placed);
                }
                for pair in new {
                    known.insert(pair);
                    touching.push(pair);
                }
            };
            let (mut drawing, paths) = parts.drawing(&primitives, &ordered, None, &[], watch)?;
            let placed = placed.into_iter();
            drawing.overlaid.extend(placed.map(|(parts, what)| (paths[parts as usize], what)));
            sort_by(&mut drawing.overlaid, watch, |(a, _), (b, _)| a.cmp(b))?;
            Ok(drawing)
        })
    }
}

/// The drawing of a map with translucent polygons: opaque polygons have one path each, and translucent
/// polygons have paths as in [`Drawing::translucent`]. Hidden polygons and the polygons in `left_out` are
/// left out. Counts as two phases of the progress.
pub(super) fn mixed(
    primitives: &Primitives<'_>,
    leaves: &[Leaf],
    left_out: &[usize],
    watch: &Watch<'_>,
) -> Result<Drawing, Error> {
    // Visible polygons are identified by their first items.
    let polygon = |item: u32| primitives.polygon(item);
    let mut shows = vec![false; primitives.polygon_count()];
    for visible in leaves.iter().flat_map(|leaf| &leaf.cells) {
        shows[polygon(visible.item)] = true;
    }
    let mut first = vec![u32::MAX; primitives.polygon_count()];
    let items = (0..primitives.items.len() as u32).rev();
    items.filter(|&item| shows[polygon(item)]).for_each(|item| first[polygon(item)] = item);
    let place = |face: u32| first[primitives.lines.frame.faces.polygon(face)];
    let pairs = pairs(primitives, leaves, &place, Wanted::ALL, watch)?;
    let mut blended = pairs.clone();
    blended.retain(|pair| !primitives.is_opaque(pair.above));
    let parts = Parts::new(primitives, &blended, &[], watch)?;
    let ordered = parts.order(primitives, &pairs, Some(leaves), watch)?;
    let (drawing, _) = parts.drawing(primitives, &ordered, Some(leaves), left_out, watch)?;
    Ok(drawing)
}

/// Each piece of a polygon is joined, if possible, with at most this many of the next pieces in the order.
/// Too small: more paths. Too large: more time.
const NEXT: usize = 16;

/// The parts of polygons that are painted at once. All items of a part belong to one polygon.
pub(super) struct Parts {
    of_item: Vec<u32>,
    /// The items of each part, one face after another.
    items: Vec<Vec<u32>>,
    /// Pairs of items that only touch. An order of the parts can keep these pairs in addition to the pairs
    /// that overlap.
    touching: Vec<Pair>,
}

impl Parts {
    /// Joins items to parts. The parts still have an order that keeps all pairs of overlapping items, and as
    /// many as possible of the pairs that only touch. The tree's order may not keep the pairs that only
    /// touch.
    pub(super) fn new(
        primitives: &Primitives<'_>,
        overlaps: &[Pair],
        touching: &[Pair],
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let units = units(primitives, overlaps);
        let count = units.iter().max().map_or(0, |&most| most as usize + 1);
        let all = overlaps.iter().chain(touching);
        let all = contracted(all, |item| units[item as usize], watch)?;
        let cycles = cycles(count, &all, watch)?;
        let cycle = |item: u32| cycles[units[item as usize] as usize];
        // Units in no cycle are whole. Each piece of the other units starts as a separate group.
        let items = 0..units.len() as u32;
        let mut nodes: Vec<u32> = items.filter(|&item| cycle(item).is_some()).collect();
        // From back to front, numbers of items decrease and numbers of nodes increase.
        let key = |item: u32| (cycle(item), Reverse(item));
        sort_by(&mut nodes, watch, |&a, &b| key(a).cmp(&key(b)))?;
        let mut node_of: Vec<u32> = vec![u32::MAX; units.len()];
        for (node, &item) in (0..).zip(&nodes) {
            node_of[item as usize] = node;
        }
        let in_nodes = |pair: &Pair| {
            let [a, b] = [pair.below, pair.above].map(cycle);
            (a.is_some() && a == b).then(|| pair.map(|item| node_of[item as usize]))
        };
        let mut groups = Groups::new(nodes.len(), overlaps.iter().filter_map(in_nodes));
        let mut kept = Vec::new();
        for pair in touching {
            let is_kept = match in_nodes(pair) {
                Some(pair) => groups.add(pair, watch)?,
                None => true,
            };
            if is_kept {
                kept.push(*pair);
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
        let mut items: Vec<Vec<u32>> = vec![vec![]; count + nodes.len()];
        for (item, &part) in (0..).zip(&of_item) {
            items[part as usize].push(item);
        }
        for items in &mut items {
            sort_by(items, watch, |&a, &b| primitives.face(a).cmp(&primitives.face(b)))?;
        }
        Ok(Self { of_item, items, touching: kept })
    }

    /// A painting order of the parts that keeps all pairs of items. Where the pairs leave a choice, the
    /// tree's order decides. If polygons are hidden, `leaves` contain the visible parts, and opaque polygons
    /// in cycles are clipped.
    pub(super) fn order(
        &self,
        primitives: &Primitives<'_>,
        pairs: &[Pair],
        leaves: Option<&[Leaf]>,
        watch: &Watch<'_>,
    ) -> Result<Ordered, Error> {
        let count = primitives.items.len() as u32;
        let rank = |items: &Vec<u32>| items.iter().map(|item| count - item).min().unwrap_or(0);
        let ranks: Vec<_> = self.items.iter().map(rank).collect();
        let is_opaque = |part: u32| {
            let first = self.items[part as usize].first();
            leaves.is_some() && first.is_some_and(|&item| primitives.is_opaque(item))
        };
        let pairs = pairs.iter().chain(&self.touching);
        let pairs = contracted(pairs, |item| self.of_item[item as usize], watch)?;
        order(self.items.len(), &pairs, &ranks, &is_opaque, watch)
    }

    /// The place of each item's part in an order.
    pub(super) fn places(&self, ordered: &Ordered) -> Vec<u32> {
        let mut places = vec![0; self.items.len()];
        for (place, &part) in (0..).zip(&ordered.order) {
            places[part as usize] = place;
        }
        self.of_item.iter().map(|&part| places[part as usize]).collect()
    }

    /// Draws the parts in order, as filled outlines. Also returns, for each `k`, the number of paths of the
    /// first `k` parts. Counts as one phase of the progress.
    pub(super) fn drawing(
        &self,
        primitives: &Primitives<'_>,
        ordered: &Ordered,
        leaves: Option<&[Leaf]>,
        left_out: &[usize],
        watch: &Watch<'_>,
    ) -> Result<(Drawing, Vec<u32>), Error> {
        let cells = leaves.map(|leaves| self.cells(leaves));
        let mut drawing = Drawing::empty(primitives.lines.frame.rays.size());
        let count = ordered.order.len();
        drawing.paths.reserve(count);
        let counts = Counts::of(primitives);
        let mut paths = Vec::with_capacity(count + 1);
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
                    for cell in cells {
                        area.push(&cell.sides)?;
                    }
                }
                _ => counts.add_pieces(primitives, items, &mut area, watch)?,
            }
            let polygon = items.first().map(|&item| primitives.polygon(item));
            if let Some(polygon) = polygon
                && !area.is_empty()
                && left_out.binary_search(&polygon).is_err()
            {
                let is_part = is_clipped || (items.len() as u32) < counts.of_polygon[polygon];
                // Items of one face follow one another.
                let faces = items.chunk_by(|&a, &b| primitives.face(a) == primitives.face(b));
                let faces = faces.map(|same| primitives.face(same[0]));
                drawing.push(polygon, is_part, &area, faces, primitives, watch)?;
            }
            paths.push(drawing.paths.len() as u32);
            finish_item(watch, i, count);
        }
        Ok((drawing, paths))
    }

    /// The visible cells of each part.
    fn cells<'l>(&self, leaves: &'l [Leaf]) -> Vec<Vec<&'l Cell>> {
        let mut cells: Vec<Vec<&Cell>> = vec![vec![]; self.items.len()];
        for Visible { item, cell } in leaves.iter().flat_map(|leaf| &leaf.cells) {
            cells[self.of_item[*item as usize] as usize].push(cell);
        }
        cells
    }
}

/// The number of items of each face and of each polygon.
struct Counts {
    of_face: Vec<u32>,
    of_polygon: Vec<u32>,
}

impl Counts {
    fn of(primitives: &Primitives<'_>) -> Counts {
        let mut of_face: Vec<u32> = vec![0; primitives.views.len()];
        primitives.items.iter().for_each(|item| of_face[item.face as usize] += 1);
        let mut of_polygon: Vec<u32> = vec![0; primitives.polygon_count()];
        (0..primitives.items.len() as u32)
            .for_each(|item| of_polygon[primitives.polygon(item)] += 1);
        Self { of_face, of_polygon }
    }

    /// Whether a polygon has several items.
    fn has_pieces(&self) -> bool {
        self.of_polygon.iter().any(|&count| count > 1)
    }

    /// Adds items to an area, face by face.
    fn add_pieces(
        &self,
        primitives: &Primitives<'_>,
        items: &[u32],
        area: &mut Area,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        for same in items.chunk_by(|&a, &b| primitives.face(a) == primitives.face(b)) {
            let face = primitives.face(same[0]);
            // If no piece of a face is missing, use the face's own outline.
            if same.len() as u32 == self.of_face[face as usize] {
                add_face(primitives, face, area, watch)?;
                continue;
            }
            for item in each(watch, CUT, same) {
                add_piece(&primitives.lines, primitives.halves(*item?), area, watch)?;
            }
        }
        Ok(())
    }
}

/// For each item, the number of its unit. A unit is a polygon, or a face of a polygon that overlaps itself in
/// the picture.
fn units(primitives: &Primitives<'_>, overlaps: &[Pair]) -> Vec<u32> {
    let polygon = |item: u32| primitives.polygon(item);
    let mut is_folded = vec![false; primitives.polygon_count()];
    for &Pair { below, above } in overlaps {
        is_folded[polygon(below)] |= polygon(below) == polygon(above);
    }
    let mut of_polygon: Vec<Option<u32>> = vec![None; is_folded.len()];
    let mut of_face: Vec<Option<u32>> = vec![None; primitives.views.len()];
    let mut next = 0;
    let unit = |item: u32| {
        let unit = match is_folded[polygon(item)] {
            true => &mut of_face[primitives.face(item) as usize],
            false => &mut of_polygon[polygon(item)],
        };
        let number = *unit.get_or_insert(next);
        next += u32::from(number == next);
        number
    };
    (0..primitives.items.len() as u32).map(unit).collect()
}

/// Pairs of nodes of one unit. Pairs whose nodes are nearest in the order come first, because such a pair has
/// the fewest nodes between its two nodes. (The number of remaining parts hardly depends on the sequence of
/// joins.)
fn candidates(nodes: &[u32], units: &[u32], watch: &Watch<'_>) -> Result<Vec<(u32, u32)>, Error> {
    let unit = |node: u32| units[nodes[node as usize] as usize];
    let mut by_unit: Vec<u32> = (0..nodes.len() as u32).collect();
    sort_by(&mut by_unit, watch, |&a, &b| unit(a).cmp(&unit(b)))?;
    let mut pairs = Vec::new();
    for same in by_unit.chunk_by(|&a, &b| unit(a) == unit(b)) {
        watch.work(same.len() * NEXT)?;
        for (i, &a) in same.iter().enumerate() {
            pairs.extend(same[i + 1..].iter().take(NEXT).map(|&b| (a, b)));
        }
    }
    let key = |&(a, b): &(u32, u32)| (b - a, a);
    sort_by(&mut pairs, watch, |a, b| key(a).cmp(&key(b)))?;
    Ok(pairs)
}
