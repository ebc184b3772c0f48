//! Bézier patches.

use super::{Shared, slopes};
use crate::plain::{Corner, PlainView, UNITS};

/// A bicubic Bézier patch ahead of the eye: rows of control points, in units of 1 / [`UNITS`], below
/// 2¹² in magnitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patch(pub [[Corner; 4]; 4]);

/// The side of a part, in pixels, at which it counts as a point. Too large: the boundary is thicker. Too
/// small: drawing takes longer.
const POINT: f64 = 1.0 / 64.0;

type Net = [[[f64; 3]; 4]; 4];

impl Patch {
    /// Draws the patch by its own routine (Catmull 1974): parts are halved until they count as points. Only
    /// points at a pixel's centre are drawn, so parts without a pixel's centre are left out early.
    pub fn draw(&self, view: &PlainView, number: u32, picture: &mut Shared) {
        let net: Net = self.0.map(|row| row.map(|p| p.map(|c| c as f64 / UNITS)));
        let mut parts = vec![net];
        while let Some(net) = parts.pop() {
            let ([low, high], pixels) = reach(view, &net);
            let [columns, rows] = pixels;
            if columns.is_empty() || rows.is_empty() {
                continue;
            }
            let side = [high[0] - low[0], high[1] - low[1]];
            if side[0].max(side[1]) < POINT {
                let corners = [net[0][0], net[0][3], net[3][0], net[3][3]];
                let depth = corners.iter().map(|p| -p[2]).sum::<f64>() / 4.0;
                let pixels = rows.flat_map(|y| columns.clone().map(move |x| [x, y]));
                pixels.for_each(|pixel| picture.put(pixel, depth, number));
                continue;
            }
            // The direction that is longer on the picture is halved.
            let extent = |a: [f64; 3], b: [f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
            let along = (0..4).map(|i| extent(net[i][0], net[i][3])).fold(0.0, f64::max);
            let across = (0..4).map(|i| extent(net[0][i], net[3][i])).fold(0.0, f64::max);
            parts.extend(if along > across {
                halves(&net)
            } else {
                halves(&transposed(&net)).map(|half| transposed(&half))
            });
        }
    }

    /// Returns two patches that share an edge. The edge runs in opposite directions in the two.
    pub fn pair() -> [Self; 2] {
        let first: [[Corner; 4]; 4] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let [i, j] = [i as i64, j as i64];
                [-700 + 230 * i + 20 * j, -450 + 300 * j, -1500 - 120 * (i * j % 3) + 150 * (j - i)]
            })
        });
        let second = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let [x, y, _] = first[3][3 - j];
                let out = 3 - i as i64;
                if out == 0 { first[3][3 - j] } else { [x + 220 * out, y - 30, -1430 - 90 * out] }
            })
        });
        [Self(first), Self(second)]
    }

    /// The point at two parameters, by Bernstein's polynomials.
    pub(super) fn at(&self, u: f64, v: f64) -> [f64; 3] {
        let weights = |t: f64| {
            let s = 1.0 - t;
            [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
        };
        let (by_row, by_column) = (weights(u), weights(v));
        let mut sum = [0.0; 3];
        for (row, a) in self.0.iter().zip(by_row) {
            for (point, b) in row.iter().zip(by_column) {
                sum.iter_mut().zip(point).for_each(|(sum, &c)| *sum += a * b * c as f64 / UNITS);
            }
        }
        sum
    }
}

/// The box around a part on the picture, in pixels, and the pixels whose centres are in it.
fn reach(view: &PlainView, net: &Net) -> ([[f64; 2]; 2], [std::ops::Range<u32>; 2]) {
    let [first, step] = [slopes(view, [0, 0]), slopes(view, [1, 1])];
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for point in net.iter().flatten() {
        for axis in 0..2 {
            let slope = point[axis] / -point[2];
            let pixel = (slope - first[axis]) / (step[axis] - first[axis]);
            low[axis] = low[axis].min(pixel);
            high[axis] = high[axis].max(pixel);
        }
    }
    let pixels = [0, 1].map(|axis: usize| {
        let end = (high[axis].floor() + 1.0).clamp(0.0, f64::from(view.size()[axis]));
        low[axis].ceil().max(0.0) as u32..end as u32
    });
    ([low, high], pixels)
}

/// Both halves of each row (de Casteljau).
fn halves(net: &Net) -> [Net; 2] {
    let mean = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
    let both = net.map(|[a, b, c, d]| {
        let (ab, bc, cd): ([f64; 3], [f64; 3], [f64; 3]) = (mean(a, b), mean(b, c), mean(c, d));
        let (abc, bcd): ([f64; 3], [f64; 3]) = (mean(ab, bc), mean(bc, cd));
        let middle = mean(abc, bcd);
        ([a, ab, abc, middle], [middle, bcd, cd, d])
    });
    [both.map(|(first, _)| first), both.map(|(_, second)| second)]
}

fn transposed(net: &Net) -> Net {
    std::array::from_fn(|i| std::array::from_fn(|j| net[j][i]))
}
