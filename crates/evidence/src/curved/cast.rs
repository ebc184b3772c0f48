//! Rays cast at Bézier patches, in integers.

use super::patch::Patch;
use crate::plain::{PlainView, UNITS};

/// The certain result of a ray cast at a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cast {
    /// The ray misses the patch.
    Misses,
    /// The ray meets the patch. The first intersection is between these depths, in world units.
    Meets([f64; 2]),
    /// Undecided: the ray passes too near the boundary, or meets the patch in several places.
    Doubtful,
}

/// Coefficients of a bicubic polynomial.
type Net = [[i128; 4]; 4];

/// The number of times that parameters are halved. Too small: intervals of depth are wide. Too large: numbers
/// become long, 64 bits and 6 more for each level.
const LEVELS: u32 = 8;

impl Cast {
    /// Casts the ray of a pixel. The ray is the intersection of two planes, so it meets the patch where two
    /// functions are both 0. It misses a part of the patch if all coefficients of one function have the same
    /// sign there. It meets a remaining part if, after a linear change of both functions, the first has
    /// opposite signs on two opposite sides of the part, and the second has opposite signs on the other two
    /// sides (Poincaré & Miranda 1940).
    pub fn new(patch: &Patch, view: &PlainView, pixel: [u32; 2]) -> Self {
        let ray = view.ray(pixel);
        let plane = |axis: usize| {
            patch
                .0
                .map(|row| row.map(|p| ray[2] * i128::from(p[axis]) - ray[axis] * i128::from(p[2])))
        };
        let functions: [Net; 2] = [plane(0), plane(1)];
        let Some([low, high]) = cells(&functions) else { return Self::Misses };
        let unit = 1 << LEVELS;
        let wide = (0..2).any(|axis| high[axis] - low[axis] > 3);
        let at_rim = (0..2).any(|axis| low[axis] == 0 || high[axis] == unit);
        if wide || at_rim {
            return Self::Doubtful;
        }
        let [u, v] = [0, 1].map(|axis: usize| [low[axis] - 1, high[axis] + 1]);
        let parts = functions.map(|net| part(&net, u, v, unit));
        if !surely_zero(&parts) {
            return Self::Doubtful;
        }
        let depths = part(&patch.0.map(|row| row.map(|p| -i128::from(p[2]))), u, v, unit);
        let scale = (unit as f64).powi(6) * UNITS;
        let ends = depths
            .iter()
            .flatten()
            .fold([i128::MAX, i128::MIN], |[low, high], &w| [low.min(w), high.max(w)]);
        Self::Meets(ends.map(|w| w as f64 / scale))
    }
}

/// The smallest box of cells in which both functions may be 0, as its two corners; `None` if no cell is left.
fn cells(functions: &[Net; 2]) -> Option<[[i128; 2]; 2]> {
    let mut found: Option<[[i128; 2]; 2]> = None;
    let mut parts = vec![(0, [0i128, 0])];
    while let Some((level, [i, j])) = parts.pop() {
        let one_sign = |net: &Net| {
            let part = part(net, [i, i + 1], [j, j + 1], 1 << level);
            let mut all = part.iter().flatten();
            all.clone().all(|&c| c > 0) || all.all(|&c| c < 0)
        };
        if functions.iter().any(one_sign) {
            continue;
        }
        if level < LEVELS {
            let half = |n: i128| [2 * n, 2 * n + 1];
            parts.extend(half(i).into_iter().flat_map(|i| half(j).map(|j| (level + 1, [i, j]))));
            continue;
        }
        let [low, high] = found.unwrap_or([[i, j], [i + 1, j + 1]]);
        let low = [low[0].min(i), low[1].min(j)];
        found = Some([low, [high[0].max(i + 1), high[1].max(j + 1)]]);
    }
    found
}

/// The coefficients of the part between two values of each parameter, by blossoms. Parameters are in units of
/// 1 / `unit`, and the result is multiplied by unit⁶.
fn part(net: &Net, u: [i128; 2], v: [i128; 2], unit: i128) -> Net {
    let rows = net.map(|row| blossoms(row, v, unit));
    let turned: Net = std::array::from_fn(|i| std::array::from_fn(|j| rows[j][i]));
    let columns = turned.map(|column| blossoms(column, u, unit));
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}

fn blossoms(cubic: [i128; 4], [from, to]: [i128; 2], unit: i128) -> [i128; 4] {
    std::array::from_fn(|n| {
        let mut values = cubic;
        for step in 0..3 {
            let t = if step < n { to } else { from };
            for k in 0..3 - step {
                values[k] = values[k] * (unit - t) + values[k + 1] * t;
            }
        }
        values[0]
    })
}

/// Whether both functions are certainly 0 in some point of a part.
fn surely_zero([f, g]: &[Net; 2]) -> bool {
    // The slopes as shares of the largest slope, in units of 2⁻¹⁶. The proof is valid for any numbers; these
    // numbers succeed most often.
    let slope = |net: &Net| [(net[3][1] - net[0][1]) as f64, (net[1][3] - net[1][0]) as f64];
    let ([fu, fv], [gu, gv]) = (slope(f), slope(g));
    let largest = [fu, fv, gu, gv].into_iter().fold(0.0, |most: f64, s| most.max(s.abs()));
    let [fu, fv, gu, gv] = [fu, fv, gu, gv].map(|s| (s / largest * 65536.0) as i128);
    let mix = |a: i128, b: i128| -> Net {
        std::array::from_fn(|i| std::array::from_fn(|j| a * f[i][j] + b * g[i][j]))
    };
    let opposite = |first: [i128; 4], last: [i128; 4]| {
        let (above, below) = (
            |side: [i128; 4]| side.iter().all(|&c| c > 0),
            |side: [i128; 4]| side.iter().all(|&c| c < 0),
        );
        above(first) && below(last) || below(first) && above(last)
    };
    let (along, across) = (mix(gv, -fv), mix(-gu, fu));
    let column = |j: usize| across.map(|row| row[j]);
    opposite(along[0], along[3]) && opposite(column(0), column(3))
}
