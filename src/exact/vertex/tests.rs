//! Leading bits compared with full numbers.

use dashu_int::IBig;
use num_traits::Signed;
use proptest::prelude::*;

use super::super::{Int, LATTICE_LIMIT};
use super::{ExactEdge, KEPT, Moved, Plane, Weights, integers, leading, meeting, nearest, on_edge};
use crate::random::SplitMix64;

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
    // Also points near one another, where planes are almost parallel.
    let near = (point(), prop::array::uniform3(prop::array::uniform3(-2..3i64))).prop_map(
        |(point, offsets)| {
            let limit = LATTICE_LIMIT;
            offsets.map(|o| [0, 1, 2].map(|i| (point[i] + o[i] as f64).clamp(-limit, limit)))
        },
    );
    prop_oneof![prop::array::uniform3(point()), near]
}

/// The value of a plane at a lattice point.
fn value(plane: &Plane, point: &[f64; 3]) -> IBig {
    let through = plane.point();
    let arm = |i: usize| IBig::from(point[i] as i64) - IBig::from(through[i]);
    (0..3).map(|i| IBig::from(plane.normal()[i]) * arm(i)).sum()
}

/// The distance of a position from the exact mean, in roundings: in units of 2⁻⁵³ of the lattice's size.
fn roundings(position: [f64; 3], points: &[[f64; 3]], weights: &[IBig]) -> f64 {
    let total: IBig = weights.iter().sum();
    let off = (0..3).map(|axis| {
        let terms = points.iter().zip(weights);
        let sum: IBig = terms.map(|(p, w)| IBig::from(p[axis] as i64) * w).sum();
        // The position in units of 2⁻⁸⁰, which keeps every bit that matters.
        let scaled = IBig::from((position[axis] * 2f64.powi(40)) as i128) << 40;
        let off: IBig = (scaled * &total - (sum << 80)) / &total;
        off.abs().to_f64().value() / 2f64.powi(80)
    });
    off.fold(0.0, f64::max) / LATTICE_LIMIT * 2f64.powi(53)
}

#[test]
fn a_bit_below_a_tie_decides_where_a_number_is_rounded_to() {
    // 71 bits: the last bit of the `f64` is 2^18.
    let (even, tie, up) = (1_i128 << 70, 1_i128 << 17, 1_i128 << 18);
    for (high, low, expected) in [
        (even + tie, 0, even),
        (even + tie, 1, even + up),
        (even + up + tie, 0, even + 2 * up),
        (-even - tie, 0, -even),
        // 1/2⁶² more than the negative tie.
        (-even - tie, 1, -even),
        (-even - tie - 1, u64::MAX >> 2, -even - up),
    ] {
        assert_eq!(nearest(high, low), expected as f64, "{high} {low}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, max_global_rejects: 200_000, ..ProptestConfig::default() })]

    #[test]
    fn leading_bits_are_those_of_the_number(plane in triangle(), points in triangle()) {
        let plane = Plane::through(plane);
        let (leading, dropped) = leading(&plane, points.map(integers));
        for (point, leads) in points.iter().zip(leading) {
            // The division of big integers rounds towards 0.
            let expected = value(&plane, point) / (IBig::from(1) << dropped as usize);
            prop_assert_eq!(IBig::from(leads), expected);
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
        let position = on_edge(&ExactEdge { ends, moved: None }, &plane);
        prop_assert!(position.is_some(), "the weights do not cancel");
        let off = roundings(position.unwrap_or_default(), &ends, &[-b, a]);
        prop_assert!(off <= 3.04, "{off}");
    }
}

/// A triangle and two almost equal planes. The weights of the point where the planes meet cancel to any
/// degree.
fn nearly_the_same(random: &mut SplitMix64) -> [[[f64; 3]; 3]; 3] {
    let mut corner = || (random.point(-1.0, 1.0) * (LATTICE_LIMIT - 1e13)).round();
    let (triangle, plane) = ([(); 3].map(|()| corner()), [(); 3].map(|()| corner()));
    let off = 2f64.powf(random.range(0.0, 43.0));
    let mut near = || plane.map(|c| (c + (random.point(-1.0, 1.0) * off).round()).to_array());
    [triangle.map(|corner| corner.to_array()), near(), near()]
}

/// For any cancellation, and on either side of the triangle's edges, results are right, and the same if the
/// triangle and the planes are reversed.
#[test]
fn positions_inside_are_right_or_undecided() {
    let mut random = SplitMix64::new(7);
    let (mut told, mut untold) = (0, 0);
    for turn in 0..20_000 {
        let [triangle, g, h] = nearly_the_same(&mut random);
        let planes = [g, h].map(Plane::through);
        let values = planes.map(|plane| triangle.map(|point| value(&plane, &point)));
        let [g, h] = &values;
        let weights = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| &g[j] * &h[k] - &g[k] * &h[j]);
        let total: IBig = weights.iter().sum();
        // Positions are needed only within the lattice.
        let is_near = !total.is_zero()
            && (0..3).all(|axis| {
                let terms = triangle.iter().zip(&weights);
                let sum: IBig = terms.map(|(p, w)| IBig::from(p[axis] as i64) * w).sum();
                (sum / &total).abs() <= IBig::from(LATTICE_LIMIT as i64)
            });
        let Some(position) = meeting(&triangle, &planes[0], &planes[1]) else {
            untold += 1;
            continue;
        };
        if is_near {
            told += 1;
            let off = roundings(position, &triangle, &weights);
            assert!(off <= 3.001, "{turn}: {off}");
        }
        let [a, b, c] = triangle;
        let back = meeting(&[a, c, b], &planes[1], &planes[0]);
        assert_eq!(back.map(|p| p.map(f64::to_bits)), Some(position.map(f64::to_bits)), "{turn}");
    }
    assert!(told > 10_000 && untold > 400, "{told} told, {untold} not");
}

/// Leading bits nearly always decide, and then compute the same results as all bits.
#[test]
fn leading_bits_nearly_always_decide() {
    let mut random = SplitMix64::new(5);
    let mut some = || {
        let mut point = || (random.point(-1.0, 1.0) * (LATTICE_LIMIT - 1.0)).round().to_array();
        [point(), point(), point()]
    };
    let mut told = 0;
    for _ in 0..2000 {
        let triangle = some();
        let planes = [some(), some()].map(Plane::through);
        let [g, h] = planes.map(|plane| triangle.map(|point| plane.at(&point)));
        let Some(position) = meeting(&triangle, &planes[0], &planes[1]) else { continue };
        told += 1;
        let full = Weights::meeting(triangle, &g, &h).position();
        for axis in 0..3 {
            let off = (position[axis] - full[axis]).abs();
            assert!(off <= 1.01 * f64::EPSILON * full[axis].abs(), "{position:?} {full:?}");
        }
    }
    assert_eq!(told, 2000);
}

type Corners = [[f64; 3]; 3];

/// A triangle, two points within half a step of its plane along its main axis, and another plane between
/// them.
fn moved_edge(random: &mut SplitMix64) -> (Corners, [[f64; 3]; 2], Corners) {
    let size = 2f64.powf(random.range(3.0, 50.9));
    let mut point = || (random.point(-1.0, 1.0) * size).round();
    let ([a, b, c], near) = ([(); 3].map(|()| point()), [(); 2].map(|()| point()));
    let normal = (b - a).cross(c - a);
    let axis = normal.abs().max_position();
    let ends = near.map(|mut end| {
        end[axis] = 0.0;
        end[axis] = (normal.dot(a - end) / normal[axis]).round();
        end.to_array()
    });
    let other = [(); 3].map(|()| (random.point(-1.0, 1.0) * size).round().to_array());
    ([a, b, c].map(|corner| corner.to_array()), ends, other)
}

fn edge(own: &Plane, ends: [[f64; 3]; 2]) -> ExactEdge {
    let offs = ends.map(|end| own.last_bits_at(&end));
    let moved = Moved { axis: own.dominant_axis(), offs, slope: own.normal()[own.dominant_axis()] };
    ExactEdge { ends, moved: Some(moved) }
}

/// The position is exactly on the edge between the moved ends, and the same if the triangle, the plane and
/// the edge are reversed.
#[test]
fn positions_on_moved_edges_are_right_or_undecided() {
    let mut random = SplitMix64::new(11);
    let (mut told, mut untold, mut moved) = (0, 0, 0);
    for turn in 0..20_000 {
        let (triangle, ends, other) = moved_edge(&mut random);
        let plane = Plane::through(other);
        let own = Plane::through(triangle);
        let (axis, [a, b]) = (own.dominant_axis(), ends);
        let offs = ends.map(|end| value(&own, &end));
        let slope = IBig::from(own.normal()[axis]);
        let is_near = offs.iter().all(|off| off.abs() * IBig::from(2) <= slope.abs());
        let is_inside = ends.iter().flatten().all(|c| c.abs() <= LATTICE_LIMIT);
        // Each end, times the slope, after its move onto the triangle's plane.
        let values = [0, 1].map(|i| {
            value(&plane, &ends[i]) * &slope - &offs[i] * IBig::from(plane.normal()[axis])
        });
        if !is_near || !is_inside || !(&values[0] * &values[1]).is_negative() {
            continue;
        }
        let Some(position) = on_edge(&edge(&own, ends), &plane) else {
            untold += 1;
            continue;
        };
        told += 1;
        moved += usize::from(offs.iter().any(|off| !off.is_zero()));
        let upright = Plane::upright(a, b, axis);
        let [g, h] = [&upright, &plane].map(|plane| triangle.map(|point| value(plane, &point)));
        let weights = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| &g[j] * &h[k] - &g[k] * &h[j]);
        let off = roundings(position, &triangle, &weights);
        assert!(off <= 3.04, "{turn}: {off}");
        let [p, q, r] = triangle;
        let [x, y, z] = other;
        let reverse = Plane::through([x, z, y]);
        let back = on_edge(&edge(&Plane::through([p, r, q]), [b, a]), &reverse);
        assert_eq!(back.map(|p| p.map(f64::to_bits)), Some(position.map(f64::to_bits)), "{turn}");
    }
    assert!(
        told > 3000 && moved > 2000 && untold > 100,
        "{told} told, {moved} moved, {untold} not"
    );
}
