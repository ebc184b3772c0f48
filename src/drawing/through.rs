//! Which faces go through one another, shown or not, and where in the picture.

use smallvec::SmallVec;

use super::cell::Cell;
use super::crossings::CommonSide;
use super::edge_run::{EdgeKind, EdgeRun};
use super::half::Half;
use super::halving::{CUT, LINES, VISITED};
use super::in_front::{Depths, in_layers};
use super::inner_edges::{Bend, InnerEdges};
use super::intervals::parts;
use super::lines::Lines;
use super::map::VisibilityMap;
use super::pairs::Pair;
use super::reporter::{each, finish_item, sort_by, sort_unique};
use super::rims::Rims;
use super::sight::Sight;
use super::stock::{Stock, View};
use super::straddling::straddling;
use super::tile::Tile;
use crate::Error;
use crate::build::progress::Watch;
use crate::exact::PlaneId;
use crate::memory::{push, reserve};
use crate::parallel_map;

/// So many pairs are looked at by one thread.
const SHARE: usize = 256;

/// Two faces, and the line in which they go through one another.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// As those of [`CommonSide`].
    faces: [u32; 2],
    sight: Sight,
}

impl VisibilityMap<'_> {
    /// The runs of [`crossings`](Self::crossings), and those that are hidden by others. Of polygons in several
    /// faces, each pair of faces has runs of its own.
    ///
    /// Hidden are those of polygons that both have corners on both sides of the other, further from it than the
    /// tolerance.
    ///
    /// O(n log n) for n faces, unless there are many with overlapping boxes, as at the tip of a cone of many faces.
    ///
    /// # Errors
    ///
    /// If there is not enough memory, or if it was [cancelled](Self#progress).
    pub fn crossings_with_hidden(&self) -> Result<Vec<EdgeRun>, Error> {
        self.reporter.watch(4, |watch| {
            let (crossings, shown) = self.all_crossings(watch)?;
            self.crossing_runs(&crossings, &shown, None, watch)
        })
    }

    /// The runs of [`crossings_with_hidden`](Self::crossings_with_hidden), each with [`EdgeRun::layers`]: as
    /// [`edges_in_layers`](Self::edges_in_layers) has edges, cut where the number of polygons in front of them
    /// changes. For each crossing this takes time and memory as for an edge.
    ///
    /// # Errors
    ///
    /// If there is not enough memory, or if it was [cancelled](Self#progress).
    pub fn crossings_in_layers(&self) -> Result<Vec<EdgeRun>, Error> {
        self.reporter.watch(6, |watch| {
            let (crossings, shown) = self.all_crossings(watch)?;
            let mut sights: Vec<Sight> = Vec::new();
            reserve(&mut sights, crossings.len())?;
            for crossing in each(watch, VISITED, &crossings) {
                sights.push(crossing?.sight);
            }
            let is_own = |sight: u32, face: u32| crossings[sight as usize].faces.contains(&face);
            let depths = self.depths(&sights, is_own, watch)?;
            self.crossing_runs(&crossings, &shown, Some(&depths), watch)
        })
    }

    /// All crossings in the picture, and what shows of them, by their faces: four phases.
    fn all_crossings(&self, watch: &Watch<'_>) -> Result<(Vec<Crossing>, Vec<CommonSide>), Error> {
        let stock = &self.stock;
        let inner = InnerEdges::of(stock.frame.faces, watch)?;
        let mut shown = self.common_sides(&inner, watch)?;
        sort_by(&mut shown, watch, |a, b| a.faces.cmp(&b.faces))?;
        let mut pairs = straddling(stock, &inner, watch)?;
        // What shows of a crossing may be nearer to the end of a polygon than the tolerance.
        for side in each(watch, VISITED, &shown) {
            let [below, above] = side?.faces;
            push(&mut pairs, Pair { below, above })?;
        }
        sort_unique(&mut pairs, watch)?;
        Ok((crossings_of(&pairs, stock, &inner, watch)?, shown))
    }

    /// The runs of crossings, with how many polygons are in front of each if that is known.
    fn crossing_runs(
        &self,
        crossings: &[Crossing],
        shown: &[CommonSide],
        depths: Option<&Depths>,
        watch: &Watch<'_>,
    ) -> Result<Vec<EdgeRun>, Error> {
        let faces = self.stock.frame.faces;
        let (mut runs, mut visible) = (Vec::new(), Vec::new());
        for numbered in each(watch, VISITED, crossings.iter().enumerate()) {
            let (i, crossing) = numbered?;
            let sight = &crossing.sight;
            let first = shown.partition_point(|side| side.faces < crossing.faces);
            let own = shown[first..].iter().take_while(|side| side.faces == crossing.faces);
            visible.clear();
            for side in each(watch, VISITED, own) {
                let [a, b] = side?.ends.map(|end| sight.course.place_on(end));
                push(&mut visible, [a.min(b), a.max(b)])?;
            }
            sort_by(&mut visible, watch, |a, b| a[0].total_cmp(&b[0]))?;
            let [a, b] = crossing.faces.map(|face| faces.polygon(face));
            let (polygon, kind) = (a.min(b), EdgeKind::Crossing(a.max(b)));
            for (ends, is_visible) in parts(&sight.course, visible.iter().copied()) {
                let run = EdgeRun { polygon, edge: None, kind, ends, is_visible, layers: None };
                let Some(depths) = depths else {
                    push(&mut runs, run)?;
                    continue;
                };
                for (ends, layers) in
                    in_layers(ends, is_visible, Some((sight, depths.of(i))), watch)?
                {
                    push(&mut runs, EdgeRun { ends, layers: Some(layers), ..run })?;
                }
            }
        }
        sort_by(&mut runs, watch, |a, b| a.polygon.cmp(&b.polygon))?;
        Ok(runs)
    }
}

/// Those pairs that go through one another in the picture: a phase.
fn crossings_of(
    pairs: &[Pair],
    stock: &Stock<'_>,
    inner: &InnerEdges,
    watch: &Watch<'_>,
) -> Result<Vec<Crossing>, Error> {
    let shares: Vec<_> = pairs.chunks(SHARE).enumerate().collect();
    let count = shares.len();
    let share = |(i, pairs): (usize, &[Pair])| {
        let (mut rims, mut found) = (Rims::new(stock), Vec::new());
        for &Pair { below, above } in pairs {
            let faces = [below, above];
            let corners: usize = faces.map(|face| stock.edges_work(face)).iter().sum();
            watch.work(2 * LINES + CUT + corners * LINES / 4)?;
            let sight = match inner.bend(stock.frame.faces, faces) {
                Some(bend) => bent(&bend, stock, &mut rims, watch)?,
                None => straight(faces, stock, &mut rims, watch)?,
            };
            if let Some(sight) = sight {
                push(&mut found, Crossing { faces, sight })?;
            }
        }
        finish_item(watch, i, count);
        Ok(found)
    };
    let mut all = Vec::new();
    for mut found in parallel_map::map(shares, share)? {
        reserve(&mut all, found.len())?;
        all.append(&mut found);
    }
    Ok(all)
}

/// Where two faces go through one another: where both are in the picture, the line along which they are as far
/// away.
fn straight(
    [one, other]: [u32; 2],
    stock: &Stock<'_>,
    rims: &mut Rims<'_>,
    watch: &Watch<'_>,
) -> Result<Option<Sight>, Error> {
    let mut halves: SmallVec<[Half; 8]> = SmallVec::from_slice(rims.outline(stock, one)?);
    halves.extend_from_slice(rims.outline(stock, other)?);
    let View { is_positive, .. } = stock.views[one as usize];
    let cut = rims.lines.cut(one, PlaneId::face(other), true, is_positive)?;
    let lines = &rims.lines;
    let Some(common) = picture(stock, lines).within(lines, &halves, None, watch)? else {
        return Ok(None);
    };
    if !common.meets(lines, &[cut.flipped(true)], watch)? {
        return Ok(None);
    }
    let Some(Cell { sides }) = common.within(lines, &[cut], None, watch)? else { return Ok(None) };
    let Some(i) = sides.iter().position(|side| side.half == cut) else { return Ok(None) };
    let next = if i + 1 == sides.len() { 0 } else { i + 1 };
    Ok(Sight::crossing(lines, [one, other], [i, next].map(|i| sides[i].start.at)))
}

/// Where a face goes through a polygon along an edge inside it.
fn bent(
    bend: &Bend,
    stock: &Stock<'_>,
    rims: &mut Rims<'_>,
    watch: &Watch<'_>,
) -> Result<Option<Sight>, Error> {
    let Bend { edge: (face, k), other, other_edge, .. } = *bend;
    let faces = stock.frame.faces;
    let sight = Sight::new(&rims.lines, faces.ends(face, k));
    // Along a border of the picture, there is nothing on the other side.
    let Some(sight) = sight.filter(|sight| sight.picture.is_eq()) else { return Ok(None) };
    let common = match other_edge {
        Some(k) => Sight::new(&rims.lines, faces.ends(other, k)).map(|along| {
            let [a, b] = along.course.places.map(|at| sight.course.place(along.course.at(at)));
            [a.min(b), a.max(b)]
        }),
        None => {
            let halves: SmallVec<[Half; 8]> = SmallVec::from_slice(rims.outline(stock, other)?);
            let cell = picture(stock, &rims.lines).within(&rims.lines, &halves, None, watch)?;
            cell.and_then(|cell| sight.chord(&rims.lines, &cell))
        }
    };
    Ok(common.and_then(|common| sight.within(common)))
}

/// All of the picture.
fn picture(stock: &Stock<'_>, lines: &Lines<'_>) -> Cell {
    let Tile { low, high } = Tile::picture(stock.frame.rays.size());
    Cell::rectangle(lines, low, high)
}
