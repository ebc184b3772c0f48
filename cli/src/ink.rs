//! Lines over pixels, by the share of each pixel's area that they cover.
//!
//! A wide line is a band along each segment and a disc at each joint and round end. A row of pixels is
//! sampled at several levels. On each level, the joint coverage of all bands and discs is exact.

use crate::drawn::{HIDDEN_WIDTH, dashes};
use crate::strokes::Strokes;

/// Levels in a row of pixels. An edge along the row is off by at most half the distance of two levels. Too
/// small: level lines are lighter or darker by a visible amount (one part in 64 now). Too large: time.
const LEVELS: usize = 32;

/// A convex part of a wide line, in pixels from the picture's corner.
#[derive(Clone, Copy, Debug)]
enum Part {
    Band([[f64; 2]; 4]),
    Disc { centre: [f64; 2], radius: f64 },
}

/// Draws lines in black over RGB pixels. Lines of each depth are drawn together, so that lines are no darker
/// where they meet.
pub(crate) fn draw(pixels: &mut [u8], size: [u32; 2], strokes: &[Strokes], width: f64) {
    for alike in strokes.chunk_by(|a, b| a.depth == b.depth) {
        let parts = alike.iter().flat_map(|strokes| {
            let depth = strokes.depth;
            strokes.lines.iter().flat_map(move |line| parts(&line.points, depth, width))
        });
        cover(parts.collect(), size, |at, covered| {
            for channel in &mut pixels[3 * at..3 * at + 3] {
                *channel = (f64::from(*channel) * (1.0 - covered)).round() as u8;
            }
        });
    }
}

/// The parts of a line through points, given in pixels.
fn parts(points: &[[f64; 2]], depth: u32, width: f64) -> Vec<Part> {
    let mut parts = Vec::new();
    if depth == 0 {
        let radius = width / 2.0;
        add_bands(points, radius, &mut parts);
        parts.extend(points.iter().map(|&centre| Part::Disc { centre, radius }));
        return parts;
    }
    let radius = HIDDEN_WIDTH * width / 2.0;
    for dash in dashed(points, dashes(depth, width)) {
        add_bands(&dash, radius, &mut parts);
        let joints = &dash[1..dash.len() - 1];
        parts.extend(joints.iter().map(|&centre| Part::Disc { centre, radius }));
    }
    parts
}

fn add_bands(points: &[[f64; 2]], radius: f64, parts: &mut Vec<Part>) {
    for ends in points.windows(2) {
        let ([ax, ay], [bx, by]) = (ends[0], ends[1]);
        let length = (bx - ax).hypot(by - ay);
        if length > 0.0 {
            let [x, y] = [(ay - by) * radius / length, (bx - ax) * radius / length];
            parts.push(Part::Band([
                [ax + x, ay + y],
                [bx + x, by + y],
                [bx - x, by - y],
                [ax - x, ay - y],
            ]));
        }
    }
}

/// The dashes of a line, given the lengths of a dash and of a gap.
fn dashed(points: &[[f64; 2]], [dash, gap]: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let Some(&first) = points.first() else { return vec![] };
    let mut dashes = vec![vec![first]];
    // The remaining length of the dash or gap that is being drawn.
    let (mut is_dash, mut left) = (true, dash);
    for ends in points.windows(2) {
        let (from, to) = (ends[0], ends[1]);
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let share = done / length;
            let at = [0, 1].map(|i: usize| from[i] + (to[i] - from[i]) * share);
            match (is_dash, dashes.last_mut()) {
                (true, Some(last)) => last.push(at),
                _ => dashes.push(vec![at]),
            }
            is_dash = !is_dash;
            left = if is_dash { dash } else { gap };
        }
        left -= length - done;
        if let (true, Some(last)) = (is_dash, dashes.last_mut()) {
            last.push(to);
        }
    }
    dashes.retain(|dash| dash.len() > 1);
    dashes
}

impl Part {
    /// The lower and the upper end of the part.
    fn rows(&self) -> [f64; 2] {
        match self {
            Self::Disc { centre: [_, y], radius } => [y - radius, y + radius],
            Self::Band(corners) => {
                let rows = corners.map(|corner| corner[1]);
                [
                    rows.into_iter().fold(f64::MAX, f64::min),
                    rows.into_iter().fold(f64::MIN, f64::max),
                ]
            }
        }
    }

    /// The range in which the part covers a level.
    fn span(&self, level: f64) -> Option<[f64; 2]> {
        match *self {
            Self::Disc { centre: [x, y], radius } => {
                let square = radius * radius - (level - y) * (level - y);
                (square > 0.0).then(|| [x - square.sqrt(), x + square.sqrt()])
            }
            Self::Band(corners) => {
                let [mut from, mut to] = [f64::MAX, f64::MIN];
                for (i, [ax, ay]) in corners.into_iter().enumerate() {
                    let [bx, by] = corners[(i + 1) % 4];
                    if (ay <= level) != (by <= level) {
                        let x = ax + (bx - ax) * ((level - ay) / (by - ay));
                        (from, to) = (from.min(x), to.max(x));
                    }
                }
                (from < to).then_some([from, to])
            }
        }
    }
}

/// Calls a function with each pixel that some parts cover, and the joint coverage of all these parts.
fn cover(mut parts: Vec<Part>, [width, height]: [u32; 2], mut see: impl FnMut(usize, f64)) {
    let width = width as usize;
    parts.sort_by(|a, b| a.rows()[0].total_cmp(&b.rows()[0]));
    let mut parts = parts.into_iter().peekable();
    let (mut here, mut spans): (Vec<Part>, Vec<[f64; 2]>) = (vec![], vec![]);
    let mut covered = vec![0.0; width];
    for row in 0..height {
        let top = f64::from(row);
        here.retain(|part| part.rows()[1] > top);
        while let Some(part) = parts.next_if(|part| part.rows()[0] < top + 1.0) {
            here.push(part);
        }
        if here.is_empty() {
            continue;
        }
        for level in 0..LEVELS {
            let level = top + (level as f64 + 0.5) / LEVELS as f64;
            spans.clear();
            spans.extend(here.iter().filter_map(|part| part.span(level)));
            spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let mut done = 0.0;
            for &[from, to] in &spans {
                add([from.max(done), to.min(width as f64)], &mut covered);
                done = to.max(done);
            }
        }
        for (column, covered) in covered.iter_mut().enumerate() {
            if *covered > 0.0 {
                see(row as usize * width + column, (*covered / LEVELS as f64).min(1.0));
                *covered = 0.0;
            }
        }
    }
}

/// Adds a range of a level to the pixels that the range crosses.
fn add([from, to]: [f64; 2], covered: &mut [f64]) {
    let mut at = from;
    while at < to {
        let column = at as usize;
        let next = to.min(column as f64 + 1.0);
        covered[column] += next - at;
        at = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(points: &[[f64; 2]], depth: u32, width: f64, size: [u32; 2]) -> Vec<f64> {
        let mut found = vec![0.0; (size[0] * size[1]) as usize];
        cover(parts(points, depth, width), size, |at, covered| found[at] = covered);
        found
    }

    /// The distance of a point from a line through points.
    fn distance([x, y]: [f64; 2], points: &[[f64; 2]]) -> f64 {
        let distances = points.windows(2).map(|ends| {
            let (a, b) = (ends[0], ends[1]);
            let way = [b[0] - a[0], b[1] - a[1]];
            let along = (x - a[0]) * way[0] + (y - a[1]) * way[1];
            let share = (along / (way[0] * way[0] + way[1] * way[1])).clamp(0.0, 1.0);
            (a[0] + way[0] * share - x).hypot(a[1] + way[1] * share - y)
        });
        distances.fold(f64::MAX, f64::min)
    }

    /// A visible line covers all points within half its width.
    #[test]
    fn coverage_is_the_area_within_half_a_width() {
        let lines: [&[[f64; 2]]; 5] = [
            &[[2.0, 3.0], [9.3, 4.1]],
            &[[1.0, 1.0], [8.0, 1.0], [8.0, 6.5], [1.0, 6.5], [1.0, 1.0]],
            // Sharp turns, short steps, and beyond the picture.
            &[[2.0, 7.0], [9.0, 6.6], [2.0, 6.2], [2.1, 6.1], [2.2, 6.3]],
            &[[-4.5, 4.5], [3.5, -3.5], [20.5, 4.5]],
            &[[5.5, 5.5], [5.5, 5.5000001]],
        ];
        const EACH: i32 = 100;
        for (line, width) in lines.into_iter().flat_map(|line| [(line, 1.0), (line, 2.5)]) {
            let found = covered(line, 0, width, [12, 9]);
            let mut sum = 0.0;
            for (at, &found) in found.iter().enumerate() {
                let corner = [at % 12, at / 12].map(|c| c as f64);
                let inside = (0..EACH * EACH).filter(|k| {
                    let part = |k: i32| (f64::from(k) + 0.5) / f64::from(EACH);
                    let point = [corner[0] + part(k % EACH), corner[1] + part(k / EACH)];
                    distance(point, line) <= width / 2.0
                });
                let expected = inside.count() as f64 / f64::from(EACH * EACH);
                assert!((found - expected).abs() < 0.025, "{line:?} {at}: {found} {expected}");
                sum += found;
            }
            assert!(sum > 0.7, "{line:?}");
        }
    }

    #[test]
    fn dashes_go_on_around_corners() {
        let line = [[0.0, 0.0], [2.0, 0.0], [2.0, 7.0]];
        let expected: [&[[f64; 2]]; 2] =
            [&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]], &[[2.0, 3.0], [2.0, 6.0]]];
        assert_eq!(dashed(&line, [3.0, 2.0]), expected);
        // As long as the dashes, and as wide as hidden lines.
        for depth in 1..=4 {
            let [dash, gap] = dashes(depth, 1.0);
            let area: f64 =
                covered(&[[2.0, 3.3], [2.0 + 5.0 * (dash + gap), 3.3]], depth, 1.0, [90, 9])
                    .iter()
                    .sum();
            assert!((area - 5.0 * dash * HIDDEN_WIDTH).abs() < 0.02 * area, "{depth}: {area}");
        }
    }

    #[test]
    fn lines_of_one_depth_are_no_darker_where_they_meet() {
        use crate::strokes::Strokes;
        use binspace::drawing::polylines;

        let strokes = |class: &'static str, ends: [[f64; 2]; 2]| {
            let lines = polylines([ends]).unwrap();
            Strokes { depth: 0, class, runs: vec![], lines }
        };
        let along = [[1.5, 2.5], [6.5, 2.5]];
        let mut once = vec![200; 3 * 8 * 5];
        let mut twice = once.clone();
        draw(&mut once, [8, 5], &[strokes("border", along)], 1.0);
        draw(&mut twice, [8, 5], &[strokes("border", along), strokes("crease", along)], 1.0);
        assert_eq!(once, twice);
        assert!(once.contains(&0) && once.contains(&200));
    }
}
