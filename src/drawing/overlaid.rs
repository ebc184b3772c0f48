//! An overlay's lines and points: which parts are visible, and where they come between painted polygons.

use std::collections::BTreeMap;

use super::cell::are_apart;
use super::edges::{SHORTEST, in_layers};
use super::leaf::{Leaf, Visible};
use super::lines::LineTable;
use super::map::{Hidden, VisibilityMap, each, sort_by};
use super::order::{Found, Pair, add, around};
use super::primitives::Primitives;
use super::sight::{Pass, Passes, Passing, Pieces, ProjectedSegment, Spot, kept, parts, passes};
use super::tile::{CUT, Reaches, VISITED, found_in};
use crate::Error;
use crate::overlay::Overlay;
use crate::overlay::place::GivenSegment;
use crate::progress::Watch;

/// A part of a segment of an overlay's line, visible or hidden from one end to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LineRun {
    /// The line, by its number in the overlay.
    pub line: usize,
    /// The number of the segment in its line: it joins the corners of this number and the next.
    pub segment: usize,
    /// Where the run begins and ends in the picture, in the direction of the line, in pixels.
    pub ends: [[f64; 2]; 2],
    /// Whether it is visible.
    pub is_visible: bool,
    /// The number of polygons in front of it; `None` unless they were [counted](Hidden::Count). It is 0 of a visible
    /// run: polygons that it is seen through do not count.
    pub layers: Option<u32>,
}

/// A point of an overlay in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MarkerView {
    /// The point, by its number in the overlay.
    pub point: usize,
    /// Where it is in the picture, in pixels.
    pub at: [f64; 2],
    /// Whether it is visible.
    pub is_visible: bool,
}

/// A line or a point that is in a drawing.
#[derive(Clone, Copy, Debug)]
pub(super) enum Overlaid {
    Line(LineRun),
    Marker(MarkerView),
}

impl LineRun {
    pub(super) fn new(segment: &GivenSegment, ends: [[f64; 2]; 2], is_visible: bool) -> Self {
        let GivenSegment { line, number, .. } = *segment;
        Self { line, segment: number, ends, is_visible, layers: None }
    }
}

impl VisibilityMap<'_> {
    /// The lines of an overlay of the same tree, as far as they are in the picture, in runs that are visible
    /// or, unless they are [skipped](Hidden::Skip), hidden: in input order, and along each segment from its beginning to its end.
    ///
    /// A point of a line is hidden if a polygon that shows a side to the camera lies in front of it, be it
    /// with its edge or a corner alone. A segment that is no further from a polygon's plane than the
    /// tolerance lies on it, and is not hidden by it; one that is further from it on one side only is treated as
    /// wholly on that side. This is decided in integers; only the ends of runs are rounded. Polygons seen
    /// edge-on hide nothing, lines hide nothing, and a segment that is seen end-on has no run.
    ///
    /// O(n log n) for n segments and cells, plus the number of pairs that have points in common.
    ///
    /// # Errors
    ///
    /// If the overlay was made for another tree; if it has polygons, the first of
    /// which is [`Error::polygon`]; or if it was [cancelled](Self#progress).
    pub fn lines(&self, overlay: &Overlay, hidden: Hidden) -> Result<Vec<LineRun>, Error> {
        overlay.expect_no_polygons(self.tree)?;
        let counts = hidden == Hidden::Count;
        self.reporter.watch(if counts { 3 } else { 1 }, |watch| {
            let (segments, sights) = sights(&self.primitives.lines, overlay, watch)?;
            let mut runs = self.line_runs(&segments, &sights, watch)?;
            match hidden {
                Hidden::Skip => runs.retain(|run| run.is_visible),
                Hidden::Keep => {}
                Hidden::Count => runs = self.lines_in_layers(&segments, &sights, &runs, watch)?,
            }
            Ok(runs)
        })
    }

    /// Runs, cut where the number of polygons in front of them changes: two phases.
    fn lines_in_layers(
        &self,
        segments: &[GivenSegment],
        sights: &[ProjectedSegment],
        runs: &[LineRun],
        watch: &Watch<'_>,
    ) -> Result<Vec<LineRun>, Error> {
        let depths = self.depths(sights, |_, _| false, watch)?;
        let mut layered = Vec::new();
        let mut runs = runs.iter().peekable();
        for numbered in each(watch, VISITED, segments.iter().enumerate()) {
            let (number, segment) = numbered?;
            let name = (segment.line, segment.number);
            while let Some(run) = runs.next_if(|run| (run.line, run.segment) == name) {
                let known = Some((&sights[number], depths.of(number)));
                for (ends, layers) in in_layers(run.ends, run.is_visible, known, watch)? {
                    layered.push(LineRun { ends, layers: Some(layers), ..*run });
                }
            }
        }
        Ok(layered)
    }

    /// The runs of segments that the picture shows: a phase.
    pub(super) fn line_runs(
        &self,
        segments: &[GivenSegment],
        sights: &[ProjectedSegment],
        watch: &Watch<'_>,
    ) -> Result<Vec<LineRun>, Error> {
        let mut hidden = self.covered(Passing { sights, spots: &[] }, watch)?.hidden;
        sort_by(&mut hidden, watch, |(a, p), (b, q)| a.cmp(b).then(p[0].total_cmp(&q[0])))?;
        let mut rest = &hidden[..];
        let mut runs = Vec::new();
        for segment in each(watch, VISITED, (0..).zip(segments.iter().zip(sights))) {
            let (number, (segment, sight)) = segment?;
            let (own, others) = rest.split_at(rest.partition_point(|&(of, _)| of == number));
            rest = others;
            watch.work(own.len())?;
            for (ends, is_hidden) in parts(&sight.course, own.iter().map(|(_, part)| *part)) {
                runs.push(LineRun::new(segment, ends, !is_hidden));
            }
        }
        Ok(runs)
    }

    /// The points of an overlay of the same tree that are in the picture, in input order.
    ///
    /// A point is hidden as a point of a line is: see [`lines`](Self::lines).
    ///
    /// # Errors
    ///
    /// As for `lines`.
    pub fn markers(&self, overlay: &Overlay) -> Result<Vec<MarkerView>, Error> {
        overlay.expect_no_polygons(self.tree)?;
        self.reporter.watch(1, |watch| {
            let (mut views, spots) = spots(&self.primitives.lines, overlay, watch)?;
            let hidden = self.covered(Passing { sights: &[], spots: &spots }, watch)?.hidden_spots;
            for number in each(watch, 1, hidden) {
                views[number? as usize].is_visible = false;
            }
            Ok(views)
        })
    }

    /// What is hidden of segments and points, in no particular order: a phase.
    fn covered<'m>(&'m self, passing: Passing<'_>, watch: &Watch<'_>) -> Result<Covered, Error> {
        let sights: Vec<_> = (0..passing.sights.len() as u32).collect();
        let spots: Vec<_> = (0..passing.spots.len() as u32).collect();
        let all = LeafPasses { leaves: &self.leaves, sights, spots };
        let halves = |part: &LeafPasses<'m>, _: &mut Covered| part.halves(passing, watch);
        let leaf =
            |part: &LeafPasses<'_>, found: &mut Covered| part.leaf(self, passing, found, watch);
        let mut all_found = Covered::default();
        for mut found in found_in(all, Covered::default, halves, leaf, watch)? {
            watch.work(found.hidden.len() + found.hidden_spots.len())?;
            all_found.hidden.reserve(found.hidden.len());
            all_found.hidden.append(&mut found.hidden);
            all_found.hidden_spots.reserve(found.hidden_spots.len());
            all_found.hidden_spots.append(&mut found.hidden_spots);
        }
        Ok(all_found)
    }
}

/// The segments of an overlay that the picture shows as lines.
pub(super) fn sights(
    lines: &LineTable<'_>,
    overlay: &Overlay,
    watch: &Watch<'_>,
) -> Result<(Vec<GivenSegment>, Vec<ProjectedSegment>), Error> {
    let (mut segments, mut sights) = (Vec::new(), Vec::new());
    for segment in each(watch, CUT, overlay.given_segments()) {
        let segment = segment?;
        if let Some(sight) = ProjectedSegment::new(lines, segment.ends) {
            segments.push(segment);
            sights.push(sight);
        }
    }
    Ok((segments, sights))
}

/// The points of an overlay that are in the picture, not hidden so far.
pub(super) fn spots(
    lines: &LineTable<'_>,
    overlay: &Overlay,
    watch: &Watch<'_>,
) -> Result<(Vec<MarkerView>, Vec<Spot>), Error> {
    let (mut views, mut spots) = (Vec::new(), Vec::new());
    for numbered in each(watch, CUT, overlay.given_points().enumerate()) {
        let (point, given) = numbered?;
        if let Some(spot) = Spot::new(lines, given) {
            views.push(MarkerView { point, at: spot.at, is_visible: true });
            spots.push(spot);
        }
    }
    Ok((views, spots))
}

/// What is hidden.
#[derive(Default)]
struct Covered {
    /// Of segments, by their numbers: from one place to another.
    hidden: Vec<(u32, [f64; 2])>,
    hidden_spots: Vec<u32>,
}

/// Leaves, with the segments and points that may be in them.
struct LeafPasses<'l> {
    leaves: &'l [Leaf],
    sights: Vec<u32>,
    spots: Vec<u32>,
}

impl<'l> LeafPasses<'l> {
    /// The first and the second half of the leaves; `None` of a single one, or where nothing is.
    fn halves(&self, passing: Passing<'_>, watch: &Watch<'_>) -> Result<Option<[Self; 2]>, Error> {
        let Self { leaves, sights, spots } = self;
        if leaves.len() < 2 || sights.is_empty() && spots.is_empty() {
            return Ok(None);
        }
        let (first, second) = leaves.split_at(leaves.len() / 2);
        let part = |leaves: &'l [Leaf]| {
            let around = around(leaves);
            let may_meet = |number: u32| passing.sights[number as usize].may_meet(&around);
            let sights = kept(sights, may_meet, watch)?;
            let is_near =
                |number: u32| !are_apart(&around, &passing.spots[number as usize].around());
            Ok(Self { leaves, sights, spots: kept(spots, is_near, watch)? })
        };
        Ok(Some([part(first)?, part(second)?]))
    }

    /// Adds what the cells of the leaves hide.
    fn leaf(
        &self,
        map: &VisibilityMap<'_>,
        passing: Passing<'_>,
        found: &mut Covered,
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let (primitives, lines) = (&map.primitives, &map.primitives.lines);
        for Visible { item, cell } in self.leaves.iter().flat_map(|leaf| &leaf.cells) {
            watch.work(CUT)?;
            // What is behind something translucent shows through.
            if !primitives.is_opaque(*item) {
                continue;
            }
            let around = cell.around();
            let face = primitives.face(*item);
            let mut side = None;
            let mut seen = || *side.get_or_insert_with(|| lines.frame.seen_side(face));
            for number in each(watch, CUT, &self.sights) {
                let number = *number?;
                let sight = &passing.sights[number as usize];
                if !sight.may_meet(&around) {
                    continue;
                }
                let Some([from, to]) = sight.chord(lines, cell) else { continue };
                let Some([first, last]) = sight.behind(lines, face, seen()) else { continue };
                let (from, to) = (from.max(first), to.min(last));
                if from < to {
                    found.hidden.push((number, [from, to]));
                }
            }
            for number in each(watch, CUT, &self.spots) {
                let number = *number?;
                let spot = &passing.spots[number as usize];
                if !are_apart(&around, &spot.around())
                    && spot.is_in(lines, cell)
                    && spot.is_behind(lines, face, seen())
                {
                    found.hidden_spots.push(number);
                }
            }
        }
        Ok(())
    }
}

/// An overlay's lines and points, each with how many parts of the drawing come before it: in input order, lines
/// first.
pub(super) type Placed = Vec<(u32, Overlaid)>;

/// The lines and points of an overlay, with the items that they pass.
pub(super) struct Between {
    segments: Vec<GivenSegment>,
    sights: Vec<ProjectedSegment>,
    markers: Vec<MarkerView>,
    /// Sorted by the lines and points.
    passes: Passes,
}

impl Between {
    pub(super) fn of(
        primitives: &Primitives<'_>,
        overlay: &Overlay,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let (segments, sights) = sights(&primitives.lines, overlay, watch)?;
        let (markers, spots) = spots(&primitives.lines, overlay, watch)?;
        let mut reaches = Reaches::default();
        for item in each(watch, VISITED, 0..primitives.items.len() as u32) {
            let item = item?;
            reaches.push(item, primitives.halves(item))?;
        }
        let face = |item: u32| primitives.face(item);
        let around = |item: u32| primitives.items[item as usize].around;
        let pieces = Pieces { lines: &primitives.lines, reaches, face: &face, around: &around };
        let passing = Passing { sights: &sights, spots: &spots };
        let mut passes = passes(pieces, passing, |_| true, watch)?;
        sort_by(&mut passes.sights, watch, |a, b| a.sight.cmp(&b.sight))?;
        sort_by(&mut passes.spots, watch, |a, b| a.spot.cmp(&b.spot))?;
        Ok(Self { segments, sights, markers, passes })
    }

    /// What comes where in an order of so many parts, by the place of each item in it; and pairs of items that
    /// the order would have to keep for a line or point between them.
    pub(super) fn placed(
        &self,
        places: &[u32],
        count: usize,
        watch: &Watch<'_>,
    ) -> Result<(Placed, Found), Error> {
        let count = count as u32;
        let mut rest = &self.passes.sights[..];
        let (mut placed, mut missed) = (Vec::new(), Found::default());
        for (number, (segment, sight)) in (0..).zip(self.segments.iter().zip(&self.sights)) {
            let (own, others) = rest.split_at(rest.partition_point(|pass| pass.sight == number));
            rest = others;
            let parts = in_order(sight.course.places, own, places, count, &mut missed, watch)?;
            for (below, ends) in parts {
                let run = LineRun::new(segment, ends.map(|end| sight.course.at(end)), true);
                placed.push((below, Overlaid::Line(run)));
            }
        }
        let mut rest = &self.passes.spots[..];
        for (number, marker) in (0..).zip(&self.markers) {
            let (own, others) = rest.split_at(rest.partition_point(|pass| pass.spot == number));
            rest = others;
            let mut passed = Passed::new();
            for pass in each(watch, VISITED, own) {
                let pass = pass?;
                passed.insert((pass.is_behind, places[pass.piece as usize], pass.piece), 1);
            }
            add_missed(&passed, &mut missed, watch)?;
            let below = Room::between(&passed, count).most;
            placed.push((below, Overlaid::Marker(*marker)));
        }
        Ok((placed, missed))
    }
}

/// An item that is passed: whether it is in front, its place in the order, and its number.
type Key = (bool, u32, u32);

/// What is passed somewhere, and how often.
type Passed = BTreeMap<Key, i32>;

/// Where in an order something may come: after so many parts.
#[derive(Clone, Copy, Debug)]
struct Room {
    least: u32,
    most: u32,
}

impl Room {
    /// Anywhere.
    const fn of(count: u32) -> Self {
        Self { least: 0, most: count }
    }

    /// After what is passed before it, and before what is in front. Where that is nowhere, only the first.
    fn between(passed: &Passed, count: u32) -> Self {
        let [last, first] = outermost(passed);
        let least = last.map_or(0, |last| last.1 + 1);
        Self { least, most: first.map_or(count, |first| first.1).max(least) }
    }

    /// What is in both.
    fn common(self, other: Self) -> Option<Self> {
        let (least, most) = (self.least.max(other.least), self.most.min(other.most));
        (least <= most).then_some(Self { least, most })
    }
}

/// What comes last of what is passed before it, and first of what is in front.
fn outermost(passed: &Passed) -> [Option<Key>; 2] {
    let before = passed.range(..(true, 0, 0)).next_back();
    let in_front = passed.range((true, 0, 0)..).next();
    [before, in_front].map(|end| end.map(|(key, _)| *key))
}

/// Adds pairs that leave no place: of what is last of all that has to come before, and all that has to come after
/// and does not; and of what is first of all that has to come after, and all that has to come before and does
/// not.
fn add_missed(passed: &Passed, missed: &mut Found, watch: &Watch<'_>) -> Result<(), Error> {
    let [Some(below), Some(above)] = outermost(passed) else { return Ok(()) };
    if above.1 >= below.1 {
        return Ok(());
    }
    for early in each(watch, VISITED, passed.range((true, 0, 0)..(true, below.1, 0))) {
        add(missed, Pair { below: below.2, above: early?.0.2 });
    }
    for late in each(watch, VISITED, passed.range((false, above.1 + 1, 0)..(true, 0, 0))) {
        add(missed, Pair { below: late?.0.2, above: above.2 });
    }
    Ok(())
}

/// A segment in as few runs as can be, each with how many parts of the drawing come before it, by what it
/// passes. Adds pairs that leave no place between them.
fn in_order(
    ends: [f64; 2],
    passes: &[Pass],
    places: &[u32],
    count: u32,
    missed: &mut Found,
    watch: &Watch<'_>,
) -> Result<Vec<(u32, [f64; 2])>, Error> {
    // Where each pass begins and ends.
    let mut events = Vec::new();
    for pass in each(watch, VISITED, passes) {
        let pass = pass?;
        let key = (pass.is_behind, places[pass.piece as usize], pass.piece);
        for (at, change) in [(pass.places[0], 1), (pass.places[1], -1)] {
            events.push((at, key, change));
        }
    }
    sort_by(&mut events, watch, |a, b| a.0.total_cmp(&b.0))?;
    let (mut passed, mut parts) = (Passed::new(), Vec::new());
    let [mut start, mut done] = [ends[0]; 2];
    let mut room = Room::of(count);
    let stops = events.iter().map(|event| event.0.clamp(ends[0], ends[1]));
    for numbered in each(watch, 2 * VISITED, stops.chain([ends[1]]).enumerate()) {
        let (i, to) = numbered?;
        if to - done >= SHORTEST {
            add_missed(&passed, missed, watch)?;
            let next = Room::between(&passed, count);
            if let Some(common) = room.common(next) {
                room = common;
            } else {
                parts.push((room.most, [start, done]));
                (start, room) = (done, next);
            }
            done = to;
        }
        if let Some(&(_, key, change)) = events.get(i) {
            let count = passed.entry(key).or_insert(0);
            *count += change;
            if *count == 0 {
                passed.remove(&key);
            }
        }
    }
    // The last place: what lies beside then covers least of a wide stroke.
    parts.push((room.most, [start, ends[1]]));
    Ok(parts)
}
