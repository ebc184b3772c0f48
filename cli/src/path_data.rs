//! Outlines as the data of an SVG path.

use std::fmt::Write;

/// Coordinates have no more decimals than this. What is smaller is nothing in floats of viewers, too.
const MOST_DECIMALS: u32 = 9;
/// From this longer side of a picture on, two decimals are enough: a five-hundredth of a pixel is not
/// seen, also when the picture is enlarged a few times. Each tenth of it needs one more.
const LARGE: u32 = 480;

/// Whole numbers of steps, and how many of them are a pixel.
type Outline = Vec<[i64; 2]>;

/// The number of decimals for a picture of some size in pixels.
pub(crate) fn decimals([width, height]: [u32; 2]) -> u32 {
    let longer = width.max(height);
    2 + (1..4).filter(|&k| longer < LARGE.div_ceil(10u32.pow(k - 1))).count() as u32
}

/// The data of a path that fills outlines, given in pixels from the centre of the first one.
///
/// Coordinates are rounded to some decimals, and written as steps from one rounded corner to the next, so
/// that roundings do not add up. Where nothing would be left of the area, there are more decimals.
pub(crate) fn path_data<'o>(
    outlines: impl Iterator<Item = &'o [[f64; 2]]> + Clone,
    decimals: u32,
) -> String {
    for decimals in decimals..MOST_DECIMALS {
        let mut rounded: Vec<Outline> = outlines.clone().map(|o| round(o, decimals)).collect();
        rounded.retain(|outline| outline.len() > 2);
        if rounded.iter().any(|outline| has_area(outline)) {
            return written(&rounded, decimals);
        }
    }
    let rounded: Vec<Outline> = outlines.map(|outline| round(outline, MOST_DECIMALS)).collect();
    written(&rounded, MOST_DECIMALS)
}

/// Corners in steps from the corner of the picture, without those that fall on the one before.
fn round(outline: &[[f64; 2]], decimals: u32) -> Outline {
    let scale = 10f64.powi(decimals as i32);
    let steps = |corner: [f64; 2]| corner.map(|c| ((c + 0.5) * scale).round() as i64);
    let mut rounded: Outline = outline.iter().map(|&corner| steps(corner)).collect();
    rounded.dedup();
    while rounded.len() > 1 && rounded.first() == rounded.last() {
        rounded.pop();
    }
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

fn written(outlines: &[Outline], decimals: u32) -> String {
    let mut data = Data { text: String::new(), decimals, had_point: false };
    let mut start = [0; 2];
    for outline in outlines {
        data.command('m');
        // After `z` the pen is back at the start of its outline.
        let mut pen = start;
        for &corner in outline {
            for axis in 0..2 {
                data.number(corner[axis] - pen[axis]);
            }
            pen = corner;
        }
        start = outline.first().copied().unwrap_or(start);
        data.command('z');
    }
    data.text
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

    fn data(outlines: &[&[[f64; 2]]], decimals: u32) -> String {
        path_data(outlines.iter().copied(), decimals)
    }

    #[test]
    fn steps_are_short_and_set_apart() {
        let outline = [[11.5, 4.1], [12.75, 3.0], [12.7, 3.0], [12.7, 3.05], [13.7, -0.5]];
        assert_eq!(data(&[&outline], 2), "m12 4.6 1.25-1.1-.05 0 0 .05 1-3.55z");
        let square = [[-0.5, -0.5], [0.0, -0.5], [0.0, 0.0]];
        let hole = [[0.75, 1.0], [1.0, 1.25], [1.25, 1.0]];
        assert_eq!(data(&[&square, &hole], 2), "m0 0 .5 0 0 .5zm1.25 1.5.25.25.25-.25z");
    }

    #[test]
    fn roundings_do_not_add_up() {
        // Each step is 0.004, which alone would be rounded to nothing.
        let mut outline: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i) * 0.004, 0.5]).collect();
        outline.push([2.0, 9.5]);
        let text = data(&[&outline], 2);
        let numbers = text.trim_matches(['m', 'z']).replace('-', " -").replace(" .", " 0.");
        let last_step = numbers.split(' ').next_back().unwrap();
        assert_eq!(last_step, "9", "{text}");
        let ends = data(&[&[outline[0], outline[999], outline[1000]]], 2);
        assert_eq!(ends, "m.5 1 4 0-2 9z");
        assert!(text.starts_with("m.5 1 .01 0"), "{text}");
        assert!(text.ends_with(" 0-2 9z"), "{text}");
    }

    #[test]
    fn what_is_small_keeps_an_area() {
        let speck = [[3.0, 3.0], [3.001, 3.0], [3.0, 3.0003]];
        assert_eq!(data(&[&speck], 2), "m3.5 3.5.001 0-.001.0003z");
        // Smaller than all decimals: a path all the same.
        assert_eq!(data(&[&[[3.0, 3.0], [3.0, 3.0], [3.0, 3.0]]], 2), "m3.5 3.5z");
        // Corners that fall together are one, and what is left of a hole is nothing.
        let square = [[0.0, 0.0], [0.001, 0.0], [4.0, 0.0], [4.0, 4.0], [0.001, 0.001]];
        assert_eq!(data(&[&square, &speck], 2), "m.5.5 4 0 0 4z");
    }

    #[test]
    fn decimals_go_with_the_size() {
        let sizes = [[640, 480], [480, 1], [479, 300], [48, 20], [47, 3], [1, 1]];
        assert_eq!(sizes.map(decimals), [2, 2, 3, 3, 4, 5]);
    }
}
