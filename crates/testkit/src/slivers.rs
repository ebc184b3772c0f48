//! Triangles with integer corners that are almost collinear.

use super::dice::Dice;

pub type Point = [i64; 3];

/// A sliver, and two short steps that span its plane.
#[derive(Clone, Copy, Debug)]
pub struct Sliver {
    pub corners: [Point; 3],
    pub steps: [Point; 2],
}

impl Sliver {
    /// Creates a sliver with coordinates up to `size`, and of any length up to about `size`. Its area is half
    /// the area that the two steps span, or up to a million times as much.
    pub fn new(dice: &mut Dice, size: i64) -> Self {
        let steps = loop {
            let steps = [0; 2].map(|_| [0; 3].map(|_| whole(dice, 3)));
            if cross(steps) != [0; 3] {
                break steps;
            }
        };
        // The numbers of steps along two sides. The determinant of both sides is 1.
        let most = size / 16;
        let powers = 1 + dice.below(most.ilog2() as usize);
        let power = dice.below(powers) as u32;
        let [s, t] = loop {
            let [s, t] = [0; 2].map(|_| whole(dice, most >> power).abs() + 1);
            if bezout([s, t]).1 == 1 {
                break [s, t];
            }
        };
        let ([a, b], _) = bezout([s, t]);
        let thick = 1 << dice.below(20);
        let times = thick.min(most / (a.abs() + b.abs())).max(1);
        let from = [0; 3].map(|_| whole(dice, size / 2));
        let at = |s: i64, t: i64| along(from, steps, [s, t]);
        Self { corners: [from, at(s, t), at(-b * times, a * times)], steps }
    }
}

/// Returns the point `s` steps along `u` and `t` steps along `v` from another point.
pub fn along(from: Point, [u, v]: [Point; 2], [s, t]: [i64; 2]) -> Point {
    std::array::from_fn(|i| from[i] + s * u[i] + t * v[i])
}

/// Returns a whole number from −n to n.
pub fn whole(dice: &mut Dice, n: i64) -> i64 {
    (dice.roll() % (2 * n as u64 + 1)) as i64 - n
}

fn cross([u, v]: [Point; 2]) -> Point {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        u[j] * v[k] - u[k] * v[j]
    })
}

/// Numbers a and b for which a s + b t is the greatest common divisor of s and t, and that divisor.
fn bezout([s, t]: [i64; 2]) -> ([i64; 2], i64) {
    let ([mut r, mut next], [mut x, mut y]) = ([s, t], [[1, 0], [0, 1]]);
    while next != 0 {
        let n = r / next;
        (r, next) = (next, r - n * next);
        (x, y) = (y, [x[0] - n * y[0], x[1] - n * y[1]]);
    }
    (x, r)
}
