//! Lines in space that edges run along. Two edges on one line have the same, wherever they begin.

use std::collections::{HashMap, TryReserveError};

/// A line that carries edges of fragments: that of an edge as given, shared by all faces, or where a
/// plane cuts one face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carrier {
    /// An axis along which the line is not constant.
    pub(super) axis: usize,
    /// The face that is cut.
    pub(super) face: Option<u32>,
}

/// The lines of edges, by their shortest integer direction, the first coordinate that is not zero
/// positive, and their moment.
#[derive(Default)]
pub(super) struct Lines(HashMap<([i64; 3], [i128; 3]), u32>);

impl Lines {
    pub(super) fn try_reserve(&mut self, more: usize) -> Result<(), TryReserveError> {
        self.0.try_reserve(more)
    }

    /// The number of the line through two lattice points; if it is new, it is added to `carriers`.
    pub(super) fn number(&mut self, ends: [[f64; 3]; 2], carriers: &mut Vec<Carrier>) -> u32 {
        let [a, b] = ends.map(|end| end.map(|c| c as i64));
        let arm: [i64; 3] = std::array::from_fn(|i| b[i] - a[i]);
        let size = |axis: usize| arm[axis].abs();
        let axis = (1..3).fold(0, |best, axis| if size(axis) > size(best) { axis } else { best });
        let common = arm.into_iter().fold(0, divisor).max(1);
        let first = arm.into_iter().find(|&c| c != 0).unwrap_or(1);
        let direction = arm.map(|c| c / common * first.signum());
        let moment = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let product = |j: usize, k: usize| i128::from(a[j]) * i128::from(direction[k]);
            product(j, k) - product(k, j)
        });
        *self.0.entry((direction, moment)).or_insert_with(|| {
            carriers.push(Carrier { axis, face: None });
            carriers.len() as u32 - 1
        })
    }
}

/// The greatest common divisor (Stein 1967: shifts and differences).
fn divisor(a: i64, b: i64) -> i64 {
    let (mut a, mut b) = (a.unsigned_abs(), b.unsigned_abs());
    if a == 0 || b == 0 {
        return (a | b) as i64;
    }
    let twos = (a | b).trailing_zeros();
    a >>= a.trailing_zeros();
    while b != 0 {
        b >>= b.trailing_zeros();
        (a, b) = (a.min(b), a.abs_diff(b));
    }
    (a << twos) as i64
}

#[cfg(test)]
mod tests {
    use super::{Lines, divisor};

    #[test]
    fn edges_on_one_line_have_one_number() {
        let (mut lines, mut carriers) = (Lines::default(), Vec::new());
        let mut number = |a, b| lines.number([a, b], &mut carriers);
        let first = number([1.0, 2.0, 3.0], [3.0, 6.0, -1.0]);
        assert_eq!(number([3.0, 6.0, -1.0], [1.0, 2.0, 3.0]), first);
        assert_eq!(number([4.0, 8.0, -3.0], [-1.0, -2.0, 7.0]), first);
        assert_ne!(number([1.0, 2.0, 4.0], [3.0, 6.0, 0.0]), first);
        assert_ne!(number([1.0, 2.0, 3.0], [3.0, 6.0, -2.0]), first);
        assert_eq!(carriers.iter().map(|c| c.axis).collect::<Vec<_>>(), [1, 1, 2]);
    }

    #[test]
    fn divisors() {
        for (a, b, common) in [(0, 0, 0), (0, -6, 6), (12, 18, 6), (-35, 14, 7), (1 << 52, 3, 1)] {
            assert_eq!((divisor(a, b), divisor(b, a)), (common, common), "{a} {b}");
        }
    }
}
