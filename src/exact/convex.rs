//! Whether an outline is convex.

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
    let step = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
    let ascending = |s: [f64; 2]| s[0] > 0.0 || (s[0] == 0.0 && s[1] > 0.0);
    let (mut here, mut next) = (point(0), point(1));
    let (mut rises, mut turn) = (0, 0i8);
    for then in (2..n + 2).map(point) {
        let (a, b) = (step(here, next), step(next, then));
        (here, next) = (next, then);
        // The projection puts two corners in a row on one point: no direction to turn from.
        if a == [0.0; 2] || b == [0.0; 2] {
            return false;
        }
        let product = |p: f64, q: f64| i128::from(p as i64) * i128::from(q as i64);
        let area = product(a[0], b[1]) - product(a[1], b[0]);
        let backwards = area == 0 && product(a[0], b[0]) + product(a[1], b[1]) < 0;
        let sign = area.signum() as i8;
        if backwards || sign * turn < 0 {
            return false;
        }
        turn |= sign;
        rises += u32::from(!ascending(a) && ascending(b));
    }
    // It turns one way only. Each time round it changes once from descending to ascending.
    rises == 1
}
