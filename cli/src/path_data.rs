//! Outlines and lines in whole numbers of a small unit, and as the data of an SVG path.

use std::fmt::Write;

use binspace::drawing::Polyline;

/// A pixel has no more steps than this. What is smaller is nothing in floats of viewers, too.
const MOST_STEPS: f64 = 1e9;
/// From this longer side of a picture on, units of a fiftieth of a pixel are enough: a hundredth, by which
/// corners are off at most, is not seen, also when the picture is enlarged a few times. Each tenth of the
/// side has units a tenth as large.
const LARGE: u32 = 480;
const UNITS: u32 = 50;

/// Outlines and lines in whole numbers of steps.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Steps {
    pub(crate) lines: Vec<Line>,
    /// How many decimals a unit has: a step is that part of it.
    pub(crate) decimals: u32,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    /// The corners, that where a closed line ends not repeated.
    pub(crate) corners: Vec<[i64; 2]>,
    pub(crate) is_closed: bool,
}

/// How many units of coordinates a pixel has in a picture of some size in pixels.
pub(crate) fn units([width, height]: [u32; 2]) -> u32 {
    let longer = width.max(height);
    let smaller = (1..4).filter(|&k| longer < LARGE.div_ceil(10u32.pow(k - 1))).count();
    UNITS * 10u32.pow(smaller as u32)
}

impl Steps {
    /// Of outlines to be filled, given in pixels.
    ///
    /// Coordinates are rounded to whole units. Where nothing would be left of the area, units have
    /// decimals.
    pub(crate) fn filled<'o>(
        outlines: impl Iterator<Item = &'o [[f64; 2]]> + Clone,
        units: u32,
    ) -> Self {
        let mut steps = f64::from(units);
        for decimals in 0.. {
            let all = outlines.clone().map(|outline| closed(round(outline, steps)));
            let mut lines: Vec<Line> = all.clone().filter(|line| line.corners.len() > 2).collect();
            if lines.iter().any(|line| has_area(&line.corners)) {
                return Self { lines, decimals };
            }
            if steps * 10.0 > MOST_STEPS {
                lines = all.collect();
                return Self { lines, decimals };
            }
            steps *= 10.0;
        }
        Self { lines: vec![], decimals: 0 }
    }

    /// Of lines to be drawn. One that ends where it begins is closed.
    pub(crate) fn drawn<'l>(lines: impl Iterator<Item = &'l [[f64; 2]]>, units: u32) -> Self {
        let line = |points: &[[f64; 2]]| {
            let mut corners = round(points, f64::from(units));
            if corners.len() > 3 && corners.first() == corners.last() {
                corners.pop();
                return Line { corners, is_closed: true };
            }
            // A dot is a line all the same.
            corners.extend_from_within(..usize::from(corners.len() == 1));
            Line { corners, is_closed: false }
        };
        Self { lines: lines.map(line).collect(), decimals: 0 }
    }

    /// As the data of a path, in steps from one corner to the next, so that roundings do not add up.
    pub(crate) fn data(&self) -> String {
        let mut data = Data { text: String::new(), decimals: self.decimals, had_point: false };
        let mut pen = [0; 2];
        for Line { corners, is_closed } in &self.lines {
            data.command('m');
            let start = corners.first().copied().unwrap_or(pen);
            for &corner in corners {
                for axis in 0..2 {
                    data.number(corner[axis] - pen[axis]);
                }
                pen = corner;
            }
            if *is_closed {
                data.command('z');
                pen = start;
            }
        }
        data.text
    }
}

/// The points of lines.
pub(crate) fn points(lines: &[Polyline]) -> impl Iterator<Item = &[[f64; 2]]> {
    lines.iter().map(|line| &line.points[..])
}

/// An outline: its last corner is not the first one again.
fn closed(mut corners: Vec<[i64; 2]>) -> Line {
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    Line { corners, is_closed: true }
}

/// Corners in steps from the corner of the picture, without those that fall on the one before.
fn round(points: &[[f64; 2]], scale: f64) -> Vec<[i64; 2]> {
    let steps = |corner: [f64; 2]| corner.map(|c| (c * scale).round() as i64);
    let mut rounded: Vec<[i64; 2]> = points.iter().map(|&corner| steps(corner)).collect();
    rounded.dedup();
    rounded
}

fn has_area(outline: &[[i64; 2]]) -> bool {
    let next = outline.iter().cycle().skip(1);
    let wide = |c: i64| i128::from(c);
    let doubled: i128 = outline
        .iter()
        .zip(next)
        .map(|(a, b)| wide(a[0]) * wide(b[1]) - wide(a[1]) * wide(b[0]))
        .sum();
    doubled != 0
}

/// The text of a path, as short as its grammar allows.
struct Data {
    text: String,
    decimals: u32,
    /// Whether the number before has a decimal point.
    had_point: bool,
}

impl Data {
    fn command(&mut self, letter: char) {
        self.text.push(letter);
        self.had_point = false;
    }

    /// Adds a number of steps. It is set apart by its sign, by its point if the number before has
    /// one, or else by a space.
    fn number(&mut self, steps: i64) {
        let unit = 10u64.pow(self.decimals);
        let (whole, rest) = (steps.unsigned_abs() / unit, steps.unsigned_abs() % unit);
        let begins_with_point = whole == 0 && rest > 0;
        let is_first = self.text.ends_with(|last: char| last.is_ascii_alphabetic());
        if steps < 0 {
            self.text.push('-');
        } else if !(is_first || begins_with_point && self.had_point) {
            self.text.push(' ');
        }
        if !begins_with_point {
            push(&mut self.text, whole);
        }
        self.had_point = rest > 0;
        if rest > 0 {
            let digits = format!("{rest:0width$}", width = self.decimals as usize);
            self.text.push('.');
            self.text.push_str(digits.trim_end_matches('0'));
        }
    }
}

fn push(text: &mut String, number: u64) {
    // Writing to a string does not fail.
    let _ = write!(text, "{number}");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data(outlines: &[&[[f64; 2]]], units: u32) -> String {
        Steps::filled(outlines.iter().copied(), units).data()
    }

    #[test]
    fn steps_are_short_and_set_apart() {
        let outline = [[11.5, 4.1], [12.75, 3.0], [12.7, 3.0], [12.7, 3.05], [13.7, -0.5]];
        assert_eq!(data(&[&outline], 100), "m1150 410 125-110-5 0 0 5 100-355z");
        let square = [[-0.5, -0.5], [0.0, -0.5], [0.0, 0.0]];
        let hole = [[0.75, 1.0], [1.0, 1.25], [1.25, 1.0]];
        assert_eq!(data(&[&square, &hole], 100), "m-50-50 50 0 0 50zm125 150 25 25 25-25z");
    }

    #[test]
    fn lines_are_open_or_closed() {
        let corner = [[0.5, 0.5], [1.5, 0.5], [1.5, 2.5]];
        let ring = [[0.5, 1.5], [1.5, 1.5], [0.5, 2.5], [0.5, 1.5]];
        let dot = [[3.5, 3.5], [3.501, 3.5]];
        let lines: [&[[f64; 2]]; 4] = [&corner, &ring, &dot, &corner[..2]];
        let data = Steps::drawn(lines.into_iter(), 10).data();
        // After an open line the pen is at its end, after a closed one where that began.
        assert_eq!(data, "m5 5 10 0 0 20m-10-10 10 0-10 10zm30 20 0 0m-30-30 10 0");
    }

    #[test]
    fn roundings_do_not_add_up() {
        // Each step is 0.004, which alone would be rounded to nothing.
        let mut outline: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i) * 0.004, 0.5]).collect();
        outline.push([2.0, 9.5]);
        let text = data(&[&outline], 100);
        let ends = data(&[&[outline[0], outline[999], outline[1000]]], 100);
        assert_eq!(ends, "m0 50 400 0-200 900z");
        assert!(text.starts_with("m0 50 1 0"), "{text}");
        assert!(text.ends_with(" 0-200 900z"), "{text}");
    }

    #[test]
    fn what_is_small_keeps_an_area() {
        let speck = [[3.0, 3.0], [3.001, 3.0], [3.0, 3.0003]];
        assert_eq!(data(&[&speck], 100), "m300 300 .1 0-.1.03z");
        // Smaller than all steps: a path all the same.
        assert_eq!(data(&[&[[3.0, 3.0], [3.0, 3.0], [3.0, 3.0]]], 100), "m300 300z");
        // Corners that fall together are one, and what is left of a hole is nothing.
        let square = [[0.0, 0.0], [0.001, 0.0], [4.0, 0.0], [4.0, 4.0], [0.001, 0.001]];
        assert_eq!(data(&[&square, &speck], 100), "m0 0 400 0 0 400z");
    }

    #[test]
    fn units_go_with_the_size() {
        let sizes = [[640, 480], [480, 1], [479, 300], [48, 20], [47, 3], [1, 1]];
        assert_eq!(sizes.map(units), [50, 50, 500, 500, 5_000, 50_000]);
    }
}
