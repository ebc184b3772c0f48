//! Tests whether fractions are equal that are too large to be added, by their residues modulo a prime.

use dashu_int::IBig;
use num_traits::Euclid;

use crate::place::Place;

/// A number modulo the prime 2⁶¹ − 1. Equal fractions have equal residues; unequal ones have equal residues
/// with a probability of 2⁻⁶¹.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Residue(u64);

const PRIME: u64 = (1 << 61) - 1;

impl Residue {
    pub(crate) const ZERO: Self = Self(0);

    fn of(value: &IBig) -> Self {
        Self(value.rem_euclid(&PRIME.into()).try_into().expect("below the prime"))
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self((self.0 + other.0) % PRIME)
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        Self((self.0 + PRIME - other.0) % PRIME)
    }

    pub(crate) fn times(self, other: Self) -> Self {
        let product = u128::from(self.0) * u128::from(other.0);
        // 2⁶¹ is 1 modulo the prime, so the digits of 61 bits are added up.
        Self(((product >> 61) as u64 + (product as u64 & PRIME)) % PRIME)
    }

    /// The inverse by Fermat's little theorem; `None` for 0.
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

    /// A place as seen along an axis; `None` if the prime divides its weight, with a probability of 2⁻⁶¹.
    pub(crate) fn place(place: &Place, axis: usize) -> Option<[Self; 2]> {
        let coordinates = place.along(axis).map(Self::of);
        if place.weight().is_one() {
            return Some(coordinates);
        }
        let inverse = Self::of(place.weight()).inverse()?;
        Some(coordinates.map(|c| c.times(inverse)))
    }
}

/// Twice the area of an outline as seen along an axis.
pub(crate) fn twice_area(outline: &[[Residue; 2]]) -> Residue {
    let next = outline.iter().cycle().skip(1);
    outline
        .iter()
        .zip(next)
        .fold(Residue::ZERO, |sum, ([a, b], [c, d])| sum.plus(a.times(*d)).minus(b.times(*c)))
}

#[cfg(test)]
mod tests {
    use super::{PRIME, Residue};
    use dashu_int::IBig;

    #[test]
    fn residues_calculate_as_their_numbers_do() {
        let numbers = [0, 1, -1, 12345, -98765, i64::MAX, i64::MIN + 1];
        for a in numbers {
            let x = Residue::of(&IBig::from(a));
            assert_eq!(x.0, i128::from(a).rem_euclid(i128::from(PRIME)) as u64);
            for b in numbers {
                let product = i128::from(a) * i128::from(b);
                let y = Residue::of(&IBig::from(b));
                assert_eq!(x.times(y), Residue::of(&IBig::from(product)), "{a} · {b}");
                assert_eq!(x.times(y).0, product.rem_euclid(i128::from(PRIME)) as u64);
                assert_eq!(x.plus(y).minus(y), x);
            }
            if let Some(inverse) = x.inverse() {
                assert_eq!(x.times(inverse), Residue(1));
            }
        }
    }
}
