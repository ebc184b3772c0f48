//! An overlay's lines and points: their visible parts, and their places between painted polygons.

use std::collections::BTreeMap;

use super::edges::SHORTEST;
use super::graph::Pair;
use super::lines::LineTable;
use super::map::{Hidden, VisibilityMap, each, sort_by};
use super::pairs::Found;
use super::passes::{Depths, Pass, Passes, Passing, in_layers, parts, passes, take_own};
use super::primitives::Primitives;
use super::quadtree::{CUT, Candidates, VISITED};
use super::segments::{ProjectedPoint, ProjectedSegment};
use crate::Error;
use crate::overlay::Overlay;
use crate::overlay::place::GivenSegment;
use crate::progress::Watch;

/// A part of a segment of a line of an [`Overlay`], either entirely visible or entirely hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LineRun {
    /// The index of the line, in input order.
    pub line: usize,
    /// The number of the segment in its line: segment `k` joins the corners `k` and `k + 1`.
    pub segment: usize,
    /// The start and the end of the run in the picture, in the direction of the line, in pixels.
    pub ends: [[f64; 2]; 2],
    /// Whether the run is visible.
    pub is_visible: bool,
    /// The number of polygons in front of a hidden run, including translucent polygons; 0 for a visible run.
    /// `None` unless the polygons were [counted](Hidden::Count).
    pub layers: Option<u32>,
}

/// A point of an [`Overlay`](crate::overlay::Overlay), as it appears in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MarkerView {
    /// The index of the point, in input order.
    pub point: usize,
    /// The position of the point in the picture, in pixels.
    pub position: [f64; 2],
    /// Whether the point is visible.
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
    /// Returns the lines of an [overlay](Overlay) of the same tree, clipped to the picture. Each segment is
    /// divided into [runs](LineRun), which are entirely visible or entirely hidden. With [`Hidden::Skip`],
    /// only visible runs are returned. Runs are sorted by segment in input order, then from the start of the
    /// segment to its end.
    ///
    /// A point of a line is hidden if an opaque polygon is in front of the point. It suffices that an edge or
    /// a corner of the polygon is in front of the point. Polygons seen edge-on hide nothing, and lines hide
    /// nothing. A segment seen end-on has no run.
    ///
    /// The [overlay's tolerance](Overlay#order) decides which segments lie on a polygon, as it does in orders.
    /// Consider the part of a segment that passes a polygon in the picture:
    ///
    /// - the polygon does not hide the segment if no point of the part is behind the polygon's plane by more than
    ///   the tolerance. So a line on a flat wall of many small polygons is visible, although their planes differ;
    /// - otherwise the polygon hides the whole part if no point of the whole segment is in front of the plane by
    ///   more than the tolerance;
    /// - otherwise the polygon hides what is behind the plane.
    ///
    /// (A polygon that is not planar consists of triangles, each with its own plane.) These decisions are exact;
    /// only the ends of runs are rounded.
    ///
    /// Takes O(n log n + k) for n segments and cells, and k pairs of a segment and a cell that meet in the
    /// picture. With [`Hidden::Count`], n and k also include hidden polygons.
    ///
    /// # Errors
    ///
    /// If the overlay was made for another tree; if the overlay has polygons ([`Error::polygon`] is the first
    /// polygon); or if the operation was [cancelled](Self#progress).
    pub fn lines(&self, overlay: &Overlay, hidden: Hidden) -> Result<Vec<LineRun>, Error> {
        overlay.expect_no_polygons(self.tree)?;
        let (primitives, counts) = (&self.primitives, hidden == Hidden::Count);
        let faces = primitives.lines.frame.faces;
        self.reporter.watch(1, |watch| {
            let (segments, projected) = segments(&primitives.lines, overlay, watch)?;
            let passing = Passing::new(&projected, &[], overlay.faces());
            let passes = self.in_front(passing, counts, watch)?.segments;
            let depths = match counts {
                true => Some(Depths::new(projected.len(), &passes, faces, |_, _| false, watch)?),
                false => None,
            };
            let (mut runs, mut rest) = (Vec::new(), &passes[..]);
            for (number, (segment, projected)) in segments.iter().zip(&projected).enumerate() {
                let own = take_own(&mut rest, number as u32).iter();
                watch.work(own.len() * VISITED)?;
                let is_opaque = |pass: &&Pass| primitives.views[pass.piece as usize].is_opaque;
                let mut covered: Vec<_> = own.filter(is_opaque).map(|pass| pass.places).collect();
                covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
                for (ends, is_hidden) in parts(&projected.course, covered.into_iter()) {
                    let run = LineRun::new(segment, ends, !is_hidden);
                    match &depths {
                        Some(depths) => {
                            let known = Some((&projected.course, depths.of(number)));
                            let layered = in_layers(ends, !is_hidden, known, watch)?.into_iter();
                            runs.extend(layered.map(|(ends, layers)| LineRun {
                                ends,
                                layers: Some(layers),
                                ..run
                            }));
                        }
                        None if is_hidden && hidden == Hidden::Skip => {}
                        None => runs.push(run),
                    }
                }
            }
            Ok(runs)
        })
    }

    /// Returns the points of an [overlay](Overlay) of the same tree that are in the picture, in input order.
    ///
    /// The rules of [`lines`](Self::lines) decide whether a point is hidden.
    ///
    /// # Errors
    ///
    /// As for `lines`.
    pub fn markers(&self, overlay: &Overlay) -> Result<Vec<MarkerView>, Error> {
        overlay.expect_no_polygons(self.tree)?;
        self.reporter.watch(1, |watch| {
            let (mut views, points) = points(&self.primitives.lines, overlay, watch)?;
            let passing = Passing::new(&[], &points, overlay.faces());
            for pass in self.in_front(passing, false, watch)?.points {
                views[pass.point as usize].is_visible = false;
            }
            Ok(views)
        })
    }
}

/// The segments of an overlay that the picture shows as lines.
fn segments(
    lines: &LineTable<'_>,
    overlay: &Overlay,
    watch: &Watch<'_>,
) -> Result<(Vec<GivenSegment>, Vec<ProjectedSegment>), Error> {
    let (mut segments, mut projected) = (Vec::new(), Vec::new());
    for segment in each(watch, CUT, overlay.given_segments()) {
        let segment = segment?;
        if let Some(shown) = ProjectedSegment::new(lines, segment.ends) {
            segments.push(segment);
            projected.push(shown);
        }
    }
    Ok((segments, projected))
}

/// The points of an overlay that are in the picture, not hidden so far.
fn points(
    lines: &LineTable<'_>,
    overlay: &Overlay,
    watch: &Watch<'_>,
) -> Result<(Vec<MarkerView>, Vec<ProjectedPoint>), Error> {
    let (mut views, mut projected) = (Vec::new(), Vec::new());
    for numbered in each(watch, CUT, overlay.given_points().enumerate()) {
        let (point, given) = numbered?;
        if let Some(shown) = ProjectedPoint::new(lines, given) {
            views.push(MarkerView { point, position: shown.at, is_visible: true });
            projected.push(shown);
        }
    }
    Ok((views, projected))
}

/// An overlay's lines and points in input order, lines first, each with the number of parts of the drawing
/// that precede it.
pub(super) type Placed = Vec<(u32, Overlaid)>;

/// The lines and points of an overlay, with the items that they pass.
pub(super) struct Between {
    segments: Vec<GivenSegment>,
    projected: Vec<ProjectedSegment>,
    markers: Vec<MarkerView>,
    /// The passes, sorted by lines and points.
    passes: Passes,
}

impl Between {
    pub(super) fn of(
        primitives: &Primitives<'_>,
        overlay: &Overlay,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let (segments, projected) = segments(&primitives.lines, overlay, watch)?;
        let (markers, points) = points(&primitives.lines, overlay, watch)?;
        let items = Candidates::items(primitives, |_| true)?;
        let passing = Passing::new(&projected, &points, overlay.faces());
        let mut passes = passes(items, passing, false, watch)?;
        sort_by(&mut passes.segments, watch, |a, b| a.segment.cmp(&b.segment))?;
        sort_by(&mut passes.points, watch, |a, b| a.point.cmp(&b.point))?;
        Ok(Self { segments, projected, markers, passes })
    }

    /// Places lines and points in an order of `count` parts; `places` contains the place of each item. Also
    /// returns pairs of items whose order leaves no place for a line or a point.
    pub(super) fn placed(
        &self,
        places: &[u32],
        count: usize,
        watch: &Watch<'_>,
    ) -> Result<(Placed, Found), Error> {
        let count = count as u32;
        let mut rest = &self.passes.segments[..];
        let (mut placed, mut missed) = (Vec::new(), Found::default());
        for (number, (segment, projected)) in (0..).zip(self.segments.iter().zip(&self.projected)) {
            let own = take_own(&mut rest, number);
            let parts = in_order(projected.course.places, own, places, count, &mut missed, watch)?;
            for (below, ends) in parts {
                let run = LineRun::new(segment, ends.map(|end| projected.course.at(end)), true);
                placed.push((below, Overlaid::Line(run)));
            }
        }
        let mut rest = &self.passes.points[..];
        for (number, marker) in (0..).zip(&self.markers) {
            let (own, others) = rest.split_at(rest.partition_point(|pass| pass.point == number));
            rest = others;
            watch.work(own.len() * VISITED)?;
            let mut passed = Passed::new();
            for pass in own {
                passed.insert((pass.is_behind, places[pass.piece as usize], pass.piece), 1);
            }
            add_missed(&passed, &mut missed, watch)?;
            let below = Room::between(&passed, count).most;
            placed.push((below, Overlaid::Marker(*marker)));
        }
        Ok((placed, missed))
    }
}

/// An item that is passed: whether the item is in front, its place in the order, and its number.
type Key = (bool, u32, u32);

/// The items that are passed at a point, and for each item the number of passes.
type Passed = BTreeMap<Key, i32>;

/// The places that an order allows: after at least `least` and at most `most` parts.
#[derive(Clone, Copy, Debug)]
struct Room {
    least: u32,
    most: u32,
}

impl Room {
    /// Any place in the order.
    const fn of(count: u32) -> Self {
        Self { least: 0, most: count }
    }

    /// The places after the items behind, and before the items in front. If no place satisfies both
    /// conditions, the first condition wins.
    fn between(passed: &Passed, count: u32) -> Self {
        let [last, first] = outermost(passed);
        let least = last.map_or(0, |last| last.1 + 1);
        Self { least, most: first.map_or(count, |first| first.1).max(least) }
    }

    /// The places in both rooms; `None` if no place is in both.
    fn common(self, other: Self) -> Option<Self> {
        let (least, most) = (self.least.max(other.least), self.most.min(other.most));
        (least <= most).then_some(Self { least, most })
    }
}

/// The last of the items behind, and the first of the items in front.
fn outermost(passed: &Passed) -> [Option<Key>; 2] {
    let before = passed.range(..(true, 0, 0)).next_back();
    let in_front = passed.range((true, 0, 0)..).next();
    [before, in_front].map(|end| end.map(|(key, _)| *key))
}

/// If no place remains, adds the pairs that are in the wrong order: the last item behind with each item in
/// front that precedes the last item behind; and the first item in front with each item behind that follows
/// the first item in front.
fn add_missed(passed: &Passed, missed: &mut Found, watch: &Watch<'_>) -> Result<(), Error> {
    let [Some(below), Some(above)] = outermost(passed) else { return Ok(()) };
    if above.1 >= below.1 {
        return Ok(());
    }
    for early in each(watch, VISITED, passed.range((true, 0, 0)..(true, below.1, 0))) {
        missed.insert(Pair { below: below.2, above: early?.0.2 });
    }
    for late in each(watch, VISITED, passed.range((false, above.1 + 1, 0)..(true, 0, 0))) {
        missed.insert(Pair { below: late?.0.2, above: above.2 });
    }
    Ok(())
}

/// Divides a segment into as few runs as possible, according to the items that the segment passes. Each run
/// has the number of parts of the drawing that precede the run. Adds the pairs of items that leave no place
/// for a run.
fn in_order(
    ends: [f64; 2],
    passes: &[Pass],
    places: &[u32],
    count: u32,
    missed: &mut Found,
    watch: &Watch<'_>,
) -> Result<Vec<(u32, [f64; 2])>, Error> {
    // The start and end of each pass.
    let mut events = Vec::new();
    for pass in passes {
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
    // The last possible place: then neighbours cover the least part of a wide stroke.
    parts.push((room.most, [start, ends[1]]));
    Ok(parts)
}
