//! Leading bits against numbers in full.

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};
use proptest::prelude::*;

use super::super::{Int, LATTICE_LIMIT};
use super::{KEPT, Leading, Plane, meeting, nearest, on_edge, ratio};

/// Lattice coordinates of any size, often few bits or near the limit.
fn coordinate() -> impl Strategy<Value = f64> {
    let limit = LATTICE_LIMIT as i64;
    let any = prop_oneof![
        -3..4i64,
        -1000..1000i64,
        -limit..=limit,
        (limit - 9)..=limit,
        (-40i64..40).prop_map(|k| k << 43),
    ];
    any.prop_map(|c| c as f64)
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(coordinate())
}

fn triangle() -> impl Strategy<Value = [[f64; 3]; 3]> {
    // Near one another as well, where planes are all but parallel.
    let near = (point(), prop::array::uniform3(prop::array::uniform3(-2..3i64))).prop_map(
        |(point, offsets)| {
            let limit = LATTICE_LIMIT;
            offsets.map(|o| [0, 1, 2].map(|i| (point[i] + o[i] as f64).clamp(-limit, limit)))
        },
    );
    prop_oneof![prop::array::uniform3(point()), near]
}

/// A plane at a lattice point.
fn value(plane: &Plane, point: &[f64; 3]) -> BigInt {
    let through = plane.point();
    let arm = |i: usize| BigInt::from(point[i] as i64) - BigInt::from(through[i]);
    (0..3).map(|i| BigInt::from(plane.normal()[i]) * arm(i)).sum()
}

/// How far a position is from the exact mean, times 2⁵³ by the lattice's size: in roundings.
fn roundings(position: [f64; 3], points: &[[f64; 3]], weights: &[BigInt]) -> f64 {
    let total: BigInt = weights.iter().sum();
    let off = (0..3).map(|axis| {
        let terms = points.iter().zip(weights);
        let sum: BigInt = terms.map(|(p, w)| BigInt::from(p[axis] as i64) * w).sum();
        // The position in 2⁻⁸⁰ths, which holds every bit of it that matters.
        let scaled = BigInt::from((position[axis] * 2f64.powi(40)) as i128) << 40;
        let off: BigInt = (scaled * &total - (sum << 80)) / &total;
        off.abs().to_f64().unwrap_or(f64::INFINITY) / 2f64.powi(80)
    });
    off.fold(0.0, f64::max) / LATTICE_LIMIT * 2f64.powi(53)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, max_global_rejects: 200_000, ..ProptestConfig::default() })]

    #[test]
    fn leading_bits_are_those_of_the_number(plane in triangle(), points in triangle()) {
        let plane = Plane::through(plane);
        let leading = Leading::of(&plane, &points);
        for (point, leads) in points.iter().zip(leading.values) {
            prop_assert_eq!(BigInt::from(leads), value(&plane, point) >> leading.dropped);
            prop_assert!(leads.unsigned_abs() <= 1 << KEPT);
        }
    }

    #[test]
    fn a_number_in_two_parts_is_rounded_once(high in any::<i128>(), low in any::<u64>(), cut in 3..127) {
        let (high, low) = (high >> cut, low >> 2);
        let whole = Int::<3>::from(high).times::<1, 4>(&Int::from(1i64 << 62)) + Int::from(low as i64);
        prop_assert_eq!(nearest(high, low) * 2f64.powi(62), whole.to_f64());
    }

    #[test]
    fn positions_on_edges_are_within_three_roundings(ends in triangle(), plane in triangle()) {
        let (plane, ends) = (Plane::through(plane), [ends[0], ends[1]]);
        let [a, b] = [0, 1].map(|i| value(&plane, &ends[i]));
        prop_assume!((&a * &b).is_negative());
        let position = on_edge(&ends, &plane);
        prop_assert!(position.is_some(), "the weights do not cancel");
        let off = roundings(position.unwrap_or_default(), &ends, &[-b, a]);
        prop_assert!(off <= 3.01, "{off}");
    }

    #[test]
    fn positions_inside_are_within_three_roundings(
        triangle in triangle(), g in triangle(), h in triangle(),
    ) {
        let planes = [g, h].map(Plane::through);
        let [g, h] = planes.map(|plane| triangle.map(|point| value(&plane, &point)));
        let weights = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| &g[j] * &h[k] - &g[k] * &h[j]);
        let total: BigInt = weights.iter().sum();
        // Only points of the triangle are asked for.
        prop_assume!(!total.is_zero() && weights.iter().all(|w| !(w * &total).is_negative()));
        if let Some(position) = meeting(&triangle, &planes[0], &planes[1]) {
            let off = roundings(position, &triangle, &weights);
            prop_assert!(off <= 3.01, "{off}");
        }
    }
}

/// What is not told by leading bits is rare, and what is told is what all bits tell.
#[test]
fn leading_bits_nearly_always_tell() {
    let mut random = crate::random::SplitMix64::new(5);
    let mut some = || {
        let mut point = || (random.point(-1.0, 1.0) * (LATTICE_LIMIT - 1.0)).round().to_array();
        [point(), point(), point()]
    };
    let mut told = 0;
    for _ in 0..2000 {
        let triangle = some();
        let planes = [some(), some()].map(Plane::through);
        let [g, h] = planes.map(|plane| triangle.map(|point| plane.at(&point)));
        let weights: [Int<5>; 3] = [(1, 2), (2, 0), (0, 1)]
            .map(|(j, k)| g[j].times::<3, 5>(&h[k]) - g[k].times::<3, 5>(&h[j]));
        let Some(position) = meeting(&triangle, &planes[0], &planes[1]) else { continue };
        told += 1;
        let full = ratio(&triangle, &weights);
        for axis in 0..3 {
            let off = (position[axis] - full[axis]).abs();
            assert!(off <= 1.01 * f64::EPSILON * full[axis].abs(), "{position:?} {full:?}");
        }
    }
    assert_eq!(told, 2000);
}
