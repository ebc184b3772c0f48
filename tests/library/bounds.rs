//! Tests that the filter's bounds are tight. Hill climbing searches for scenes on which a smaller bound would
//! decide wrongly. Such scenes exist, so the bound is hardly larger than necessary. The library decides them
//! correctly, so the bound is large enough there.

use binspace::internals::{PreparedPlane, Side, Vertex};
use dashu_int::IBig;
use num_traits::ToPrimitive;
use testkit::prelude::*;

/// The largest coordinate of a scene whose lattice step is 1.
const EDGE: i64 = (1 << 51) - 1;

type Triangle = [[i64; 3]; 3];

fn floats(triangle: &Triangle) -> Vec<[f64; 3]> {
    triangle.map(|p| p.map(|c| c as f64)).to_vec()
}

/// Faces of a triangle that spans the scene, so that no corner is moved, and of the given triangles.
fn faces(triangles: &[Triangle]) -> Faces {
    let all = [[[-EDGE; 3], [EDGE; 3], [EDGE, -EDGE, 0]]];
    let all: Vec<_> = all.iter().chain(triangles).map(floats).collect();
    let (faces, _) = Faces::new(&all, Some(0.0)).expect("finite");
    assert_eq!(faces.corners(1), floats(&triangles[0]), "moved");
    faces
}

/// The target of a search for planes: a place as numerators and a denominator, and the rounded place.
struct Place {
    over: [IBig; 3],
    denominator: IBig,
    rounded: [f64; 3],
}

impl Place {
    fn corner(at: [i64; 3]) -> Self {
        let rounded = at.map(|c| c as f64);
        Self { over: at.map(IBig::from), denominator: 1.into(), rounded }
    }

    /// The rounded coordinate minus the exact one.
    fn error(&self, axis: usize) -> f64 {
        let eighths = IBig::from((self.rounded[axis] * 8.0) as i128) * &self.denominator;
        let off: IBig = eighths - &self.over[axis] * 8;
        off.to_f64().value() / self.denominator.to_f64().value() / 8.0
    }
}

/// The exact value of a triangle's plane at a place, times the denominator; and the plane's normal.
fn exactly(triangle: &Triangle, place: &Place) -> (IBig, [i128; 3]) {
    let [p, q, r] = triangle;
    let arm = |to: &[i64; 3]| [0, 1, 2].map(|i| i128::from(to[i] - p[i]));
    let (u, w) = (arm(q), arm(r));
    let normal = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| u[j] * w[k] - u[k] * w[j]);
    let term = |i: usize| (&place.over[i] - p[i] * &place.denominator) * normal[i];
    (term(0) + term(1) + term(2), normal)
}

/// Shifts a triangle along an axis until its plane has the place just behind it, or on it.
fn shifted(mut triangle: Triangle, place: &Place, axis: usize) -> Option<Triangle> {
    let (value, normal) = exactly(&triangle, place);
    let step = &place.denominator * normal[axis];
    if step.is_zero() {
        return None;
    }
    // One more than the quotient rounded towards zero is enough for either sign.
    let mut steps = (&value / &step).to_i64()?;
    if (&value - &step * steps).is_positive() {
        steps += i64::from(step.is_positive()) - i64::from(step.is_negative());
    }
    for corner in &mut triangle {
        corner[axis] = corner[axis].checked_add(steps)?;
    }
    triangle.iter().flatten().all(|c| c.abs() <= EDGE).then_some(triangle)
}

/// The rounded distance of a place from a triangle's plane, in units of π, the sum of the products in the
/// plane's normal. The exact place is not in front of the plane, so a positive distance is an error.
fn distance(triangle: &Triangle, place: &Place) -> f64 {
    let faces = faces(&[*triangle]);
    let prepared = PreparedPlane::new(&faces, PlaneId::face(1));
    let [p, q, r] = triangle;
    let product = |i: usize, j: usize| ((q[i] - p[i]) as f64 * (r[j] - p[j]) as f64).abs();
    let pairs = [(0, 1), (1, 0), (1, 2), (2, 1), (2, 0), (0, 2)];
    let size: f64 = pairs.into_iter().map(|(i, j)| product(i, j)).sum();
    prepared.distance(place.rounded) / size
}

/// A start where all errors are largest. The plane is as steep along x as along z, goes through the far ends
/// of both, and is next to the place. Products are slightly above powers of two, where rounding loses most.
fn start(place: &Place, dice: &mut Dice) -> Option<Triangle> {
    let mut above = |power: u32, bits: u32| (1i64 << power) + dice.below(1 << bits) as i64;
    let [a, c] = [above(41, 33), above(41, 33)];
    let [s, t] = [above(25, 24), above(25, 23)];
    let [b, d] = [above(51, 40) - (1 << 41), above(51, 40) - (1 << 41)];
    let p = [-EDGE + (c << 1), s << 10, EDGE - (a << 1)];
    let u = [a, -b, s - a];
    let w = [c, d, t - c];
    let with = |arm: [i64; 3]| [0, 1, 2].map(|i| p[i] + arm[i]);
    let triangle = shifted([p, with(u), with(w)], place, 2)?;
    shifted(triangle, place, 1)
}

/// Hill climbing: changes one coordinate at a time, and keeps the result if it is no worse.
fn climb(place: &Place, steps: usize, dice: &mut Dice) -> Option<(f64, Triangle)> {
    let mut best = start(place, dice).map(|triangle| (distance(&triangle, place), triangle))?;
    for _ in 0..steps {
        let mut triangle = best.1;
        let change = (dice.roll() as i64) >> (22 + dice.below(41));
        let (corner, axis) = (dice.below(3), dice.below(3));
        triangle[corner][axis] = triangle[corner][axis].saturating_add(change);
        if triangle.iter().flatten().any(|c| c.abs() > EDGE) {
            continue;
        }
        let moved = shifted(triangle, place, 2).and_then(|moved| shifted(moved, place, 1));
        let Some(moved) = moved else { continue };
        let found = distance(&moved, place);
        if found >= best.0 {
            best = (found, moved);
        }
    }
    Some(best)
}

/// The best of several climbs.
fn sought(places: &[Place], climbs: usize, steps: usize) -> (f64, Triangle, &Place) {
    let mut dice = Dice(7);
    let tries = (0..climbs).filter_map(|i| {
        let place = &places[i % places.len()];
        climb(place, steps, &mut dice).map(|(found, triangle)| (found, triangle, place))
    });
    tries.max_by(|a, b| a.0.total_cmp(&b.0)).expect("a start")
}

/// Vertices where a plane perpendicular to y cuts an edge that spans the scene, in the corner of large x and
/// small z. Returns the vertices with the largest errors upwards along x and z.
fn cut_vertices(count: usize, dice: &mut Dice) -> Vec<(Triangle, i64, Place)> {
    let mut found: Vec<(f64, _)> = (0..20_000)
        .map(|_| {
            let mut near = |end: i64| end - end.signum() * dice.below(1 << 36) as i64;
            // Numerator and denominator are slightly above powers of two.
            let [a, b] = [[near(EDGE), 0, near(-EDGE)], [near(EDGE), 0, near(-EDGE)]];
            let mut above = || (1 << 50) + dice.below(1 << 38) as i64;
            let [a, b] = [[a[0], above(), a[2]], [b[0], -above(), b[2]]];
            let level = dice.below(1 << 49) as i64;
            let triangle = [a, b, [0, 0, EDGE]];
            let place = cut(&triangle, level);
            (place.error(0) + place.error(2), (triangle, level, place))
        })
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().take(count).map(|(_, vertex)| vertex).collect()
}

/// The vertex where a triangle's first edge reaches a height y.
fn vertex(triangle: &Triangle, level: i64, others: &[Triangle]) -> (Faces, Vertex) {
    let flat = [[0, level, 0], [1, level, 0], [0, level, 1]];
    let all: Vec<Triangle> = others.iter().copied().chain([*triangle, flat]).collect();
    let faces = faces(&all);
    let cut = others.len() as u32 + 1;
    let plane = PlaneId::axis(1, faces.corner_range(cut + 1).start as u32);
    let corner = Vertex::corner(&faces, cut, 0);
    let vertex = corner.cut(&faces, cut, &PreparedPlane::new(&faces, plane));
    (faces, vertex)
}

fn cut(triangle: &Triangle, level: i64) -> Place {
    let [a, b, _] = triangle;
    let [above, below] = [a[1] - level, level - b[1]].map(IBig::from);
    let over = [0, 1, 2].map(|i| &below * a[i] + &above * b[i]);
    let rounded = vertex(triangle, level, &[]).1.position();
    Place { over, denominator: above + below, rounded }
}

/// The bound in units of π.
fn bound(triangle: &Triangle) -> f64 {
    let faces = faces(&[*triangle]);
    let prepared = PreparedPlane::new(&faces, PlaneId::face(1));
    let place = Place::corner([EDGE, 0, 0]);
    let unit = prepared.distance(place.rounded) / distance(triangle, &place);
    prepared.slack() / unit
}

#[test]
fn a_bound_of_three_quarters_would_put_a_cut_vertex_on_the_wrong_side_of_a_plane() {
    let vertices = cut_vertices(16, &mut Dice(3));
    let places: Vec<Place> =
        vertices.iter().map(|(triangle, level, _)| cut(triangle, *level)).collect();
    let (found, plane, place) = sought(&places, 12, 6000);
    let share = found / bound(&plane);
    assert!((0.75..1.0).contains(&share), "{share}: {plane:?}");
    let at = places.iter().position(|other| std::ptr::eq(other, place)).expect("one of them");
    let (triangle, level, _) = &vertices[at];
    let (faces, vertex) = vertex(triangle, *level, &[plane]);
    let prepared = PreparedPlane::new(&faces, PlaneId::face(1));
    assert!(prepared.distance(vertex.position()) > 0.75 * prepared.slack());
    let side = prepared.side(&faces, 2, &vertex);
    assert_eq!(side, exactly(&plane, place).0.cmp(&IBig::zero()));
    assert!(side.is_le());
}

#[test]
fn a_bound_of_six_tenths_would_put_a_corner_on_the_wrong_side_of_a_plane() {
    let mut dice = Dice(1);
    let mut near = |end: i64| end - end.signum() * dice.below(1 << 36) as i64;
    let corners: Vec<_> = (0..32).map(|_| [near(EDGE), near(1 << 40), near(-EDGE)]).collect();
    let places: Vec<Place> = corners.iter().map(|&corner| Place::corner(corner)).collect();
    let (found, plane, place) = sought(&places, 12, 6000);
    let corner = place.rounded.map(|c| c as i64);
    let share = found / bound(&plane);
    assert!((0.6..1.0).contains(&share), "{share}: {plane:?}");
    let behind = [corner, [corner[0], 0, -EDGE], [0, 0, -EDGE]];
    let faces = faces(&[plane, behind]);
    let prepared = PreparedPlane::new(&faces, PlaneId::face(1));
    assert!(prepared.distance(place.rounded) > 0.6 * prepared.slack());
    let side = prepared.side(&faces, 2, &Vertex::corner(&faces, 2, 0));
    assert!(side.is_le() && side == exactly(&plane, place).0.cmp(&IBig::zero()));
}

/// A vertex may be rounded across the integer position of a plane perpendicular to an axis.
#[test]
fn a_bound_of_no_quarter_step_would_put_a_vertex_on_the_wrong_side_of_an_axis_s_plane() {
    let (mut crossed, mut worst) = (0, 0f64);
    for (triangle, level, place) in cut_vertices(400, &mut Dice(5)) {
        for axis in [0, 2] {
            worst = worst.max(place.error(axis).abs());
            let wall = place.rounded[axis].floor() as i64;
            let at = &place.over[axis] - wall * &place.denominator;
            if !at.is_positive() && place.rounded[axis] >= wall as f64 + 0.25 {
                let mut standing = [[0, 0, 0], [0, 1, 0], [1, 0, 1]];
                standing[0][axis] = wall;
                let (faces, vertex) = vertex(&triangle, level, &[standing]);
                let corner = faces.corner_range(1).start as u32;
                let prepared = PreparedPlane::new(&faces, PlaneId::axis(axis, corner));
                assert!(prepared.distance(vertex.position()) >= 0.25);
                let side = prepared.side(&faces, 2, &vertex);
                assert_eq!(side, at.cmp(&IBig::zero()));
                crossed += 1;
            }
        }
    }
    enough!(crossed >= 10; "{crossed}");
    assert!((0.3..0.5).contains(&worst), "{worst}");
}

/// The tolerance times the length of a normal is not an integer, but determinants are integers. The next
/// larger integer is beyond the tolerance, and the next smaller is not. The same holds for distances from a
/// plane perpendicular to an axis.
#[test]
fn a_corner_beyond_the_tolerance_by_less_than_a_step_of_the_determinant_is_beyond_it() {
    // The normal (1, 1, 1) and a normal along an axis: their lengths are √3 and 1.
    let tilted = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let flat = [[0, 0, 0], [1, 0, 0], [0, 1, 0]];
    for (plane, values, tolerance) in [(tilted, [1, 2], 1.0), (flat, [2, 3], 2.5)] {
        for (value, beyond) in values.into_iter().zip([false, true]) {
            // The sum of coordinates, or z, is off the plane by this value on either side.
            let off = |by: i64, x: i64| {
                if plane == flat { [x, 0, by] } else { [x, -x, 1 + by] }
            };
            let across = [off(value, 0), off(-value, 100), off(0, 9000)];
            let above =
                [off(value, 0), off(0, 100), [0, 9000, 1 - 9000 * i64::from(plane != flat)]];
            let below = above.map(|p| [p[0], p[1], p[2]]).map(|p| {
                let sum = if plane == flat { p[2] } else { p.iter().sum::<i64>() - 1 };
                [p[0], p[1], p[2] - 2 * sum]
            });
            let scene: Vec<_> =
                [[[-EDGE; 3], [EDGE; 3], [EDGE, -EDGE, 0]], plane, across, above, below]
                    .iter()
                    .map(floats)
                    .collect();
            let (faces, _) = Faces::new(&scene, Some(tolerance)).expect("finite");
            assert_eq!(faces.tolerance(), tolerance);
            let expected = if beyond {
                [Side::Spanning, Side::Front, Side::Back]
            } else {
                [Side::Coplanar; 3]
            };
            let level = PlaneId::axis(2, faces.corner_range(1).start as u32);
            for id in [PlaneId::face(1), level].into_iter().take(if plane == flat { 2 } else { 1 })
            {
                let prepared = PreparedPlane::new(&faces, id);
                let sides = [2, 3, 4].map(|face| prepared.classify(&faces, face, None));
                assert_eq!(sides, expected, "{value} off {plane:?}, {id:?}, tolerance {tolerance}");
            }
        }
    }
}

/// Without a tolerance, even the least distance counts. A corner is one lattice step off the plane of a
/// triangle with sides of one step, where the plane's value is 1.
#[test]
fn without_a_tolerance_one_step_off_a_plane_is_off_it() {
    let flat = [[0, 0, 0], [1, 0, 0], [0, 1, 0]];
    let mut decided = 0;
    for axis in 0..3 {
        for (step, expected) in [(1, Side::Front), (-1, Side::Back)] {
            let turned = |p: [i64; 3]| [0, 1, 2].map(|i| p[(i + axis) % 3]);
            let upright = [[0, 0, 0], [1, 0, 0], [0, 0, step]];
            let faces = faces(&[flat.map(turned), upright.map(turned)]);
            let prepared = PreparedPlane::new(&faces, PlaneId::face(1));
            assert_eq!(prepared.classify(&faces, 2, None), expected, "axis {axis}");
            decided += 1;
        }
    }
    assert_eq!(decided, 6);
}
