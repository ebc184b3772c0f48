//! The effect of a plane on a set of pieces, and its cost.

use std::cmp::Ordering;
use std::ops::AddAssign;

use crate::build::piece::Division;
use crate::exact::{PlaneId, Side};

/// The numbers of pieces in front of a plane, behind it, and across it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) front: u32,
    pub(super) back: u32,
    pub(super) splits: u32,
}

impl Counts {
    pub(super) fn of(division: &Division) -> Self {
        let count = |side| division.count(side) as u32;
        Self { front: count(Side::Front), back: count(Side::Back), splits: count(Side::Spanning) }
    }

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

/// The cost of dividing a set by a plane. A lower cost is better.
///
/// A plane that cuts nothing costs less than any plane that cuts, because such a plane adds no fragment, now
/// or later. (Proof: restrict the smallest tree of the set to each side of the plane. The two restricted
/// trees together have no more fragments.) Exception: own planes of
/// large sets, whose cuts do not count by themselves. Planes at the boundary of a set cut nothing, but they would turn
/// the set into a list; and many planes that cut much of the set cut nothing of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cost {
    pub(super) cuts: bool,
    pub(super) amount: f64,
}

impl Cost {
    /// The cost of a plane from its counts: the work left on both sides.
    #[inline]
    pub(super) fn of(counts: &Counts) -> Self {
        let Counts { front, back, splits } = *counts;
        let amount = work((front + splits) as usize) + work((back + splits) as usize);
        Self { cuts: splits > 0, amount }
    }

    /// More than the cost of any plane.
    pub(super) const MOST: Self = Self { cuts: true, amount: f64::INFINITY };

    /// Whether the plane splits nothing and leaves at least 1/`uneven` of the pieces on each side.
    pub(super) fn divides_evenly(&self, pieces: usize, uneven: usize) -> bool {
        !self.cuts && self.amount <= work(pieces / uneven) + work(pieces - pieces / uneven)
    }

    /// Whether the plane is better than another plane.
    #[inline]
    pub(super) fn is_less(&self, other: &Self) -> bool {
        (self.cuts, other.cuts) == (false, true)
            || self.cuts == other.cuts && self.amount < other.amount
    }

    /// The order by [`is_less`](Self::is_less); no amount is NaN.
    pub(super) fn cmp(&self, other: &Self) -> Ordering {
        match (self.is_less(other), other.is_less(self)) {
            (true, _) => Ordering::Less,
            (_, true) => Ordering::Greater,
            _ => Ordering::Equal,
        }
    }
}

/// A plane with its cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct PricedPlane {
    pub(super) plane: PlaneId,
    pub(super) cost: Cost,
}

/// The estimated work of building a tree of `n` pieces: n^1.25.
///
/// The estimate grows faster than the work of sorting, n·log n, because a larger set is also cut more. Too
/// large an exponent: scans are cut more for better balance. Too small: planes at the boundary are preferred
/// in sets where every plane cuts much.
#[inline]
pub(super) fn work(n: usize) -> f64 {
    WORK.get(n).copied().unwrap_or_else(|| {
        let n = n as f64;
        n * n.sqrt().sqrt()
    })
}

/// The work that one more piece adds to `n` pieces: 1.25 n^.25.
#[inline]
pub(super) fn work_of_one_more(n: usize) -> f64 {
    1.25 * work(n) / n as f64
}

/// The work of small sets, the most frequent case. Computing two square roots each time makes builds longer
/// by 2 to 4 %.
static WORK: [f64; 1024] = {
    let (mut table, mut n) = ([0.0; 1024], 1);
    while n < table.len() {
        table[n] = n as f64 * sqrt(sqrt(n as f64));
        n += 1;
    }
    table
};

/// The square root of a number of at least 1, by Newton's method.
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
    use super::{Cost, Counts, work};

    #[test]
    fn work_is_a_power() {
        for n in [0, 1, 2, 3, 100, 1023, 1024, 5000, 1 << 28] {
            let expected = (n as f64).powf(1.25);
            assert!((work(n) - expected).abs() <= expected * 1e-14, "{n}: {}", work(n));
        }
    }

    /// A quarter of 42 pieces, rounded down, is 10.
    #[test]
    fn a_plane_divides_evenly_from_a_share_of_the_pieces_on() {
        let divides_evenly = |front, splits| {
            let counts = Counts { front, back: 42 - front - splits, splits };
            Cost::of(&counts).divides_evenly(42, 4)
        };
        assert!([10, 21, 32].into_iter().all(|front| divides_evenly(front, 0)));
        assert!(!divides_evenly(9, 0) && !divides_evenly(33, 0) && !divides_evenly(20, 1));
    }
}
