//! Surfaces of connected squares, seen from above: which square is visible where is known in integers. Each case
//! has something that prevents the map from showing the connected squares without subtraction.

use super::map_with;
use super::scenes::cameras;
use super::sheets::{Corners, from_above, tree_of};
use testkit::fill::{Score, check_with_rays};
use testkit::prelude::*;

/// A rectangle over whole squares of a grid of 8 by 8. Its height is `slope`·x + `height`.
#[derive(Clone, Copy, Debug)]
struct Patch {
    low: [i64; 2],
    high: [i64; 2],
    slope: i64,
    height: i64,
    opacity: f64,
}

impl Patch {
    fn level([x, y]: [i64; 2], height: i64) -> Self {
        Self { low: [x, y], high: [x + 1, y + 1], slope: 0, height, opacity: 1.0 }
    }

    fn corners(&self) -> Corners {
        let Self { low: [x0, y0], high: [x1, y1], .. } = *self;
        let corner = |[x, y]: [i64; 2]| [x as f64, y as f64, (self.slope * x + self.height) as f64];
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(corner).to_vec()
    }

    /// Twice the height over the middle of a square, if the patch covers the square.
    fn over(&self, square: [i64; 2]) -> Option<i64> {
        let is_in = |axis: usize| self.low[axis] <= square[axis] && square[axis] < self.high[axis];
        (is_in(0) && is_in(1)).then_some(self.slope * (2 * square[0] + 1) + 2 * self.height)
    }
}

/// Level squares over the given squares of the grid.
fn floor(height: i64, has: impl Fn([i64; 2]) -> bool) -> Vec<Patch> {
    let squares = (0..64).map(|i| [i % 8, i / 8]).filter(|&square| has(square));
    squares.map(|square| Patch::level(square, height)).collect()
}

/// Compares the visible areas of patches with sums over squares. `upright` polygons are seen edge-on.
fn check(name: &str, patches: &[Patch], upright: &[Corners]) {
    let polygons: Vec<Corners> =
        patches.iter().map(Patch::corners).chain(upright.iter().cloned()).collect();
    // Whole squares, parts of squares, and squares beyond the surface.
    for (height, scale) in [(4, 40), (2, 50), (6, 30), (10, 20)] {
        for turn in 0..2 {
            let mut order: Vec<usize> = (0..polygons.len()).collect();
            if turn == 1 {
                order.reverse();
            }
            let turned: Vec<Corners> = order.iter().map(|&i| polygons[i].clone()).collect();
            let tree = tree_of(&turned);
            let side = (height * scale) as u32;
            let camera = from_above(height as f64, [side, side]);
            let opacity = |i: usize| patches.get(order[i]).map_or(1.0, |patch| patch.opacity);
            let map = map_with(&tree, &camera, opacity);
            let mut expected = vec![0; polygons.len()];
            // Squares in the picture, whose borders are between squares.
            let shown = |c: i64| (c - 4) * 2 >= -height && (c - 3) * 2 <= height;
            for square in (0..64).map(|i| [i % 8, i / 8]).filter(|s| s.iter().all(|&c| shown(c))) {
                let over = |i: &usize| patches.get(*i)?.over(square).map(|height| (height, *i));
                let mut stack: Vec<(i64, usize)> = order.iter().filter_map(over).collect();
                stack.sort_by_key(|&(height, _)| -height);
                for (_, i) in stack {
                    expected[i] += scale * scale;
                    if patches[i].opacity == 1.0 {
                        break;
                    }
                }
            }
            let mut found = vec![0.0; polygons.len()];
            map.polygons().for_each(|shown| found[order[shown.polygon]] = shown.area);
            for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
                let off = (found - *expected as f64).abs();
                assert!(off < 1e-6, "{name}, {height}, {i}: {found}, not {expected}");
            }
        }
    }
}

#[test]
fn a_floor_is_visible_as_a_whole() {
    check("floor", &floor(0, |_| true), &[]);
    let mut both = floor(0, |_| true);
    both.extend(floor(-1, |_| true));
    check("a floor below", &both, &[]);
}

#[test]
fn a_floor_with_a_long_side_beside_two_short_ones() {
    let mut patches = floor(0, |square| square != [3, 3] && square != [3, 4]);
    patches.push(Patch { high: [4, 5], ..Patch::level([3, 3], 0) });
    check("a long side", &patches, &[]);
    patches.extend(floor(-2, |_| true));
    check("a long side above a floor", &patches, &[]);
}

#[test]
fn a_floor_with_a_hole() {
    let mut patches = floor(0, |square| square != [4, 3]);
    check("a hole", &patches, &[]);
    patches.extend(floor(-3, |_| true));
    check("a floor below a hole", &patches, &[]);
}

/// A ramp rises from a line between squares of the floor, over one square or over two.
#[test]
fn a_ramp_that_leans_on_shared_edges() {
    for (length, slope) in [1, 2].into_iter().flat_map(|length| [(length, 1), (length, -1)]) {
        let mut patches = floor(0, |_| true);
        let [x, edge] = if slope > 0 { [4, 4] } else { [2, 4] };
        let low = [x, 3];
        let height = -slope * edge;
        patches.push(Patch { high: [x + 2, 3 + length], slope, height, ..Patch::level(low, 0) });
        check("a ramp", &patches, &[]);
    }
}

/// Below a floor, a trough has both its upper edges in common with the floor. In every second row, the trough
/// comes first.
#[test]
fn edges_that_three_faces_share() {
    let mut patches = floor(0, |square| square[0] < 1 || square[0] >= 3);
    for y in 0..8 {
        let patch = |x: i64, size: i64, slope: i64, height: i64| {
            let [low, high] = [[x, y], [x + size, y + 1]];
            Patch { low, high, slope, height, opacity: 1.0 }
        };
        let trough = [patch(1, 1, -1, 1), patch(2, 1, 1, -3)];
        let cover = patch(1, 2, 0, 0);
        match y % 2 {
            0 => patches.extend([trough[0], trough[1], cover]),
            _ => patches.extend([cover, trough[0], trough[1]]),
        }
    }
    check("a trough", &patches, &[]);
}

/// A slope goes through a floor, along edges of the slope. The floor hides the lower half of the slope.
#[test]
fn a_slope_through_a_floor_that_hides_its_lower_half() {
    let mut patches = vec![Patch { high: [8, 8], ..Patch::level([0, 0], 0) }];
    for (y, [from, to]) in (0..8).flat_map(|y| [(y, [3, 8]), (y, [0, 3])]) {
        let [low, high] = [[from, y], [to, y + 1]];
        patches.push(Patch { low, high, slope: 1, height: -3, opacity: 1.0 });
    }
    check("a slope", &patches, &[]);
}

#[test]
fn a_floor_that_is_folded_back_over_itself() {
    let mut patches = floor(0, |square| square[0] < 5);
    let roof = |y: i64| Patch { low: [2, y], high: [5, y + 1], slope: -1, height: 5, opacity: 1.0 };
    patches.extend((0..8).map(roof));
    check("a fold", &patches, &[]);
}

#[test]
fn steps_whose_upright_sides_are_seen_edge_on() {
    let mut patches = floor(0, |square| square[0] < 4);
    patches.extend(floor(1, |square| square[0] >= 4));
    let side =
        |y: f64| vec![[4.0, y, 0.0], [4.0, y + 1.0, 0.0], [4.0, y + 1.0, 1.0], [4.0, y, 1.0]];
    let sides: Vec<Corners> = (0..8).map(|y| side(f64::from(y))).collect();
    check("a step", &patches, &sides);
    patches.extend(floor(0, |square| square[0] >= 4));
    check("a step over a floor", &patches, &sides);
}

#[test]
fn squares_that_are_translucent() {
    let mut patches = floor(0, |_| true);
    for i in [0, 20, 27, 36, 44] {
        patches[i].opacity = 0.5;
    }
    patches.extend(floor(-1, |_| true));
    check("glass in a floor", &patches, &[]);
    patches.push(Patch { low: [1, 1], high: [6, 5], opacity: 0.25, ..Patch::level([1, 1], 2) });
    check("glass over a floor", &patches, &[]);
    patches.push(Patch { high: [8, 8], opacity: 0.25, ..Patch::level([0, 0], 3) });
    check("glass over everything", &patches, &[]);
}

/// Surfaces of bent quads, whose corners are moved a little or far, seen from around and from inside.
#[test]
fn surfaces_of_bent_quads() {
    let mut score = Score::default();
    let mut dice = Dice(8);
    for bend in [1e-11, 1e-9, 1e-7] {
        let n = 16;
        let mut scene = Scene::new("bent quads", DVec3::Z);
        let off: Vec<f64> = (0..=n * n).map(|_| dice.range(-bend, bend)).collect();
        let at = |x: usize, y: usize| {
            let (turn, height) = ((x % n) as f64 / n as f64, y as f64 / n as f64);
            let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
            let (radius, z) = (std::f64::consts::PI * height).sin_cos();
            let place = DVec3::new(radius * cos, radius * sin, z);
            if y == 0 || y == n { DVec3::Z * z } else { place * (1.0 + off[(x % n) + y * (n - 1)]) }
        };
        for (x, y) in (0..n * n).map(|i| (i % n, i / n)) {
            let mut corners = vec![at(x, y), at(x, y + 1), at(x + 1, y + 1), at(x + 1, y)];
            corners.dedup();
            if corners.first() == corners.last() {
                corners.pop();
            }
            scene.push(corners, 0);
        }
        let tree = BuildOptions::DEFAULT.build(scene.polygons()).unwrap();
        for camera in cameras(&scene, 4, [240, 180]) {
            check_with_rays(&tree, &camera, &mut score).unwrap_or_else(|f| panic!("{bend}: {f}"));
        }
    }
    enough!(score.pixels > 500_000, score.pictures > 15; "{score:?}");
}
