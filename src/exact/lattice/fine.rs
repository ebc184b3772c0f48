//! Points on a grid that is much finer than the lattice, as fine as 128 bits allow.

use glam::DVec3;

use super::{LIMIT, Lattice, exponent_of, two_sum};

/// Points in units of 2^−`bits` lattice steps. Coordinates are below 2¹²⁴ in magnitude, and so are
/// those of all lattice points in this unit.
pub(crate) struct FinePoints<const N: usize> {
    pub(crate) points: [[i128; 3]; N],
    pub(crate) bits: u32,
}

/// Coordinates in lattice steps, and the lattice's origin, are below two to this power, so that they
/// take as many bits of an `i128`. A difference of two points, and of two such, takes three more.
const BITS: i32 = 123;

impl Lattice {
    /// Points in the finest unit in which they all are below 2¹²⁴, rounded to the nearest. `None` if a
    /// coordinate is NaN, infinite, or 2¹²³ lattice steps or more.
    pub(crate) fn fine_points<const N: usize>(&self, points: [DVec3; N]) -> Option<FinePoints<N>> {
        let largest = self.largest_in_steps(&points)?;
        let bits = (BITS - 1 - exponent_of(largest)) as u32;
        let origin = self.origin.map(|c| fixed(c, bits));
        let points = points.map(|point| {
            let steps = self.in_steps(point);
            std::array::from_fn(|axis| {
                let [sum, lost] = steps[axis].map(|part| fixed(part, bits));
                sum + lost - origin[axis]
            })
        });
        Some(FinePoints { points, bits })
    }

    /// The largest of the coordinates that say how fine the grid of some points is: it has steps of at
    /// most 2⁻¹²² of this. `None` where [`fine_points`](Self::fine_points) has none.
    pub(crate) fn largest_in_steps(&self, points: &[DVec3]) -> Option<f64> {
        let mut largest = self.origin.iter().fold(2.0 * LIMIT, |largest, c| largest.max(c.abs()));
        for [c, _] in points.iter().flat_map(|&point| self.in_steps(point)) {
            if !c.is_finite() {
                return None;
            }
            largest = largest.max(c.abs());
        }
        (exponent_of(largest) < BITS).then_some(largest)
    }

    /// The exponent of the steps in a unit of length: there are two to the power of this many.
    pub(crate) fn exponent(&self) -> i32 {
        self.steps.factors.map(exponent_of).iter().sum()
    }

    /// A point in lattice steps from the world's origin, or along an axis along which the scene is far
    /// out, from the scene: each coordinate as a number and what its rounding has lost.
    pub(super) fn in_steps(&self, point: DVec3) -> [[f64; 2]; 3] {
        let world = point.to_array();
        std::array::from_fn(|axis| {
            let (sum, lost) = two_sum(world[axis], -self.far[axis]);
            [sum, lost].map(|part| self.steps.times(part))
        })
    }
}

/// A number times 2^`bits`, which is below 2¹²³ in magnitude, rounded to the nearest integer.
fn fixed(value: f64, bits: u32) -> i128 {
    (value * (1u128 << bits) as f64).round() as i128
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_any_size_keep_120_bits() {
        let lattice = Lattice::new(DVec3::splat(-1.0), DVec3::splat(1.0));
        let step = lattice.length_to_world(1.0);
        for size in [1e-18, 1e-3, 0.7, 3.0, 1e5, 1e15, 4e20] {
            let points = [DVec3::new(size, -size, 0.0), DVec3::new(0.5, 0.25, 0.1)];
            let fine = lattice.fine_points(points).expect("within reach");
            let unit = step / (1u128 << fine.bits) as f64;
            assert!(unit <= size.max(1.0) * 2f64.powi(-120), "{size}: {unit:e}");
            for (fine, point) in fine.points.iter().zip(points) {
                let back = DVec3::from(fine.map(|c| c as f64 * unit));
                let slack = DVec3::splat(unit) + point.abs() * f64::EPSILON;
                assert!((back - point).abs().cmple(slack).all(), "{size}: {point}, {back}");
            }
        }
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e30, f64::MAX] {
            assert!(lattice.fine_points([DVec3::ZERO, DVec3::new(0.0, bad, 0.0)]).is_none());
        }
    }

    #[test]
    fn lattice_points_are_multiples_of_the_steps() {
        let (low, high) = (DVec3::new(1e6, -3.0, 2e-9), DVec3::new(1e6 + 0.3, -1.0, 7e-9));
        let lattice = Lattice::new(low, high);
        for point in [low, high, high * 0.25 + low * 0.75] {
            let on_lattice = lattice.snap(point);
            let fine = lattice.fine_points([lattice.to_world(on_lattice)]).expect("within reach");
            assert_eq!(fine.points[0], on_lattice.map(|c| (c as i128) << fine.bits));
        }
    }
}
