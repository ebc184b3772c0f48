//! Logarithmic axes.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

/// A logarithmic axis: the exponents (base ten) of its ends and ticks.
#[derive(Debug, PartialEq)]
pub(super) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) ticks: Vec<f64>,
    /// Whether the axis runs from large to small.
    pub(super) falls: bool,
}

impl Scale {
    /// An axis for these positive values, with at most nine ticks. The axis ends at decades. If at most two
    /// decades contain all values, the axis ends at steps of 1, 2 and 5.
    pub(super) fn decades(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = bounds(values.map(f64::log10)).unwrap_or((0.0, 1.0));
        // A value that exceeds a decade only by rounding does not add another decade.
        let (first, mut last) = ((low + 0.01).floor(), (high - 0.01).ceil());
        if last <= first {
            last = first + 1.0;
        }
        if last - first <= 2.0 {
            return Self::fine(low, high, first, last);
        }
        let steps = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
        let step = steps.into_iter().find(|step| (last - first) / step <= 8.0).unwrap_or(100.0);
        let count = ((last - first) / step).floor() as u32;
        let ticks = (0..=count).map(|i| first + f64::from(i) * step).collect();
        Self { low: first, high: last, ticks, falls: false }
    }

    fn fine(low: f64, high: f64, first: f64, last: f64) -> Self {
        let decades = (first as i32..=last as i32).map(f64::from);
        let all = decades.flat_map(|decade| [1.0, 2.0, 5.0].map(|m: f64| decade + m.log10()));
        let all: Vec<f64> = all.filter(|tick| *tick < last + 1e-9).collect();
        let from = all.iter().rposition(|tick| *tick < low + 0.01).unwrap_or(0);
        let to = all.iter().position(|tick| *tick > high - 0.01).unwrap_or(all.len() - 1);
        let (from, to) = if from < to { (from, to) } else { (from.saturating_sub(1), from + 1) };
        let ticks: Vec<f64> = all.into_iter().take(to + 1).skip(from).collect();
        let (low, high) = bounds(ticks.iter().copied()).unwrap_or((first, last));
        Self { low, high, ticks, falls: false }
    }

    /// An axis with ticks at these values, and a small margin.
    pub(super) fn at(values: &[f64]) -> Self {
        let ticks: Vec<f64> = values.iter().map(|value| value.log10()).collect();
        let (low, high) = bounds(ticks.iter().copied()).unwrap_or((0.0, 1.0));
        Self { low: low - 0.05, high: high + 0.05, ticks, falls: false }
    }
}

/// Maps exponents to pixels, as the plotting library requires.
impl Ranged for Scale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let share = (value - self.low) / (self.high - self.low);
        let share = if self.falls { 1.0 - share } else { share };
        first + (share * f64::from(last - first)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
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

/// Formats the power of ten of an exponent: from 0.01 to 5000 in decimals, others in scientific notation.
pub(super) fn label(exponent: f64) -> String {
    let decade = (exponent + 1e-6).floor();
    let digit = 10f64.powf(exponent - decade);
    if (-2.0..4.0).contains(&decade) {
        let value = (digit * 10f64.powf(decade) * 100.0).round() / 100.0;
        return value.to_string();
    }
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = (decade as i32).unsigned_abs().to_string();
    let raised = raised.chars().filter_map(|c| c.to_digit(10)).map(|d| digits[d as usize]);
    let sign = if decade < 0.0 { "⁻" } else { "" };
    let power = format!("10{sign}{}", raised.collect::<String>());
    if digit < 1.005 { power } else { format!("{}·{power}", (digit * 10.0).round() / 10.0) }
}

#[cfg(test)]
mod tests {
    use super::{Scale, label};

    #[test]
    fn ticks_are_decades_few_enough_to_read() {
        let scale = Scale::decades([3e-5, 0.2].into_iter());
        assert_eq!((scale.low, scale.high), (-5.0, 0.0));
        assert_eq!(scale.ticks, [-5.0, -4.0, -3.0, -2.0, -1.0, 0.0]);
        assert_eq!(Scale::decades([1e-30, 1e30].into_iter()).ticks.len(), 7);
        let none = Scale::decades(std::iter::empty());
        assert!(none.high > none.low);
    }

    #[test]
    fn a_narrow_range_has_ticks_within_decades() {
        let scale = Scale::decades([1.3e-4, 4e-4].into_iter());
        let labels: Vec<String> = scale.ticks.iter().map(|&tick| label(tick)).collect();
        assert_eq!(labels, ["10⁻⁴", "2·10⁻⁴", "5·10⁻⁴"]);
        for value in [1.0, 3.0, 1e-7] {
            let scale = Scale::decades([value].into_iter());
            assert!(scale.low < scale.high && scale.ticks.len() >= 2, "{scale:?}");
        }
    }

    #[test]
    fn powers_are_written_with_raised_figures() {
        let labels = [-12.0, -1.0, 0.0, 2.0, 3.0, 2f64.log10(), 12f64.log10()].map(label);
        assert_eq!(labels, ["10⁻¹²", "0.1", "1", "100", "1000", "2", "12"]);
        // Decimals from 0.01 to 5000.
        let ends = [5e-3, 0.01, 5e3, 1e4, 2e4].map(|value: f64| label(value.log10()));
        assert_eq!(ends, ["5·10⁻³", "0.01", "5000", "10⁴", "2·10⁴"]);
    }
}
