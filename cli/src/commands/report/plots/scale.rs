//! Logarithmic axes.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

/// A logarithmic axis: its ends, and where its ticks are, as powers of ten.
#[derive(Debug, PartialEq)]
pub(super) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) ticks: Vec<f64>,
}

impl Scale {
    /// An axis for these positive values, which ends at whole decades, with at most nine ticks.
    pub(super) fn decades(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = bounds(values.map(f64::log10)).unwrap_or((0.0, 1.0));
        let (low, mut high) = ((low + 1e-9).floor(), (high - 1e-9).ceil());
        if high <= low {
            high = low + 1.0;
        }
        let step = ((high - low) / 8.0).ceil().max(1.0);
        let count = ((high - low) / step).floor() as u32;
        let ticks = (0..=count).map(|i| low + f64::from(i) * step).collect();
        Self { low, high, ticks }
    }

    /// An axis with ticks at these values, and a little room around them.
    pub(super) fn at(values: &[f64]) -> Self {
        let ticks: Vec<f64> = values.iter().map(|value| value.log10()).collect();
        let (low, high) = bounds(ticks.iter().copied()).unwrap_or((0.0, 1.0));
        Self { low: low - 0.05, high: high + 0.05, ticks }
    }
}

/// As the library for plots has it: from exponents to pixels.
impl Ranged for Scale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let share = (value - self.low) / (self.high - self.low);
        first + (share * f64::from(last - first)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // Lines between ticks would be at no round number.
        if hint.bold_points() > 0 { self.ticks.clone() } else { Vec::new() }
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

fn bounds(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|value| value.is_finite()).fold(None, |bounds, value| {
        let (low, high) = bounds.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}

/// A power of ten as people write it: 0.01 to 1000 in full, others as 10ᵏ.
pub(super) fn label(exponent: f64) -> String {
    let whole = exponent.round();
    if (exponent - whole).abs() > 1e-6 {
        // A tick at a value that is no decade.
        let value = 10f64.powf(exponent);
        return if value >= 10.0 { format!("{value:.0}") } else { format!("{value:.1}") }
            .trim_end_matches(".0")
            .to_owned();
    }
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    match whole as i32 {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        2 => "100".to_owned(),
        power => {
            let raised = power.unsigned_abs().to_string();
            let raised = raised.chars().filter_map(|c| c.to_digit(10)).map(|d| digits[d as usize]);
            let sign = if power < 0 { "⁻" } else { "" };
            format!("10{sign}{}", raised.collect::<String>())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Scale, label};

    #[test]
    fn ticks_are_decades_few_enough_to_read() {
        let scale = Scale::decades([3e-5, 0.2].into_iter());
        assert_eq!((scale.low, scale.high), (-5.0, 0.0));
        assert_eq!(scale.ticks, [-5.0, -4.0, -3.0, -2.0, -1.0, 0.0]);
        assert_eq!(Scale::decades([1e-30, 1e30].into_iter()).ticks.len(), 8);
        let none = Scale::decades(std::iter::empty());
        assert!(none.high > none.low);
    }

    #[test]
    fn powers_are_written_with_raised_figures() {
        let labels = [-12.0, -1.0, 0.0, 2.0, 3.0, 2f64.log10(), 12f64.log10()].map(label);
        assert_eq!(labels, ["10⁻¹²", "10⁻¹", "1", "100", "10³", "2", "12"]);
    }
}
