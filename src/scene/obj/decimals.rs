//! How precisely a file writes its coordinates.

/// Powers of ten from −`DECADES` to `DECADES` − 1 are told apart.
const DECADES: i32 = 40;
/// The least fixed number of significant digits that programs write. Fewer: short numbers of
/// different size, as people write them, are taken for rounded ones.
const FEWEST_DIGITS: i32 = 5;

/// What was seen of the digits of numbers.
///
/// Programs write either a fixed number of decimals, or a fixed number of significant digits. In
/// the latter case numbers of different size have as many digits, which otherwise only the largest
/// numbers have. Zeros that were left off at an end do no harm, as the longest numbers decide.
#[derive(Debug)]
pub(super) struct Decimals {
    /// The most digits behind the point of any number; fewer than none before a large power of ten.
    most: Option<i32>,
    /// For each power of ten, the most significant digits of the numbers that begin there.
    digits: [i32; 2 * DECADES as usize],
}

impl Default for Decimals {
    fn default() -> Self {
        Self { most: None, digits: [0; 2 * DECADES as usize] }
    }
}

impl Decimals {
    /// Takes notice of a number, which is finite and not malformed.
    pub(super) fn see(&mut self, number: &str) {
        let (mantissa, exponent) = match number.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().unwrap_or(0)),
            None => (number, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let decimals = (fraction.len() as i32).saturating_sub(exponent);
        self.most = Some(self.most.map_or(decimals, |most| most.max(decimals)));
        // The power of ten of the first digit that is not 0, before that of the exponent.
        let is_first = |digit: u8| (b'1'..=b'9').contains(&digit);
        let first = match whole.bytes().position(is_first) {
            Some(place) => (whole.len() - place - 1) as i32,
            None => match fraction.bytes().position(is_first) {
                Some(place) => -(place as i32) - 1,
                None => return,
            },
        };
        let decade = first.saturating_add(exponent).clamp(-DECADES, DECADES - 1);
        let digits = first + 1 + fraction.len() as i32;
        let longest = &mut self.digits[(decade + DECADES) as usize];
        *longest = digits.max(*longest);
    }

    /// One unit in the last decimal of the largest numbers; 0 if no number was seen.
    pub(super) fn unit(&self) -> f64 {
        let digits = self.digits.iter().copied().max().unwrap_or(0);
        let mut longest = (-DECADES..).zip(self.digits).filter(|decade| decade.1 == digits);
        let exponent = match (longest.next(), longest.last(), self.most) {
            (Some(_), Some((decade, _)), _) if digits >= FEWEST_DIGITS => decade + 1 - digits,
            (_, _, Some(most)) => -most,
            (_, _, None) => return 0.0,
        };
        // Read as a number, it is rounded as the coordinates are.
        format!("1e{exponent}").parse().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Decimals;

    #[test]
    fn the_unit_is_that_of_the_numbers_as_they_are_written() {
        let cases: [(&[&str], f64); 12] = [
            (&[], 0.0),
            (&["0", "0"], 1.0),
            (&["0.000"], 1e-3),
            (&["12", "-7", "100"], 1.0),
            (&["12.250000", "-0.500000", "100.000000"], 1e-6),
            // The same without zeros at the end.
            (&["12.25", "-0.500001", "100"], 1e-6),
            // Six significant digits, of which some zeros are left off.
            (&["0.00123456", "1.23457", "123.456", "1e3", "-12.5"], 1e-3),
            (&["1.23456e-03", "1.23457e+00", "1.23456e+02"], 1e-3),
            // Whole numbers, and thin layers over them.
            (&["100", "57", "8", "0.000001", "0.000002"], 1e-6),
            (&["1", "0.000001", "0.000002"], 1e-6),
            (&["5e7", "3e7"], 1e7),
            (&["1e-999999", "1"], 0.0),
        ];
        for (numbers, unit) in cases {
            let mut decimals = Decimals::default();
            numbers.iter().for_each(|number| decimals.see(number));
            assert_eq!(decimals.unit(), unit, "{numbers:?}");
        }
    }

    #[test]
    fn numbers_as_programs_write_them_tell_their_unit() {
        let mut state = 1_u64;
        let mut random = || {
            state = crate::random::mix(state);
            (state >> 11) as f64 * 2f64.powi(-53)
        };
        for places in [4_usize, 6, 8] {
            let (mut fixed, mut significant) = (Decimals::default(), Decimals::default());
            for _ in 0..300 {
                let value = (random() - 0.5) * 40.0 * random() * random();
                fixed.see(&format!("{value:.places$}"));
                significant.see(&format!("{value:.places$e}"));
            }
            let unit = |exponent: usize| format!("1e-{exponent}").parse::<f64>().unwrap();
            assert_eq!(fixed.unit(), unit(places), "{places} decimals");
            // The largest are from 10 on.
            assert_eq!(significant.unit(), unit(places - 1), "{places} digits after the first");
        }
    }
}
