//! Checks by brute force in big integers which polygons preparation drops, keeps whole and counts as
//! duplicates. Polygons have little or no area.

use binspace::internals::Lattice;
use dashu_int::IBig;
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use std::collections::{BTreeSet, HashMap};
use testkit::prelude::*;
use testkit::shapes;
use testkit::vector::{difference, is_zero, product, scalar};

type Vector = [IBig; 3];

/// The corners on the lattice, without repetitions of the corner before.
fn outline(lattice: &Lattice, polygon: &[DVec3]) -> Vec<Vector> {
    let mut corners: Vec<Vector> =
        polygon.iter().map(|&p| lattice.snap(p).map(|c| IBig::from(c as i64))).collect();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    corners
}

/// The corners on the lattice that occur in a face of the polygon; an empty list for a polygon without faces.
fn known_outline(faces: &Faces, polygon: usize, corners: &[DVec3]) -> Vec<Vector> {
    let own = (0..faces.len() as u32).filter(|&face| faces.polygon(face) == polygon);
    let numbers: BTreeSet<u32> = own
        .flat_map(|face| {
            (0..faces.corners(face).len() as u32).map(move |k| faces.corner_number(face, k))
        })
        .collect();
    let snap = |number| faces.lattice().snap(corners[number as usize]);
    numbers.into_iter().map(|number| snap(number).map(|c| IBig::from(c as i64))).collect()
}

/// The cross product of two edges from the first corner that are not collinear; `None` if all corners are
/// collinear.
fn plane(corners: &[Vector]) -> Option<Vector> {
    let arms: Vec<Vector> = corners.iter().map(|corner| difference(corner, &corners[0])).collect();
    let pairs = arms.iter().flat_map(|a| arms.iter().map(move |b| product(a, b)));
    pairs.into_iter().find(|normal| !is_zero(normal))
}

/// Whether every part of the outline is passed as often backwards as forwards. Then the outline has no area,
/// although its corners may not be collinear.
fn is_run_through_both_ways(corners: &[Vector]) -> bool {
    let mut runs: HashMap<[&Vector; 2], i32> = HashMap::new();
    for (i, a) in corners.iter().enumerate() {
        let b = &corners[(i + 1) % corners.len()];
        // Edges are divided where other corners lie on them.
        let arm = difference(b, a);
        let mut along: Vec<(IBig, &Vector)> = corners
            .iter()
            .filter(|corner| is_zero(&product(&arm, &difference(corner, a))))
            .map(|corner| (scalar(&arm, &difference(corner, a)), corner))
            .filter(|(at, _)| !at.is_negative() && *at <= scalar(&arm, &arm))
            .collect();
        along.sort();
        along.dedup();
        for pair in along.windows(2) {
            let [from, to] = [pair[0].1, pair[1].1];
            *runs.entry([from.min(to), from.max(to)]).or_default() +=
                if from < to { 1 } else { -1 };
        }
    }
    runs.values().all(|&run| run == 0)
}

/// Twice the vector area.
fn area(corners: &[Vector]) -> Vector {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).fold([0, 0, 0].map(IBig::from), |sum, (a, b)| {
        let part = product(a, b);
        std::array::from_fn(|i| &sum[i] + &part[i])
    })
}

/// Whether the corners are in one plane and on their convex hull, and go around their middle once.
fn is_convex(corners: &[Vector], normal: &Vector) -> bool {
    let flat = |corner: &Vector| scalar(normal, &difference(corner, &corners[0])).is_zero();
    if !corners.iter().all(flat) {
        return false;
    }
    let n = corners.len();
    let count = IBig::from(n);
    let sum = corners.iter().fold([0, 0, 0].map(IBig::from), |sum, corner| {
        std::array::from_fn(|i| &sum[i] + &corner[i])
    });
    let arms: Vec<Vector> =
        corners.iter().map(|c| std::array::from_fn(|i| &c[i] * &count - &sum[i])).collect();
    let turn = |a: &Vector, b: &Vector| scalar(normal, &product(a, b));
    let sign = turn(&arms[0], &arms[1]);
    let around = (0..n).map(|i| turn(&arms[i], &arms[(i + 1) % n]));
    if sign.is_zero() || around.into_iter().any(|t| t.is_zero() || t.sign() != sign.sign()) {
        return false;
    }
    // The number of times that the corners pass the first arm.
    let is_ahead = |arm: &Vector| {
        let across = turn(&arms[0], arm);
        if across.is_zero() {
            scalar(&arms[0], arm).is_positive()
        } else {
            across.sign() == sign.sign()
        }
    };
    let passes = (0..n).filter(|&i| !is_ahead(&arms[i]) && is_ahead(&arms[(i + 1) % n])).count();
    let on_rim = (0..n).all(|i| {
        let edge = difference(&corners[(i + 1) % n], &corners[i]);
        corners.iter().all(|c| {
            let t = turn(&edge, &difference(c, &corners[i]));
            t.is_zero() || t.sign() == sign.sign()
        })
    });
    passes == 1 && on_rim
}

/// Whether one outline equals another, from any corner and in either direction.
fn is_same(a: &[Vector], b: &[Vector]) -> bool {
    let n = a.len();
    let matches = |start: usize, step: usize| (0..n).all(|i| a[i] == b[(start + i * step) % n]);
    n == b.len() && (0..n).any(|start| matches(start, 1) || matches(start, n - 1))
}

/// The number of polygons of each kind.
#[derive(Debug, Default)]
struct Kinds {
    on_a_line: usize,
    /// Dropped polygons whose corners are not collinear: outlines that run out and back, and outlines whose
    /// parts cancel.
    folded: usize,
    cancelled: usize,
    whole: usize,
    triangulated: usize,
    /// Polygons whose area is within rounding of zero: 2⁻⁴⁰ of the square of their size.
    thin: usize,
    duplicates: usize,
}

fn check(kinds: &mut Kinds, polygons: &[Corners]) -> Result<(), TestCaseError> {
    let (faces, report) = Faces::new(polygons, Some(0.0)).expect("finite");
    let outlines: Vec<_> = polygons.iter().map(|p| outline(faces.lattice(), p)).collect();
    let known: Vec<_> =
        (0..polygons.len()).map(|i| known_outline(&faces, i, &polygons[i])).collect();
    let dropped: Vec<usize> = faces.dropped(report.polygons).collect();
    prop_assert_eq!(dropped.len(), report.dropped);
    let (mut triangulated, mut duplicates) = (0, 0);
    for (i, corners) in outlines.iter().enumerate() {
        let is_dropped = dropped.binary_search(&i).is_ok();
        let Some(normal) = plane(corners) else {
            prop_assert!(is_dropped, "polygon {i} is on a line: {corners:?}");
            kinds.on_a_line += 1;
            continue;
        };
        let area = area(corners);
        let square = |v: &Vector| scalar(v, v);
        let size =
            corners.iter().map(|c| square(&difference(c, &corners[0]))).max().expect("corners");
        kinds.thin += usize::from(square(&area) << 80 < &size * &size && !is_zero(&area));
        if is_zero(&area) {
            // If the outline only runs out and back, it has no area. Otherwise its parts face both ways and
            // cancel, and ear clipping gives the covered area.
            let is_fold = is_run_through_both_ways(corners);
            kinds.folded += usize::from(is_fold && is_dropped);
            kinds.cancelled += usize::from(!is_fold || !is_dropped);
            triangulated += usize::from(!is_dropped);
        } else {
            prop_assert!(!is_dropped, "polygon {i} has area: {corners:?}");
            let is_whole = corners.len() == 3 || is_convex(corners, &normal);
            let own = (0..faces.len() as u32).filter(|&face| faces.polygon(face) == i);
            prop_assert!(!is_whole || own.count() == 1, "polygon {i} is whole: {corners:?}");
            triangulated += usize::from(!is_whole);
            kinds.whole += usize::from(is_whole);
        }
        if is_dropped {
            continue;
        }
        duplicates += usize::from(known[..i].iter().any(|other| is_same(other, &known[i])));
    }
    prop_assert_eq!(report.triangulated, triangulated);
    prop_assert_eq!(faces.duplicates(), duplicates);
    kinds.triangulated += triangulated;
    kinds.duplicates += duplicates;
    Ok(())
}

/// Polygons of little or no area: with collinear corners, with corners off a line by ulps, with repeated
/// corners, running out and back, and needles. Also other polygons, some given twice.
fn thin(seed: u64, count: usize) -> Vec<Corners> {
    let mut dice = Dice(seed);
    let lattice = dice.below(2) == 0;
    let point = |dice: &mut Dice| {
        DVec3::from_array(
            [0; 3].map(|_| if lattice { dice.around_zero(6) } else { 2.0 * dice.share() - 1.0 }),
        )
    };
    let mut polygons: Vec<Corners> = vec![vec![DVec3::splat(-7.0), DVec3::splat(7.0), DVec3::X]];
    for _ in 0..count {
        let [a, b] = [point(&mut dice), point(&mut dice)];
        let corners = 3 + dice.below(4);
        let share = |dice: &mut Dice| dice.below(9) as f64 / 8.0;
        let mut polygon: Corners = match dice.below(6) {
            0 => (0..corners).map(|_| a + (b - a) * share(&mut dice)).collect(),
            1 => {
                // The outline runs out and back over some corners.
                let way: Corners = (0..corners).map(|_| point(&mut dice)).collect();
                let back = way[1..corners - 1].iter().rev();
                way.iter().chain(back).copied().collect()
            }
            2 => vec![a, b, a + (b - a) * share(&mut dice) + DVec3::Z * 2f64.powi(-48)],
            3 => {
                let c = point(&mut dice);
                vec![a, b, b + (c - b) * 0.5, c]
            }
            4 => polygons[dice.below(polygons.len())].clone(),
            _ => (0..corners).map(|_| point(&mut dice)).collect(),
        };
        if dice.below(3) == 0 {
            let k = dice.below(polygon.len());
            polygon.insert(k, polygon[k]);
        }
        if dice.below(3) == 0 {
            let (k, axis) = (dice.below(polygon.len()), dice.below(3));
            polygon[k][axis] = shapes::ulps_from(polygon[k][axis], dice.around_zero(3) as i32);
        }
        if dice.below(3) == 0 {
            let k = dice.below(polygon.len());
            polygon.rotate_left(k);
        }
        if dice.below(3) == 0 {
            polygon.reverse();
        }
        polygons.push(polygon);
    }
    polygons
}

#[test]
fn exactly_polygons_without_area_are_dropped_and_exactly_others_cut_up() {
    let seeds = (any::<u64>(), 1..24usize);
    let kinds = tally(file!(), 600, seeds, |kinds: &mut Kinds, (seed, count)| {
        check(kinds, &thin(seed, count))
    });
    let Kinds { on_a_line, folded, whole, triangulated, thin, duplicates, cancelled } = kinds;
    let least = [on_a_line, folded, whole, triangulated, thin, duplicates].into_iter().min();
    assert!(least > Some(200) && cancelled * 10 < folded, "{kinds:?}");
}

#[test]
fn dropped_polygons_of_hard_scenes_agree_with_brute_force() {
    let kinds = tally(file!(), 600, hard::scene(), |kinds: &mut Kinds, scene| {
        check(kinds, &scene.polygons)
    });
    let Kinds { on_a_line, whole, triangulated, duplicates, .. } = kinds;
    let least = [on_a_line, whole, triangulated, duplicates].into_iter().min();
    assert!(least > Some(10), "{kinds:?}");
}

/// In floats, no two corners of this polygon span an area with its first corner. In integers, one corner is
/// off the line of the others, and spans a triangle with two of them. Twice the area of this triangle is 1.
#[test]
fn a_polygon_whose_area_only_integers_find_is_kept() {
    const S: f64 = (1_u64 << 50) as f64;
    let [a, b] = [1_001_839_071_114_162.0, 862_809_303_082_285.0];
    let [c, d] = [361_461_402_778_337.0, 311_299_758_628_383.0];
    assert_eq!(a * d, b * c);
    let wall = [[-S, -S, -S], [S, -S, -S], [S, S, -S], [-S, S, -S]];
    let mut sliver = [[0.0, 0.0, 0.0], [c, d, 0.0], [a, b, 0.0], [-a, -b, 0.0]];
    for _ in 0..4 {
        let tree = BspTree::build([sliver, wall]).unwrap();
        assert_eq!(tree.dropped().count(), 0, "{sliver:?}");
        sliver.rotate_left(1);
    }
    let straight = [[0.0, 0.0, 0.0], [0.5 * S, 0.5 * S, 0.0], [S, S, 0.0], [-S, -S, 0.0]];
    assert!(BspTree::build([straight, wall]).unwrap().dropped().eq([0]));
}
