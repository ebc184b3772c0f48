//! On which side of a line two others meet, and where: by integers and pairs of floats, where one float cannot tell.

#[cfg(test)]
mod tests;

use std::cmp::Ordering;

use super::frame::{ExactLine, meeting, orientation};
use super::half::Half;
use super::lines::{Lines, NOWHERE};
use super::rounded::ROUNDING;
use super::twofold::{self, Twofold};

impl Lines<'_> {
    /// On which side of a half's line the point lies where two others meet, the second turning to the
    /// left of the first as seen from their halves: exact.
    #[cold]
    pub(super) fn exact_side(&self, half: Half, [first, second]: [Half; 2]) -> Ordering {
        let lines = [first, second, half];
        if half.line() == first.line() || half.line() == second.line() || self.share_point(lines) {
            return Ordering::Equal;
        }
        let side = self
            .twofold_side(lines)
            .unwrap_or_else(|| orientation(lines.map(|half| self.exact(half)).each_ref()));
        let flips = lines.iter().filter(|half| half.is_negative()).count();
        if flips % 2 == 1 { side.reverse() } else { side }
    }

    /// On which side of a line, which may be none of these, the point lies where two others meet: exact.
    #[cold]
    pub(super) fn exact_side_of(&self, line: &ExactLine, corner: [Half; 2]) -> Ordering {
        let [a, b] = corner.map(|half| self.exact(half));
        let side = orientation([&a, &b, line]);
        if corner[0].is_negative() == corner[1].is_negative() { side } else { side.reverse() }
    }

    /// Where two lines meet, from integers, and how far off that may be by rounding.
    #[cold]
    pub(super) fn exact_meeting(&self, halves: [Half; 2]) -> ([f64; 2], f64) {
        let exact = halves.map(|half| self.exact(half));
        let at = meeting(exact.each_ref());
        let radius = 8.0 * ROUNDING * self.reach[0].max(self.reach[1]);
        if self.shows(at) { (at, radius) } else { ([0.0; 2], f64::INFINITY) }
    }

    /// Whether three lines are known to go through one point.
    fn share_point(&self, lines: [Half; 3]) -> bool {
        let through = lines.map(|half| half.number().map(|line| self.through[line as usize]));
        let [Some(a), Some(b), Some(c)] = through else { return false };
        a.iter().any(|point| *point != NOWHERE && b.contains(point) && c.contains(point))
    }

    /// The orientation of three lines by pairs of floats, if that is certain. Not if none is an edge of a
    /// face of which corners were moved: others that floats cannot tell apart go through one point.
    fn twofold_side(&self, lines: [Half; 3]) -> Option<Ordering> {
        let known = lines.map(|half| self.twofold.get(&half.number()?));
        if known.iter().all(Option::is_none) {
            return None;
        }
        let twofold: [Twofold; 3] = std::array::from_fn(|i| {
            known[i].copied().unwrap_or_else(|| Twofold::of(&self.exact(lines[i])))
        });
        twofold::orientation(twofold.each_ref())
    }
}
