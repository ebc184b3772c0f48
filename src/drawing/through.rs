//! Which faces go through one another, shown or not, and where in the picture.

use smallvec::SmallVec;

use super::cell::Cell;
use super::edge_run::{EdgeKind, EdgeRun};
use super::edges::parts;
use super::half::Half;
use super::halving::{CUT, LINES, NARROWED, VISITED, found_in};
use super::in_front::in_layers;
use super::inner_edges::{Bend, InnerEdges};
use super::lines::Lines;
use super::map::VisibilityMap;
use super::pairs::{Found, Pair, add, sorted};
use super::reporter::{each, finish_item, sort_by};
use super::rims::Rims;
use super::sight::Sight;
use super::stock::{Stock, View};
use super::tile::{IN_VAIN, Tile, in_vain};
use crate::Error;
use crate::build::progress::Watch;
use crate::exact::{Exact, Faces, Kernel, PlaneId};
use crate::memory::{collect, push, reserve};
use crate::parallel_map;

/// Blocks of at most so many faces are not halved. Larger: more pairs are compared; smaller: more blocks.
const FEW: usize = 16;
/// So many pairs are looked at by one thread.
const SHARE: usize = 256;

/// A box in the scene: its least and its largest coordinates.
type Bounds = [[f64; 3]; 2];

/// A part of the scene with the faces that may reach into it.
struct Block {
    bounds: Bounds,
    faces: Vec<u32>,
    in_vain: u32,
}

/// Two faces, and the line in which they go through one another.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// As those of [`CommonSide`](super::crossings::CommonSide).
    faces: [u32; 2],
    sight: Sight,
}

impl VisibilityMap<'_> {
    /// The runs of [`crossings`](Self::crossings), and those that are hidden by others: as
    /// [`edges_in_layers`](Self::edges_in_layers) has edges, cut where the number of polygons in front of them
    /// changes. A crossing of polygons in several faces is in several runs at least.
    ///
    /// Hidden are those of polygons that both have corners on both sides of the other, further from it than the
    /// tolerance.
    ///
    /// O(n log n) for n faces, and for each pair that goes through one another time and memory as for an edge,
    /// unless there are many with overlapping boxes, as at the tip of a cone of many faces.
    ///
    /// # Errors
    ///
    /// If there is not enough memory, or if it was [cancelled](Self#progress).
    pub fn crossings_in_layers(&self) -> Result<Vec<EdgeRun>, Error> {
        self.reporter.watch(6, |watch| {
            let (stock, faces) = (&self.stock, self.stock.frame.faces);
            let inner = InnerEdges::of(faces, watch)?;
            let mut shown = self.common_sides(&inner, watch)?;
            sort_by(&mut shown, watch, |a, b| a.faces.cmp(&b.faces))?;
            let mut pairs = straddling(stock, &inner, watch)?;
            // What shows of a crossing may be nearer to the end of a polygon than the tolerance.
            for side in each(watch, VISITED, &shown) {
                let [below, above] = side?.faces;
                push(&mut pairs, Pair { below, above })?;
            }
            sort_by(&mut pairs, watch, Ord::cmp)?;
            pairs.dedup();
            let crossings = crossings_of(&pairs, stock, &inner, watch)?;
            let sights: Vec<Sight> = collect(crossings.iter().map(|crossing| crossing.sight))?;
            let is_own = |sight: u32, face: u32| crossings[sight as usize].faces.contains(&face);
            let steps = self.steps(&sights, is_own, watch)?;
            let (mut layered, mut visible) = (Vec::new(), Vec::new());
            for (i, crossing) in crossings.iter().enumerate() {
                let sight = &crossing.sight;
                let first = shown.partition_point(|side| side.faces < crossing.faces);
                let own = shown[first..].iter().take_while(|side| side.faces == crossing.faces);
                visible.clear();
                for side in each(watch, VISITED, own) {
                    let [a, b] = side?.ends.map(|end| sight.place_on(end));
                    push(&mut visible, [a.min(b), a.max(b)])?;
                }
                sort_by(&mut visible, watch, |a, b| a[0].total_cmp(&b[0]))?;
                let [a, b] = crossing.faces.map(|face| faces.polygon(face));
                let (polygon, kind) = (a.min(b), EdgeKind::Crossing(a.max(b)));
                for (ends, is_visible) in parts(sight, &visible) {
                    for (ends, layers) in
                        in_layers(ends, is_visible, Some((sight, steps.of(i))), watch)?
                    {
                        let layers = Some(layers);
                        let run = EdgeRun { polygon, edge: None, kind, ends, is_visible, layers };
                        push(&mut layered, run)?;
                    }
                }
            }
            sort_by(&mut layered, watch, |a, b| a.polygon.cmp(&b.polygon))?;
            Ok(layered)
        })
    }
}

/// Pairs of faces of different polygons, with corners on both sides of one another's planes and further from
/// these than the tolerance, that may go through one another: a phase.
fn straddling(
    stock: &Stock<'_>,
    inner: &InnerEdges,
    watch: &Watch<'_>,
) -> Result<Vec<Pair>, Error> {
    let faces = stock.frame.faces;
    let all_bounds: Vec<Bounds> =
        collect((0..faces.len() as u32).map(|face| bounds(faces.corners(face))))?;
    let (mut seen, mut around) = (Vec::new(), NOTHING);
    for face in each(watch, 1, 0..faces.len() as u32) {
        let face = face?;
        if stock.sees(face) {
            push(&mut seen, face)?;
            around = joined(around, all_bounds[face as usize]);
        }
    }
    let all = Block { bounds: around, faces: seen, in_vain: 0 };
    let halves = |block: &Block, _: &mut Found| block.halves(&all_bounds, watch);
    let leaf = |block: &Block, found: &mut Found| {
        for (i, &a) in block.faces.iter().enumerate() {
            for b in each(watch, NARROWED, &block.faces[i + 1..]) {
                let b = *b?;
                let is_near = !are_apart(&all_bounds[a as usize], &all_bounds[b as usize]);
                if !is_near || faces.polygon(a) == faces.polygon(b) {
                    continue;
                }
                let is_crossed = faces.straddles(a, b) && faces.straddles(b, a);
                let bend = || inner.bend(faces, [a, b]).map(|bend| bend.faces);
                if let Some([below, above]) =
                    if is_crossed { Some([a.min(b), a.max(b)]) } else { bend() }
                {
                    add(found, Pair { below, above })?;
                }
            }
        }
        Ok(())
    };
    sorted(found_in(all, Found::default, halves, leaf, watch)?, watch)
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
            watch.work(2 * LINES + CUT)?;
            let faces = [below, above];
            let sight = match inner.bend(stock.frame.faces, faces) {
                Some(bend) => bent(&bend, stock, &mut rims)?,
                None => straight(faces, stock, &mut rims)?,
            };
            if let Some(sight) = sight {
                push(&mut found, Crossing { faces, sight })?;
            }
        }
        finish_item(watch, i, count);
        Ok(found)
    };
    let mut all = Vec::new();
    for found in parallel_map::map(shares, share) {
        let mut found: Vec<Crossing> = found?;
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
) -> Result<Option<Sight>, Error> {
    let mut halves: SmallVec<[Half; 8]> = SmallVec::from_slice(rims.outline(stock, one)?);
    halves.extend_from_slice(rims.outline(stock, other)?);
    let View { is_positive, .. } = stock.views[one as usize];
    let cut = rims.lines.cut(one, PlaneId::face(other), true, is_positive)?;
    let lines = &rims.lines;
    let Some(common) = picture(stock, lines).within(lines, &halves, None)? else { return Ok(None) };
    if !common.meets(lines, &[cut.flipped(true)])? {
        return Ok(None);
    }
    let Some(Cell { sides }) = common.within(lines, &[cut], None)? else { return Ok(None) };
    let Some(i) = sides.iter().position(|side| side.half == cut) else { return Ok(None) };
    let next = if i + 1 == sides.len() { 0 } else { i + 1 };
    Ok(Sight::crossing(lines, [one, other], [i, next].map(|i| sides[i].start.at)))
}

/// Where a face goes through a polygon along an edge inside it.
fn bent(bend: &Bend, stock: &Stock<'_>, rims: &mut Rims<'_>) -> Result<Option<Sight>, Error> {
    let Bend { edge: (face, k), other, other_edge, .. } = *bend;
    let faces = stock.frame.faces;
    let Some(sight) = Sight::new(&rims.lines, faces.ends(face, k)) else { return Ok(None) };
    let common = match other_edge {
        Some(k) => Sight::new(&rims.lines, faces.ends(other, k)).map(|along| {
            let [a, b] = along.places.map(|place| sight.place(along.at(place)));
            [a.min(b), a.max(b)]
        }),
        None => {
            let halves: SmallVec<[Half; 8]> = SmallVec::from_slice(rims.outline(stock, other)?);
            let cell = picture(stock, &rims.lines).within(&rims.lines, &halves, None)?;
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

impl Faces {
    /// Whether a face has corners on both sides of another's plane, further from it than the tolerance.
    pub(super) fn straddles(&self, face: u32, other: u32) -> bool {
        let splitter = Exact.splitter(self, PlaneId::face(other));
        let mut sides = self.corners(face).iter().map(|at| splitter.side_beyond(self, at));
        let Some(first) = sides.find(|side| side.is_ne()) else { return false };
        sides.any(|side| side == first.reverse())
    }
}

impl Block {
    /// Both halves, across the longest side; `None` of one that is not halved.
    fn halves(&self, all_bounds: &[Bounds], watch: &Watch<'_>) -> Result<Option<[Self; 2]>, Error> {
        if self.faces.len() <= FEW || self.in_vain == IN_VAIN {
            return Ok(None);
        }
        let [low, high] = self.bounds;
        let length = |&axis: &usize| high[axis] - low[axis];
        let longest = (0..3).max_by(|a, b| length(a).total_cmp(&length(b)));
        let axis = longest.unwrap_or_default();
        let middle = 0.5 * (low[axis] + high[axis]);
        let part = || Self { bounds: self.bounds, faces: vec![], in_vain: 0 };
        let mut parts = [part(), part()];
        parts[0].bounds[1][axis] = middle;
        parts[1].bounds[0][axis] = middle;
        for face in each(watch, NARROWED, &self.faces) {
            let face = *face?;
            let [from, to] = all_bounds[face as usize];
            if from[axis] <= middle {
                push(&mut parts[0].faces, face)?;
            }
            if to[axis] >= middle {
                push(&mut parts[1].faces, face)?;
            }
        }
        let counts = parts.each_ref().map(|part| part.faces.len());
        [parts[0].in_vain, parts[1].in_vain] = in_vain(self.in_vain, self.faces.len(), counts);
        Ok(Some(parts))
    }
}

const NOTHING: Bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

fn bounds(corners: &[[f64; 3]]) -> Bounds {
    corners.iter().fold(NOTHING, |bounds, &corner| joined(bounds, [corner; 2]))
}

fn joined(a: Bounds, b: Bounds) -> Bounds {
    let axes = [0, 1, 2];
    [axes.map(|i: usize| a[0][i].min(b[0][i])), axes.map(|i: usize| a[1][i].max(b[1][i]))]
}

fn are_apart([low, high]: &Bounds, [from, to]: &Bounds) -> bool {
    (0..3).any(|axis| to[axis] < low[axis] || from[axis] > high[axis])
}
