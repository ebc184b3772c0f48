//! Makes equal lines one line. Collinear edges, cuts and borders of tiles share a line, for instance the edges
//! of walls side by side. Otherwise integers would have to decide repeatedly whether sides of cells are
//! collinear.

use super::{ExactLine, HalfPlane, LineTable, NO_POINT, Rounded, STEPS, compare, is_opposite};
use crate::Error;
use crate::drawing::map::sort_by;
use crate::memory::collect;
use crate::progress::Watch;

/// A length, in steps, that exceeds the distance of every tile's border from the origin.
const FURTHEST: f64 = (1u64 << 50) as f64;
/// Equal lines have marks that differ by less than this. (Values of lines in the picture are off by less than
/// 2⁻³¹ pixels, and each of the three terms of a mark by less than four times as much.) Too small: equal lines
/// are not found. Too large: more lines are compared in integers.
const MARGIN: f64 = 1.0 / (1u64 << 26) as f64;
/// The shares of a foot's two coordinates and of the cosine in a mark: at most 1 each, and without a pattern,
/// so that different lines rarely have equal marks.
const SHARES: [f64; 3] = [1.0, 0.618_033_988_749_894_9, 0.754_877_666_246_692_7];
/// The cost of sorting a line, in pieces that a build examines.
const SORTED: usize = 4;
/// The cost of a line in integers.
const EXACT: usize = 16;

/// A line, with a number that equal lines share: a sum of the coordinates of the line's foot, which is the
/// line's point nearest to the middle of the picture, and of the cosine of twice the line's angle. Both
/// directions of a line have the same mark.
#[derive(Clone, Copy)]
struct Marked {
    mark: f64,
    line: u32,
}

impl Marked {
    fn new(rounded: &Rounded, line: u32, size: [f64; 2]) -> Self {
        let [_, kx, ky] = rounded.k;
        let middle = size.map(|side| 0.5 * side);
        let square = kx * kx + ky * ky;
        let off = rounded.at(middle) / square;
        let terms = [middle[0] - off * kx, middle[1] - off * ky, (kx * kx - ky * ky) / square];
        Self { mark: (0..3).map(|i| SHARES[i] * terms[i]).sum(), line }
    }

    /// Whether the lines of two consecutive marks may be equal. Lines without slope have no mark.
    fn may_equal(&self, next: &Self) -> bool {
        let gap = next.mark - self.mark;
        gap.is_nan() || gap <= MARGIN
    }
}

impl LineTable<'_> {
    /// Makes equal lines one line, with the lowest of their numbers, and replaces the lines of `halves`. Lines
    /// on borders of tiles become the borders. The remaining lines are numbered anew, in the same order. No
    /// lines can be added later.
    pub(in crate::drawing) fn merge_equal(
        &mut self,
        halves: &mut [HalfPlane],
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        self.of_edges = vec![];
        let marked = |(line, rounded)| Marked::new(rounded, line as u32, self.reach);
        let mut marked: Vec<Marked> = collect(self.rounded.iter().enumerate().map(marked))?;
        watch.work(marked.len() * SORTED)?;
        marked.sort_unstable_by(|a, b| a.mark.total_cmp(&b.mark));
        // For each line, the half on which it is positive.
        let mut merged: Vec<HalfPlane> = collect((0..self.keys.len() as u32).map(HalfPlane::of))?;
        for alike in marked.chunk_by(Marked::may_equal).filter(|alike| alike.len() > 1) {
            self.merge(alike, &mut merged, watch)?;
        }
        for line in 0..merged.len() as u32 {
            if merged[line as usize] == HalfPlane::of(line)
                && let Some(border) = self.near_border(&self.rounded[line as usize])
            {
                let [exact, other] = [HalfPlane::of(line), border].map(|half| self.exact(half));
                if compare(&exact, &other).is_eq() {
                    merged[line as usize] = border.flipped(is_opposite(&exact, &other));
                }
            }
        }
        self.renumber(&mut merged);
        let new = |half: HalfPlane| match half.number() {
            Some(line) => merged[line as usize].flipped(half.is_negative()),
            None => half,
        };
        watch.work(halves.len())?;
        halves.iter_mut().for_each(|half| *half = new(*half));
        self.of_cuts.values_mut().for_each(|half| *half = new(*half));
        self.cuts = self.of_cuts.values().map(|half| (half.positive(), ())).collect();
        Ok(())
    }

    /// Finds the equal lines among lines that may be equal.
    fn merge(
        &mut self,
        alike: &[Marked],
        merged: &mut [HalfPlane],
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        watch.work(alike.len() * EXACT)?;
        let exact = |&Marked { line, .. }: &Marked| (line, self.exact(HalfPlane::of(line)));
        let mut lines: Vec<(u32, ExactLine)> = collect(alike.iter().map(exact))?;
        let by_place = |(a, one): &(u32, ExactLine), (b, other): &(u32, ExactLine)| {
            compare(one, other).then(a.cmp(b))
        };
        sort_by(&mut lines, watch, by_place)?;
        for equal in lines.chunk_by(|(_, a), (_, b)| compare(a, b).is_eq()) {
            let (first, exact) = &equal[0];
            for (line, other) in &equal[1..] {
                let half = HalfPlane::of(*first).flipped(is_opposite(exact, other));
                merged[*line as usize] = half;
                self.remember(*first, self.through[*line as usize]);
            }
        }
        Ok(())
    }

    /// The border of tiles on which a line may lie.
    fn near_border(&self, line: &Rounded) -> Option<HalfPlane> {
        let [k0, kx, ky] = line.k;
        let (axis, [along, across]) =
            if kx.abs() > ky.abs() { (0, [ky, kx]) } else { (1, [kx, ky]) };
        if along.abs() > self.slope_error(line) {
            return None;
        }
        let steps = -k0 / across * STEPS;
        let is_near =
            (steps - steps.round()).abs() <= 2.0 * line.error * STEPS && steps.abs() < FURTHEST;
        is_near.then(|| HalfPlane::beyond(axis, steps.round() as i64))
    }

    /// Stores points that a line is known to go through, if there is room for them.
    fn remember(&mut self, line: u32, points: [u32; 2]) {
        let known = &mut self.through[line as usize];
        for point in points.into_iter().filter(|&point| point != NO_POINT) {
            if let Some(free) = known.iter().position(|&known| known == NO_POINT)
                && !known.contains(&point)
            {
                known[free] = point;
            }
        }
    }

    /// Removes the lines that are part of another line or of a border, and numbers the others anew.
    fn renumber(&mut self, merged: &mut [HalfPlane]) {
        let mut count = 0;
        for line in 0..merged.len() {
            match merged[line].number() {
                Some(own) if own as usize == line => {
                    self.keys[count] = self.keys[line];
                    self.rounded[count] = self.rounded[line];
                    self.through[count] = self.through[line];
                    merged[line] = HalfPlane::of(count as u32);
                    count += 1;
                }
                // The other line has a lower number, and is numbered anew already.
                Some(first) => {
                    let is_negative = merged[line].is_negative();
                    merged[line] = merged[first as usize].flipped(is_negative);
                }
                None => {}
            }
        }
        self.keys.truncate(count);
        self.rounded.truncate(count);
        self.through.truncate(count);
    }
}
