//! What a plane promises for a set of pieces, and what that costs.

use std::cmp::Ordering;
use std::ops::AddAssign;

use crate::exact::PlaneId;

/// How many pieces lie in front of a plane, behind it, and across.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) front: u32,
    pub(super) back: u32,
    pub(super) splits: u32,
}

impl Counts {
    pub(super) fn imbalance(&self) -> u32 {
        self.front.abs_diff(self.back)
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.front += other.front;
        self.back += other.back;
        self.splits += other.splits;
    }
}

/// What it costs to divide a set by a plane. The lower cost is the better.
///
/// A plane that cuts nothing costs less than any that cuts: it adds no fragment, now or later.
/// (Any tree of a set, restricted to one side of a plane, is a tree of that side.) In large sets
/// this is not applied to own planes: those at the rim cut nothing too, and would make a list of the
/// set (see `Terms::large`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cost {
    pub(super) cuts: bool,
    pub(super) amount: f64,
}

impl Cost {
    /// Of a plane by what it does to the pieces: the work left on both sides.
    #[inline]
    pub(super) fn of(counts: &Counts) -> Self {
        let Counts { front, back, splits } = *counts;
        let amount = work((front + splits) as usize) + work((back + splits) as usize);
        Self { cuts: splits > 0, amount }
    }

    /// More than that of any plane.
    pub(super) const MOST: Self = Self { cuts: true, amount: f64::INFINITY };

    pub(super) fn cmp(&self, other: &Self) -> Ordering {
        self.cuts.cmp(&other.cuts).then(self.amount.total_cmp(&other.amount))
    }

    /// Whether it is that of a plane that cuts nothing, and leaves at least one in so many pieces on
    /// either side.
    pub(super) fn divides_evenly(&self, pieces: usize, uneven: usize) -> bool {
        !self.cuts && self.amount <= work(pieces / uneven) + work(pieces - pieces / uneven)
    }

    pub(super) fn is_less(&self, other: &Self) -> bool {
        (self.cuts, other.cuts) == (false, true)
            || self.cuts == other.cuts && self.amount < other.amount
    }
}

/// A plane with what it costs to divide a set by it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) plane: PlaneId,
    pub(super) cost: Cost,
}

/// The work of putting `n` pieces in order: n^1.25.
///
/// It grows faster than n·log n, the work of sorting, because a larger set is also cut more. A
/// larger exponent balances trees better, and cuts scans more for that; a smaller one prefers planes
/// at the rim of sets in which every plane cuts much.
#[inline]
pub(super) fn work(n: usize) -> f64 {
    WORK.get(n).copied().unwrap_or_else(|| {
        let n = n as f64;
        n * n.sqrt().sqrt()
    })
}

/// The work of small sets, which is asked for most often: to take two roots each time instead, builds
/// take 2 to 4 % longer.
static WORK: [f64; 1024] = {
    let (mut table, mut n) = ([0.0; 1024], 1);
    while n < table.len() {
        table[n] = n as f64 * sqrt(sqrt(n as f64));
        n += 1;
    }
    table
};

/// The square root of a number from 1 on, by Newton's method.
const fn sqrt(x: f64) -> f64 {
    let (mut root, mut steps) = (x, 0);
    while steps < 16 {
        root = 0.5 * (root + x / root);
        steps += 1;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::work;

    #[test]
    fn work_is_a_power() {
        for n in [0, 1, 2, 3, 100, 1023, 1024, 5000, 1 << 28] {
            let expected = (n as f64).powf(1.25);
            assert!((work(n) - expected).abs() <= expected * 1e-14, "{n}: {}", work(n));
        }
    }
}
