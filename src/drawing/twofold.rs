//! Lines of the picture in pairs of floats: twice the digits of one.
//!
//! Corners of faces that are not quite flat are moved onto their planes, so that edges of neighbours pass each
//! other by a rounding. One float cannot tell on which side; two can nearly always, in a tenth of the
//! time that integers take.

use std::cmp::Ordering;

use super::frame::ExactLine;
use crate::exact::Int;
use crate::exact::lattice::{exponent_of, scaled};

/// A number, and what was left when it was rounded (Dekker, “A floating-point technique for extending the
/// available precision”, 1971).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair(f64, f64);

/// The coefficients of a line, times a power of two that brings the largest to 1 or 2. Each is off by at most
/// 2⁻¹⁰⁵ of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Twofold([Pair; 3]);

/// Error bound of the orientation, as a share of the magnitudes of its six terms: a term is a product of
/// three coefficients by two roundings to pairs, of which each is off by at most 2⁻¹⁰² of the product, and
/// takes part in three sums. Smaller: a wrong side passes; larger: integers decide what pairs could.
const ERROR: f64 = 1.0 / (1u128 << 98) as f64;
/// What is lost where products leave the range of `f64`.
const LOST: f64 = f64::MIN_POSITIVE * (1u64 << 60) as f64;

impl Twofold {
    pub(super) fn of(line: &ExactLine) -> Self {
        let high = line.map(Int::to_f64);
        let largest = high.iter().fold(0.0f64, |largest, k| largest.max(k.abs()));
        let exponent = if largest > 0.0 { -exponent_of(largest) } else { 0 };
        Self(std::array::from_fn(|i| {
            let low = (line[i] - Int::from_f64(high[i])).to_f64();
            Pair(scaled(high[i], exponent), scaled(low, exponent))
        }))
    }

    /// The same with its signs changed, if `flip`.
    pub(super) fn flipped(self, flip: bool) -> Self {
        if flip { Self(self.0.map(|Pair(high, low)| Pair(-high, -low))) } else { self }
    }
}

/// On which side of a third line two lines meet, times the sign of the turn from the first to the
/// second; `None` if that is not certain.
pub(super) fn orientation([a, b, c]: [&Twofold; 3]) -> Option<Ordering> {
    let (mut sum, mut size) = (Pair(0.0, 0.0), 0.0);
    for (i, j, k) in [(1, 2, 0), (2, 0, 1), (0, 1, 2)] {
        let (left, right) = (a.0[i].times(b.0[j]), a.0[j].times(b.0[i]));
        size += (left.0.abs() + right.0.abs()) * c.0[k].0.abs();
        sum = sum.plus(left.plus(Pair(-right.0, -right.1)).times(c.0[k]));
    }
    let bound = ERROR * size + LOST;
    // The higher part has the sign: the lower is at most half a step of it.
    if sum.0 > bound {
        Some(Ordering::Greater)
    } else if sum.0 < -bound {
        Some(Ordering::Less)
    } else {
        None
    }
}

impl Pair {
    #[inline]
    fn plus(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        // What the sum lost, exactly (Knuth).
        let taken = sum - self.0;
        let lost = (self.0 - (sum - taken)) + (other.0 - taken);
        Self::normal(sum, lost + (self.1 + other.1))
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let ([a, b], [c, d]) = (halves(self.0), halves(other.0));
        let lost = ((a * c - product) + a * d + b * c) + b * d;
        Self::normal(product, lost + (self.0 * other.1 + self.1 * other.0))
    }

    /// A large number and a small one as a pair.
    #[inline]
    fn normal(large: f64, small: f64) -> Self {
        let sum = large + small;
        Self(sum, small - (sum - large))
    }
}

/// A number as the sum of two of half as many digits, whose products are exact (Veltkamp).
#[inline]
fn halves(value: f64) -> [f64; 2] {
    let far = value * ((1u64 << 27) + 1) as f64;
    let high = far - (far - value);
    [high, value - high]
}

#[cfg(test)]
mod tests {
    use super::super::frame;
    use super::*;
    use crate::random::SplitMix64;

    /// Numbers of some bits, of either sign.
    fn number(random: &mut SplitMix64, bits: u32) -> i128 {
        let value = u128::from(random.next()) << 64 | u128::from(random.next());
        (value as i128) >> (127 - bits)
    }

    fn line(random: &mut SplitMix64, bits: u32) -> ExactLine {
        std::array::from_fn(|_| Int::from(number(random, bits)))
    }

    /// Any line through where two others meet, moved aside by a number of few bits.
    fn through([a, b]: [&ExactLine; 2], random: &mut SplitMix64, aside: u32) -> ExactLine {
        let [p, q] = [40, 40].map(|bits| Int::<1>::from(number(random, bits) as i64));
        let aside = Int::<6>::from(number(random, aside));
        std::array::from_fn(|i| {
            let sum: Int<6> = a[i].times::<1, 6>(&p) + b[i].times::<1, 6>(&q);
            if i == 0 { sum + aside } else { sum }
        })
    }

    #[test]
    fn what_is_certain_is_right_and_most_near_ones_are_certain() {
        let mut random = SplitMix64::new(5);
        // By how many bits lines are moved aside that have 120 or more; how many must be certain.
        for (aside, least) in [(0, 0), (20, 0), (60, 950), (100, 1000)] {
            let mut certain = 0;
            for _ in 0..1000 {
                let [a, b] = [80, 80].map(|bits| line(&mut random, bits));
                let c = through([&a, &b], &mut random, aside);
                let lines = [&a, &b, &c];
                let exact = frame::orientation(lines);
                let twofold = lines.map(Twofold::of);
                if let Some(side) = orientation(twofold.each_ref()) {
                    assert_eq!(side, exact, "{lines:?}");
                    certain += 1;
                }
            }
            assert!(certain >= least, "{aside} bits: {certain}");
        }
    }

    /// Lines through one point are never told apart, however their coefficients differ in size.
    #[test]
    fn lines_through_one_point_are_not_certain() {
        let mut random = SplitMix64::new(6);
        for bits in [3, 50, 90, 120] {
            for shift in [0, 100, 200] {
                let a = line(&mut random, bits).map(|k| k.shifted::<6>(shift));
                let b = line(&mut random, 90);
                let sum: ExactLine = std::array::from_fn(|i| a[i] + b[i]);
                let twofold = [&a, &b, &sum].map(Twofold::of);
                assert_eq!(orientation(twofold.each_ref()), None, "{bits} {shift}");
            }
        }
    }

    #[test]
    fn numbers_of_the_whole_range_are_pairs() {
        let mut random = SplitMix64::new(7);
        for shift in [0, 30, 120, 230] {
            let line = line(&mut random, 125).map(|k| k.shifted::<6>(shift));
            let Twofold(pairs) = Twofold::of(&line);
            let largest = pairs.iter().fold(0.0f64, |most, pair| most.max(pair.0.abs()));
            assert!((1.0..2.0 + 1e-9).contains(&largest), "{largest}");
            for Pair(high, low) in pairs {
                assert!(low.abs() <= high.abs() * f64::EPSILON / 2.0, "{high} {low}");
            }
            assert!(pairs.iter().any(|pair| pair.1 != 0.0));
        }
    }
}
