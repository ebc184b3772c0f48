//! Finds the covered pixels of a convex region, row by row.

use std::ops::Range;

use super::coverage::Coverage;

/// In windows of at most this many columns every pixel is tested; in wider ones the lines first
/// narrow each row. Smaller: the narrowing costs more than it saves; larger: more pixels are
/// tested.
const NARROW: u32 = 8;

impl Coverage<'_> {
    /// Calls `run` with the row and the columns of all covered pixels, row by row from the top.
    pub(super) fn for_each_run(&self, run: &mut impl FnMut(u32, Range<u32>)) {
        let columns = self.window.columns.clone();
        for y in self.window.rows.clone() {
            let (outer, inner) = if columns.len() > NARROW as usize {
                self.narrow(y)
            } else {
                (columns.clone(), columns.end..columns.end)
            };
            self.single(y, outer.start..inner.start.min(outer.end), run);
            if !inner.is_empty() {
                run(y, inner.clone());
            }
            self.single(y, inner.end.max(outer.start)..outer.end, run);
        }
    }

    fn single(&self, y: u32, columns: Range<u32>, run: &mut impl FnMut(u32, Range<u32>)) {
        let mut start = None;
        for x in columns.clone() {
            match (self.covers(x, y), start) {
                (true, None) => start = Some(x),
                (false, Some(first)) => {
                    run(y, first..x);
                    start = None;
                }
                _ => {}
            }
        }
        if let Some(first) = start {
            run(y, first..columns.end);
        }
    }

    /// Two ranges of columns of a row: no pixel outside the first is covered, and every pixel
    /// within the second is. The second lies within the first, or is empty at its end.
    fn narrow(&self, y: u32) -> (Range<u32>, Range<u32>) {
        let Range { start, end } = self.window.columns;
        let (mut outer, mut inner) =
            ([f64::from(start), f64::from(end)], [f64::from(start), f64::from(end)]);
        for line in &self.lines {
            let [k0, kx, ky] = line.k;
            let value = k0 + f64::from(y) * ky;
            if kx == 0.0 || !kx.is_finite() || !value.is_finite() {
                if value < -line.bound && kx == 0.0 {
                    outer[1] = outer[0];
                } else if !(value > line.bound && kx == 0.0) {
                    inner[1] = inner[0];
                }
                continue;
            }
            // A margin of one pixel is more than the rounding of the division and of the bound.
            let (zero, margin) = (-value / kx, line.bound / kx.abs() + 1.0);
            if kx > 0.0 {
                outer[0] = outer[0].max((zero - margin).floor());
                inner[0] = inner[0].max((zero + margin).ceil());
            } else {
                outer[1] = outer[1].min((zero + margin).ceil());
                inner[1] = inner[1].min((zero - margin).floor());
            }
        }
        let range = |[low, high]: [f64; 2]| {
            let bound = |c: f64| c.clamp(f64::from(start), f64::from(end)) as u32;
            bound(low)..bound(high)
        };
        let outer = range(outer);
        if outer.is_empty() {
            return (end..end, end..end);
        }
        let inner = range(inner);
        let inner = if inner.is_empty() { outer.end..outer.end } else { inner };
        (outer, inner)
    }
}
