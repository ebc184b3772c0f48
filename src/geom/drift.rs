//! How far a position is from where it should be.

use super::exact::Weights;
use super::{Faces, Int, Symbol};

impl Faces {
    /// A position less the exact place of a vertex, in lattice units, each coordinate within a
    /// few roundings of the difference itself; `None` if the vertex has no place, because what
    /// defines it is parallel.
    pub(crate) fn drift(&self, face: u32, vertex: Symbol, position: [f64; 3]) -> Option<[f64; 3]> {
        match self.weights(face, vertex) {
            Weights::Corner(point) => Some(std::array::from_fn(|i| position[i] - point[i])),
            Weights::Edge(points, weights) => {
                difference(&points, &weights.map(|weight| weight.resize()), position)
            }
            Weights::Inside(points, weights) => difference(&points, &weights, position),
        }
    }
}

/// A position less the weighted mean of lattice points.
///
/// With x = whole + part, Σ w (p − whole) / Σ w is small, and exact up to that quotient.
fn difference<const K: usize>(
    points: &[[f64; 3]; K],
    weights: &[Int<5>; K],
    position: [f64; 3],
) -> Option<[f64; 3]> {
    let total = weights.iter().fold(Int::<5>::ZERO, |sum, &w| sum + w).to_f64();
    if total == 0.0 {
        return None;
    }
    Some(std::array::from_fn(|axis| {
        let x = position[axis];
        // Coordinates so far out are wrong enough to be taken for what they are.
        if x.is_nan() || x.abs() > super::LATTICE_LIMIT * 256.0 {
            return f64::INFINITY;
        }
        let whole = x.trunc();
        let terms = points.iter().zip(weights);
        let sum = terms.fold(Int::<6>::ZERO, |sum, (point, weight)| {
            let arm = Int::from(point[axis] as i64 - whole as i64);
            sum + weight.times::<1, 6>(&arm)
        });
        (x - whole) - sum.to_f64() / total
    }))
}
