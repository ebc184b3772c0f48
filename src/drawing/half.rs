//! Lines by their numbers, each with a side.

/// Borders of tiles are at multiples of 1/`STEPS` of a pixel.
pub(super) const STEPS: f64 = (1u64 << STEP_BITS) as f64;
pub(super) const STEP_BITS: u32 = 24;

/// A line, and which of its sides is meant.
///
/// The last bit is set for the side on which the line is negative. Above it is the number of the line;
/// or, with the first bit set, what a border of a tile is: so these need no list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Half(u64);

const BORDER: u64 = 1 << 63;
/// Borders are this many steps from where their number is 0, so that all numbers are positive.
const OFFSET: i64 = 1 << 60;

impl Half {
    /// The side of a line on which it is positive.
    pub(super) const fn of(line: u32) -> Self {
        Self((line as u64) << 1)
    }

    /// The points whose coordinate (axis 0, 1 for x, y) is at least so many [`STEPS`] of a pixel.
    pub(super) const fn beyond(axis: usize, steps: i64) -> Self {
        Self(BORDER | (((steps + OFFSET) as u64) << 1 | axis as u64) << 1)
    }

    /// The same for all halves of a line.
    pub(super) const fn line(self) -> u64 {
        self.0 >> 1
    }

    /// The half of the same line on which it is positive.
    pub(super) const fn positive(self) -> Self {
        Self(self.0 & !1)
    }

    /// The number of the line; `None` for a border.
    pub(super) const fn number(self) -> Option<u32> {
        if self.0 & BORDER == 0 { Some((self.0 >> 1) as u32) } else { None }
    }

    /// The axis of a border, and where it is.
    pub(super) const fn border(self) -> (usize, i64) {
        let number = (self.0 & !BORDER) >> 1;
        ((number & 1) as usize, (number >> 1) as i64 - OFFSET)
    }

    /// Whether the side is meant on which the line is negative.
    pub(super) const fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    /// The other side, if `flip`.
    pub(super) const fn flipped(self, flip: bool) -> Self {
        Self(self.0 ^ flip as u64)
    }
}
