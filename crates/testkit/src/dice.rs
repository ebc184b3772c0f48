//! Random choices from a seed, the same on every machine.

use binspace::glam::DVec3;

/// A stream of numbers (SplitMix64: Steele, Lea and Flood, 2014).
#[derive(Clone, Debug)]
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number below `n`, which is not 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.roll() % n as u64) as usize
    }

    /// Returns an integer from −n to n.
    pub fn around_zero(&mut self, n: u32) -> f64 {
        self.below(2 * n as usize + 1) as f64 - f64::from(n)
    }

    /// Returns a number from 0 to 1.
    pub fn share(&mut self) -> f64 {
        (self.roll() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number between two others.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + self.share() * (high - low)
    }

    /// Returns a point with coordinates between two numbers.
    pub fn point(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.range(low, high)))
    }

    /// Returns a point with integer coordinates from −n to n.
    pub fn whole_point(&mut self, n: u32) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.around_zero(n)))
    }

    /// Shuffles a list.
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for i in (1..list.len()).rev() {
            list.swap(i, self.below(i + 1));
        }
    }
}
