//! Signed integers of fixed width, on the stack.

use std::cmp::Ordering;

/// The greatest common divisor.
pub(crate) fn gcd(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// A signed integer of `64 * N` bits, in two's complement, least significant limb first.
///
/// The number of bits of every predicate's result is known in advance (see the table in `vertex.rs`), so
/// nothing here checks for overflow in release builds: each product states its width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Int<const N: usize>([u64; N]);

impl<const N: usize> Int<N> {
    /// Zero.
    pub(crate) const ZERO: Self = Self([0; N]);

    /// The value of the limbs, least significant first, in two's complement.
    pub(crate) const fn from_limbs(limbs: [u64; N]) -> Self {
        Self(limbs)
    }

    /// Whether the value is below zero.
    #[inline]
    pub(crate) const fn is_negative(&self) -> bool {
        (self.0[N - 1] as i64) < 0
    }

    /// The sign of the value.
    #[inline]
    pub(crate) fn sign(&self) -> Ordering {
        if self.is_negative() {
            Ordering::Less
        } else if self.0.iter().all(|&limb| limb == 0) {
            Ordering::Equal
        } else {
            Ordering::Greater
        }
    }

    /// The same value in `M` limbs; `M` must suffice.
    #[inline]
    pub(crate) fn resize<const M: usize>(&self) -> Int<M> {
        let fill = if self.is_negative() { u64::MAX } else { 0 };
        let mut limbs = [fill; M];
        let shared = N.min(M);
        limbs[..shared].copy_from_slice(&self.0[..shared]);
        let result = Int(limbs);
        debug_assert!(
            self.0[shared..].iter().all(|&limb| limb == fill)
                && result.is_negative() == self.is_negative(),
            "the value does not fit the narrower integer"
        );
        result
    }

    /// The product, in `R` limbs; `R` must suffice.
    #[inline]
    pub(crate) fn times<const M: usize, const R: usize>(&self, other: &Int<M>) -> Int<R> {
        let (a, b) = (self.magnitude(), other.magnitude());
        let mut limbs = [0u64; R];
        for (i, &x) in a.iter().enumerate().take(R) {
            let mut carry = 0u128;
            // At most (2⁶⁴ − 1)² + 2 (2⁶⁴ − 1) = 2¹²⁸ − 1: the sum cannot overflow. Limbs beyond `R` are
            // not computed: the caller knows that the product fits.
            for (limb, &y) in limbs[i..].iter_mut().zip(&b) {
                carry += u128::from(x) * u128::from(y) + u128::from(*limb);
                *limb = carry as u64;
                carry >>= 64;
            }
            if let Some(limb) = limbs.get_mut(i + M) {
                *limb = carry as u64;
            }
        }
        let product = Int(limbs);
        if self.is_negative() == other.is_negative() { product } else { -product }
    }

    /// The value times two to the power of `shift`, in `R` limbs; `R` must suffice.
    pub(crate) fn shifted<const R: usize>(&self, shift: u32) -> Int<R> {
        let wide: Int<R> = self.resize();
        let (limb_shift, bit_shift) = ((shift / 64) as usize, shift % 64);
        let limbs = std::array::from_fn(|i| {
            let at = |k: usize| if k <= i { wide.0[i - k] } else { 0 };
            let low = if bit_shift == 0 { 0 } else { at(limb_shift + 1) >> (64 - bit_shift) };
            (at(limb_shift) << bit_shift) | low
        });
        Int(limbs)
    }

    /// The value of an `f64`, rounded towards zero; the value must be finite and fit.
    pub(crate) fn from_f64(value: f64) -> Self {
        let bits = value.abs().to_bits();
        let exponent = (bits >> 52) as i32 - 1075;
        let fraction = if bits >> 52 == 0 { 0 } else { bits & ((1 << 52) - 1) | 1 << 52 };
        let result: Self = if exponent > 0 {
            Int::<2>::from_limbs([fraction, 0]).shifted(exponent as u32)
        } else {
            Int::<2>::from_limbs([fraction.checked_shr(-exponent as u32).unwrap_or(0), 0]).resize()
        };
        if value < 0.0 { -result } else { result }
    }

    /// The nearest `f64`, ties to even; infinite beyond the range of `f64`.
    pub(crate) fn to_f64(self) -> f64 {
        let magnitude = self.magnitude();
        let Some(top) = magnitude.iter().rposition(|&limb| limb != 0) else {
            return 0.0;
        };
        // Take the 64 leading bits, and set the last of these if any bit below them is set. The conversion to
        // f64 then rounds once, as if it saw every bit.
        let lead = magnitude[top].leading_zeros();
        let mut bits = magnitude[top] << lead;
        let mut sticky = false;
        if top > 0 {
            if lead > 0 {
                bits |= magnitude[top - 1] >> (64 - lead);
            }
            sticky = (lead < 64 && (magnitude[top - 1] << lead) != 0)
                || magnitude[..top - 1].iter().any(|&limb| limb != 0);
        }
        let exponent = 64 * top as i32 - lead as i32;
        // 2^exponent; the exponent is at least −63, so the number is not subnormal.
        let bits_of_scale = ((exponent + 1023) as u64) << 52;
        let scale = if exponent <= 1023 { f64::from_bits(bits_of_scale) } else { f64::INFINITY };
        let value = (bits | u64::from(sticky)) as f64 * scale;
        if self.is_negative() { -value } else { value }
    }

    /// The limbs of the absolute value, unsigned. (The least value is its own negative in two's complement;
    /// the same bits, read as unsigned, are its absolute value.)
    #[inline]
    fn magnitude(&self) -> [u64; N] {
        if self.is_negative() { (-*self).0 } else { self.0 }
    }
}

impl<const N: usize> std::ops::Neg for Int<N> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        let mut carry = true;
        Int(self.0.map(|limb| {
            let (sum, overflow) = (!limb).overflowing_add(u64::from(carry));
            carry = overflow;
            sum
        }))
    }
}

impl<const N: usize> std::ops::Add for Int<N> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let mut carry = 0u128;
        let mut limbs = [0; N];
        for ((sum, a), b) in limbs.iter_mut().zip(self.0).zip(other.0) {
            carry += u128::from(a) + u128::from(b);
            *sum = carry as u64;
            carry >>= 64;
        }
        Int(limbs)
    }
}

impl<const N: usize> std::ops::Sub for Int<N> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        let mut borrow = 0i128;
        let mut limbs = [0; N];
        for ((difference, a), b) in limbs.iter_mut().zip(self.0).zip(other.0) {
            borrow += i128::from(a) - i128::from(b);
            *difference = borrow as u64;
            borrow >>= 64;
        }
        Int(limbs)
    }
}

impl<const N: usize, I: Into<i128>> From<I> for Int<N> {
    /// `N` must be at least 2, unless the value fits one limb.
    #[inline]
    fn from(value: I) -> Self {
        let value = value.into();
        Int::<2>([value as u64, (value >> 64) as u64]).resize()
    }
}

#[cfg(test)]
mod tests;
