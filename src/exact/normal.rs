//! The normals of faces, rounded.

use glam::DVec3;

use super::faces::Faces;
use super::label::PlaneId;
use super::plane::cross;

/// A rounded normal is used if its `size` is at most this many times its longest component; of others,
/// too many bits were cancelled, and integers compute them. Larger: normals are taken that
/// are off by more than the bounds of those who use them allow, such as the 10⁻⁹ by which the coplanar
/// tolerance may be off; smaller: more are computed in integers.
const CANCELLED: f64 = (1u64 << 18) as f64;

/// The vector product (q − p) × (r − p) of three lattice points, in `f64`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundedNormal {
    /// Each component is off by at most 2⁻⁵² of its share of `size`: its two products and their
    /// difference are rounded.
    pub(crate) normal: [f64; 3],
    /// Σ over components of the magnitudes of their two products.
    pub(crate) size: f64,
}

impl RoundedNormal {
    /// Of the plane through three lattice points.
    #[inline]
    pub(crate) fn through([p, q, r]: [[f64; 3]; 3]) -> Self {
        let (mut normal, mut size) = ([0.0; 3], 0.0);
        for (i, component) in normal.iter_mut().enumerate() {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let a = (q[j] - p[j]) * (r[k] - p[k]);
            let b = (q[k] - p[k]) * (r[j] - p[j]);
            *component = a - b;
            size += a.abs() + b.abs();
        }
        Self { normal, size }
    }

    /// The axis along which it is longest; the first of several.
    #[inline]
    pub(crate) fn longest(&self) -> usize {
        let sizes = self.normal.map(f64::abs);
        (1..3).fold(0, |best, axis| if sizes[axis] > sizes[best] { axis } else { best })
    }

    /// The axis along which the exact normal is longest, if it is certain which that is.
    #[inline]
    pub(crate) fn certain_axis(&self) -> Option<usize> {
        let (sizes, axis) = (self.normal.map(f64::abs), self.longest());
        // Two components are off by no more than `size` together.
        let least = sizes[axis] - f64::EPSILON * self.size;
        (0..3).all(|other| other == axis || sizes[other] < least).then_some(axis)
    }
}

/// Whether three lattice points are not on one line: exact.
#[inline]
pub(crate) fn have_area(corners: [[f64; 3]; 3]) -> bool {
    let RoundedNormal { normal, size } = RoundedNormal::through(corners);
    let [p, q, r] = corners;
    normal.iter().any(|c| c.abs() > f64::EPSILON * size) || cross(p, q, r) != [0; 3]
}

impl Faces {
    /// The normal of a face's plane: each component is within 2⁻³⁴ of the longest of them.
    #[inline]
    pub(crate) fn normal(&self, face: u32) -> DVec3 {
        let corners = self.triangle(face);
        let RoundedNormal { normal, size } = RoundedNormal::through(corners);
        let normal = DVec3::from_array(normal);
        if size <= CANCELLED * normal.abs().max_element() {
            normal
        } else {
            self.exact_normal(face)
        }
    }

    /// The length of the normal of a face's plane, within 2⁻³⁴ of it, from the rounded normal.
    #[inline]
    pub(super) fn normal_length(&self, face: u32, rounded: &RoundedNormal) -> f64 {
        // Not by the longest component, which takes more time to find.
        let length = DVec3::from_array(rounded.normal).length();
        if rounded.size <= CANCELLED * length { length } else { self.exact_normal(face).length() }
    }

    #[cold]
    fn exact_normal(&self, face: u32) -> DVec3 {
        self.plane(PlaneId::face(face)).normal_f64()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::{RoundedNormal, have_area};
    use crate::exact::lattice::LIMIT;
    use crate::exact::plane::{Plane, cross};
    use crate::exact::{Faces, PlaneId};
    use crate::random::SplitMix64;

    /// Triangles of every thickness: the third corner is near a point of the line of the others, or
    /// on it.
    fn thin(random: &mut SplitMix64) -> [[f64; 3]; 3] {
        let p = (random.point(-1.0, 1.0) * (LIMIT / 4.0)).round();
        let arm = (random.point(-1.0, 1.0) * 2f64.powf(random.range(1.0, 48.0))).round();
        let off = random.point(-1.0, 1.0) * 2f64.powf(random.range(-3.0, 48.0));
        [p, p + arm, p + 3.0 * arm + off.round()].map(|corner| corner.to_array())
    }

    #[test]
    fn three_corners_have_area_unless_they_are_on_one_line() {
        let (mut random, mut flat) = (SplitMix64::new(1), 0);
        for _ in 0..20_000 {
            let [p, q, r] = thin(&mut random);
            let is_flat = cross(p, q, r) == [0; 3];
            assert_eq!(have_area([p, q, r]), !is_flat);
            flat += usize::from(is_flat);
        }
        assert!((300..5000).contains(&flat), "{flat}");
    }

    #[test]
    fn normals_are_as_near_as_they_say() {
        let (mut random, mut cancelled) = (SplitMix64::new(2), 0);
        for _ in 0..20_000 {
            let corners = thin(&mut random);
            let exact = Plane::through(corners).normal_f64();
            let rounded = RoundedNormal::through(corners);
            let off = (DVec3::from(rounded.normal) - exact).abs().max_element();
            assert!(off <= rounded.size * 1.001 * f64::EPSILON, "{corners:?}");
            let polygon = corners.map(|corner| DVec3::from(corner) / LIMIT);
            let (faces, _) = Faces::new([polygon], Some(0.0)).unwrap();
            if faces.is_empty() {
                continue;
            }
            // On a lattice of its own.
            let exact = faces.plane(PlaneId::face(0)).normal_f64();
            let off = (faces.normal(0) - exact).abs().max_element();
            let most = exact.abs().max_element();
            assert!(off <= most * 2f64.powi(-34) * 1.001, "{corners:?}");
            let rough = RoundedNormal::through([0, 1, 2].map(|k| faces.corner(k)));
            let off = (DVec3::from(rough.normal) - exact).abs().max_element();
            cancelled += usize::from(off > most * 2f64.powi(-34));
        }
        assert!(cancelled > 100, "{cancelled} that floats alone would have got wrong");
    }
}
