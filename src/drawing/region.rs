//! Boxes in the picture, and around what several lines bound.

use smallvec::{SmallVec, smallvec};

use super::half::Half;
use super::lines::Lines;

/// A box in the picture: its least and its largest coordinates, in pixels.
pub(super) type Region = [[f64; 2]; 2];

/// Whether two boxes are apart.
pub(super) fn are_apart([low, high]: &Region, [from, to]: &Region) -> bool {
    (0..2).any(|axis| to[axis] < low[axis] || from[axis] > high[axis])
}

/// Whether a box is in another.
pub(super) fn is_within([low, high]: &Region, [from, to]: &Region) -> bool {
    (0..2).all(|axis| from[axis] <= low[axis] && high[axis] <= to[axis])
}

/// What two boxes have in common; if they are apart, no box.
pub(super) fn common(a: &Region, b: &Region) -> Region {
    let axes = [0, 1];
    [axes.map(|i: usize| a[0][i].max(b[0][i])), axes.map(|i: usize| a[1][i].min(b[1][i]))]
}

impl Lines<'_> {
    /// A box around the points of another box that lie in some halves; `None` if there certainly are none.
    ///
    /// The box is cut by one line after another (I. E. Sutherland, G. W. Hodgman, "Reentrant polygon
    /// clipping", 1974), each moved outwards by more than the rounding of its values.
    pub(super) fn around(&self, within: &Region, halves: &[Half]) -> Option<Region> {
        let [[left, top], [right, bottom]] = *within;
        let mut corners: Outline =
            smallvec![[left, top], [right, top], [right, bottom], [left, bottom]];
        let reach = [left.abs().max(right.abs()), top.abs().max(bottom.abs())];
        let mut kept = Outline::new();
        for &half in halves {
            let line = self.rounded(half);
            let [k0, kx, ky] = line.k;
            let rounding = ROUNDING * (k0.abs() + kx.abs() * reach[0] + ky.abs() * reach[1]);
            let margin = rounding + line.error;
            let sign = if half.is_negative() { -1.0 } else { 1.0 };
            let value = |at: &[f64; 2]| sign * line.at(*at) + margin;
            if corners.iter().all(|corner| value(corner) >= 0.0) {
                continue;
            }
            let mut before = *corners.last()?;
            let mut was = value(&before);
            for &corner in &corners {
                let is = value(&corner);
                if (was < 0.0) != (is < 0.0) {
                    let share = was / (was - is);
                    kept.push([0, 1].map(|i: usize| before[i] + share * (corner[i] - before[i])));
                }
                if is >= 0.0 {
                    kept.push(corner);
                }
                (before, was) = (corner, is);
            }
            std::mem::swap(&mut corners, &mut kept);
            kept.clear();
        }
        let mut around = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for corner in &corners {
            for axis in 0..2 {
                let off = ROUNDING * reach[axis];
                around[0][axis] = around[0][axis].min(corner[axis] - off);
                around[1][axis] = around[1][axis].max(corner[axis] + off);
            }
        }
        (!corners.is_empty()).then_some(around)
    }
}

type Outline = SmallVec<[[f64; 2]; 12]>;

/// Values are off by less than 4 roundings of 2⁻⁵³ of the sum of their terms, and where they change sign on
/// a side by less than 8.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
