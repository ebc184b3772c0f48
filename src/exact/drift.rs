//! How far a rounded position is from the exact vertex.

use super::vertex::Weights;
use super::{Faces, Int, Symbol};

impl Faces {
    /// A position minus the exact position of a vertex, in lattice units. Each coordinate is within
    /// a few roundings of the exact difference. `None` if the planes that define the vertex do not
    /// meet in a point.
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

/// A position minus the weighted mean of lattice points.
///
/// With x = whole + part, the numerator of Σ w (p − whole) / Σ w is exact, and the quotient is
/// small, so that rounding it loses little.
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
        // This far outside the lattice the integers below could overflow: report it as infinite.
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
