//! Finds the precision of a file's coordinates.

use std::collections::BTreeMap;

/// The least fixed number of significant digits that programs write. Too small: short numbers of different
/// size, as people write them, count as rounded.
const FEWEST_DIGITS: i32 = 6;
/// The number of decimal digits that an `f64` stores for any value; further digits are noise of a
/// computation, as in `0.30000000000000004`.
const DIGITS_OF_F64: i32 = 15;
/// A number that begins more than this many places after the largest number is zero plus noise. Too small:
/// thin layers near zero are ignored. Too large: one computed zero, such as the sine of a rounded π, decides.
const NOISE_PLACES: i32 = 11;
/// Numbers of this many significant digits or more are long: 9 digits distinguish every `f32` from all
/// others. Too small: the heights of thin layers, as people write them, are long. Too large: numbers from
/// `f32` are not long.
const LONG: i32 = 9;
/// Unusually long numbers are strays if they are at most one in this many. Too small: parts of a scene that
/// are more precise than others are overlooked. Too large: a few long numbers decide for all.
const STRAYS: usize = 100;
/// The least number of long numbers that shows whether all were `f32`. Too small: some are near an `f32` by
/// chance. Too large: files with few `f32` are not recognised.
const TELLING: usize = 12;
/// The number of leading digits of a long number that count if such numbers are strays. Too small: layers
/// near zero that a program computed are merged. Too large: a stray decides for all.
const DIGITS_OF_STRAYS: i32 = 3;

/// The digits of the numbers seen so far.
///
/// Programs write either a fixed number of decimals, or a fixed number of significant digits. With a fixed
/// number of significant digits, numbers of different size have equally many digits; otherwise only the
/// largest numbers have the most digits. Zeros that a program adds at the end do not count. Zeros that a
/// program omits at the end do no harm, because the longest numbers decide. The exceptions are numbers far
/// longer than nearly all others: see `Digits::without_noise` and `Decimals::counted`.
#[derive(Debug, Default)]
pub struct Decimals {
    numbers: usize,
    /// The number of numbers with each kind of digits. Numbers equal to 0 are not counted.
    seen: BTreeMap<Digits, usize>,
    /// The number of long numbers, and the number of these that are `f32` up to their written digits.
    long: usize,
    long_of_f32: usize,
    /// The largest magnitude of a number.
    largest: f64,
}

/// The digits of a number; places are powers of ten.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Digits {
    /// The place of the first digit that is not 0.
    first: i32,
    /// The place of the last digit. Zeros at the end of the decimals do not count.
    last: i32,
    /// The number of written digits, from the first digit that is not 0. Later zeros count.
    written: i32,
}

impl Digits {
    /// The digits of a number; `None` if the number is 0.
    fn of(number: &str) -> Option<Self> {
        let (mantissa, exponent) = match number.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().unwrap_or(0)),
            None => (number, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let is_first = |digit: u8| (b'1'..=b'9').contains(&digit);
        let first = match whole.bytes().position(is_first) {
            Some(place) => (whole.len() - place - 1) as i32,
            None => -(fraction.bytes().position(is_first)? as i32) - 1,
        };
        let needed = fraction.trim_end_matches('0').len();
        Some(Self {
            first: first.saturating_add(exponent),
            last: exponent.saturating_sub(needed as i32),
            written: first + 1 + fraction.len() as i32,
        })
    }

    /// The digits of a number that an `f64` certainly stores.
    fn without_noise(self, value: f64) -> Option<Self> {
        if self.count() <= DIGITS_OF_F64 {
            return Some(self);
        }
        Self::of(&format!("{value:.*e}", DIGITS_OF_F64 as usize - 1))
    }

    fn count(self) -> i32 {
        self.first.saturating_sub(self.last).saturating_add(1)
    }

    /// The first digits of the number.
    fn cut(self) -> Self {
        let last = self.last.max(self.first.saturating_sub(DIGITS_OF_STRAYS - 1));
        Self { last, written: self.written.min(DIGITS_OF_STRAYS), ..self }
    }
}

impl Decimals {
    /// Records a finite number, as written and as read.
    pub fn see(&mut self, number: &str, value: f64) {
        self.numbers += 1;
        self.largest = self.largest.max(value.abs());
        let Some(digits) = Digits::of(number) else { return };
        if digits.count() >= LONG {
            let off = (value - f64::from(value as f32)).abs();
            self.long += 1;
            // The rounding errors of writing and of reading.
            let rounding = 0.51 * 10f64.powi(digits.last) + f64::EPSILON * value.abs();
            self.long_of_f32 += usize::from(off <= rounding);
        }
        if let Some(digits) = digits.without_noise(value) {
            *self.seen.entry(digits).or_default() += 1;
        }
    }

    /// Returns one unit in the last decimal of the largest numbers; 0 if no number was seen. If the numbers
    /// were `f32`, and are written with more digits than an `f32` has, returns the `f32` step of the largest
    /// number.
    pub fn unit(&self) -> f64 {
        let is_f32 = self.long >= TELLING && self.long_of_f32 >= self.long - self.long / STRAYS;
        let step = if is_f32 { f64::from(f32::EPSILON) * self.largest } else { 0.0 };
        step.max(self.decimal())
    }

    /// The digits that count. Numbers that are zero plus noise do not count. If only a few long numbers have
    /// more decimals than all short numbers, only the first digits of these long numbers count.
    fn counted(&self) -> Vec<Digits> {
        let largest = self.seen.keys().map(|digits| digits.first).max().unwrap_or(0);
        let is_noise = |digits: &Digits| digits.first < largest.saturating_sub(NOISE_PLACES);
        let is_long = |digits: &Digits| digits.count() >= LONG;
        let mut counted = self.seen.clone();
        counted.retain(|digits, _| !is_noise(digits));
        let short = counted.keys().filter(|digits| !is_long(digits));
        let finest = short.map(|digits| digits.last).min().unwrap_or(i32::MIN);
        let is_odd = |digits: &Digits| is_long(digits) && digits.last < finest;
        let odd = counted.iter().filter(|(digits, _)| is_odd(digits));
        let are_strays = odd.map(|(_, count)| count).sum::<usize>() <= self.numbers / STRAYS;
        let cut =
            |digits: Digits| if are_strays && is_odd(&digits) { digits.cut() } else { digits };
        counted.into_keys().map(cut).collect()
    }

    fn decimal(&self) -> f64 {
        let counted = self.counted();
        let Some(last) = counted.iter().map(|digits| digits.last).min() else {
            return if self.numbers > 0 { 1.0 } else { 0.0 };
        };
        let written = counted.iter().map(|digits| digits.written).max();
        let needed = counted.iter().map(|digits| digits.count()).max().unwrap_or(0);
        let longest = counted.iter().filter(|digits| Some(digits.written) == written);
        let (lowest, highest) = longest
            .fold((i32::MAX, i32::MIN), |(low, high), d| (low.min(d.first), high.max(d.first)));
        let is_significant = lowest < highest && needed >= FEWEST_DIGITS;
        let exponent =
            if is_significant { highest.saturating_add(1).saturating_sub(needed) } else { last };
        // Parsed as a number, so it is rounded like the coordinates.
        format!("1e{exponent}").parse().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Decimals;

    fn unit<'n>(numbers: impl IntoIterator<Item = &'n str>) -> f64 {
        let mut decimals = Decimals::default();
        numbers.into_iter().for_each(|number| decimals.see(number, number.parse().unwrap()));
        decimals.unit()
    }

    #[test]
    fn the_unit_follows_the_written_digits() {
        let cases: [(&[&str], f64); 16] = [
            (&[], 0.0),
            (&["0", "0"], 1.0),
            (&["0.000"], 1.0),
            (&["12", "-7", "100"], 1.0),
            // Zeros at the end of all numbers.
            (&["12.250000", "-0.500000", "100.000000"], 1e-2),
            (&["1.230000", "4.560000", "0.000000"], 1e-2),
            (&["1.2300000e+00", "4.560000e+01", "1.000000e+02"], 1e-2),
            (&["12.250000", "-0.500001", "100.000000"], 1e-6),
            // The same without zeros at the end.
            (&["12.25", "-0.500001", "100"], 1e-6),
            // Six significant digits, of which some zeros are left off.
            (&["0.00123456", "1.23457", "123.456", "1e3", "-12.5"], 1e-3),
            (&["1.23456e-03", "1.23457e+00", "1.23456e+02"], 1e-3),
            // Whole numbers, and thin layers over them.
            (&["100", "57", "8", "0.000001", "0.000002"], 1e-6),
            (&["1", "0.000001", "0.000002"], 1e-6),
            (&["12.345", "0.50002"], 1e-5),
            (&["5e7", "3e7"], 1e7),
            (&["1e-999999", "1"], 1.0),
        ];
        for (numbers, expected) in cases {
            assert_eq!(unit(numbers.iter().copied()), expected, "{numbers:?}");
        }
    }

    #[test]
    fn the_unit_of_fixed_and_significant_digits_is_found() {
        let mut state = 1_u64;
        let mut random = || {
            state = crate::random::mix(state);
            (state >> 11) as f64 * 2f64.powi(-53)
        };
        for places in [5_usize, 6, 8] {
            let (mut fixed, mut significant) = (Decimals::default(), Decimals::default());
            for _ in 0..300 {
                let value = (random() - 0.5) * 40.0 * random() * random();
                for (decimals, number) in [
                    (&mut fixed, format!("{value:.places$}")),
                    (&mut significant, format!("{value:.places$e}")),
                ] {
                    decimals.see(&number, number.parse().unwrap());
                }
            }
            let unit = |exponent: usize| format!("1e-{exponent}").parse::<f64>().unwrap();
            assert_eq!(fixed.unit(), unit(places), "{places} decimals");
            // The largest numbers are from 10 on.
            assert_eq!(significant.unit(), unit(places - 1), "{places} digits after the first");
        }
    }

    /// Adds a few other numbers to 1000 numbers with three decimals, and checks the unit.
    #[test]
    fn a_few_long_numbers_do_not_decide_for_all() {
        let three: Vec<String> = (0..1000).map(|k| format!("{}.{:03}", k % 7, k)).collect();
        let with = |others: &[&str]| unit(three.iter().map(|n| &**n).chain(others.iter().copied()));
        let cases: [(&[&str], f64); 15] = [
            (&[], 1e-3),
            (&["0.30000000000000004"], 1e-3),
            (&["2.9999999999999996", "30.000000000000004"], 1e-3),
            (&["0.1234567890123456", "12.345678901234567"], 1e-3),
            (&["0.333333343"], 1e-3),
            // A sine of π.
            (&["1.2246467991473532e-16", "-6.123234e-17"], 1e-3),
            (&["0.0000000000015"], 1e-3),
            // Eleven places after the largest number, it counts.
            (&["0.000000000015"], 1e-12),
            // Thin layers are not strays: neither written by people, nor near zero, nor a poster on a wall.
            (&["0.0005"], 1e-4),
            (&["123.45605"], 1e-5),
            (&["0.0000125"], 1e-7),
            (&["0.0033333333333"], 1e-5),
            // Long numbers with no more decimals than short numbers are not strays.
            (&["0.12345", "1234.56789", "2345.67"], 1e-5),
            // Many long numbers are not strays.
            (&["0.1234567890123"; 9], 1e-3),
            (&["0.1234567890123"; 11], 1e-13),
        ];
        for (others, expected) in cases {
            assert_eq!(with(others), expected, "{others:?}");
        }
        // Noise of sums does no harm, in any number.
        let sums: Vec<String> = (0..500).map(|k| (f64::from(k) * 0.1).to_string()).collect();
        assert!(sums.iter().any(|sum| sum.len() > 15));
        assert_eq!(unit(sums.iter().map(|sum| &**sum)), 0.1);
    }

    /// The number of written digits does not matter.
    #[test]
    fn numbers_that_were_f32_have_the_unit_of_f32() {
        let mut state = 7_u64;
        let mut random = || {
            state = crate::random::mix(state);
            ((state >> 11) as f64 * 2f64.powi(-53) - 0.5) * 6.0
        };
        let values: Vec<f32> = (0..200).map(|_| (5.0 * random()) as f32).collect();
        let largest = values.iter().fold(0.0f32, |most, value| most.max(value.abs()));
        let step = f64::from(f32::EPSILON * largest);
        type Write = fn(f32) -> String;
        let ways: [Write; 4] = [
            |value| format!("{value:.8e}"),
            |value| format!("{value:.10}"),
            |value| format!("{value:.15}"),
            |value| f64::from(value).to_string(),
        ];
        for (way, write) in ways.iter().enumerate() {
            let numbers: Vec<String> = values.iter().map(|&value| write(value)).collect();
            let found = unit(numbers.iter().map(|number| &**number));
            assert!((step * 0.99..step * 1.01).contains(&found), "{way}: {found} {step}");
        }
        // Few `f64` numbers with as many digits are near an `f32`.
        let numbers: Vec<String> = (0..200).map(|_| format!("{:.10}", random())).collect();
        assert_eq!(unit(numbers.iter().map(|number| &**number)), 1e-10);
    }
}
