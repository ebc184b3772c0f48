//! Outlines of areas that are given in parts.

use smallvec::SmallVec;

use super::halving::VISITED;
use super::reporter::{each, sort_by};
use super::table::Table;
use crate::Error;
use crate::build::progress::Watch;
use crate::memory::{collect, filled, push};

/// A side of a part: its line, and where it begins and ends, with the part on its left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Sides on one line have the same number.
    pub(super) line: u64,
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
}

impl Edge {
    /// Whether the next edge is on the same line, and does not turn back.
    fn goes_on_as(&self, next: &Self) -> bool {
        let along = |i: usize| (self.to[i] - self.from[i]) * (next.to[i] - next.from[i]);
        self.line == next.line && along(0) + along(1) > 0.0
    }
}

/// Points are rounded to a grid of this step, in pixels, and are one if they fall on one place.
const GRID: f64 = 1.0 / (1u64 << 16) as f64;

/// To go on from an edge to the next takes as long as a build takes to examine so many pieces.
const FOLLOWED: usize = 16;

type Place = [i64; 2];

/// Which edges begin at a place: mostly one.
type Begin = Table<Place, SmallVec<[usize; 2]>>;

/// The closed outlines of the union of convex parts side by side, each around what is on its
/// left; `None` if some overlap, or if rounding left an outline open, or nothing.
///
/// Where two parts share a side, or some of it, that is no outline.
pub(super) fn outlines(
    edges: &[Edge],
    watch: &Watch<'_>,
) -> Result<Option<Vec<Vec<[f64; 2]>>>, Error> {
    let Some(edges) = without_common(edges, watch)? else { return Ok(None) };
    // Which edges begin at a place.
    let mut begin = Begin::default();
    for numbered in each(watch, VISITED, edges.iter().enumerate()) {
        let (i, edge) = numbered?;
        begin.try_reserve(1).map_err(|_| Error::out_of_memory())?;
        let list = begin.entry(place(edge.from)).or_default();
        list.try_reserve(1).map_err(|_| Error::out_of_memory())?;
        list.push(i);
    }
    let mut is_used = filled(edges.len(), false)?;
    let mut outlines = Vec::new();
    for first in 0..edges.len() {
        if is_used[first] {
            continue;
        }
        let mut outline: Vec<[f64; 2]> = Vec::new();
        let (mut current, mut last): (usize, Option<&Edge>) = (first, None);
        loop {
            watch.work(FOLLOWED)?;
            is_used[current] = true;
            let edge = &edges[current];
            // Edges of one line follow one another where others meet it.
            if !last.is_some_and(|last| last.goes_on_as(edge)) {
                push(&mut outline, edge.from)?;
            }
            last = Some(edge);
            if is_same(edge.to, edges[first].from) {
                break;
            }
            match next(&begin, &is_used, &edges, current) {
                Some(next) => current = next,
                None => return Ok(None),
            }
        }
        if outline.len() > 1 && last.is_some_and(|last| last.goes_on_as(&edges[first])) {
            outline.remove(0);
        }
        if outline.len() > 2 {
            push(&mut outlines, outline)?;
        }
    }
    // Nothing is left of what is smaller than the grid.
    Ok(if outlines.is_empty() { None } else { Some(outlines) })
}

fn place(point: [f64; 2]) -> Place {
    point.map(|c| (c / GRID).round() as i64)
}

fn is_same(a: [f64; 2], b: [f64; 2]) -> bool {
    (0..2).all(|axis| (a[axis] - b[axis]).abs() <= 1.5 * GRID)
}

/// The unused edge that begins where another ends: of several, the one that turns furthest to the left,
/// so that outlines that touch in a point stay apart.
fn next(begin: &Begin, is_used: &[bool], edges: &[Edge], current: usize) -> Option<usize> {
    let edge = &edges[current];
    let [x, y] = place(edge.to);
    let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
    let found = around.filter_map(|place| begin.get(&place)).flatten().copied();
    let way = |edge: &Edge| [edge.to[0] - edge.from[0], edge.to[1] - edge.from[1]];
    let [ax, ay] = way(edge);
    let turn = |&i: &usize| {
        let [bx, by] = way(&edges[i]);
        (ax * by - ay * bx).atan2(ax * bx + ay * by)
    };
    let open = found.filter(|&i| !is_used[i] && is_same(edges[i].from, edge.to));
    open.max_by(|a, b| turn(a).total_cmp(&turn(b)))
}

/// The edges without what two of them have in common, in opposite directions; `None` if some run in the
/// same direction, as those of parts that overlap do.
fn without_common(edges: &[Edge], watch: &Watch<'_>) -> Result<Option<Vec<Edge>>, Error> {
    let mut by_line: Vec<usize> = collect(0..edges.len())?;
    sort_by(&mut by_line, watch, |&a, &b| edges[a].line.cmp(&edges[b].line))?;
    let mut left = Vec::new();
    for group in by_line.chunk_by(|&a, &b| edges[a].line == edges[b].line) {
        watch.work(group.len() * VISITED)?;
        if let [one] = group {
            push(&mut left, edges[*one])?;
            continue;
        }
        if !on_one_line(group.iter().map(|&i| &edges[i]), &mut left)? {
            return Ok(None);
        }
    }
    Ok(Some(left))
}

/// The same of edges on one line, added to those that are left; whether none overlap.
fn on_one_line<'e>(
    edges: impl Iterator<Item = &'e Edge> + Clone,
    left: &mut Vec<Edge>,
) -> Result<bool, Error> {
    // Along the axis on which the line is longer.
    let span = |axis: usize| edges.clone().map(|e| (e.to[axis] - e.from[axis]).abs()).sum::<f64>();
    let axis = usize::from(span(1) > span(0));
    let mut ends: Vec<(i64, i32, [f64; 2])> = Vec::new();
    let mut common = 0;
    for &Edge { line, from, to } in edges {
        common = line;
        let [a, b] = [from, to].map(|point| (point[axis] / GRID).round() as i64);
        if a != b {
            push(&mut ends, (a, 1, from))?;
            push(&mut ends, (b, -1, to))?;
        }
    }
    ends.sort_by_key(|&(at, ..)| at);
    // At each place, how many more edges run forwards than backwards.
    let (mut count, mut open) = (0, None);
    for group in ends.chunk_by(|a, b| a.0 == b.0) {
        let (before, point) = (count, group[0].2);
        count += group.iter().map(|&(_, step, _)| step).sum::<i32>();
        if count.abs() > 1 {
            return Ok(false);
        }
        if let Some(from) = open
            && before != count
        {
            let edge = if before > 0 {
                Edge { line: common, from, to: point }
            } else {
                Edge { line: common, from: point, to: from }
            };
            push(left, edge)?;
            open = None;
        }
        if count != 0 && open.is_none() {
            open = Some(point);
        }
    }
    Ok(true)
}
