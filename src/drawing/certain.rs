//! What floats tell of segments before integers are asked.

use super::lines::Lines;
use super::rect::Rect;

/// What floats tell of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Certain {
    /// Both ends are in the picture, here.
    Inside([[f64; 2]; 2]),
    /// No point is in the picture.
    Outside,
    Unknown,
}

/// One over the largest error of a projected point, in pixels, that counts as none.
const FAR: f64 = (1u64 << 30) as f64;

/// What floats tell of the segment between two lattice points. (Most are inside or outside.)
pub(super) fn certain_ends(lines: &Lines<'_>, ends: [[f64; 3]; 2], [low, high]: &Rect) -> Certain {
    let projected = ends.map(|end| lines.frame.rays.project(end));
    // What is positive in the picture and ahead of the eye, and how far off that may be.
    let inside = |([x, y, z], [ex, ey, ez]): ([f64; 3], [f64; 3])| {
        let side = |at: f64, error: f64, border: f64, sign: f64| {
            let off = error + border.abs() * ez;
            (sign * (at - border * z), off + 4.0 * f64::EPSILON * (at.abs() + (border * z).abs()))
        };
        let beyond = |at, error, axis: usize| side(at, error, low[axis], 1.0);
        let before = |at, error, axis: usize| side(at, error, high[axis], -1.0);
        [(z, ez), beyond(x, ex, 0), before(x, ex, 0), beyond(y, ey, 1), before(y, ey, 1)]
    };
    let [a, b] = projected.map(inside);
    let is_out = |&(value, off): &(f64, f64)| value < -off;
    if a.iter().zip(&b).any(|(a, b)| is_out(a) && is_out(b)) {
        return Certain::Outside;
    }
    let is_in = |&(value, off): &(f64, f64)| value > off;
    // Near the eye, errors that are small for the scene are large in the picture.
    let is_fine = |([_, _, z], errors): &([f64; 3], [f64; 3])| errors.iter().all(|e| e * FAR < *z);
    match a.iter().chain(&b).all(is_in) && projected.iter().all(is_fine) {
        true => Certain::Inside(projected.map(|([x, y, z], _)| [x / z, y / z])),
        false => Certain::Unknown,
    }
}
