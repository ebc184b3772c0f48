//! Integers compared with a bignum, and through decimal digits.

use super::Int;
use dashu_int::IBig;
use num_traits::FromPrimitive;
use proptest::prelude::*;

fn big<const N: usize>(value: &Int<N>) -> IBig {
    let bytes: Vec<u8> = value.0.iter().flat_map(|limb| limb.to_le_bytes()).collect();
    IBig::from_le_bytes(&bytes)
}

/// Limbs that are often all ones or all zeros, where carries propagate.
fn limb() -> impl Strategy<Value = u64> {
    prop_oneof![Just(0), Just(u64::MAX), Just(1 << 63), 0..4u64, any::<u64>()]
}

fn int3() -> impl Strategy<Value = Int<3>> {
    [limb(), limb(), limb()].prop_map(Int::from_limbs)
}

proptest! {
    #[test]
    fn agrees_with_a_bignum(a in int3(), b in int3(), shift in 0u32..190) {
        let (x, y): (Int<4>, Int<4>) = (a.resize(), b.resize());
        prop_assert_eq!(big(&(x + y)), big(&a) + big(&b));
        prop_assert_eq!(big(&(x - y)), big(&a) - big(&b));
        prop_assert_eq!(big(&-x), -big(&a));
        prop_assert_eq!(big(&a.times::<3, 6>(&b)), big(&a) * big(&b));
        prop_assert_eq!(big(&a.times::<3, 8>(&b)), big(&a) * big(&b));
        prop_assert_eq!(big(&a.shifted::<6>(shift)), big(&a) << shift as usize);
        prop_assert_eq!(a.sign(), big(&a).cmp(&IBig::ZERO));
    }

    #[test]
    fn rounds_to_the_nearest_float(a in int3()) {
        // An independent rounding: through the decimal digits.
        let expected: f64 = big(&a).to_string().parse().unwrap();
        prop_assert_eq!(a.to_f64(), expected);
        prop_assert!((a.to_f64() - big(&a).to_f64().value()).abs() <= expected.abs() * 1e-15);
    }

    #[test]
    fn takes_machine_integers(a in any::<i64>(), b in any::<i128>()) {
        prop_assert_eq!(big(&Int::<3>::from(a)), IBig::from(a));
        prop_assert_eq!(big(&Int::<2>::from(b)), IBig::from(b));
    }

    #[test]
    fn takes_floats(x in -1e57..1e57f64, small in -3.0..3.0f64) {
        for value in [x, small, 0.0, 1e-300] {
            let expected = IBig::from_f64(value.trunc()).unwrap();
            prop_assert_eq!(big(&Int::<3>::from_f64(value)), expected);
        }
    }
}

/// The nearest float, computed in another way: through the decimal digits.
fn nearest<const N: usize>(value: &Int<N>) -> f64 {
    big(value).to_string().parse().expect("a number")
}

/// A power of two.
fn power<const N: usize>(exponent: u32) -> Int<N> {
    Int::<1>::from_limbs([1]).shifted(exponent)
}

/// Half-way between two floats, a single lower bit decides. This bit may be in the limb of the last kept
/// bits, in the next limb, or in any other.
#[test]
fn one_bit_far_below_a_tie_decides() {
    let mut ties = 0;
    for top in 53..316 {
        let tie: Int<5> = power(top) + power(top - 53);
        let even: Int<5> = power(top);
        assert_eq!(tie.to_f64(), even.to_f64(), "2^{top} and half a step");
        let odd = tie + power(top - 52);
        assert_eq!(odd.to_f64(), (even + power(top - 51)).to_f64(), "an odd one and half a step");
        for bit in 0..top - 53 {
            for tie in [tie, odd] {
                let [above, below] = [tie + power(bit), tie - power(bit)];
                for (value, name) in [(above, "above"), (below, "below"), (-above, "minus above")] {
                    assert_eq!(value.to_f64(), nearest(&value), "2^{bit} {name} a tie at 2^{top}");
                }
                assert!(above.to_f64() > below.to_f64(), "2^{bit} about a tie at 2^{top}");
                ties += 1;
            }
        }
    }
    assert!(ties > 60_000, "{ties}");
}
