//! Planes of faces, in integers and rounded; and how corners are moved onto them.

use std::cmp::Ordering;

use glam::DVec3;

use super::Int;
use super::faces::Faces;
use super::lattice::nearest;
use super::names::PlaneId;

/// The integer vector product (q − p) × (r − p) of three lattice points.
pub(crate) fn cross(p: [f64; 3], q: [f64; 3], r: [f64; 3]) -> [i128; 3] {
    let u: [i128; 3] = std::array::from_fn(|i| i128::from((q[i] - p[i]) as i64));
    let w: [i128; 3] = std::array::from_fn(|i| i128::from((r[i] - p[i]) as i64));
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        u[j] * w[k] - u[k] * w[j]
    })
}

/// Components of a normal are divided into parts of so many bits. Products of these with differences
/// of coordinates fit 128 bits, three of them added.
pub(super) const LOW_BITS: u32 = 56;
pub(super) const LOW: i128 = (1 << LOW_BITS) - 1;

/// A plane in integers: a normal and a lattice point on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    normal: [i128; 3],
    point: [i64; 3],
}

impl Plane {
    /// The plane through three lattice points; its front is the side from which they run
    /// counter-clockwise.
    pub(crate) fn through([p, q, r]: [[f64; 3]; 3]) -> Self {
        Self { normal: cross(p, q, r), point: p.map(|c| c as i64) }
    }

    /// The plane through two lattice points and along an axis.
    pub(crate) fn upright(p: [f64; 3], q: [f64; 3], axis: usize) -> Self {
        let mut normal = [0; 3];
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        normal[j] = i128::from((q[k] - p[k]) as i64);
        normal[k] = -i128::from((q[j] - p[j]) as i64);
        Self { normal, point: p.map(|c| c as i64) }
    }

    pub(super) fn axis(axis: usize, point: [f64; 3]) -> Self {
        let mut normal = [0; 3];
        normal[axis] = 1;
        Self { normal, point: point.map(|c| c as i64) }
    }

    /// The normal, each component rounded at most twice.
    #[inline]
    pub(crate) fn normal_f64(&self) -> DVec3 {
        DVec3::from_array(self.normal.map(rounded))
    }

    /// The scalar product of the normal and a point of the plane, rounded.
    #[cfg(test)]
    pub(crate) fn offset_f64(&self) -> f64 {
        self.along(self.point).to_f64()
    }

    /// A lattice point of the plane.
    pub(crate) fn point(&self) -> [i64; 3] {
        self.point
    }

    /// The normal.
    pub(crate) fn normal(&self) -> [i128; 3] {
        self.normal
    }

    /// The axis along which the normal is longest, the first of several: the one in which the
    /// plane is least steep.
    pub(crate) fn main_axis(&self) -> usize {
        let size = |axis: usize| self.normal[axis].unsigned_abs();
        (1..3).fold(0, |best, axis| if size(axis) > size(best) { axis } else { best })
    }

    /// The signed distance of a lattice point times the length of the normal.
    #[inline]
    pub(crate) fn at(&self, x: &[f64; 3]) -> Int<3> {
        self.along(std::array::from_fn(|i| x[i] as i64 - self.point[i]))
    }

    /// The same in 128 bits: right but for multiples of 2¹²⁸, whatever its parts are.
    #[inline]
    pub(super) fn last_bits_at(&self, x: &[f64; 3]) -> i128 {
        let terms = self.normal.iter().zip(x).zip(self.point);
        terms.fold(0, |sum, ((component, &x), through)| {
            sum.wrapping_add(component.wrapping_mul(i128::from(x as i64 - through)))
        })
    }

    /// Whether the signed distance of a lattice point times the length of the normal is at most `most`
    /// in magnitude, which is below 2¹¹⁸: exact. `rounded` is the normal in `f64`.
    #[cfg(feature = "save")]
    #[inline]
    pub(crate) fn is_within(&self, most: u128, rounded: &[f64; 3], x: &[f64; 3]) -> bool {
        // The products are below 2¹⁵⁸, and all of their roundings together below 2¹¹⁰. So this tells what
        // 128 bits cannot hold; what is left, they do.
        let terms = rounded.iter().zip(x).zip(self.point);
        let off: f64 = terms.map(|((n, x), through)| n * (x - through as f64)).sum();
        off.abs() < (1u128 << 120) as f64 && self.last_bits_at(x).unsigned_abs() <= most
    }

    /// The scalar product of the normal and a direction of components below 2⁶².
    #[inline]
    pub(crate) fn along(&self, direction: [i64; 3]) -> Int<3> {
        dot(self.normal, direction)
    }
}

/// The scalar product of vectors: components below 2¹¹⁸ by components below 2⁶², together below 2¹⁹⁰.
#[inline]
pub(crate) fn dot(vector: [i128; 3], direction: [i64; 3]) -> Int<3> {
    // The parts and products of the components fit 64 and 128 bits.
    let (mut high, mut low) = (0i128, 0i128);
    for (component, step) in vector.into_iter().zip(direction) {
        high += i128::from((component >> LOW_BITS) as i64) * i128::from(step);
        low += i128::from((component & LOW) as i64) * i128::from(step);
    }
    high += low >> LOW_BITS;
    let (low, high_bits) = ((low & LOW) as u64, high as u128);
    let last = (high >> (128 - LOW_BITS)) as u64;
    Int::from_limbs([
        low | (high_bits << LOW_BITS) as u64,
        (high_bits >> (64 - LOW_BITS)) as u64,
        last,
    ])
}

/// A number below 2¹²⁶, rounded at most twice. By parts, because a conversion of 128 bits calls a
/// function; they have one sign, so nothing cancels.
#[inline]
pub(super) fn rounded(number: i128) -> f64 {
    let size = number.unsigned_abs();
    let (high, low) = ((size >> 62) as i64, (size & ((1 << 62) - 1)) as i64);
    let size = high as f64 * (1u64 << 62) as f64 + low as f64;
    if number < 0 { -size } else { size }
}

/// The sign of a quotient, from the signs of its numerator and its denominator.
#[inline]
pub(crate) fn relative_to(numerator: Ordering, denominator: Ordering) -> Ordering {
    if denominator.is_lt() { numerator.reverse() } else { numerator }
}

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
        let mut steps = nearest(value / normal[*axis]);
        // Less than the slope, so no more bits are needed.
        let rest = last_bits.wrapping_sub(slope.wrapping_mul(i128::from(steps as i64)));
        if rest.unsigned_abs() > slope.unsigned_abs() / 2 {
            steps += if (rest < 0) == (slope < 0) { 1.0 } else { -1.0 };
        }
        Off { distance: value.abs() / normal.length(), steps }
    }
}

impl Faces {
    /// Moves the corners of the last face along `axis` to the lattice points nearest to its plane.
    /// Gives how far the furthest was off it, in lattice units, rounded; 0 only if all were exactly on
    /// it.
    pub(crate) fn flatten_last(&mut self, axis: usize) -> f64 {
        let face = self.faces.len() as u32 - 1;
        let triangle = self.reference_triangle(face);
        let flattener = Flattener::new(triangle.map(|corner| self.corner(corner)), axis);
        let mut furthest = 0.0f64;
        for corner in self.corner_range(face) {
            if triangle.contains(&(corner as u32)) {
                continue;
            }
            let point = self.corners[corner];
            let Off { distance, steps } = flattener.off(&point);
            furthest = furthest.max(distance);
            if steps != 0.0 {
                self.moved.push((corner as u32, point));
                self.corners[corner][axis] -= steps;
            }
        }
        furthest
    }
}

#[cfg(test)]
mod tests {
    use super::Plane;

    /// Of every size, and of both signs: components near 0 as well.
    #[test]
    fn rounded_normals_are_off_by_two_roundings_at_most() {
        let mut random = crate::random::SplitMix64::new(3);
        for shift in (0..106).flat_map(|shift| [shift; 20]) {
            let normal = [(); 3].map(|()| {
                let size =
                    (u128::from(random.next()) << 64 | u128::from(random.next())) >> (22 + shift);
                if random.next() & 1 == 0 { size as i128 } else { -(size as i128) }
            });
            let rounded = Plane { normal, point: [0; 3] }.normal_f64().to_array();
            for (exact, rounded) in normal.into_iter().zip(rounded) {
                // The conversion of the language rounds once.
                let error = (rounded - exact as f64).abs();
                assert!(error <= f64::EPSILON * (exact as f64).abs(), "{exact} {rounded}");
            }
        }
    }

    /// Corners at every distance from their plane, 128 bits and more of it, against `at`.
    #[cfg(feature = "save")]
    #[test]
    fn within_is_exact() {
        use crate::exact::{Int, RoundedNormal};

        let mut random = crate::random::SplitMix64::new(9);
        let mut told = [0; 2];
        for round in 0..40_000 {
            let size = 2f64.powf(random.range(2.0, 51.0));
            let mut point = || [(); 3].map(|()| random.range(-size, size).round());
            let (triangle, mut x) = ([point(), point(), point()], point());
            let plane = Plane::through(triangle);
            let axis = plane.main_axis();
            let most = plane.normal()[axis].unsigned_abs() / 2;
            if round % 4 > 0 {
                // Near the plane, or a multiple of 2^k steps off it.
                let normal = plane.normal_f64().to_array();
                let off: f64 = (0..3).map(|i| normal[i] * (x[i] - triangle[0][i])).sum();
                x[axis] = (x[axis] - off / normal[axis]).round() + f64::from(round % 4 - 2);
                if x[axis].is_nan() || x[axis].abs() > 2.0 * size {
                    continue;
                }
            }
            let off = plane.at(&x);
            let off = if off.is_negative() { -off } else { off };
            for most in [most, 0] {
                let exact = !(Int::<3>::from(most as i128) - off).is_negative();
                let found = plane.is_within(most, &RoundedNormal::through(triangle).normal, &x);
                assert_eq!(found, exact, "{triangle:?} {x:?}");
                told[usize::from(found)] += 1;
            }
        }
        assert!(told[0] > 5000 && told[1] > 2000, "{told:?}");
    }

    #[test]
    fn of_equally_long_components_the_first_is_the_main_axis() {
        let main_axis = |normal| Plane { normal, point: [0; 3] }.main_axis();
        for (normal, axis) in [
            ([5, 5, 5], 0),
            ([5, -5, 5], 0),
            ([-5, 5, 1], 0),
            ([1, 5, -5], 1),
            ([1, -2, 3], 2),
            ([0, 0, -1], 2),
        ] {
            assert_eq!(main_axis(normal), axis, "{normal:?}");
        }
    }
}

#[cfg(test)]
mod normal_tests {
    use glam::DVec3;

    use super::{Plane, cross};
    use super::{RoundedNormal, have_area};
    use crate::exact::lattice::LIMIT;
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
