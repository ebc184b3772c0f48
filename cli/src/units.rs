//! Figures for people.

/// A length of time with three digits and a unit.
pub fn time(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s >= 0.9995 => (s, "s"),
        s if s >= 0.9995e-3 => (s * 1e3, "ms"),
        s if s >= 0.9995e-6 => (s * 1e6, "µs"),
        s => (s * 1e9, "ns"),
    };
    format!("{} {unit}", three_digits(value))
}

/// A number of bytes with three digits and a unit.
pub fn bytes(bytes: usize) -> String {
    match bytes as f64 {
        b if b >= 999.5e6 => format!("{} GB", three_digits(b / 1e9)),
        b if b >= 999.5e3 => format!("{} MB", three_digits(b / 1e6)),
        b => format!("{} kB", three_digits(b / 1e3)),
    }
}

/// A number with three digits, or all digits before the point.
pub fn three_digits(value: f64) -> String {
    let decimals = match value {
        v if v >= 99.95 => 0,
        v if v >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.decimals$}")
}

/// A count with its noun, in the singular for a count of one.
pub fn count(number: usize, noun: &str) -> String {
    if number == 1 { format!("1 {noun}") } else { format!("{number} {noun}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_three_digits() {
        let texts = [0.0, 2.5e-9, 999.4e-9, 999.6e-9, 0.01234, 0.9999, 7.125, 1234.0].map(time);
        let expected =
            ["0.00 ns", "2.50 ns", "999 ns", "1.00 µs", "12.3 ms", "1.00 s", "7.12 s", "1234 s"];
        assert_eq!(texts, expected);
        assert_eq!([0, 1536, 2_500_000].map(bytes), ["0.00 kB", "1.54 kB", "2.50 MB"]);
        assert_eq!([count(1, "face"), count(2, "face")], ["1 face", "2 faces"]);
    }
}
