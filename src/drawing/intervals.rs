//! Parts of segments, from one place to another.

use smallvec::SmallVec;

use super::edge_run::SHORTEST;
use super::sight::Course;

/// Intervals that are given in the order of their beginnings: those that lie one over another, or end where another
/// begins but for rounding, as one.
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

/// A segment in parts that are in some intervals and parts that are not, in the order of their beginnings; the
/// intervals are given in that of theirs.
pub(super) fn parts(
    course: &Course,
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
