//! Lattice points moved onto a plane along its main axis, to the nearest lattice points.

use glam::DVec3;

use super::plane::{Plane, rounded};

/// A plane at a lattice point certainly fits 128 bits if it is below this, rounded. Larger, up to half
/// the range: values that do not fit are taken; smaller: more are computed in full.
const FITS: f64 = (1u128 << 124) as f64;

/// Moves lattice points onto a plane.
#[derive(Debug)]
pub(crate) struct Flattener {
    plane: Plane,
    through: DVec3,
    axis: usize,
    normal: DVec3,
}

/// How far a point is off a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Off {
    /// The distance in lattice units, rounded; 0 only if the point is exactly on the plane.
    pub(crate) distance: f64,
    /// How many whole steps along the axis it is moved towards the plane.
    pub(crate) steps: f64,
}

impl Flattener {
    /// Moves along an axis onto the plane of three lattice points.
    pub(crate) fn new(corners: [[f64; 3]; 3], axis: usize) -> Self {
        let plane = Plane::through(corners);
        let (through, normal) = (DVec3::from(corners[0]), plane.normal_f64());
        Self { plane, through, axis, normal }
    }

    /// How far a point is off.
    #[inline]
    pub(crate) fn off(&self, point: &[f64; 3]) -> Off {
        let Self { plane, axis, normal, .. } = self;
        let slope = plane.normal()[*axis];
        let last_bits = plane.last_bits_at(point);
        // Most are so near the plane that 128 bits hold its value there. This is off by less than 2¹¹⁰.
        let near = normal.dot(DVec3::from(*point) - self.through).abs();
        let value = if near < FITS { rounded(last_bits) } else { plane.at(point).to_f64() };
        if value == 0.0 {
            return Off { distance: 0.0, steps: 0.0 };
        }
        // The plane is value / slope steps away. Both are rounded here, and the quotient, but within
        // the largest tolerance it is below 2⁴⁵, so the nearest integer is this or the next.
        let mut steps = super::lattice::nearest(value / normal[*axis]);
        // Less than the slope, so no more bits are needed.
        let rest = last_bits.wrapping_sub(slope.wrapping_mul(i128::from(steps as i64)));
        if rest.unsigned_abs() > slope.unsigned_abs() / 2 {
            steps += if (rest < 0) == (slope < 0) { 1.0 } else { -1.0 };
        }
        Off { distance: value.abs() / normal.length(), steps }
    }
}

#[cfg(test)]
mod tests {
    use super::Flattener;

    /// The plane 3z = x, moved along z.
    #[test]
    fn only_what_is_on_the_plane_is_off_by_nothing() {
        let flattener = Flattener::new([[0.0; 3], [3.0, 0.0, 1.0], [0.0, 1.0, 0.0]], 2);
        for (point, value, steps) in [
            ([3.0, 5.0, 1.0], 0.0, 0.0),
            ([2.0, 5.0, 1.0], 1.0, 0.0),
            ([4.0, 5.0, 1.0], 1.0, 0.0),
            ([1.0, 5.0, 1.0], 2.0, 1.0),
            ([3.0, 5.0, -6.0], 21.0, -7.0),
        ] {
            let off = flattener.off(&point);
            assert!((off.distance - value / 10f64.sqrt()).abs() < 1e-14, "{point:?} {off:?}");
            assert_eq!((off.distance == 0.0, off.steps), (value == 0.0, steps), "{point:?}");
        }
    }
}
