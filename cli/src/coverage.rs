//! Pictures of pixels by exact coverage: each visible polygon contributes its colour by its share of the
//! pixel's area. (Translucent polygons: see [`blended`](crate::blended).)
//!
//! Coverage comes from the sides of cells. In the pixels that a side crosses, it adds the area
//! between the side and the right end of the row of pixels. The area counts as positive or negative,
//! depending on whether the side goes up or down. (The sum along a row is then the cell's coverage, as in
//! font rasterizers.) Time is proportional to the number of pixels of the cells.

use std::collections::HashMap;
use std::ops::Range;

use binspace::drawing::VisibilityMap;

/// The number of pixels that are summed up at once. Too large: more memory, 32 bytes each. Too small: more
/// time, as all cells are visited for each part of a picture.
const AT_ONCE: usize = 1 << 21;

/// The pixels of a map, row by row, with the colours of the map's polygons.
///
/// Colours are blended as sRGB numbers, as viewers of vector pictures do, not as amounts of light.
pub(crate) fn picture(
    map: &VisibilityMap<'_>,
    background: [u8; 3],
    rgb: impl Fn(usize) -> [u8; 3],
) -> Vec<u8> {
    let mut colours: HashMap<usize, [f64; 3]> = HashMap::new();
    for cell in map.cells() {
        let polygon = cell.polygon();
        colours.entry(polygon).or_insert_with(|| rgb(polygon).map(f64::from));
    }
    let [width, height] = map.size().map(|side| side as usize);
    let rows = (AT_ONCE / width).clamp(1, height);
    let mut pixels = Vec::with_capacity(3 * width * height);
    for top in (0..height).step_by(rows) {
        let mut band = Band::new(background, width, top, rows.min(height - top));
        for cell in map.cells() {
            band.add(cell.corners(), colours[&cell.polygon()]);
        }
        pixels.extend(band.pixels());
    }
    pixels
}

/// The pixels of an empty picture.
pub(crate) fn blank(size: [u32; 2], background: [u8; 3]) -> Vec<u8> {
    background.repeat(size.map(|side| side as usize).iter().product())
}

/// Some rows of a picture.
struct Band {
    background: [f64; 3],
    width: usize,
    top: usize,
    /// The coverage of a pixel minus the previous pixel's coverage, for the cell that is being added.
    change: Vec<f64>,
    /// The first and last change of each row.
    changed: Vec<[usize; 2]>,
    /// The difference of each pixel from the background.
    sums: Vec<[f64; 3]>,
}

const UNCHANGED: [usize; 2] = [usize::MAX, 0];

impl Band {
    fn new(background: [u8; 3], width: usize, top: usize, rows: usize) -> Self {
        let change = vec![0.0; (width + 2) * rows];
        Self {
            background: background.map(f64::from),
            width,
            top,
            change,
            changed: vec![UNCHANGED; rows],
            sums: vec![[0.0; 3]; width * rows],
        }
    }

    /// Adds a cell with corners in a clockwise order, y down, in pixels from the picture's corner.
    fn add(&mut self, corners: impl Iterator<Item = [f64; 2]> + Clone, rgb: [f64; 3]) {
        let next = corners.clone().cycle().skip(1);
        let (mut first, mut last) = (self.changed.len(), 0);
        for (from, to) in corners.zip(next) {
            let rows = self.add_side(from, to);
            (first, last) = (first.min(rows.start), last.max(rows.end));
        }
        let difference: [f64; 3] = std::array::from_fn(|i| rgb[i] - self.background[i]);
        for row in first..last {
            let [left, right] = std::mem::replace(&mut self.changed[row], UNCHANGED);
            let mut covered = 0.0;
            for column in left..right {
                covered += std::mem::take(&mut self.change[row * (self.width + 2) + column]);
                if column < self.width {
                    let sum = &mut self.sums[row * self.width + column];
                    (0..3).for_each(|i| sum[i] += covered * difference[i]);
                }
            }
        }
    }

    /// Adds the changes that a side makes, and returns the rows that it crosses. Where the side goes up, the
    /// cell is on the right.
    fn add_side(&mut self, from: [f64; 2], to: [f64; 2]) -> Range<usize> {
        let (low, high, sign) = if from[1] < to[1] { (from, to, -1.0) } else { (to, from, 1.0) };
        let [low_y, high_y] = [low, high].map(|end| end[1] - self.top as f64);
        let end = high_y.ceil().clamp(0.0, self.changed.len() as f64) as usize;
        let rows = low_y.floor().clamp(0.0, end as f64) as usize..end;
        let slope = (high[0] - low[0]) / (high_y - low_y);
        for row in rows.clone() {
            let [y0, y1] = [low_y.max(row as f64), high_y.min(row as f64 + 1.0)];
            if y0 < y1 {
                let x = [y0, y1].map(|y| {
                    let x = low[0] + (y - low_y) * slope;
                    x.clamp(low[0].min(high[0]), low[0].max(high[0])).clamp(0.0, self.width as f64)
                });
                self.add_part(row, x, sign * (y1 - y0));
            }
        }
        rows
    }

    /// Adds the changes of a part of a side in one row, with a height.
    fn add_part(&mut self, row: usize, [a, b]: [f64; 2], height: f64) {
        let (left, right) = (a.min(b), a.max(b));
        let columns = left as usize..right as usize + 1;
        let [start, end] = &mut self.changed[row];
        (*start, *end) = ((*start).min(columns.start), (*end).max(columns.end + 1));
        let change = &mut self.change[row * (self.width + 2)..];
        for column in columns {
            let (from, to) = (left.max(column as f64), right.min(column as f64 + 1.0));
            let share = if left < right { (to - from) / (right - left) } else { 1.0 };
            // The mean distance of the part into the pixel.
            let place = 0.5 * (from + to) - column as f64;
            change[column] += share * height * (1.0 - place);
            change[column + 1] += share * height * place;
        }
    }

    fn pixels(&self) -> impl Iterator<Item = u8> {
        let pixel = |sum: &[f64; 3]| {
            std::array::from_fn::<u8, 3, _>(|i| (self.background[i] + sum[i]).round() as u8)
        };
        self.sums.iter().flat_map(pixel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The area of a convex outline in a pixel, by clipping the outline to the pixel's sides one after
    /// another.
    fn clipped(outline: &[[f64; 2]], column: usize, row: usize) -> f64 {
        let mut points = outline.to_vec();
        for (axis, at, sign) in [
            (0, column as f64, 1.0),
            (0, column as f64 + 1.0, -1.0),
            (1, row as f64, 1.0),
            (1, row as f64 + 1.0, -1.0),
        ] {
            let inside = |p: [f64; 2]| sign * (p[axis] - at);
            let mut kept = Vec::new();
            for (i, &to) in points.iter().enumerate() {
                let from = points[(i + points.len() - 1) % points.len()];
                let (before, after) = (inside(from), inside(to));
                if (before < 0.0) != (after < 0.0) {
                    let share = before / (before - after);
                    kept.push([0, 1].map(|k| from[k] + (to[k] - from[k]) * share));
                }
                if after >= 0.0 {
                    kept.push(to);
                }
            }
            points = kept;
        }
        let n = points.len();
        let cross = |i: usize| {
            let ([ax, ay], [bx, by]) = (points[i], points[(i + 1) % n]);
            ax * by - ay * bx
        };
        0.5 * (0..n).map(cross).sum::<f64>()
    }

    #[test]
    fn coverage_is_the_area_in_each_pixel() {
        let outlines: [&[[f64; 2]]; 6] = [
            &[[1.25, 0.5], [6.5, 2.25], [3.0, 4.75]],
            // On pixels' sides, and the whole picture.
            &[[2.0, 1.0], [4.0, 1.0], [4.0, 3.0], [2.0, 3.0]],
            &[[0.0, 0.0], [8.0, 0.0], [8.0, 5.0], [0.0, 5.0]],
            // In one pixel, along a row, and long and thin.
            &[[2.2, 2.1], [2.6, 2.3], [2.3, 2.9]],
            &[[0.1, 3.25], [7.9, 3.5], [7.9, 3.75]],
            &[[0.0, 0.0], [0.1, 0.0], [8.0, 5.0], [7.9, 5.0]],
        ];
        let (white, black) = ([255; 3], [0.0; 3]);
        for outline in outlines {
            // In two bands.
            for (top, rows) in [(0, 3), (3, 2)] {
                let mut band = Band::new(white, 8, top, rows);
                band.add(outline.iter().copied(), black);
                for (i, sum) in band.sums.iter().enumerate() {
                    let area = clipped(outline, i % 8, top + i / 8);
                    assert!(
                        (sum[0] + 255.0 * area).abs() < 1e-9,
                        "{outline:?} {i}: {sum:?} {area}"
                    );
                }
                assert!(band.change.iter().all(|&change| change == 0.0));
            }
        }
    }
}
