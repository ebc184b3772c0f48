//! Whether an outline is convex.

/// Whether an outline of `n` lattice points is convex and winds once, seen along an axis. Exact.
pub(crate) fn is_convex(n: usize, at: impl Fn(usize) -> [f64; 3], axis: usize) -> bool {
    let at = |k: usize| at(k % n);
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let step = |k: usize| [at(k + 1)[x] - at(k)[x], at(k + 1)[y] - at(k)[y]];
    let mut rises = 0;
    let mut turn = 0i8;
    let ascending = |s: [f64; 2]| s[0] > 0.0 || (s[0] == 0.0 && s[1] > 0.0);
    for k in 0..n {
        let (a, b) = (step(k), step(k + 1));
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
