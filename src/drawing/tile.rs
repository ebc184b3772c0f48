//! Tiles of the picture: rectangles that are halved again and again.

use super::half::{Half, STEPS};
use super::lines::Lines;
use super::rect::Rect;

/// A rectangle of the picture, between borders in steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tile {
    pub(super) low: [i64; 2],
    pub(super) high: [i64; 2],
}

/// Where a box lies against a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Across {
    Inside,
    Outside,
    Maybe,
}

/// Tiles that were halved in vain so often are leaves. Many items may meet along a line of the picture,
/// as the columns of a terrain do that is seen along its rows: halving would go on and on along it.
pub(super) const IN_VAIN: u32 = 3;
/// Tiles of this size, in steps, are not halved: 2⁻¹⁸ of a pixel.
const TINY: i64 = 64;

impl Tile {
    /// All of a picture.
    pub(super) fn picture(size: [u32; 2]) -> Self {
        let half = (STEPS / 2.0) as i64;
        let high = size.map(|side| 2 * half * i64::from(side) - half);
        Self { low: [-half; 2], high }
    }

    /// Its halves, across its longer side.
    pub(super) fn halves(&self) -> [Self; 2] {
        let size = [0, 1].map(|axis: usize| self.high[axis] - self.low[axis]);
        let axis = usize::from(size[1] > size[0]);
        let middle = self.low[axis] + size[axis] / 2;
        let mut parts = [*self; 2];
        parts[0].high[axis] = middle;
        parts[1].low[axis] = middle;
        parts
    }

    /// Whether a half's line is one of its borders.
    pub(super) fn has_border(&self, half: Half) -> bool {
        half.number().is_none() && {
            let (axis, steps) = half.border();
            steps == self.low[axis] || steps == self.high[axis]
        }
    }

    /// Whether it is too small to be halved.
    pub(super) fn is_tiny(&self) -> bool {
        (0..2).all(|axis| self.high[axis] - self.low[axis] <= TINY)
    }

    /// Its sides in pixels: exact.
    pub(super) fn sides(&self) -> Rect {
        [self.low, self.high].map(|end| end.map(|steps| steps as f64 / STEPS))
    }
}

/// How often both parts of a tile were halved in vain, of so many items: both have nearly all of them.
/// A part that has many more than half of them keeps the count.
pub(super) fn in_vain(before: u32, all: usize, parts: [usize; 2]) -> [u32; 2] {
    let is_in_vain = parts.iter().all(|part| part * 8 >= all * 7);
    parts.map(|part| match is_in_vain {
        true => before + 1,
        false if part * 8 >= all * 6 => before,
        false => 0,
    })
}

impl Lines<'_> {
    /// Where a box lies against a half.
    pub(super) fn across(&self, half: Half, [low, high]: &Rect) -> Across {
        let line = self.rounded(half);
        let [x, y] = [0, 1].map(|axis: usize| 0.5 * (low[axis] + high[axis]));
        let [w, h] = [0, 1].map(|axis: usize| 0.5 * (high[axis] - low[axis]));
        let reach = line.k[1].abs() * w + line.k[2].abs() * h + 2.0 * line.error;
        let value = line.at([x, y]);
        if value.abs() <= reach {
            Across::Maybe
        } else if (value > 0.0) != half.is_negative() {
            Across::Inside
        } else {
            Across::Outside
        }
    }
}
