//! The order of points along a line, exactly: by one of their coordinates, as fractions.

use std::cmp::Ordering;

use super::Int;
use super::faces::Faces;
use super::label::{PlaneId, Symbol};
use super::plane::{Plane, relative_to};
use super::vertex::Weights;

/// A coordinate of a point, in lattice units. The denominator is not zero, and of either sign.
///
/// Both are sums over the weights of [`Weights`]: 374 and 320 bits at most.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fraction {
    numerator: Int<6>,
    denominator: Int<5>,
}

impl Fraction {
    /// The coordinate of a lattice point.
    pub(crate) fn whole(value: f64) -> Self {
        Self { numerator: Int::from(value as i64), denominator: Int::from(1_i64) }
    }

    fn mean<const K: usize>(coordinates: [f64; K], weights: [Int<5>; K]) -> Self {
        let denominator = weights.iter().fold(Int::ZERO, |sum, &weight| sum + weight);
        let terms = coordinates.iter().zip(weights);
        let numerator = terms.fold(Int::ZERO, |sum, (&coordinate, weight)| {
            sum + weight.times::<1, 6>(&Int::from(coordinate as i64))
        });
        Self { numerator, denominator }
    }

    /// How two coordinates compare: exact.
    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        let left = self.numerator.times::<5, 12>(&other.denominator);
        let right = other.numerator.times::<5, 12>(&self.denominator);
        let flipped = self.denominator.is_negative() != other.denominator.is_negative();
        let denominators = if flipped { Ordering::Less } else { Ordering::Greater };
        relative_to((left - right).sign(), denominators)
    }

    /// Which share of the way from one lattice coordinate to another has been gone here, rounded.
    pub(crate) fn share(&self, from: f64, to: f64) -> f64 {
        let before = self.denominator.times::<1, 6>(&Int::from(from as i64));
        (self.numerator - before).to_f64() / (self.denominator.to_f64() * (to - from))
    }
}

/// Where a plane cuts the segment between two lattice points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    ends: [[f64; 3]; 2],
    weights: [Int<5>; 2],
}

impl Cut {
    /// The coordinate along an axis.
    pub(crate) fn along(&self, axis: usize) -> Fraction {
        Fraction::mean(self.ends.map(|end| end[axis]), self.weights)
    }

    /// The place in lattice units, each coordinate within three roundings of the exact one.
    pub(crate) fn position(&self) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let Fraction { numerator, denominator } = self.along(axis);
            numerator.to_f64() / denominator.to_f64()
        })
    }
}

impl Faces {
    /// Where a plane cuts the segment between two lattice points; `None` unless they are strictly on
    /// its two sides.
    pub(crate) fn cut_of_segment(&self, ends: [[f64; 3]; 2], plane: PlaneId) -> Option<Cut> {
        let plane = self.plane(plane);
        let [a, b] = ends.map(|end| plane.at(&end));
        let crosses = a.sign() == b.sign().reverse() && a.sign().is_ne();
        crosses.then(|| Cut { ends, weights: [(-b).resize(), a.resize()] })
    }

    /// A coordinate of a vertex.
    pub(crate) fn along(&self, face: u32, vertex: Symbol, axis: usize) -> Fraction {
        match self.weights(face, vertex) {
            Weights::Corner(point) => Fraction::whole(point[axis]),
            Weights::Edge(ends, weights) => {
                Fraction::mean(ends.map(|end| end[axis]), weights.map(|weight| weight.resize()))
            }
            Weights::Inside(points, weights) => {
                Fraction::mean(points.map(|point| point[axis]), weights)
            }
        }
    }

    /// The axis in which the line where a plane cuts a face is longest.
    pub(crate) fn axis_of_cut(&self, face: u32, plane: PlaneId) -> usize {
        let own = Plane::through(self.triangle(face)).normal();
        let other = self.plane(plane).normal();
        let product = |j: usize, k: usize| Int::<2>::from(own[j]).times::<2, 4>(&other[k].into());
        let length = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            (product(j, k) - product(k, j)).to_f64().abs()
        };
        (1..3).fold(0, |best, axis| if length(axis) > length(best) { axis } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_compare_exactly_whatever_the_signs_of_their_denominators() {
        let fraction = |n: i64, d: i64| Fraction { numerator: n.into(), denominator: d.into() };
        let third = fraction(1, 3);
        for (other, expected) in [
            (fraction(-1, -3), Ordering::Equal),
            (fraction(333_333_333_333_333, 1_000_000_000_000_000), Ordering::Greater),
            (fraction(-333_333_333_333_334, -1_000_000_000_000_000), Ordering::Less),
            (fraction(1, -3), Ordering::Greater),
            (Fraction::whole(0.0), Ordering::Greater),
            (Fraction::whole(1.0), Ordering::Less),
        ] {
            assert_eq!(third.compare(&other), expected, "{other:?}");
            assert_eq!(other.compare(&third), expected.reverse(), "{other:?}");
        }
        assert_eq!(fraction(-7, -2).share(3.0, 5.0), 0.25);
        assert_eq!(fraction(7, 2).share(5.0, 3.0), 0.75);
    }
}
