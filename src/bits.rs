//! Sets of small numbers as bits.

/// The numbers of the bits that are set, from the lowest.
#[inline]
pub(crate) fn bits(mut set: u64) -> impl Iterator<Item = usize> + Clone {
    std::iter::from_fn(move || {
        let bit = set.trailing_zeros();
        // Clears the lowest bit that is set.
        set &= set.checked_sub(1)?;
        Some(bit as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::bits;

    #[test]
    fn bits_are_listed_from_the_lowest() {
        let mut random = crate::random::SplitMix64::new(1);
        for few in 0..200 {
            let set = (0..few % 5).fold(random.next(), |set, _| set & random.next());
            let expected: Vec<usize> = (0..64).filter(|&bit| set >> bit & 1 == 1).collect();
            assert_eq!(bits(set).collect::<Vec<_>>(), expected);
        }
        assert_eq!((bits(0).count(), bits(u64::MAX).count()), (0, 64));
    }
}
