//! Exact equality of fractions too large to be added: by their residues modulo a prime.

use binspace::internals::{Faces, Int, Symbol, Weights};

/// A number modulo the prime 2⁶¹ − 1. Fractions that are equal have equal residues; others have
/// them with odds of one in 2⁶¹.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Residue(u64);

const PRIME: u64 = (1 << 61) - 1;

impl Residue {
    pub(crate) const ZERO: Self = Self(0);

    fn of<const N: usize>(value: &Int<N>) -> Self {
        let limbs = value.limbs();
        // 2⁶⁴ leaves 8; a negative number is 2^(64 N) less than its limbs say.
        let digits = limbs.iter().rev().map(|&limb| Self(limb % PRIME));
        let sum = digits.fold(Self::ZERO, |sum, digit| sum.times(Self(8)).plus(digit));
        let excess = (0..N).fold(Self(1), |power, _| power.times(Self(8)));
        if value.is_negative() { sum.minus(excess) } else { sum }
    }

    fn integer(value: f64) -> Self {
        let magnitude = Self(value.abs() as u64 % PRIME);
        if value < 0.0 { Self::ZERO.minus(magnitude) } else { magnitude }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self((self.0 + other.0) % PRIME)
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        Self((self.0 + PRIME - other.0) % PRIME)
    }

    pub(crate) fn times(self, other: Self) -> Self {
        Self((u128::from(self.0) * u128::from(other.0) % u128::from(PRIME)) as u64)
    }

    /// Its inverse, by Fermat; none of 0.
    fn inverse(self) -> Option<Self> {
        if self == Self::ZERO {
            return None;
        }
        let (mut power, mut result, mut exponent) = (self, Self(1), PRIME - 2);
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = result.times(power);
            }
            power = power.times(power);
            exponent >>= 1;
        }
        Some(result)
    }
}

impl Residue {
    /// The exact place of a vertex, seen along an axis, as residues; `None` if it has none.
    pub(crate) fn place(
        faces: &Faces,
        face: u32,
        vertex: Symbol,
        axis: usize,
    ) -> Option<[Self; 2]> {
        let axes = [(axis + 1) % 3, (axis + 2) % 3];
        match faces.weights(face, vertex) {
            Weights::Corner(point) => Some(axes.map(|axis| Residue::integer(point[axis]))),
            Weights::Edge(points, weights) => mean(&points, &weights, axes),
            Weights::Inside(points, weights) => mean(&points, &weights, axes),
        }
    }
}

fn mean<const K: usize, const N: usize>(
    points: &[[f64; 3]; K],
    weights: &[Int<N>; K],
    axes: [usize; 2],
) -> Option<[Residue; 2]> {
    let weights = weights.map(|weight| Residue::of(&weight));
    let total = weights.iter().fold(Residue::ZERO, |sum, &weight| sum.plus(weight)).inverse()?;
    Some(axes.map(|axis| {
        let terms = points.iter().zip(weights);
        let sum = terms.fold(Residue::ZERO, |sum, (point, weight)| {
            sum.plus(weight.times(Residue::integer(point[axis])))
        });
        sum.times(total)
    }))
}

#[cfg(test)]
mod tests {
    use super::{PRIME, Residue};
    use binspace::internals::Int;

    #[test]
    fn residues_calculate_as_their_numbers_do() {
        let numbers = [0, 1, -1, 12345, -98765, i64::MAX, i64::MIN + 1];
        for a in numbers {
            let x = Residue::of(&Int::<2>::from(a));
            assert_eq!(x, Residue::of(&Int::<5>::from(a)), "{a} in more limbs");
            assert_eq!(x.0, i128::from(a).rem_euclid(i128::from(PRIME)) as u64);
            for b in numbers {
                let (y, product) = (Residue::of(&Int::<1>::from(b)), i128::from(a) * i128::from(b));
                assert_eq!(x.times(y).0, product.rem_euclid(i128::from(PRIME)) as u64);
                assert_eq!(x.plus(y).minus(y), x);
            }
            if let Some(inverse) = x.inverse() {
                assert_eq!(x.times(inverse), Residue(1));
            }
        }
    }
}
