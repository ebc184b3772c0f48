//! The conventions of a depth buffer: its first value, its test and its writes.

/// The state of a depth buffer that users of graphics libraries set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthRules {
    /// Which of two stored numbers is nearer.
    pub nearer: Nearer,
    /// The test that a depth passes to show.
    pub test: DepthTest,
    /// The buffer's clear value.
    pub clear: Clear,
    /// Whether a visible polygon also writes its depth. Translucent polygons must not write their depths,
    /// because polygons behind them are visible too.
    pub writes: bool,
}

/// Which of two stored numbers is nearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nearer {
    /// The smaller: stored numbers run from 0 at the near plane to the format's largest number at the far
    /// plane.
    Smaller,
    /// The larger: stored numbers run in the opposite direction.
    Larger,
}

/// The test that a depth must pass to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthTest {
    /// The new number is smaller than the stored number.
    Less,
    /// The new number is not larger.
    LessOrEqual,
    /// The new number is larger.
    Greater,
    /// The new number is not smaller.
    GreaterOrEqual,
}

/// The clear value of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clear {
    /// To no number: any depth passes in a pixel without a face.
    Nothing,
    /// To the smallest number that can be stored.
    Smallest,
    /// To the largest number that can be stored.
    Largest,
}

impl DepthRules {
    /// Smaller is nearer, `LESS`, cleared to nothing, writing.
    pub const DEFAULT: Self = Self {
        nearer: Nearer::Smaller,
        test: DepthTest::Less,
        clear: Clear::Nothing,
        writes: true,
    };

    /// Sets the test.
    #[must_use]
    pub const fn with_test(self, test: DepthTest) -> Self {
        Self { test, ..self }
    }

    /// Sets the clear value.
    #[must_use]
    pub const fn with_clear(self, clear: Clear) -> Self {
        Self { clear, ..self }
    }

    /// Sets which of two numbers is nearer.
    #[must_use]
    pub const fn with_nearer(self, nearer: Nearer) -> Self {
        Self { nearer, ..self }
    }
}

/// Rules as a comparison of integers, given the keys of a format's ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comparison {
    /// The bits that are flipped in a stored key: none, or all bits if the test selects the further face.
    /// Keys are smaller for nearer depths.
    flip: u32,
    or_equal: bool,
    /// The clear value, flipped.
    pub(super) cleared: u32,
    /// Whether any depth passes in a pixel without a face.
    pub(super) is_open: bool,
    pub(super) writes: bool,
}

impl Comparison {
    pub(super) fn new(rules: DepthRules, [first, last]: [u32; 2]) -> Self {
        let asks_smaller = matches!(rules.test, DepthTest::Less | DepthTest::LessOrEqual);
        let smaller_is_nearer = rules.nearer == Nearer::Smaller;
        // If the test selects the numbers that are not nearer, the furthest faces show.
        let flip = if asks_smaller == smaller_is_nearer { 0 } else { u32::MAX };
        let cleared = match (rules.clear, smaller_is_nearer) {
            (Clear::Nothing, _) => u32::MAX ^ flip,
            (Clear::Smallest, true) | (Clear::Largest, false) => first,
            _ => last,
        };
        let or_equal = matches!(rules.test, DepthTest::LessOrEqual | DepthTest::GreaterOrEqual);
        let is_open = rules.clear == Clear::Nothing;
        Self { flip, or_equal, cleared: cleared ^ flip, is_open, writes: rules.writes }
    }

    /// The stored form of a key.
    #[inline]
    pub(super) fn stored(&self, key: u32) -> u32 {
        key ^ self.flip
    }

    /// Whether a new number passes the test against the stored number.
    #[inline]
    pub(super) fn passes(&self, new: u32, stored: u32) -> bool {
        new < stored || self.or_equal && new == stored
    }
}
