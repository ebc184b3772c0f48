//! Edges of faces as they are defined: between corners that may be moved onto the face's plane; and how corners
//! are moved.

use glam::DVec3;

use super::faces::Faces;
use super::plane::{Plane, rounded};

/// An edge of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExactEdge {
    /// The lattice points of its two corners.
    pub(super) ends: [[f64; 3]; 2],
    /// How they are moved onto the face's plane; `None` if both are on it.
    pub(super) moved: Option<Moved>,
}

/// How the ends of an edge are moved: along an axis, by half a step at most.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    pub(super) axis: usize,
    /// The face's plane at the ends, and what it gains with a step along the axis.
    pub(super) offs: [i128; 2],
    pub(super) slope: i128,
}

impl Faces {
    /// The edge of a face that begins at its corner `k`.
    #[inline]
    pub(super) fn edge(&self, face: u32, k: u32) -> ExactEdge {
        let corners = self.corners(face);
        let next = if k as usize + 1 == corners.len() { 0 } else { k + 1 };
        let ends = [k, next].map(|k| corners[k as usize]);
        let moved = self.upright_axis(face).and_then(|axis| {
            let is_on = [k, next].map(|k| self.is_on_triangle(face, k));
            if is_on == [true; 2] {
                return None;
            }
            let own = Plane::through(self.triangle(face));
            let off = |i: usize| if is_on[i] { 0 } else { own.last_bits_at(&ends[i]) };
            let (offs, slope) = ([off(0), off(1)], own.normal()[axis]);
            // An edge between two corners that are not moved must be treated as an edge, not as a cut
            // by an upright plane: the neighbour across it may have moved no corner, and both must
            // get the same bits.
            (offs != [0; 2]).then_some(Moved { axis, offs, slope })
        });
        ExactEdge { ends, moved }
    }

    /// The axis along which a corner is moved onto its face's plane, if it is off it.
    pub(super) fn axis_of_move(&self, face: u32, k: u32) -> Option<usize> {
        let axis = self.upright_axis(face).filter(|_| !self.is_on_triangle(face, k))?;
        let own = Plane::through(self.triangle(face));
        (own.last_bits_at(&self.corners(face)[k as usize]) != 0).then_some(axis)
    }

    /// Whether corner `k` is one of the three that define its face's plane. Others are within half a
    /// step of it along the axis, which 128 bits hold.
    fn is_on_triangle(&self, face: u32, k: u32) -> bool {
        let first = self.faces[face as usize].start;
        self.reference_triangle(face).contains(&(first + k))
    }
}

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
        let mut steps = crate::exact::lattice::nearest(value / normal[*axis]);
        // Less than the slope, so no more bits are needed.
        let rest = last_bits.wrapping_sub(slope.wrapping_mul(i128::from(steps as i64)));
        if rest.unsigned_abs() > slope.unsigned_abs() / 2 {
            steps += if (rest < 0) == (slope < 0) { 1.0 } else { -1.0 };
        }
        Off { distance: value.abs() / normal.length(), steps }
    }
}

#[cfg(test)]
mod flatten_tests {
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
