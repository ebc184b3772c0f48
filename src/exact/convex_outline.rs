//! Whether an outline is convex.

use std::cmp::Ordering;

/// Whether an outline of `n` lattice points is convex and winds once, seen along an axis. Exact.
pub(crate) fn is_convex(n: usize, at: impl Fn(usize) -> [f64; 3], axis: usize) -> bool {
    if n < 3 {
        return false;
    }
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let point = |k: usize| {
        let point = at(if k < n { k } else { k - n });
        [point[x], point[y]]
    };
    if n == 4 && turns_one_way(std::array::from_fn(point)) {
        return true;
    }
    let ascending = |s: [f64; 2]| s[0] > 0.0 || (s[0] == 0.0 && s[1] > 0.0);
    let (mut here, mut next) = (point(0), point(1));
    let (mut rises, mut turn) = (0, Ordering::Equal);
    for then in (2..n + 2).map(point) {
        let (a, b) = (step(here, next), step(next, then));
        (here, next) = (next, then);
        // The projection puts two corners in a row on one point: no direction to turn from.
        if a == [0.0; 2] || b == [0.0; 2] {
            return false;
        }
        let Some(sign) = turn_of(a, b) else { return false };
        if sign.is_ne() {
            if sign == turn.reverse() {
                return false;
            }
            turn = sign;
        }
        rises += u32::from(!ascending(a) && ascending(b));
    }
    // It turns one way only. Each time round it changes once from descending to ascending.
    rises == 1
}

#[inline]
fn step(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

/// Whether four corners certainly turn the same way. Then they wind once: each turn is less than half
/// a turn, and all four together are a whole number of turns.
#[inline]
pub(crate) fn turns_one_way(points: [[f64; 2]; 4]) -> bool {
    let steps: [_; 4] = std::array::from_fn(|k| step(points[k], points[(k + 1) % 4]));
    // No branches: for most faces they could not be foretold.
    let (mut left, mut right) = (true, true);
    for k in 0..4 {
        let (a, b) = (steps[k], steps[(k + 1) % 4]);
        let (one, other) = (a[0] * b[1], a[1] * b[0]);
        let (turn, bound) = (one - other, f64::EPSILON * (one.abs() + other.abs()));
        left &= turn > bound;
        right &= -turn > bound;
    }
    left | right
}

/// Which way an outline turns from one step to the next; `None` if it turns back.
#[inline]
fn turn_of(a: [f64; 2], b: [f64; 2]) -> Option<Ordering> {
    let (left, right) = (a[0] * b[1], a[1] * b[0]);
    // Two products and their difference are rounded.
    if (left - right).abs() > f64::EPSILON * (left.abs() + right.abs()) {
        return Some(if left > right { Ordering::Greater } else { Ordering::Less });
    }
    let product = |p: f64, q: f64| i128::from(p as i64) * i128::from(q as i64);
    let turn = (product(a[0], b[1]) - product(a[1], b[0])).cmp(&0);
    let is_back = turn.is_eq() && product(a[0], b[0]) + product(a[1], b[1]) < 0;
    (!is_back).then_some(turn)
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

    use super::{is_convex, turn_of, turns_one_way};
    use crate::random::SplitMix64;

    #[test]
    fn a_triangle_is_convex_if_it_has_an_area() {
        let convex = |triangle: [[f64; 3]; 3]| is_convex(3, |k| triangle[k], 2);
        for [x, y] in [[1.0, 2.0], [1.0, -2.0], [4.0, 1.0]] {
            assert!(convex([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [x, y, 5.0]]), "{x}, {y}");
            assert!(!convex([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [x, 0.0, 5.0]]), "{x}");
        }
    }

    #[test]
    fn an_outline_with_two_corners_on_one_point_of_the_view_is_not_convex() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        for start in 0..4 {
            let mut corners = square.to_vec();
            corners.rotate_left(start);
            let convex = |corners: &[[f64; 3]]| is_convex(corners.len(), |k| corners[k], 2);
            assert!(convex(&corners));
            let [x, y, _] = corners[3];
            corners.push([x, y, 1.0]);
            assert!(!convex(&corners), "{corners:?}");
        }
    }

    /// By integers: an outline of four corners is convex if all turns have the same sign.
    #[test]
    fn four_corners_that_certainly_turn_one_way_are_convex() {
        let mut random = SplitMix64::new(5);
        let mut told = [0; 2];
        for _ in 0..20_000 {
            let size = 2f64.powf(random.range(1.0, 50.0));
            let points = [(); 4].map(|()| [0, 1].map(|_| random.range(-size, size).round()));
            // The signs of the four areas by integers: all the same, or not.
            let area = |[p, q, r]: [[f64; 2]; 3]| {
                let of = |a: f64, b: f64| (b - a) as i128;
                (of(p[0], q[0]) * of(p[1], r[1]) - of(p[1], q[1]) * of(p[0], r[0])).signum()
            };
            let turns = [0, 1, 2, 3].map(|k| area([0, 1, 2].map(|i| points[(k + i) % 4])));
            let one_way = turns == [1; 4] || turns == [-1; 4];
            let found = turns_one_way(points);
            assert!(one_way || !found, "{points:?}");
            told[usize::from(found)] += 1;
            let corners = points.map(|[x, y]| [x, y, 0.0]);
            // Without area, a turn that is not one way can still be convex.
            if !turns.contains(&0) {
                assert_eq!(is_convex(4, |k| corners[k], 2), one_way, "{points:?}");
            }
        }
        assert!(told[0] > 2000 && told[1] > 2000, "{told:?}");
    }

    /// Steps that all but run on in one line, or back, by integers of 128 bits.
    #[test]
    fn turns_are_exact() {
        let mut random = SplitMix64::new(4);
        let (mut straight, mut back) = (0, 0);
        for _ in 0..20_000 {
            let mut number = |most: f64| random.range(-most, most).round();
            let (size, nudge) = (number(9e6), number(1.4));
            let (unit, nudge) = ([size, size + number(1.4)], [nudge; 2]);
            let [s, t] = [number(9e7), number(9e7)];
            let a = unit.map(|c| c * s);
            let b = [unit[0] * t + nudge[0], unit[1] * t + nudge[1]];
            let [p, q] = [a, b].map(|step| step.map(|c| c as i128));
            let turn = (p[0] * q[1] - p[1] * q[0]).cmp(&0);
            let is_back = turn == Ordering::Equal && p[0] * q[0] + p[1] * q[1] < 0;
            assert_eq!(turn_of(a, b), (!is_back).then_some(turn), "{a:?} {b:?}");
            straight += usize::from(turn.is_eq() && !is_back);
            back += usize::from(is_back);
        }
        assert!(straight > 500 && back > 500, "{straight} {back}");
    }
}
