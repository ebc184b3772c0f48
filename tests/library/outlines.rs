//! The faces of a polygon keep its outline: their directed edges sum to the outline, and their vector areas to
//! the vector area of the polygon. Compared in integers, at the corners on the grid.

use binspace::{Preparation, Tolerance};
use testkit::checks::{area, assert_outline_kept, face_area};
use testkit::prelude::*;
use testkit::vector::{self, difference, product};

/// Prepares a polygon of numbers that are exact in `f32`.
fn prepare(polygon: &[DVec3], is_single: bool, tolerance: Tolerance) -> (Faces, Preparation) {
    let single: Vec<[f32; 3]> = polygon.iter().map(|p| p.as_vec3().to_array()).collect();
    match is_single {
        true => Faces::new([single], tolerance),
        false => Faces::new([polygon.to_vec()], tolerance),
    }
    .expect("finite")
}

const WAYS: [(bool, Tolerance); 4] = [
    (false, Tolerance::Default),
    (true, Tolerance::Default),
    (false, Tolerance::Length(0.0)),
    (true, Tolerance::Length(0.0)),
];

/// Whether all corners are in one plane, exactly. The coordinates are whole numbers.
fn is_planar(polygon: &[DVec3]) -> bool {
    let corners: Vec<[i128; 3]> = polygon.iter().map(|p| p.to_array().map(|c| c as i128)).collect();
    let [first, rest @ ..] = &corners[..] else { return true };
    let arms: Vec<[i128; 3]> = rest.iter().map(|p| difference(p, first)).collect();
    let normals = arms.iter().flat_map(|a| arms.iter().map(move |b| product(a, b)));
    let Some(normal) = normals.into_iter().find(|&normal| normal != [0; 3]) else { return true };
    arms.iter().all(|arm| vector::scalar(arm, &normal) == 0)
}

fn of<const N: usize>(corners: [[i32; 3]; N]) -> Corners {
    corners.map(|corner| DVec3::from(corner.map(f64::from))).to_vec()
}

/// In the projection along the main axis, these outlines cross themselves, or corners coincide. They lost
/// surface or a corner, or edges were replaced.
#[test]
fn bent_polygons_that_overlap_in_their_main_projection_keep_surface_and_edges() {
    let lost_surface = of([[1, -4, 3], [2, -4, -1], [-1, -4, 0], [2, 3, 3]]);
    let lost_corner = of([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 5]]);
    let replaced_edges = of([[-38, -14, 26], [25, -20, 13], [39, 10, 28], [-33, -20, 18]]);
    // Two steps: the riser between them has no area seen from above.
    let stairs = of([
        [0, 0, 0],
        [1, 0, 0],
        [1, 0, 1],
        [2, 0, 1],
        [2, 1, 1],
        [1, 1, 1],
        [1, 1, 0],
        [0, 1, 0],
    ]);
    for polygon in [lost_surface, lost_corner, replaced_edges, stairs] {
        for start in 0..polygon.len() {
            let mut polygon = polygon.clone();
            polygon.rotate_left(start);
            for (is_single, tolerance) in WAYS {
                let (faces, report) = prepare(&polygon, is_single, tolerance);
                assert_eq!((report.triangulated, report.crossing, report.dropped), (1, 0, 0));
                assert_eq!(faces.len(), polygon.len() - 2);
                assert_outline_kept(&faces, &polygon);
            }
        }
    }
}

/// The kinds of outlines that follow are bent in every way: on small grids, where corners coincide in
/// projections and touch edges; far apart; helices that wind several times; and rough terrain with a loop.
fn outline(kind: usize, dice: &mut Dice) -> Corners {
    let n = 4 + dice.below(6);
    match kind {
        0 | 1 => {
            let wide = 1 + dice.below(3) as u32;
            (0..n).map(|_| dice.whole_point(wide)).collect()
        }
        2 => (0..4).map(|_| dice.whole_point(40)).collect(),
        3 => (0..n).map(|_| dice.whole_point(1000)).collect(),
        4 => {
            let ramp = |k: usize| {
                let [x, y] =
                    [[9, 0], [6, 6], [0, 9], [-6, 6], [-9, 0], [-6, -6], [0, -9], [6, -6]][k % 8];
                dvec3(x.into(), y.into(), k as f64)
            };
            let turns = 9 + dice.below(20);
            let back = |p: DVec3| dvec3(p.x * 2.0, p.y * 2.0, p.z);
            (0..turns).map(ramp).chain((0..turns).rev().map(|k| back(ramp(k)))).collect()
        }
        _ => {
            let count = 20 + dice.below(60);
            let mut all: Vec<DVec3> = (0..count)
                .map(|k| {
                    let turn = k as f64 / count as f64 * std::f64::consts::TAU;
                    let radius = dice.range(600.0, 1000.0);
                    let height = dice.around_zero(30);
                    dvec3(turn.cos() * radius, turn.sin() * radius, height).round()
                })
                .collect();
            let at = dice.below(count - 4);
            all.swap(at, at + 1 + dice.below(3));
            all
        }
    }
}

#[test]
fn faces_keep_the_outline_of_every_bent_polygon() {
    let mut dice = Dice(44);
    let mut counts = [[0; 2]; 6];
    let mut crossing = 0;
    for round in 0..times(3000) {
        let kind = round % 6;
        let polygon = outline(kind, &mut dice);
        let is_planar = is_planar(&polygon);
        let (is_single, tolerance) = WAYS[round / 6 % 4];
        let (faces, report) = prepare(&polygon, is_single, tolerance);
        if is_planar && report.crossing > 0 {
            crossing += 1;
            continue;
        }
        assert_eq!(report.crossing, 0, "{polygon:?}");
        assert_eq!(report.flattened, 0, "{polygon:?}");
        assert_outline_kept(&faces, &polygon);
        counts[kind][usize::from(is_planar)] += 1;
    }
    enough!(counts.iter().all(|&[bent, _]| bent > 200); "{counts:?}");
    enough!(counts[0][1] > 5; "{counts:?}");
    assert!(crossing < times(3000) / 10, "{crossing}");
}

/// Twice the area of a face along each axis.
fn area_along(faces: &Faces, face: u32) -> [i128; 3] {
    let corners = faces.corners(face).iter().map(|p| p.map(|c| c as i128));
    let corners: Vec<[i128; 3]> = corners.collect();
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).fold([0; 3], |sum, (a, b)| vector::sum(&sum, &product(a, b)))
}

/// Seen along one axis, the outline is a star; along the others it may cross itself in any way, and may have
/// more area. No triangle is folded over the others.
#[test]
fn bent_outlines_with_one_simple_projection_are_not_folded() {
    let mut dice = Dice(47);
    let (mut quads, mut steep) = (0, 0);
    for round in 0..times(600) {
        let n = 4 + round % 7;
        let height = [30.0, 1000.0, 9000.0][round % 3];
        let mut polygon: Corners = (0..n)
            .map(|k| {
                let turn = (k as f64 + 0.6 * dice.share()) / n as f64 * std::f64::consts::TAU;
                let [radius, z] = [dice.range(80.0, 1000.0), dice.range(-height, height)];
                let mut p = [turn.cos() * radius, turn.sin() * radius, z];
                p.rotate_right(round / 3 % 3);
                DVec3::from_array(p).round()
            })
            .collect();
        polygon.rotate_left(dice.below(n));
        let (faces, report) = prepare(&polygon, false, Tolerance::Length(0.0));
        assert_eq!((faces.len(), report.crossing), (n - 2, 0), "{polygon:?}");
        let areas: Vec<_> = (0..faces.len() as u32).map(|face| area_along(&faces, face)).collect();
        let face_one_way = |axis: usize| {
            let signs = areas.iter().map(|area| area[axis].signum()).collect::<Vec<_>>();
            signs[0] != 0 && signs.iter().all(|&sign| sign == signs[0])
        };
        assert!((0..3).any(face_one_way), "{polygon:?}");
        quads += usize::from(n == 4);
        steep += usize::from((0..3).filter(|&axis| face_one_way(axis)).count() == 1);
    }
    enough!(quads > 50, steep > 100; "{quads} {steep}");
}

/// Whether two sides of a quad cross, seen along an axis.
fn crosses_along(axis: usize, quad: &[DVec3]) -> bool {
    let at = |k: usize| [(axis + 1) % 3, (axis + 2) % 3].map(|i| quad[k % 4][i] as i128);
    let turn = |a: usize, b: usize, c: usize| {
        let [a, b, c] = [a, b, c].map(at);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).signum()
    };
    (0..2).any(|k| {
        let [a, b, c, d] = [k, k + 1, k + 2, k + 3];
        turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0
    })
}

/// The area by Heron's formula.
fn area_of_sides([a, b, c]: [DVec3; 3]) -> f64 {
    let [p, q, r] = [a.distance(b), b.distance(c), c.distance(a)];
    let half = 0.5 * (p + q + r);
    (half * (half - p) * (half - q) * (half - r)).max(0.0).sqrt()
}

#[test]
fn quads_that_cross_themselves_from_all_sides_have_the_least_surface() {
    let (mut dice, mut count) = (Dice(48), [0; 2]);
    for _ in 0..times(3000) {
        let quad: Corners = (0..4).map(|_| dice.whole_point(40)).collect();
        if !(0..3).all(|axis| crosses_along(axis, &quad)) {
            continue;
        }
        let [a, b, c, d] = [quad[0], quad[1], quad[2], quad[3]];
        let ways = [[[a, b, c], [a, c, d]], [[b, c, d], [b, d, a]]];
        let [one, other]: [f64; 2] = ways.map(|way| way.map(area_of_sides).iter().sum());
        let (faces, _) = prepare(&quad, false, Tolerance::Length(0.0));
        let corners = |face: u32| [0, 1, 2].map(|k| quad[faces.corner_number(face, k) as usize]);
        let found: f64 = (0..faces.len() as u32).map(|face| area_of_sides(corners(face))).sum();
        assert!((found - one.min(other)).abs() < 1e-6 * found, "{quad:?}: {found}, {one} {other}");
        count[usize::from(other < one)] += 1;
    }
    enough!(count.iter().all(|&count| count > 20); "{count:?}");
}

/// The halves of the outline face both ways and have equal areas, so only the corners tell which way the whole
/// faces: its mirror image faces the other way.
#[test]
fn an_outline_whose_areas_cancel_is_mirrored_with_its_faces() {
    let bow = [[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0]];
    let up = |bow: Corners| {
        let (faces, report) = prepare(&bow, false, Tolerance::Default);
        assert_eq!((report.triangulated, report.crossing), (1, 1));
        let up = (0..faces.len() as u32).map(|face| area_along(&faces, face)[2].signum());
        up.collect::<Vec<_>>()
    };
    let [one, other] = [bow, bow.map(|[x, y, z]| [x, -y, z])].map(|bow| up(of(bow)));
    assert!(!one.is_empty() && one.iter().all(|&sign| sign == one[0]), "{one:?}");
    assert!(!other.is_empty() && other.iter().all(|&sign| sign == -one[0]), "{one:?} {other:?}");
}

/// Outlines that are planar but for the tolerance: some corners coincide only if seen from above.
#[test]
fn planar_outlines_keep_corners_that_coincide_only_in_the_projection() {
    let (mut dice, mut kept) = (Dice(49), 0);
    for _ in 0..times(4000) {
        let n = 5 + dice.below(5);
        let corner = |dice: &mut Dice| {
            let p = dice.whole_point(2);
            dvec3(1000.0 * p.x, 1000.0 * p.y, dice.around_zero(1))
        };
        let polygon: Corners = (0..n).map(|_| corner(&mut dice)).collect();
        let (faces, report) = prepare(&polygon, false, Tolerance::Length(5.0));
        if report.triangulated == 0 || report.crossing > 0 {
            continue;
        }
        assert_outline_kept(&faces, &polygon);
        let pairs = polygon.iter().flat_map(|p| polygon.iter().map(move |q| *p - *q));
        kept += usize::from(pairs.into_iter().any(|d| d.x == 0.0 && d.y == 0.0 && d.z != 0.0));
    }
    enough!(kept > 100; "{kept}");
}

/// A loop in a large bent outline changes only its neighbourhood: few triangles face down.
#[test]
fn a_loop_in_a_bent_outline_is_cut_off() {
    let count = 400;
    let mut dice = Dice(45);
    for _ in 0..times(10) {
        let mut all: Corners = (0..count)
            .map(|k| {
                let turn = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
                let radius = 10_000.0 + 1000.0 * dice.share();
                dvec3(turn.cos() * radius, turn.sin() * radius, dice.range(0.0, 300.0)).round()
            })
            .collect();
        let at = dice.below(count as usize - 3);
        all.swap(at, at + 2);
        let (faces, report) = prepare(&all, false, Tolerance::Default);
        assert_eq!((report.triangulated, report.crossing), (1, 0));
        assert_outline_kept(&faces, &all);
        let areas = (0..faces.len() as u32).map(|face| {
            let [.., z] = face_area(&faces, face);
            z.to_f64().value()
        });
        let (up, down): (Vec<f64>, Vec<f64>) = areas.partition(|&z| z > 0.0);
        let [up, down]: [f64; 2] = [up, down].map(|areas| areas.iter().sum());
        assert!(-down < up / 1000.0, "{down} of {up}");
    }
}

/// As many corners as take long: the work is bounded, and the outline is kept.
#[test]
fn a_large_tangle_comes_to_an_end() {
    let mut dice = Dice(46);
    let tangle: Corners = (0..3000).map(|_| dice.whole_point(1 << 20)).collect();
    let (faces, report) = prepare(&tangle, false, Tolerance::Length(0.0));
    assert_eq!((report.triangulated, report.crossing), (1, 0));
    let whole = area(&faces, &tangle);
    let zero = rational::point(DVec3::ZERO);
    let sum = (0..faces.len() as u32)
        .fold(zero, |sum, face| rational::sum(&sum, &face_area(&faces, face)));
    assert_eq!(sum, whole);
}
