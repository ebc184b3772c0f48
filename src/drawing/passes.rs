//! The pieces that are in front of segments and points in the picture, or behind them.
//!
//! The number of polygons in front of a segment is its quantitative invisibility (A. Appel, "The notion of
//! quantitative invisibility and the machine rendering of solids", 1967).

use smallvec::SmallVec;

use super::cell::{Cell, Rect, are_apart};
use super::edges::SHORTEST;
use super::lines::LineTable;
use super::map::{VisibilityMap, sort_by};
use super::pairs::around;
use super::primitives::Primitives;
use super::quadtree::{
    CUT, Candidates, Leaf, NARROWED, SubTile, TINIEST, TileList, VISITED, Visible, found_in,
};
use super::segments::{ImageLine, ProjectedPoint, ProjectedSegment};
use crate::Error;
use crate::exact::Faces;
use crate::progress::Watch;

/// A part of a segment that passes in front of or behind an item or a face, over the inside or along the
/// border of that item or face in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass {
    /// The numbers of the segment and of the item or face.
    pub(super) segment: u32,
    pub(super) piece: u32,
    /// Whether the segment is behind the piece.
    pub(super) is_behind: bool,
    /// The places along the segment at which the part begins and ends.
    pub(super) places: [f64; 2],
}

/// A point that in the picture is inside an item or a face, or on the border of that item or face.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointPass {
    pub(super) point: u32,
    pub(super) piece: u32,
    /// Whether the point is behind the piece.
    pub(super) is_behind: bool,
}

/// Segments and points, and the numbers of the segments and points that may be in a part of the picture.
#[derive(Clone)]
pub(super) struct Passing<'a> {
    segments: &'a [ProjectedSegment],
    points: &'a [ProjectedPoint],
    /// The faces whose tolerance decides what lies on a plane: those of the tree, or of an overlay, which begin with
    /// those of the tree.
    faces: &'a Faces,
    near_segments: Vec<u32>,
    near_points: Vec<u32>,
}

impl<'a> Passing<'a> {
    /// No segments and no points.
    pub(super) fn nothing(faces: &'a Faces) -> Self {
        Self::new(&[], &[], faces)
    }

    pub(super) fn new(
        segments: &'a [ProjectedSegment],
        points: &'a [ProjectedPoint],
        faces: &'a Faces,
    ) -> Self {
        let near_segments = (0..segments.len() as u32).collect();
        let near_points = (0..points.len() as u32).collect();
        Self { segments, points, faces, near_segments, near_points }
    }

    fn is_empty(&self) -> bool {
        self.near_segments.is_empty() && self.near_points.is_empty()
    }

    /// The segments and points that may be in a box.
    fn near(&self, sides: &Rect) -> Self {
        self.filtered(|segment| segment.may_meet(sides), |point| !are_apart(sides, &point.around()))
    }

    /// The segments and points in a cell.
    pub(super) fn over(&self, lines: &LineTable<'_>, cell: &Cell) -> Self {
        self.filtered(|segment| segment.meets(lines, cell), |point| point.is_in(lines, cell))
    }

    fn filtered(
        &self,
        has_segment: impl Fn(&ProjectedSegment) -> bool,
        has_point: impl Fn(&ProjectedPoint) -> bool,
    ) -> Self {
        let (segments, points) = (self.near_segments.iter(), self.near_points.iter());
        let segments = segments.filter(|&&number| has_segment(&self.segments[number as usize]));
        let points = points.filter(|&&number| has_point(&self.points[number as usize]));
        let near_segments = segments.copied().collect();
        Self { near_segments, near_points: points.copied().collect(), ..*self }
    }
}

/// The passes found: one segment may pass a piece in several parts, and one point may be found twice.
#[derive(Default)]
pub(super) struct Passes {
    pub(super) segments: Vec<Pass>,
    pub(super) points: Vec<PointPass>,
}

/// Tiles are not halved if at most this many pieces reach into them without covering them. Too small: more
/// tiles, and more parts of segments (8: twice the time, for crossing triangles five times). Too large: more
/// segments are compared with more pieces (128: up to a sixth less time).
const FEW_CANDIDATES: usize = 64;

/// The passes of segments and points behind candidates and, unless `wants_behind_only`, in front of
/// candidates. Counts as one phase of the progress.
pub(super) fn passes<'p>(
    candidates: Candidates<'p>,
    passing: Passing<'p>,
    wants_behind_only: bool,
    watch: &Watch<'_>,
) -> Result<Passes, Error> {
    let primitives = candidates.primitives;
    type Part<'p> = (TileList<'p>, Passing<'p>);
    let halves = |(list, passing): &Part<'p>| {
        if passing.is_empty() || list.open() <= FEW_CANDIDATES || list.is_small(TINIEST) {
            return Ok(None);
        }
        watch.work((passing.near_segments.len() + passing.near_points.len()) * NARROWED)?;
        let halves = list.halves(watch)?;
        Ok(Some(halves.map(|half| {
            let passing = passing.near(&half.tile.sides());
            (half, passing)
        })))
    };
    let leaf = |(list, passing): &Part<'p>, found: &mut Passes| {
        if passing.is_empty() {
            return Ok(());
        }
        let whole = SubTile::new(list, passing.clone(), watch)?;
        let see = |part: SubTile<'_, '_>| {
            let face = |number: u32| part.candidates.face(number);
            found.add(primitives, &part.pieces, face, &part.passing, wants_behind_only, watch)
        };
        whole.for_each_part(see, watch)
    };
    let all = (TileList::picture(candidates, watch)?, passing);
    Ok(Passes::joined(found_in(all, halves, leaf, watch)?))
}

impl Passes {
    fn joined(parts: Vec<Self>) -> Self {
        let mut joined = Self::default();
        for mut part in parts {
            joined.segments.append(&mut part.segments);
            joined.points.append(&mut part.points);
        }
        joined
    }

    /// Adds the passes in front of or behind pieces. Pieces have the numbers of items or faces.
    fn add<'c>(
        &mut self,
        primitives: &Primitives<'_>,
        pieces: impl IntoIterator<Item = &'c Visible>,
        face: impl Fn(u32) -> u32,
        passing: &Passing<'_>,
        wants_behind_only: bool,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let Passing { segments, points, faces, near_segments, near_points } = passing;
        let lines = &primitives.lines;
        for Visible { item: piece, cell } in pieces {
            watch.work((near_segments.len() + near_points.len()) * CUT)?;
            let (around, face) = (cell.around(), face(*piece));
            let side = primitives.views[face as usize].side;
            for &number in near_segments {
                let segment = &segments[number as usize];
                if !segment.may_meet(&around) {
                    continue;
                }
                let Some(chord) = segment.chord(lines, cell) else { continue };
                let mut add = |is_behind: bool, [from, to]: [f64; 2]| {
                    let places = [from.max(chord[0]), to.min(chord[1])];
                    if places[0] < places[1] && (is_behind || !wants_behind_only) {
                        self.segments.push(Pass {
                            segment: number,
                            piece: *piece,
                            is_behind,
                            places,
                        });
                    }
                };
                let behind = segment.behind(primitives, faces, (face, chord));
                let [from, to] = behind.unwrap_or([f64::INFINITY; 2]);
                add(true, [from, to]);
                add(false, [f64::NEG_INFINITY, from]);
                add(false, [to, f64::INFINITY]);
            }
            for &number in near_points {
                let point = &points[number as usize];
                if are_apart(&around, &point.around()) || !point.is_in(lines, cell) {
                    continue;
                }
                let is_behind = point.is_behind(faces, face, side);
                if is_behind || !wants_behind_only {
                    self.points.push(PointPass { point: number, piece: *piece, is_behind });
                }
            }
        }
        Ok(())
    }
}

/// The number of polygons in front of a segment, from the place `from` to the next place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    from: f64,
    layers: u32,
}

/// The quantitative invisibility along segments, one list for each segment, and the start of each list.
/// Before the first place of a list, nothing is in front of the segment.
pub(super) struct Depths {
    depths: Vec<Depth>,
    begins: Vec<usize>,
}

impl Depths {
    /// The depths of `count` segments, by sorted passes. A segment's own faces do not count.
    pub(super) fn new(
        count: usize,
        passes: &[Pass],
        faces: &Faces,
        is_own: impl Fn(u32, u32) -> bool,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let mut all = Self { depths: vec![], begins: vec![0] };
        let (mut changes, mut rest) = (Vec::new(), passes);
        let polygon = |pass: &Pass| faces.polygon(pass.piece);
        for number in 0..count as u32 {
            let own = take_own(&mut rest, number);
            changes.clear();
            watch.work(own.len() * VISITED)?;
            for same in own.chunk_by(|a, b| polygon(a) == polygon(b)) {
                // Each polygon counts once, however many parts it has.
                let counts = |pass: &&Pass| !is_own(number, pass.piece);
                for [from, to] in merged(same.iter().filter(counts).map(|pass| pass.places)) {
                    changes.push((from, 1));
                    changes.push((to, -1));
                }
            }
            sort_by(&mut changes, watch, |a, b| a.0.total_cmp(&b.0))?;
            let mut layers = 0i64;
            for &(from, change) in &changes {
                layers += change;
                all.depths.push(Depth { from, layers: layers as u32 });
            }
            all.begins.push(all.depths.len());
        }
        Ok(all)
    }

    pub(super) fn of(&self, segment: usize) -> &[Depth] {
        &self.depths[self.begins[segment]..self.begins[segment + 1]]
    }
}

/// Removes the passes of a segment from the start of a list that is sorted by segments, and returns these
/// passes.
pub(super) fn take_own<'p>(passes: &mut &'p [Pass], segment: u32) -> &'p [Pass] {
    let (own, rest) = passes.split_at(passes.partition_point(|pass| pass.segment == segment));
    *passes = rest;
    own
}

impl VisibilityMap<'_> {
    /// The passes of segments behind faces, sorted by segments, polygons and places, and the passes of
    /// points. Hidden and translucent faces are included only if `wants_all`. Counts as one phase of the
    /// progress.
    pub(super) fn in_front<'l>(
        &'l self,
        passing: Passing<'l>,
        wants_all: bool,
        watch: &Watch<'_>,
    ) -> Result<Passes, Error> {
        let primitives = &self.primitives;
        let mut passes = match wants_all {
            true => passes(Candidates::faces(primitives, |_| true)?, passing, true, watch)?,
            false => self.behind_visible(passing, watch)?,
        };
        let key = |pass: &Pass| (pass.segment, primitives.lines.frame.faces.polygon(pass.piece));
        sort_by(&mut passes.segments, watch, |a, b| {
            key(a).cmp(&key(b)).then(a.places[0].total_cmp(&b.places[0]))
        })?;
        Ok(passes)
    }

    /// The passes of segments and points behind visible parts of opaque faces. Counts as one phase of the
    /// progress.
    fn behind_visible<'l>(
        &'l self,
        passing: Passing<'l>,
        watch: &Watch<'_>,
    ) -> Result<Passes, Error> {
        type Part<'l> = (&'l [Leaf], Passing<'l>);
        let primitives = &self.primitives;
        let halves = |(leaves, passing): &Part<'l>| {
            if leaves.len() < 2 || passing.is_empty() {
                return Ok(None);
            }
            watch.work((passing.near_segments.len() + passing.near_points.len()) * NARROWED)?;
            let (first, second) = leaves.split_at(leaves.len() / 2);
            Ok(Some([first, second].map(|leaves| (leaves, passing.near(&around(leaves))))))
        };
        let leaf = |(leaves, passing): &Part<'l>, found: &mut Passes| {
            let opaque = leaves.iter().flat_map(|leaf| &leaf.cells);
            let opaque = opaque.filter(|visible| primitives.is_opaque(visible.item));
            let face = |item: u32| primitives.face(item);
            found.add(primitives, opaque, face, passing, true, watch)
        };
        let all = (&self.leaves[..], passing);
        let mut passes = Passes::joined(found_in(all, halves, leaf, watch)?);
        passes.segments.iter_mut().for_each(|pass| pass.piece = primitives.face(pass.piece));
        Ok(passes)
    }
}

/// Merges intervals that overlap, or that meet up to rounding. The intervals are given in the order of their
/// starts.
pub(super) fn merged(intervals: impl Iterator<Item = [f64; 2]>) -> impl Iterator<Item = [f64; 2]> {
    let mut intervals = intervals.peekable();
    std::iter::from_fn(move || {
        let [from, mut to] = intervals.next()?;
        while let Some(next) = intervals.next_if(|next| next[0] <= to + SHORTEST) {
            to = to.max(next[1]);
        }
        Some([from, to])
    })
}

/// Divides a segment into parts inside and outside of intervals, which are given in the order of their
/// starts. Returns the ends of each part, and whether the part is inside.
pub(super) fn parts(
    course: &ImageLine,
    intervals: impl Iterator<Item = [f64; 2]>,
) -> SmallVec<[([[f64; 2]; 2], bool); 4]> {
    let mut found = SmallVec::new();
    let mut add = |from: f64, to: f64, is_inside: bool| {
        if to - from >= SHORTEST {
            found.push(([course.at(from), course.at(to)], is_inside));
        }
    };
    let [mut done, end] = course.places;
    for [from, to] in merged(intervals) {
        let (from, to) = (from.max(done), to.min(end));
        if to - from < SHORTEST {
            continue;
        }
        add(done, from, false);
        add(from, to, true);
        done = to;
    }
    add(done, end, false);
    found
}

/// Both ends of a run.
type Ends = [[f64; 2]; 2];

/// The parts of a run, and the number of layers in front of each: at least one for a hidden run. Parts that
/// are only due to rounding are merged with the previous parts.
pub(super) fn in_layers(
    ends: Ends,
    is_visible: bool,
    depths: Option<(&ImageLine, &[Depth])>,
    watch: &Watch<'_>,
) -> Result<Vec<(Ends, u32)>, Error> {
    let Some((line, depths)) = depths.filter(|_| !is_visible) else {
        return Ok(vec![(ends, u32::from(!is_visible))]);
    };
    let [a, b] = ends.map(|end| line.place(end));
    let (low, high) = (a.min(b), a.max(b));
    // The start of each part, as a place along the segment, and its layers.
    let mut parts: Vec<(f64, u32)> = Vec::new();
    let first = depths.partition_point(|depth| depth.from <= low);
    let before = first.checked_sub(1).map_or(0, |before| depths[before].layers);
    let inside = depths[first..].iter().take_while(|depth| depth.from < high);
    let begins = inside.map(|depth| (depth.from, depth.layers));
    let mut begins = [(low, before)].into_iter().chain(begins).peekable();
    while let Some((from, layers)) = begins.next() {
        watch.work(1)?;
        let to = begins.peek().map_or(high, |next| next.0);
        let layers = layers.max(1);
        let goes_on = parts.last().is_some_and(|last| last.1 == layers);
        if to - from >= SHORTEST && !goes_on {
            // (The first part begins where the run does.)
            parts.push((from, layers));
        }
    }
    if parts.is_empty() {
        return Ok(vec![(ends, before.max(1))]);
    }
    let at = |place: f64| {
        let share = (place - a) / (b - a);
        [0, 1].map(|i: usize| ends[0][i] + (ends[1][i] - ends[0][i]) * share)
    };
    let count = parts.len();
    let cut = |i: usize| if i == 0 || i == count { None } else { Some(at(parts[i].0)) };
    let end = |i: usize| cut(i).unwrap_or(ends[usize::from((i == 0) != (a < b))]);
    let mut all: Vec<_> = (0..count).map(|i| ([end(i), end(i + 1)], parts[i].1)).collect();
    if a > b {
        all.reverse();
        all.iter_mut().for_each(|(ends, _)| ends.swap(0, 1));
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COURSE: ImageLine = ImageLine::TEN_ALONG_X;

    /// The ends of parts, and whether each is inside.
    fn parts_of(intervals: &[[f64; 2]]) -> Vec<([f64; 2], bool)> {
        let parts = parts(&COURSE, intervals.iter().copied()).into_iter();
        parts.map(|([[a, _], [b, _]], is_inside)| ([a, b], is_inside)).collect()
    }

    #[test]
    fn intervals_and_gaps_of_rounding_make_no_parts() {
        let [low, high] = [3.0, 3.0 + 1e-9];
        assert_eq!(parts_of(&[[low, high]]), [([0.0, 10.0], false)]);
        let whole = [([0.0, 2.0], false), ([2.0, 4.0], true), ([4.0, 10.0], false)];
        assert_eq!(parts_of(&[[2.0, low], [high, 4.0]]), whole);
        assert_eq!(parts_of(&[[2.0, 4.0], [low, high]]), whole);
        assert_eq!(parts_of(&[[-1.0, 1e-9], [10.0 - 1e-9, 11.0]]), [([0.0, 10.0], false)]);
    }

    /// The starts and layers of the parts of a run from place 0 to 10.
    fn layers_of(depths: &[(f64, u32)]) -> Vec<([f64; 2], u32)> {
        let depths: Vec<Depth> =
            depths.iter().map(|&(from, layers)| Depth { from, layers }).collect();
        let ends = [[0.0; 2], [10.0, 0.0]];
        let known = Some((&COURSE, &depths[..]));
        let parts = in_layers(ends, false, known, &Watch::default()).expect("not cancelled");
        parts.into_iter().map(|([[a, _], [b, _]], layers)| ([a, b], layers)).collect()
    }

    #[test]
    fn layers_over_a_stretch_of_rounding_belong_to_the_part_before() {
        let parts = layers_of(&[(-5.0, 1), (4.0, 3), (4.0 + 1e-9, 2), (12.0, 0)]);
        assert_eq!(parts, [([0.0, 4.0 + 1e-9], 1), ([4.0 + 1e-9, 10.0], 2)]);
        // At the start, there is no part before.
        assert_eq!(layers_of(&[(-5.0, 1), (1e-9, 2), (12.0, 0)]), [([0.0, 10.0], 2)]);
        assert_eq!(layers_of(&[(-5.0, 0), (12.0, 0)]), [([0.0, 10.0], 1)]);
    }
}
