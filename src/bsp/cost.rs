//! What a plane promises for a set of pieces.

/// The price of each cut in the cost of `auto`, in polygons still to be sorted. Larger: trees
/// become unbalanced, and unbalanced ones cut more further down; smaller: cuts for balance.
const SPLIT_PRICE: f64 = 0.2;
/// The price of cutting at all: more than any amount of work. A plane that cuts nothing costs no
/// fragment, now or later: whatever tree there is of all pieces, its parts on either side are trees
/// of those. So where there is one, it is taken, however unbalanced.
const FIRST_SPLIT_PRICE: f64 = 1e12;

/// How many pieces lie in front of a plane, behind it, and across.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    pub(super) front: usize,
    pub(super) back: usize,
    pub(super) splits: usize,
}

impl Counts {
    /// With one more, that reaches in front of the plane, or behind it, or both.
    #[inline]
    pub(super) fn with(self, (front, back): (bool, bool)) -> Self {
        Self {
            front: self.front + usize::from(front & !back),
            back: self.back + usize::from(back & !front),
            splits: self.splits + usize::from(front & back),
        }
    }

    /// The work left on both sides, and the cuts: only grows with each count.
    #[inline]
    pub(super) fn cost(&self) -> f64 {
        work(self.front + self.splits) + work(self.back + self.splits) + price(self.splits)
    }

    pub(super) fn imbalance(&self) -> f64 {
        self.front.abs_diff(self.back) as f64
    }
}

/// Whether a plane of this cost cuts, and leaves more work than there was.
pub(super) fn is_loss(cost: f64, pieces: usize) -> bool {
    cost >= FIRST_SPLIT_PRICE + work(pieces)
}

/// What cuts cost.
#[inline]
pub(super) fn price(splits: usize) -> f64 {
    if splits == 0 { 0.0 } else { FIRST_SPLIT_PRICE + SPLIT_PRICE * splits as f64 }
}

/// The work of sorting `n` pieces: n·log₂ n within one in a hundred, by a parabola between powers
/// of two. The same on every machine, and faster than a logarithm.
#[inline]
pub(super) fn work(n: usize) -> f64 {
    const KEPT: usize = 512;
    const TABLE: [f64; KEPT] = {
        let (mut table, mut n) = ([0.0; KEPT], 0);
        while n < KEPT {
            table[n] = computed(n);
            n += 1;
        }
        table
    };
    TABLE.get(n).copied().unwrap_or_else(|| computed(n))
}

const fn computed(n: usize) -> f64 {
    let n = if n == 0 { 1 } else { n };
    let power = n.ilog2();
    let beyond = n as f64 / (1_u64 << power) as f64 - 1.0;
    n as f64 * (power as f64 + beyond * (4.0 - beyond) / 3.0)
}
