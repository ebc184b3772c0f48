//! Pseudo-random numbers from a seed, the same on every machine.

use glam::DVec3;

/// A stream of uniformly distributed numbers, SplitMix64: G. L. Steele, D. Lea and C. H. Flood,
/// "Fast splittable pseudorandom number generators", OOPSLA 2014.
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// Creates the stream of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns the next number.
    #[expect(clippy::should_implement_trait, reason = "a stream without an end needs no `Option`")]
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a uniform number in `low..high`, from 53 random bits.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        low + unit * (high - low)
    }

    /// Returns a point with each coordinate uniform in `low..high`.
    pub fn point(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::new(self.range(low, high), self.range(low, high), self.range(low, high))
    }
}

/// Returns a hash of a number: the first number of the stream with that seed.
pub fn mix(value: u64) -> u64 {
    SplitMix64::new(value).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first outputs for seed 1234567, as listed by the reference implementations.
    const PUBLISHED: [u64; 3] =
        [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];

    #[test]
    fn the_sequence_is_the_published_one() {
        let mut random = SplitMix64::new(1_234_567);
        assert_eq!([random.next(), random.next(), random.next()], PUBLISHED);
        assert_eq!([1_234_567, 0].map(mix), [PUBLISHED[0], 0xe220_a839_7b1d_cdaf]);
    }

    #[test]
    fn a_range_is_filled_by_the_leading_bits() {
        let mut random = SplitMix64::new(1_234_567);
        let expected = PUBLISHED.map(|bits| 2.0 + (bits >> 11) as f64 / (1u64 << 51) as f64);
        assert_eq!(random.point(2.0, 6.0), DVec3::from_array(expected));
    }
}
