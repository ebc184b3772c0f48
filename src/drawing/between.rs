//! Lines and points between what is painted behind them and what is painted in front of them.

use std::collections::BTreeMap;

use super::edge_run::SHORTEST;
use super::halving::VISITED;
use super::overlaid::{LineRun, MarkerView, Overlaid, sights, spots};
use super::pairs::{Found, Pair, add};
use super::passes::{Pass, Passes, Passing, Pieces, passes};
use super::reaches::Reaches;
use super::reporter::{each, sort_by};
use super::rims::Rims;
use super::sight::Sight;
use super::stock::Stock;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::push;
use crate::overlay::Overlay;
use crate::overlay::place::GivenSegment;

/// An overlay's lines and points, each with how many parts of the drawing come before it: in input order, lines
/// first.
pub(super) type Placed = Vec<(u32, Overlaid)>;

/// The lines and points of an overlay, with the items that they pass.
pub(super) struct Between {
    segments: Vec<GivenSegment>,
    sights: Vec<Sight>,
    markers: Vec<MarkerView>,
    /// Sorted by the lines and points.
    passes: Passes,
}

impl Between {
    pub(super) fn of(
        stock: &Stock<'_>,
        rims: &Rims<'_>,
        overlay: &Overlay,
        watch: &Watch<'_>,
    ) -> Result<Self, Error> {
        let (segments, sights) = sights(&rims.lines, overlay, watch)?;
        let (markers, spots) = spots(&rims.lines, overlay, watch)?;
        let mut reaches = Reaches::default();
        for item in each(watch, VISITED, 0..stock.items.len() as u32) {
            let item = item?;
            reaches.push(item, rims.known_item(stock, item))?;
        }
        let face = |item: u32| stock.face(item);
        let around = |item: u32| stock.items[item as usize].around;
        let pieces = Pieces { lines: &rims.lines, reaches, face: &face, around: &around };
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
                push(&mut placed, (below, Overlaid::Line(run)))?;
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
            push(&mut placed, (below, Overlaid::Marker(*marker)))?;
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
        add(missed, Pair { below: below.2, above: early?.0.2 })?;
    }
    for late in each(watch, VISITED, passed.range((false, above.1 + 1, 0)..(true, 0, 0))) {
        add(missed, Pair { below: late?.0.2, above: above.2 })?;
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
            push(&mut events, (at, key, change))?;
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
                push(&mut parts, (room.most, [start, done]))?;
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
    push(&mut parts, (room.most, [start, ends[1]]))?;
    Ok(parts)
}
