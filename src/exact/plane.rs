//! Planes of faces, in integers and rounded; moving corners onto planes.

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

/// Components of a normal are divided into parts of this many bits. The sum of three products of these parts
/// with differences of coordinates fits 128 bits.
pub(super) const LOW_BITS: u32 = 56;
pub(super) const LOW: i128 = (1 << LOW_BITS) - 1;

/// A plane in integers: a normal and a lattice point on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    normal: [i128; 3],
    point: [i64; 3],
}

impl Plane {
    /// The plane through three lattice points; its front is the side from which the points are
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

    /// The plane perpendicular to an axis, through a lattice point.
    pub(crate) fn axis(axis: usize, point: [f64; 3]) -> Self {
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

    /// The axis along which the normal is longest: in this axis the plane is least steep.
    pub(crate) fn dominant_axis(&self) -> usize {
        largest(self.normal.map(i128::unsigned_abs))
    }

    /// The signed distance of a lattice point times the length of the normal.
    #[inline]
    pub(crate) fn at(&self, x: &[f64; 3]) -> Int<3> {
        self.along(std::array::from_fn(|i| x[i] as i64 - self.point[i]))
    }

    /// The value of [`at`](Self::at) modulo 2¹²⁸.
    #[inline]
    pub(super) fn last_bits_at(&self, x: &[f64; 3]) -> i128 {
        let terms = self.normal.iter().zip(x).zip(self.point);
        terms.fold(0, |sum, ((component, &x), through)| {
            sum.wrapping_add(component.wrapping_mul(i128::from(x as i64 - through)))
        })
    }

    /// Whether the signed distance of a lattice point times the length of the normal is at most `most` in
    /// magnitude, exactly. `most` is below 2¹¹⁸; `rounded` is the normal in `f64`.
    #[cfg(feature = "save")]
    #[inline]
    pub(crate) fn is_within(&self, most: u128, rounded: &[f64; 3], x: &[f64; 3]) -> bool {
        // The products are below 2¹⁵⁸, and the sum of their rounding errors below 2¹¹⁰. So the rounded value
        // decides the cases that do not fit 128 bits.
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

/// The scalar product of a vector with components below 2¹¹⁸ and a direction with components below 2⁶². The
/// product is below 2¹⁹⁰.
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

/// Converts a number below 2¹²⁶ to `f64`, rounded at most twice. The number is converted in two parts,
/// because a conversion of 128 bits calls a function. The parts have the same sign, so nothing cancels.
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

/// A rounded normal is used if its `size` is at most this many times its longest component; otherwise too
/// many bits were cancelled, and integers compute it. Too large: normals are used whose errors exceed the
/// bounds that their users allow, such as 10⁻⁹ for the coplanar tolerance. Too small: more normals are
/// computed in integers.
const CANCELLED: f64 = (1u64 << 18) as f64;

/// The vector product (q − p) × (r − p) of three lattice points, in `f64`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundedNormal {
    /// A component is the difference of two products. The component is off by at most 2⁻⁵² of the sum of the
    /// products' magnitudes, because the products and the difference are rounded.
    pub(crate) normal: [f64; 3],
    /// The sum, over the three components, of the magnitudes of the component's two products.
    pub(crate) size: f64,
}

impl RoundedNormal {
    /// The rounded normal of the plane through three lattice points.
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

    /// The axis along which the normal is longest.
    #[inline]
    pub(crate) fn dominant_axis(&self) -> usize {
        largest(self.normal.map(f64::abs))
    }
}

/// The axis of the largest size. Of equal sizes, the first axis.
#[inline]
pub(super) fn largest<T: PartialOrd>([x, y, z]: [T; 3]) -> usize {
    let (axis, size) = if y > x { (1, y) } else { (0, x) };
    if z > size { 2 } else { axis }
}

/// Whether three lattice points are not collinear, exactly.
#[inline]
pub(crate) fn have_area(corners: [[f64; 3]; 3]) -> bool {
    let RoundedNormal { normal, size } = RoundedNormal::through(corners);
    let [p, q, r] = corners;
    normal.iter().any(|c| c.abs() > f64::EPSILON * size) || cross(p, q, r) != [0; 3]
}

/// Whether an outline of `n` lattice points is convex and winds once, seen along an axis, exactly.
pub(crate) fn is_convex(n: usize, at: impl Fn(usize) -> [f64; 3], axis: usize) -> bool {
    if n < 3 {
        return false;
    }
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let point = |k: usize| {
        let point = at(if k < n { k } else { k - n });
        [point[x], point[y]]
    };
    if n == 4 && turns_one_way(std::array::from_fn(point)) {
        return true;
    }
    let ascending = |s: [f64; 2]| s[0] > 0.0 || (s[0] == 0.0 && s[1] > 0.0);
    let (mut here, mut next) = (point(0), point(1));
    let (mut rises, mut turn) = (0, Ordering::Equal);
    for then in (2..n + 2).map(point) {
        let (a, b) = (step(here, next), step(next, then));
        (here, next) = (next, then);
        // The projection puts two consecutive corners on one point: no direction to turn from.
        if a == [0.0; 2] || b == [0.0; 2] {
            return false;
        }
        let Some(sign) = turn_of(a, b) else { return false };
        if sign.is_ne() {
            if sign == turn.reverse() {
                return false;
            }
            turn = sign;
        }
        rises += u32::from(!ascending(a) && ascending(b));
    }
    // The outline turns only one way. In each winding it changes once from descending to ascending.
    rises == 1
}

#[inline]
fn step(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

/// Whether four corners certainly turn the same way. Then the corners wind once: each turn is less than half
/// a turn, and all four together are a whole number of turns.
#[inline]
pub(crate) fn turns_one_way(points: [[f64; 2]; 4]) -> bool {
    let steps: [_; 4] = std::array::from_fn(|k| step(points[k], points[(k + 1) % 4]));
    // No branches: for most faces they would be unpredictable.
    let (mut left, mut right) = (true, true);
    for k in 0..4 {
        let (a, b) = (steps[k], steps[(k + 1) % 4]);
        let (one, other) = (a[0] * b[1], a[1] * b[0]);
        let (turn, bound) = (one - other, f64::EPSILON * (one.abs() + other.abs()));
        left &= turn > bound;
        right &= -turn > bound;
    }
    left | right
}

/// The direction in which an outline turns from one step to the next; `None` if it turns back.
#[inline]
fn turn_of(a: [f64; 2], b: [f64; 2]) -> Option<Ordering> {
    let (left, right) = (a[0] * b[1], a[1] * b[0]);
    // Two products and their difference are rounded.
    if (left - right).abs() > f64::EPSILON * (left.abs() + right.abs()) {
        return Some(if left > right { Ordering::Greater } else { Ordering::Less });
    }
    let product = |p: f64, q: f64| i128::from(p as i64) * i128::from(q as i64);
    let turn = (product(a[0], b[1]) - product(a[1], b[0])).cmp(&0);
    let is_back = turn.is_eq() && product(a[0], b[0]) + product(a[1], b[1]) < 0;
    (!is_back).then_some(turn)
}

impl Faces {
    /// The normal of a face's plane: the error of each component is at most 2⁻³⁴ of the longest component.
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

    /// The length of the normal of a face's plane, with a relative error of at most 2⁻³⁴. `rounded` is the
    /// face's rounded normal.
    #[inline]
    pub(super) fn normal_length(&self, face: u32, rounded: &RoundedNormal) -> f64 {
        // Compared with the length, not with the longest component, which takes longer to find.
        let length = DVec3::from_array(rounded.normal).length();
        if rounded.size <= CANCELLED * length { length } else { self.exact_normal(face).length() }
    }

    #[cold]
    fn exact_normal(&self, face: u32) -> DVec3 {
        self.plane(PlaneId::face(face)).normal_f64()
    }
}

/// A plane's value at a lattice point certainly fits 128 bits if the rounded value is below this. Too large,
/// up to half the range: values that do not fit are used. Too small: more values are computed in full.
const FITS: f64 = (1u128 << 124) as f64;

/// Moves lattice points onto a plane, along the plane's dominant axis.
#[derive(Debug)]
pub(crate) struct Flattener {
    pub(crate) plane: Plane,
    pub(crate) axis: usize,
    through: DVec3,
    normal: DVec3,
}

/// The distance of a point from a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Off {
    /// The distance in lattice units, rounded; 0 only if the point is exactly on the plane.
    pub(crate) distance: f64,
    /// The number of whole steps along the axis that move the point towards the plane.
    pub(crate) steps: f64,
}

impl Flattener {
    /// A flattener onto the plane of three lattice points.
    #[inline]
    pub(crate) fn new(corners: [[f64; 3]; 3]) -> Self {
        let plane = Plane::through(corners);
        let (through, normal) = (DVec3::from(corners[0]), plane.normal_f64());
        Self { plane, axis: plane.dominant_axis(), through, normal }
    }

    /// The distance of a point from the plane.
    #[inline]
    pub(crate) fn off(&self, point: &[f64; 3]) -> Off {
        let Self { plane, axis, normal, .. } = self;
        let slope = plane.normal()[*axis];
        let last_bits = plane.last_bits_at(point);
        // Most points are so near the plane that its value there fits 128 bits. This rounded value is off by
        // less than 2¹¹⁰.
        let near = normal.dot(DVec3::from(*point) - self.through).abs();
        let value = if near < FITS { rounded(last_bits) } else { plane.at(point).to_f64() };
        if value == 0.0 {
            return Off { distance: 0.0, steps: 0.0 };
        }
        // The plane is value / slope steps away. Value, slope and quotient are rounded here, but within the
        // largest tolerance the quotient is below 2⁴⁵, so the nearest integer is the rounded quotient or the
        // next integer.
        let mut steps = nearest(value / normal[*axis]);
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
    use super::Plane;

    /// Normals of every size and sign, including components near 0.
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
                // The language's conversion rounds once.
                let error = (rounded - exact as f64).abs();
                assert!(error <= f64::EPSILON * (exact as f64).abs(), "{exact} {rounded}");
            }
        }
    }

    /// Compares with `at` for points at every distance from the plane, within 128 bits and beyond.
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
            let axis = plane.dominant_axis();
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
    fn of_equally_long_components_the_first_is_the_dominant_axis() {
        let dominant_axis = |normal| Plane { normal, point: [0; 3] }.dominant_axis();
        for (normal, axis) in [
            ([5, 5, 5], 0),
            ([5, -5, 5], 0),
            ([-5, 5, 1], 0),
            ([1, 5, -5], 1),
            ([1, -2, 3], 2),
            ([0, 0, -1], 2),
        ] {
            assert_eq!(dominant_axis(normal), axis, "{normal:?}");
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

    /// Triangles of every thickness: the third corner is near the line through the others, or on it.
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
    fn errors_of_rounded_normals_are_within_their_bounds() {
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
            // The triangle on its own lattice.
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

    /// Points are moved along z onto the plane 3z = x.
    #[test]
    fn only_points_on_the_plane_have_distance_0() {
        let flattener = Flattener::new([[0.0; 3], [3.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
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

#[cfg(test)]
mod convex_outline_tests {
    use std::cmp::Ordering;

    use super::{is_convex, turn_of, turns_one_way};
    use crate::random::SplitMix64;

    #[test]
    fn a_triangle_is_convex_if_it_has_an_area() {
        let convex = |triangle: [[f64; 3]; 3]| is_convex(3, |k| triangle[k], 2);
        for [x, y] in [[1.0, 2.0], [1.0, -2.0], [4.0, 1.0]] {
            assert!(convex([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [x, y, 5.0]]), "{x}, {y}");
            assert!(!convex([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [x, 0.0, 5.0]]), "{x}");
        }
    }

    #[test]
    fn an_outline_with_two_corners_on_one_point_of_the_view_is_not_convex() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        for start in 0..4 {
            let mut corners = square.to_vec();
            corners.rotate_left(start);
            let convex = |corners: &[[f64; 3]]| is_convex(corners.len(), |k| corners[k], 2);
            assert!(convex(&corners));
            let [x, y, _] = corners[3];
            corners.push([x, y, 1.0]);
            assert!(!convex(&corners), "{corners:?}");
        }
    }

    /// By integers: an outline of four corners is convex if all turns have the same sign.
    #[test]
    fn four_corners_that_certainly_turn_one_way_are_convex() {
        let mut random = SplitMix64::new(5);
        let mut told = [0; 2];
        for _ in 0..20_000 {
            let size = 2f64.powf(random.range(1.0, 50.0));
            let points = [(); 4].map(|()| [0, 1].map(|_| random.range(-size, size).round()));
            // The signs of the four areas by integers: all equal or not.
            let area = |[p, q, r]: [[f64; 2]; 3]| {
                let of = |a: f64, b: f64| (b - a) as i128;
                (of(p[0], q[0]) * of(p[1], r[1]) - of(p[1], q[1]) * of(p[0], r[0])).signum()
            };
            let turns = [0, 1, 2, 3].map(|k| area([0, 1, 2].map(|i| points[(k + i) % 4])));
            let one_way = turns == [1; 4] || turns == [-1; 4];
            let found = turns_one_way(points);
            assert!(one_way || !found, "{points:?}");
            told[usize::from(found)] += 1;
            let corners = points.map(|[x, y]| [x, y, 0.0]);
            // A projection without area can be convex although it does not turn only one way.
            if !turns.contains(&0) {
                assert_eq!(is_convex(4, |k| corners[k], 2), one_way, "{points:?}");
            }
        }
        assert!(told[0] > 2000 && told[1] > 2000, "{told:?}");
    }

    /// Steps that almost continue in one line, or turn back. Integers of 128 bits give the correct result.
    #[test]
    fn turns_are_exact() {
        let mut random = SplitMix64::new(4);
        let (mut straight, mut back) = (0, 0);
        for _ in 0..20_000 {
            let mut number = |most: f64| random.range(-most, most).round();
            let (size, nudge) = (number(9e6), number(1.4));
            let (unit, nudge) = ([size, size + number(1.4)], [nudge; 2]);
            let [s, t] = [number(9e7), number(9e7)];
            let a = unit.map(|c| c * s);
            let b = [unit[0] * t + nudge[0], unit[1] * t + nudge[1]];
            let [p, q] = [a, b].map(|step| step.map(|c| c as i128));
            let turn = (p[0] * q[1] - p[1] * q[0]).cmp(&0);
            let is_back = turn == Ordering::Equal && p[0] * q[0] + p[1] * q[1] < 0;
            assert_eq!(turn_of(a, b), (!is_back).then_some(turn), "{a:?} {b:?}");
            straight += usize::from(turn.is_eq() && !is_back);
            back += usize::from(is_back);
        }
        assert!(straight > 500 && back > 500, "{straight} {back}");
    }
}
