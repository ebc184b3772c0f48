//! Lines and points between what is painted behind them and what is painted in front of them.

use std::collections::BTreeMap;

use super::edge_run::SHORTEST;
use super::halving::VISITED;
use super::overlaid::{LineRun, Overlaid, sights, spots};
use super::passes::{Pass, Passing, Pieces, passes};
use super::reaches::Reaches;
use super::reporter::{each, sort_by};
use super::rims::Rims;
use super::stock::Stock;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{filled, push};
use crate::overlay::Overlay;

/// The path of what is not in the picture.
pub(super) const NO_PATH: u32 = u32::MAX;

/// The lines and points of an overlay, each with how many of the paths come before it, in order: a phase. `path_of`
/// has the path of each item.
pub(super) fn between(
    stock: &Stock<'_>,
    rims: &Rims<'_>,
    path_of: &[u32],
    paths: u32,
    overlay: &Overlay,
    watch: &Watch<'_>,
) -> Result<Vec<(u32, Overlaid)>, Error> {
    let (segments, sights) = sights(&rims.lines, overlay, watch)?;
    let (markers, spots) = spots(&rims.lines, overlay, watch)?;
    let mut reaches = Reaches::default();
    for item in each(watch, VISITED, 0..stock.items.len() as u32) {
        let item = item?;
        if path_of[item as usize] != NO_PATH {
            reaches.push(item, rims.known_item(stock, item))?;
        }
    }
    let face = |item: u32| stock.face(item);
    let around = |item: u32| stock.items[item as usize].around;
    let pieces = Pieces { lines: &rims.lines, reaches, face: &face, around: &around };
    let passing = Passing { sights: &sights, spots: &spots };
    let mut found = passes(pieces, passing, |_| true, watch)?;
    sort_by(&mut found.sights, watch, |a, b| a.sight.cmp(&b.sight))?;
    let mut rest = &found.sights[..];
    let mut overlaid = Vec::new();
    for (number, (segment, sight)) in (0..).zip(segments.iter().zip(&sights)) {
        let (own, others) = rest.split_at(rest.partition_point(|pass| pass.sight == number));
        rest = others;
        for (below, places) in in_order(sight.course.places, own, path_of, paths, watch)? {
            let run = LineRun::new(segment, places.map(|place| sight.course.at(place)), true);
            push(&mut overlaid, (below, Overlaid::Line(run)))?;
        }
    }
    let mut room = filled(spots.len(), Room::of(paths))?;
    for pass in each(watch, 1, &found.spots) {
        let pass = pass?;
        room[pass.spot as usize].narrow(path_of[pass.piece as usize], pass.is_behind);
    }
    for (marker, room) in markers.into_iter().zip(room) {
        push(&mut overlaid, (room.last(), Overlaid::Marker(marker)))?;
    }
    sort_by(&mut overlaid, watch, |(a, _), (b, _)| a.cmp(b))?;
    Ok(overlaid)
}

/// Where in an order something may come: after so many paths.
#[derive(Clone, Copy, Debug)]
struct Room {
    least: u32,
    most: u32,
}

impl Room {
    /// Anywhere.
    const fn of(paths: u32) -> Self {
        Self { least: 0, most: paths }
    }

    /// Before or after a path.
    fn narrow(&mut self, path: u32, is_behind: bool) {
        if is_behind {
            self.most = self.most.min(path);
        } else {
            self.least = self.least.max(path + 1);
        }
    }

    /// The last place: what lies beside then covers least of a wide stroke. Where a line passes between two
    /// paths that only touch there, one of them in front of it and the other behind, there may be no place
    /// between them; then both come before it.
    const fn last(self) -> u32 {
        if self.most < self.least { self.least } else { self.most }
    }
}

/// A segment in as few parts as can be, each with how many paths come before it, by what it passes.
fn in_order(
    places: [f64; 2],
    passes: &[Pass],
    path_of: &[u32],
    paths: u32,
    watch: &Watch<'_>,
) -> Result<Vec<(u32, [f64; 2])>, Error> {
    // Where each pass begins and ends.
    let mut events = Vec::new();
    for pass in passes {
        let path = path_of[pass.piece as usize];
        for (place, change) in [(pass.places[0], 1), (pass.places[1], -1)] {
            push(&mut events, (place, (pass.is_behind, path), change))?;
        }
    }
    sort_by(&mut events, watch, |a, b| a.0.total_cmp(&b.0))?;
    // How many passes of each path there are, those before it and those behind it.
    let mut passed: BTreeMap<(bool, u32), i32> = BTreeMap::new();
    let mut parts = Vec::new();
    let [mut start, mut done] = [places[0]; 2];
    let mut room = Room::of(paths);
    let ends = events.iter().map(|event| event.0.clamp(places[0], places[1]));
    for numbered in each(watch, 2 * VISITED, ends.chain([places[1]]).enumerate()) {
        let (i, to) = numbered?;
        if to - done >= SHORTEST {
            let mut next = Room::of(paths);
            let before = passed.range(..(true, 0)).next_back();
            let behind = passed.range((true, 0)..).next();
            for (&(is_behind, path), _) in before.into_iter().chain(behind) {
                next.narrow(path, is_behind);
            }
            next.most = next.last();
            let common = Room { least: room.least.max(next.least), most: room.most.min(next.most) };
            if common.least <= common.most {
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
    push(&mut parts, (room.most, [start, places[1]]))?;
    Ok(parts)
}
