//! Pictures of translucent polygons by exact coverage: each pixel is divided into the parts in which the same polygons
//! are visible, and each part contributes its blended colour by its area.

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use binspace::drawing::{MapCell, VisibilityMap};
use rayon::prelude::*;

use crate::drawn::Style;

/// The number of pixels that one thread blends at once. Too large: more memory, up to some kilobytes each where many
/// polygons meet. Too small: more time, as polygons reach into several parts of a picture.
const AT_ONCE: usize = 1 << 15;

/// A pixel is divided into at most this many parts that let light through; then [`SAMPLES`] points replace the parts. Too
/// large: time where thousands of polygons meet in a pixel. Too small: shares of areas are less exact.
const MOST_PARTS: usize = 64;
/// The number of points along each side of a pixel. Too small: steps of brightness where many polygons meet. Too large:
/// time and memory there.
const SAMPLES: usize = 16;

/// Distances from a side, in pixels, and areas, in square pixels, that count as 0.
const NEAR: f64 = 1e-9;
/// A bound on the error of a cell's corner, in pixels. Too small: a side of almost no length cuts its cell. Too large: a
/// side with a wrong direction stays.
const COARSE: f64 = 1e-5;
/// A side at least this long, in pixels, has the right direction although its ends are rounded. Too small: a wrong side
/// cuts its cell. Too large: time for cells of many corners.
const LONG: f64 = 1e-3;

/// The pixels of a map, row by row, with the colours and opacities of the map's polygons. After each part of the picture,
/// calls a function with the number of rows done so far and of all rows.
///
/// Colours are blended as sRGB numbers, as viewers of vector pictures do, not as amounts of light. Takes O(p · n) time
/// for p pixels and n polygons that lie over one another. Memory is proportional to the pixels that are blended at once,
/// and to the cells, each counted once for each part of the picture that it reaches.
pub(crate) fn picture(
    map: &VisibilityMap<'_>,
    background: [u8; 3],
    style: &Style<'_>,
    report: &(impl Fn(usize, usize) + Sync),
) -> Vec<u8> {
    let mut looks: HashMap<usize, Look> = HashMap::new();
    for cell in map.cells() {
        let polygon = cell.polygon();
        looks.entry(polygon).or_insert_with(|| Look {
            rgb: style.fill(polygon).map(f64::from),
            opacity: f64::from(style.opacity(polygon)),
        });
    }
    let [width, height] = map.size().map(|side| side as usize);
    let rows = (AT_ONCE / width).clamp(1, height);
    let tops: Vec<usize> = (0..height).step_by(rows).collect();
    // The cells of each band. Of cells that overlap, the nearer comes first.
    let mut cells: Vec<Vec<MapCell<'_>>> = vec![vec![]; tops.len()];
    for cell in map.cells() {
        let y = cell.corners().map(|corner| corner[1]);
        let first = y.clone().fold(f64::INFINITY, f64::min).max(0.0) as usize / rows;
        let last = y.fold(0.0, f64::max) as usize / rows;
        let last = last.min(tops.len() - 1);
        cells[first.min(last)..=last].iter_mut().for_each(|cells| cells.push(cell));
    }
    let done = AtomicUsize::new(0);
    let band = |(&top, cells): (&usize, &Vec<MapCell<'_>>)| {
        let rows = rows.min(height - top);
        let mut band = Band::new(width, top, rows);
        let mut outline = Outline::default();
        for cell in cells {
            outline.fill(cell.corners());
            band.add(&outline, looks[&cell.polygon()]);
        }
        report(done.fetch_add(rows, Ordering::Relaxed) + rows, height);
        band.pixels(background.map(f64::from))
    };
    tops.par_iter().zip(&cells).flat_map_iter(band).collect()
}

#[derive(Clone, Copy)]
struct Look {
    rgb: [f64; 3],
    opacity: f64,
}

/// The light of some polygons, and the share that they let through from behind.
#[derive(Clone, Copy, Debug)]
struct Light {
    rgb: [f64; 3],
    left: f64,
}

impl Light {
    const NONE: Self = Self { rgb: [0.0; 3], left: 1.0 };

    /// The light with one more polygon behind.
    fn behind(self, Look { rgb, opacity }: Look) -> Self {
        let rgb = std::array::from_fn(|i| self.rgb[i] + self.left * opacity * rgb[i]);
        Self { rgb, left: self.left * (1.0 - opacity) }
    }
}

/// A convex cell.
#[derive(Default)]
struct Outline {
    corners: Vec<[f64; 2]>,
    sides: Vec<Side>,
}

impl Outline {
    fn fill(&mut self, corners: impl Iterator<Item = [f64; 2]>) {
        let Self { corners: all, sides } = self;
        all.clear();
        all.extend(corners);
        let turn = area(all).signum();
        let next = all.iter().cycle().skip(1);
        sides.clear();
        sides.extend(all.iter().zip(next).map(|(&from, &to)| Side::new(from, to, turn)));
        // Corners are rounded, so a side of almost no length may have any direction. Its neighbours bound the cell.
        let is_right = |side: &Side| all.iter().all(|&corner| side.distance(corner) >= -COARSE);
        sides.retain(|side| side.length >= LONG || is_right(side));
    }
}

/// A line through a side of a cell.
#[derive(Clone, Copy)]
struct Side {
    /// A point, and the unit vector into the cell.
    from: [f64; 2],
    inwards: [f64; 2],
    length: f64,
    /// The range of y that the side reaches, and a little more.
    reach: [f64; 2],
}

impl Side {
    fn new(from: [f64; 2], to: [f64; 2], turn: f64) -> Self {
        let [x, y] = [0, 1].map(|i| (to[i] - from[i]) * turn);
        let length = x.hypot(y);
        let reach = [from[1].min(to[1]) - LONG, from[1].max(to[1]) + LONG];
        Self { from, inwards: [-y / length, x / length], length, reach }
    }

    /// The distance of a point from the line, positive on the cell's side.
    fn distance(&self, p: [f64; 2]) -> f64 {
        (p[0] - self.from[0]) * self.inwards[0] + (p[1] - self.from[1]) * self.inwards[1]
    }
}

/// A convex part of a pixel in which the same cells are visible everywhere.
struct Part {
    outline: Vec<[f64; 2]>,
    light: Light,
}

/// The contents of a pixel.
enum Pixel {
    /// The same cells are visible everywhere.
    Whole(Light),
    Divided(Box<Divided>),
    /// The light at each of several points.
    Sampled(Vec<Light>),
}

/// The parts of a pixel that let light through, and the rest: its area, and its colour times the area.
#[derive(Default)]
struct Divided {
    parts: Vec<Part>,
    opaque: f64,
    rgb: [f64; 3],
}

/// Some rows of a picture.
struct Band {
    width: usize,
    top: usize,
    pixels: Vec<Pixel>,
}

impl Band {
    fn new(width: usize, top: usize, rows: usize) -> Self {
        let pixels = (0..width * rows).map(|_| Pixel::Whole(Light::NONE)).collect();
        Self { width, top, pixels }
    }

    /// Adds a convex cell behind all cells that were added before.
    fn add(&mut self, outline: &Outline, look: Look) {
        let corners = &*outline.corners;
        let height = self.pixels.len() / self.width;
        let y = corners.iter().map(|p| p[1] - self.top as f64);
        let low = y.clone().fold(f64::INFINITY, f64::min).floor().clamp(0.0, height as f64);
        let high = y.fold(f64::NEG_INFINITY, f64::max).ceil().clamp(0.0, height as f64);
        let mut sides = Vec::new();
        for row in low as usize..high as usize {
            let y = (self.top + row) as f64;
            // Within a row, only the sides that reach into it bound a convex cell.
            sides.clear();
            let reaches = |side: &&Side| side.reach[0] <= y + 1.0 && y <= side.reach[1];
            sides.extend(outline.sides.iter().filter(reaches));
            let Some([touched, covered]) = spans(corners, y) else { continue };
            let columns = touched.map(|x| x.clamp(0.0, self.width as f64));
            for column in columns[0].floor() as usize..columns[1].ceil() as usize {
                let x = column as f64;
                let pixel = &mut self.pixels[row * self.width + column];
                if covered[0] <= x && x + 1.0 <= covered[1] {
                    pixel.cover(look);
                } else {
                    pixel.add([x, y], &sides, look);
                }
            }
        }
    }

    fn pixels(self, background: [f64; 3]) -> impl Iterator<Item = u8> {
        self.pixels.into_iter().flat_map(move |pixel| {
            let Light { rgb, left } = pixel.light();
            std::array::from_fn::<u8, 3, _>(|i| (rgb[i] + left * background[i]).round() as u8)
        })
    }
}

/// The range of x in which a convex outline has points between y and y + 1, and the range in which it has all of them.
fn spans(corners: &[[f64; 2]], y: f64) -> Option<[[f64; 2]; 2]> {
    const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];
    let include = |range: &mut [f64; 2], x: f64| *range = [range[0].min(x), range[1].max(x)];
    let (mut touched, mut crossed) = (NOTHING, [NOTHING; 2]);
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        if (y..=y + 1.0).contains(&from[1]) {
            include(&mut touched, from[0]);
        }
        for (line, crossed) in [y, y + 1.0].into_iter().zip(&mut crossed) {
            if from[1].min(to[1]) <= line && line <= from[1].max(to[1]) {
                let share =
                    if from[1] == to[1] { 0.0 } else { (line - from[1]) / (to[1] - from[1]) };
                include(crossed, from[0] + share * (to[0] - from[0]));
                if from[1] == to[1] {
                    include(crossed, to[0]);
                }
            }
        }
    }
    for [low, high] in crossed {
        if low <= high {
            touched = [touched[0].min(low), touched[1].max(high)];
        }
    }
    let [a, b] = crossed;
    (touched[0] < touched[1]).then_some([touched, [a[0].max(b[0]), a[1].min(b[1])]])
}

impl Pixel {
    /// Adds a cell that covers the whole pixel.
    fn cover(&mut self, look: Look) {
        match self {
            Self::Whole(light) => *light = light.behind(look),
            Self::Divided(divided) => {
                let mut parts = std::mem::take(&mut divided.parts);
                parts.iter_mut().for_each(|part| part.light = part.light.behind(look));
                parts.into_iter().for_each(|part| divided.push(part));
            }
            Self::Sampled(lights) => {
                lights.iter_mut().for_each(|light| *light = light.behind(look))
            }
        }
    }

    /// Adds a cell to the pixel with a corner at a position.
    fn add(&mut self, at: [f64; 2], sides: &[Side], look: Look) {
        match self {
            Self::Whole(Light { left: 0.0, .. }) => {}
            Self::Whole(light) => {
                let [x, y] = at;
                let outline = vec![[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
                let mut divided = Divided::default();
                divided.push(Part { outline, light: *light });
                divided.add(sides, look);
                *self = Self::Divided(Box::new(divided));
            }
            Self::Divided(divided) => {
                divided.add(sides, look);
                if divided.parts.len() > MOST_PARTS {
                    *self = Self::Sampled(divided.sampled(at));
                }
            }
            Self::Sampled(lights) => {
                for (light, point) in lights.iter_mut().zip(samples(at)) {
                    if light.left > 0.0 && sides.iter().all(|side| side.distance(point) > 0.0) {
                        *light = light.behind(look);
                    }
                }
            }
        }
    }

    /// The mean light.
    fn light(&self) -> Light {
        let mut sum = Light { rgb: [0.0; 3], left: 0.0 };
        let mut add = |share: f64, light: &Light| {
            (0..3).for_each(|i| sum.rgb[i] += share * light.rgb[i]);
            sum.left += share * light.left;
        };
        match self {
            Self::Whole(light) => return *light,
            Self::Divided(divided) => {
                // Areas too small to count are missing.
                let areas = divided.parts.iter().map(|part| area(&part.outline));
                let all = divided.opaque + areas.clone().sum::<f64>();
                divided
                    .parts
                    .iter()
                    .zip(areas)
                    .for_each(|(part, area)| add(area / all, &part.light));
                add(1.0 / all, &Light { rgb: divided.rgb, left: 0.0 });
            }
            Self::Sampled(lights) => {
                lights.iter().for_each(|light| add(1.0 / lights.len() as f64, light));
            }
        }
        sum
    }
}

impl Divided {
    fn push(&mut self, part: Part) {
        if part.light.left > 0.0 {
            self.parts.push(part);
        } else {
            let area = area(&part.outline);
            self.opaque += area;
            (0..3).for_each(|i| self.rgb[i] += area * part.light.rgb[i]);
        }
    }

    fn add(&mut self, sides: &[Side], look: Look) {
        for part in std::mem::take(&mut self.parts) {
            part.divide(sides, look, |part| self.push(part));
        }
    }

    /// The light at points of the pixel with a corner at a position. Points in no part have the mean light of the rest.
    fn sampled(&self, at: [f64; 2]) -> Vec<Light> {
        let opaque = self.opaque.max(f64::MIN_POSITIVE);
        let rest = Light { rgb: self.rgb.map(|channel| channel / opaque), left: 0.0 };
        let outlines: Vec<Outline> = self
            .parts
            .iter()
            .map(|part| {
                let mut outline = Outline::default();
                outline.fill(part.outline.iter().copied());
                outline
            })
            .collect();
        let light = |point| {
            let is_inside =
                |outline: &&Outline| outline.sides.iter().all(|side| side.distance(point) >= 0.0);
            let found = outlines.iter().position(|outline| is_inside(&outline));
            found.map_or(rest, |part| self.parts[part].light)
        };
        samples(at).map(light).collect()
    }
}

/// Points in the pixel with a corner at a position, off the lines through simple fractions of a pixel.
fn samples([x, y]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let place = |k: usize| (k as f64 + 0.4937) / SAMPLES as f64;
    (0..SAMPLES * SAMPLES).map(move |k| {
        let [row, column] = [k / SAMPLES, k % SAMPLES];
        // Each row is moved a little against the row above.
        [x + (place(column) + 0.0317 * row as f64 / SAMPLES as f64) % 1.0, y + place(row)]
    })
}

impl Part {
    /// Divides the part by a convex cell, which is behind. The part in the cell is last.
    fn divide(self, sides: &[Side], look: Look, mut add: impl FnMut(Self)) {
        let Self { mut outline, light } = self;
        // Most parts are outside one side.
        if sides.iter().any(|side| outline.iter().all(|&p| side.distance(p) <= NEAR)) {
            add(Self { outline, light });
            return;
        }
        for side in sides {
            if outline.iter().all(|&p| side.distance(p) >= -NEAR) {
                continue;
            }
            let outside = half(&outline, |p| -side.distance(p));
            if area(&outside).abs() > NEAR {
                add(Self { outline: outside, light });
            }
            outline = half(&outline, |p| side.distance(p));
        }
        if area(&outline).abs() > NEAR {
            add(Self { outline, light: light.behind(look) });
        }
    }
}

/// The part of a convex outline on the positive side of a line.
fn half(outline: &[[f64; 2]], distance: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::with_capacity(outline.len() + 1);
    for (from, to) in outline.iter().zip(outline.iter().cycle().skip(1)) {
        let (before, after) = (distance(*from), distance(*to));
        if before >= 0.0 {
            kept.push(*from);
        }
        if (before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0) {
            let share = before / (before - after);
            kept.push([0, 1].map(|i| from[i] + share * (to[i] - from[i])));
        }
    }
    kept
}

/// The area of an outline: positive if it turns from the x axis towards the y axis.
fn area(outline: &[[f64; 2]]) -> f64 {
    let Some(origin) = outline.first() else { return 0.0 };
    let arm = |p: &[f64; 2]| [p[0] - origin[0], p[1] - origin[1]];
    let halves = outline.windows(2).map(|ends| {
        let ([ax, ay], [bx, by]) = (arm(&ends[0]), arm(&ends[1]));
        0.5 * (ax * by - ay * bx)
    });
    halves.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: Look = Look { rgb: [200.0, 0.0, 0.0], opacity: 0.5 };
    const BLUE: Look = Look { rgb: [0.0, 0.0, 100.0], opacity: 1.0 };

    fn blended(width: usize, rows: usize, cells: &[(Vec<[f64; 2]>, Look)]) -> Vec<Light> {
        let mut band = Band::new(width, 0, rows);
        let mut outline = Outline::default();
        for (corners, look) in cells {
            outline.fill(corners.iter().copied());
            band.add(&outline, *look);
        }
        band.pixels.iter().map(Pixel::light).collect()
    }

    fn assert_light(light: Light, rgb: [f64; 3], left: f64) {
        let off =
            (0..3).map(|i| (light.rgb[i] - rgb[i]).abs()).fold((light.left - left).abs(), f64::max);
        assert!(off < 1e-6, "{light:?}, not {rgb:?} and {left}");
    }

    #[test]
    fn cells_side_by_side_have_no_seam() {
        let fan = |k: u32| {
            let at = |k: u32| {
                let (sin, cos) = (f64::from(k) / 9.0 * std::f64::consts::TAU).sin_cos();
                [1.3 + 9.0 * cos, 1.6 + 9.0 * sin]
            };
            (vec![[1.3, 1.6], at(k), at(k + 1)], RED)
        };
        let fan: Vec<_> = (0..9).map(fan).collect();
        let under = (vec![[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]], BLUE);
        for light in blended(3, 3, &fan) {
            assert_light(light, [100.0, 0.0, 0.0], 0.5);
        }
        for light in blended(3, 3, &[&fan[..], &[under]].concat()) {
            assert_light(light, [100.0, 0.0, 50.0], 0.0);
        }
    }

    #[test]
    fn each_part_of_a_pixel_is_blended_by_its_area() {
        // The left half in front, the lower half behind.
        let left = (vec![[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]], RED);
        let low = (vec![[0.0, 0.5], [1.0, 0.5], [1.0, 1.0], [0.0, 1.0]], BLUE);
        let both = blended(1, 1, &[left.clone(), low.clone()]);
        assert_light(both[0], [50.0, 0.0, 37.5], 0.375);
        // In the other order, the front hides a half of the other.
        let both = blended(1, 1, &[low, left]);
        assert_light(both[0], [25.0, 0.0, 50.0], 0.375);
    }

    /// A side of almost no length, with a direction that rounding made.
    #[test]
    fn a_side_of_almost_no_length_does_not_cut_the_cell() {
        let cell = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 1.5], [4.0 - 1e-12, 1.5 - 1e-12], [0.0, 1.5]];
        let lights = blended(5, 2, &[(cell, BLUE)]);
        for (i, light) in lights.into_iter().enumerate() {
            let left = if i % 5 == 4 { 1.0 } else { [0.0, 0.5][i / 5] };
            assert_light(light, [0.0, 0.0, 100.0 * (1.0 - left)], left);
        }
    }

    /// Cells of an opaque surface in one pixel, many of them or few, in any order.
    #[test]
    fn nothing_shows_through_an_opaque_surface_of_many_cells() {
        for n in [3, 15, 20, 40] {
            let at = |k: usize| k as f64 / n as f64;
            let mut cells: Vec<_> = (0..n * n)
                .map(|k| {
                    let (x, y) = (k % n, k / n);
                    let corners =
                        [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]].map(|p| p.map(at));
                    (corners.to_vec(), BLUE)
                })
                .collect();
            for step in [1, 7, 11] {
                let sorted: Vec<_> =
                    (0..n * n).map(|k| cells[k * step % (n * n)].clone()).collect();
                assert_light(blended(1, 1, &sorted)[0], [0.0, 0.0, 100.0], 0.0);
                // Half of the light of a pane in front.
                let pane = (vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], RED);
                let all = [&[pane], &sorted[..]].concat();
                assert_light(blended(1, 1, &all)[0], [100.0, 0.0, 50.0], 0.0);
            }
            cells.truncate(n * n / 2);
            let Light { rgb, left } = blended(1, 1, &cells)[0];
            assert!((left - 0.5).abs() < 0.2 && (rgb[2] - 100.0 * (1.0 - left)).abs() < 1e-6);
        }
    }

    /// Panes of a fan that meet in a pixel: more than the pixel has parts.
    #[test]
    fn many_translucent_cells_that_meet_in_a_pixel_have_no_seam() {
        for count in [50, 2000] {
            let wedge = |k: u32| {
                let at = |k: u32| {
                    let (sin, cos) =
                        (f64::from(k) / f64::from(count) * std::f64::consts::TAU).sin_cos();
                    [0.4 + 3.0 * cos, 0.6 + 3.0 * sin]
                };
                (vec![[0.4, 0.6], at(k), at(k + 1)], RED)
            };
            let lights = blended(1, 1, &(0..count).map(wedge).collect::<Vec<_>>());
            assert_light(lights[0], [100.0, 0.0, 0.0], 0.5);
        }
    }
}
