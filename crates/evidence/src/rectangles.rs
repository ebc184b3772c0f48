//! Form factors of rectangles that see all of each other, by the closed formulas of J. Howell's catalogue
//! "A Catalog of Radiation Heat Transfer Configuration Factors".

use std::f64::consts::PI;

/// Returns the form factor between two equal rectangles of `sides` that face each other at a distance `apart`
/// (C-11).
pub fn facing(sides: [f64; 2], apart: f64) -> f64 {
    let [x, y] = sides.map(|side| side / apart);
    let [of_x, of_y] = [x, y].map(|c| (1.0 + c * c).sqrt());
    let log = (of_x * of_x * of_y * of_y / (1.0 + x * x + y * y)).sqrt().ln();
    let arcs = x * of_y * (x / of_y).atan() + y * of_x * (y / of_x).atan();
    2.0 / (PI * x * y) * (log + arcs - x * x.atan() - y * y.atan())
}

/// Returns the form factor from a rectangle to a second rectangle at a right angle. Both share an edge of
/// length `edge`. The first reaches `from` away from it, and the second reaches `to` (C-14).
pub fn in_a_corner(edge: f64, from: f64, to: f64) -> f64 {
    let [w, h] = [from, to].map(|side| side / edge);
    let [ww, hh] = [w * w, h * h];
    let (both, all) = (ww + hh, 1.0 + ww + hh);
    let arcs =
        w * (1.0 / w).atan() + h * (1.0 / h).atan() - both.sqrt() * (1.0 / both.sqrt()).atan();
    let logs = ((1.0 + ww) * (1.0 + hh) / all).ln()
        + ww * (ww * all / ((1.0 + ww) * both)).ln()
        + hh * (hh * all / ((1.0 + hh) * both)).ln();
    (arcs + 0.25 * logs) / (PI * w)
}

/// Returns the form factor from a point of a surface to a rectangle of `sides` that faces the surface at a
/// distance `apart`, with a corner straight above the point (B-3).
pub fn above_a_point(sides: [f64; 2], apart: f64) -> f64 {
    let [a, b] = sides.map(|side| side / apart);
    let arc = |a: f64, b: f64| {
        let root = (1.0 + a * a).sqrt();
        a / root * (b / root).atan()
    };
    (arc(a, b) + arc(b, a)) / (2.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The form factor as a sum over small parts of both rectangles, each taken as its middle point.
    fn by_sums(
        at: impl Fn(f64, f64) -> ([f64; 3], [f64; 3]),
        other: impl Fn(f64, f64) -> ([f64; 3], [f64; 3]),
        area: f64,
    ) -> f64 {
        const PARTS: u32 = 40;
        let middle = |k: u32| (f64::from(k) + 0.5) / f64::from(PARTS);
        let all = || (0..PARTS * PARTS).map(|k| (middle(k % PARTS), middle(k / PARTS)));
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        let mut sum = 0.0;
        for (p, n) in all().map(|(u, v)| at(u, v)) {
            for (q, m) in all().map(|(u, v)| other(u, v)) {
                let way: [f64; 3] = std::array::from_fn(|i| q[i] - p[i]);
                sum += dot(n, way) * -dot(m, way) / (PI * dot(way, way).powi(2));
            }
        }
        sum * area / f64::from(PARTS).powi(4)
    }

    #[test]
    fn closed_formulas_are_the_published_numbers_and_the_sums_of_small_parts() {
        let published = [
            (facing([1.0, 1.0], 1.0), 0.1998),
            (in_a_corner(1.0, 1.0, 1.0), 0.2000),
            (above_a_point([1.0, 1.0], 1.0), 0.1385),
        ];
        for (found, truth) in published {
            assert!((found - truth).abs() < 5e-5, "{found} {truth}");
        }
        let floor = |u: f64, v: f64| ([2.0 * u, 3.0 * v, 0.0], [0.0, 0.0, 1.0]);
        let over = |u: f64, v: f64| ([2.0 * u, 3.0 * v, 1.5], [0.0, 0.0, -1.0]);
        let beside = |u: f64, v: f64| ([0.0, 3.0 * u, 4.0 * v], [1.0, 0.0, 0.0]);
        let sums = by_sums(floor, over, 6.0);
        assert!((facing([2.0, 3.0], 1.5) / sums - 1.0).abs() < 2e-3, "{sums}");
        let sums = by_sums(floor, beside, 12.0);
        assert!((in_a_corner(3.0, 2.0, 4.0) / sums - 1.0).abs() < 0.02, "{sums}");
        let point = |_: f64, _: f64| ([0.0; 3], [0.0, 0.0, 1.0]);
        let sums = by_sums(point, over, 6.0);
        assert!((above_a_point([2.0, 3.0], 1.5) / sums - 1.0).abs() < 2e-3, "{sums}");
    }
}
