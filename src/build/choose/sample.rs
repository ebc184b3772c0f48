//! A growing sample of a set.

use super::set::Set;
use super::sketch::Sketch;
use crate::Error;

/// A sketch of some pieces of a set, to which others are added in an order of which every beginning
/// is a sample of the set.
#[derive(Debug, Default)]
pub(super) struct Sample {
    pub(super) sketch: Sketch,
    rest: Spread,
}

impl Sample {
    /// Replaces what is sketched by the first `count` pieces, or all of them if there are not more.
    pub(super) fn restart(&mut self, set: &Set<'_>, count: usize) -> Result<(), Error> {
        self.sketch.clear();
        self.rest = Spread::new(set.len());
        self.grow(set, count)
    }

    /// Adds pieces until there are `count`, or all.
    pub(super) fn grow(&mut self, set: &Set<'_>, count: usize) -> Result<(), Error> {
        let missing = count.min(set.len()).saturating_sub(self.sketch.len());
        if missing > 0 {
            self.sketch.extend(set, self.rest.by_ref().take(missing))?;
        }
        Ok(())
    }
}

/// The numbers below `n`, so that however many of the first are taken, they are spread evenly.
#[derive(Debug, Default)]
struct Spread {
    n: usize,
    /// Without a common divisor with `n`.
    step: usize,
    next: usize,
    left: usize,
}

impl Spread {
    fn new(n: usize) -> Self {
        Self { n, step: coprime(n), next: 0, left: n }
    }
}

impl Iterator for Spread {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        self.left = self.left.checked_sub(1)?;
        let here = self.next;
        self.next += self.step;
        self.next -= if self.next < self.n { 0 } else { self.n };
        Some(here)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl ExactSizeIterator for Spread {}

/// A number without a common divisor with `n`, near the golden section of it: its multiples are the
/// most evenly spread.
fn coprime(n: usize) -> usize {
    let section = (n as f64 * 0.618_034) as usize;
    (section.max(1)..n.max(2)).find(|&step| gcd(step, n) == 1).unwrap_or(1)
}

fn gcd(mut a: usize, mut b: usize) -> usize {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn every_number_comes_once_and_the_first_are_spread_evenly() {
        for n in (0..100).chain([255, 256, 1000, 4096]) {
            let mut numbers: Vec<usize> = Spread::new(n).collect();
            let first = numbers.len().min(16);
            let mut sample = numbers[..first].to_vec();
            sample.sort_unstable();
            for pair in sample.windows(2) {
                assert!(pair[1] - pair[0] <= 4 * n / first + 2, "{n}: {sample:?}");
            }
            numbers.sort_unstable();
            assert!(numbers.iter().copied().eq(0..n));
        }
    }
}
