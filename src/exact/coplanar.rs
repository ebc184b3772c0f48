//! Whether two faces lie in one plane: the one place that decides it.
//!
//! Two faces are *coplanar* if every corner of the smaller face is within the tolerance of the larger face's
//! plane. The corners of all faces are rounded by the same amount, so the plane of a small face is less
//! certain. Extended across a large face, it can deviate from that face by many times the tolerance. So the
//! plane of the larger face decides. With τ = 0, faces are coplanar if their planes are equal.
//!
//! The relation is symmetric, but not transitive: two faces can be coplanar with a third and up to 2 τ apart.

use std::cmp::Ordering;

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::plane::RoundedNormal;
use super::{Faces, PlaneId, PreparedPlane, Side, Vertex};

/// The rounded vertices of a piece, in order.
pub(crate) type Outline = SmallVec<[[f64; 3]; 8]>;

/// The same points without one of their coordinates.
type FlatOutline = SmallVec<[DVec2; 8]>;

impl Faces {
    /// Whether one face is larger than another, by the areas of their reference triangles, rounded: the larger
    /// face has the more certain plane. Of faces of equal size, the earlier face is larger.
    #[inline]
    pub(crate) fn is_larger(&self, one: u32, other: u32) -> bool {
        let [a, b] = [one, other].map(|face| {
            DVec3::from_array(RoundedNormal::through(self.triangle(face)).normal).length_squared()
        });
        a > b || a == b && one < other
    }

    /// The order of two faces by size, the larger first. Faces without area are last.
    pub(crate) fn largest_first(&self, one: u32, other: u32) -> Ordering {
        let by_size = || match one == other {
            true => Ordering::Equal,
            false if self.is_larger(one, other) => Ordering::Less,
            false => Ordering::Greater,
        };
        self.has_area(other).cmp(&self.has_area(one)).then_with(by_size)
    }

    /// Whether two faces lie in one plane.
    pub(crate) fn are_coplanar(&self, one: u32, other: u32) -> bool {
        let [large, small] =
            if self.largest_first(one, other).is_le() { [one, other] } else { [other, one] };
        PreparedPlane::new(self, PlaneId::face(large)).contains(self, small)
    }

    /// Whether a face lies on another face's plane.
    #[cfg(feature = "drawing")]
    pub(crate) fn is_on_plane_of(&self, face: u32, other: u32) -> bool {
        PreparedPlane::new(self, PlaneId::face(other)).contains(self, face)
    }

    /// Whether two coplanar convex outlines overlap by more than the tolerance, seen along an axis, given a face in
    /// their plane: no side of one has the other entirely outside (the separating axes of convex polygons). Neighbours
    /// in a mesh, which share an edge, do not overlap. An outline of two points is a segment. Takes O(n) time for n
    /// corners.
    pub(crate) fn overlap(&self, face: u32, outlines: [&Outline; 2]) -> bool {
        let ([a, b], margin) = (self.flat(face, outlines), self.tolerance());
        !has_outside(&a, &b, margin) && !has_outside(&b, &a, margin)
    }

    /// Whether the first of two coplanar outlines lies in the second, or beyond its sides by no more than the tolerance.
    /// Takes O(n) time for n corners.
    pub(crate) fn is_inside(&self, face: u32, outlines: [&Outline; 2]) -> bool {
        let ([inner, outer], margin) = (self.flat(face, outlines), self.tolerance());
        sides(&outer).any(|[_, side]| is_long(side))
            && !extremes(&outer, &inner, -1.0).any(|outside| outside > margin)
    }

    /// Outlines without the coordinate along which a face's normal is longest.
    fn flat(&self, face: u32, outlines: [&Outline; 2]) -> [FlatOutline; 2] {
        let normal = self.normal(face).abs();
        let axis = (0..3).max_by(|&a, &b| normal[a].total_cmp(&normal[b])).unwrap_or(0);
        let flat = |p: &[f64; 3]| DVec2::new(p[(axis + 1) % 3], p[(axis + 2) % 3]);
        outlines.map(|outline| outline.iter().map(flat).collect())
    }
}

impl PreparedPlane {
    /// Whether every corner of a face is within the tolerance of the plane.
    #[inline]
    pub(crate) fn contains(&self, faces: &Faces, face: u32) -> bool {
        // Most planes are far from the first corner.
        self.distance(faces.corners(face)[0]).abs() <= self.slack()
            && match faces.has_area(face) {
                true => self.classify(faces, face, None),
                false => {
                    let ends: SmallVec<[Vertex; 2]> = Vertex::corners(faces, face).collect();
                    self.classify(faces, face, Some(&ends))
                }
            } == Side::Coplanar
    }
}

/// Vertices of outlines are rounded, by less than a lattice unit in each coordinate. The direction of a side shorter than
/// this, in lattice units, does not tell what is beyond it.
const ROUNDED: f64 = 8.0;

fn is_long(side: DVec2) -> bool {
    side.abs().max_element() >= ROUNDED
}

/// Whether some side of a convex outline has no point of another convex outline inside by more than a margin.
fn has_outside(outline: &[DVec2], other: &[DVec2], margin: f64) -> bool {
    extremes(outline, other, 1.0).any(|inside| inside <= margin)
}

/// For each long side of a convex outline, how far another convex outline reaches inside (`sign` 1) or outside (-1). From
/// one side to the next, the point that reaches furthest moves on around the other outline (rotating calipers: Toussaint,
/// “Solving geometric problems with the rotating calipers”, 1983).
fn extremes<'a>(
    outline: &'a [DVec2],
    other: &'a [DVec2],
    sign: f64,
) -> impl Iterator<Item = f64> + 'a {
    let same_turn = area(outline) * area(other) >= 0.0;
    let step = if same_turn { 1 } else { other.len() - 1 };
    let mut last: Option<(DVec2, usize)> = None;
    sides(outline).filter(|[_, side]| is_long(*side)).map(move |[a, side]| {
        let reach = |point: usize| sign * side.perp_dot(other[point] - a);
        // After a sharp turn, rounding could hide in which direction the way leads.
        let mut here = match last {
            Some((before, point)) if before.dot(side) > 0.0 => point,
            _ => (0..other.len()).max_by(|&p, &q| reach(p).total_cmp(&reach(q))).unwrap_or(0),
        };
        let (mut next, slack) = (here, ROUNDED * side.length());
        for _ in 0..other.len() {
            next = (next + step) % other.len();
            if reach(next) >= reach(here) {
                here = next;
            } else if reach(next) < reach(here) - slack {
                break;
            }
        }
        last = Some((side, here));
        reach(here) / side.length()
    })
}

/// Twice the signed area of an outline.
fn area(outline: &[DVec2]) -> f64 {
    // About the first point: about the origin, products of large coordinates would round a small area away.
    let origin = outline.first().copied().unwrap_or_default();
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| (*a - origin).perp_dot(*b - origin)).sum()
}

/// The sides of a convex outline, each with its first point and as a vector with the inside to its left.
fn sides(outline: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> {
    let turn = area(outline).signum();
    outline.iter().zip(outline.iter().cycle().skip(1)).map(move |(&a, &b)| [a, (b - a) * turn])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::PlaneId;
    use super::*;

    /// A small card on a large wall, both of `f32`: the wall leaves the card's plane by more than the
    /// tolerance.
    #[test]
    fn the_plane_of_the_larger_face_decides() {
        let point = |p: [f32; 3]| DVec3::from_array(p.map(f64::from));
        let card = [
            [0.16458091, -0.8256243, -0.50781417],
            [0.15240966, -0.82543993, -0.50566643],
            [0.15728892, -0.82035375, -0.5140212],
        ];
        let wall = [
            [0.21473855, -0.8454632, -0.48895735],
            [-0.3938244, -0.8362459, -0.38156936],
            [-0.14986128, -0.5819343, -0.7993085],
        ];
        let (faces, _) = Faces::new([card.map(point), wall.map(point)], Some(2.4e-7)).unwrap();
        let contains = |plane: u32, face: u32| {
            PreparedPlane::new(&faces, PlaneId::face(plane)).contains(&faces, face)
        };
        assert!(contains(1, 0) && !contains(0, 1) && faces.is_larger(1, 0));
        assert!(faces.are_coplanar(0, 1) && faces.are_coplanar(1, 0));
    }

    /// Two triangles of equal size across each other. Only the first one's plane is near all corners.
    #[test]
    fn of_faces_of_equal_size_the_plane_of_the_earlier_decides() {
        let flat = [[0.0, 0.0, 0.0], [8192.0, 0.0, 0.0], [0.0, 101.0, 0.0]];
        let tilted = [[0.0, 0.0, 0.0], [0.0, 8192.0, 0.0], [99.0, 0.0, 20.0]];
        for (both, expected) in [([flat, tilted], true), ([tilted, flat], false)] {
            let (faces, _) = Faces::new(both, Some(24.0)).unwrap();
            assert_eq!([faces.are_coplanar(0, 1), faces.are_coplanar(1, 0)], [expected; 2]);
        }
    }

    /// A small triangle over a large one has one corner just below or above the tolerance, each in turn.
    #[test]
    fn every_corner_counts_up_to_the_tolerance() {
        let wall = [[-8192.0, -8192.0, 0.0], [8192.0, -8192.0, 0.0], [0.0, 8192.0, 0.0]];
        for (turn, height) in (0..3).flat_map(|turn| [(turn, 23.0), (turn, -23.0), (turn, 25.0)]) {
            let mut card = [[0.0, 0.0, height], [64.0, 0.0, 0.0], [0.0, 64.0, 0.0]];
            card.rotate_left(turn);
            let (faces, _) = Faces::new([wall, card], Some(24.0)).unwrap();
            assert_eq!(faces.are_coplanar(0, 1), height < 24.0, "{turn}, {height}");
        }
    }

    /// Outlines of few and of many corners, segments and points, in both directions, against all pairs of a side and a
    /// point.
    #[test]
    fn outlines_overlap_as_all_pairs_of_sides_and_points_say() {
        let mut random = crate::random::SplitMix64::new(8);
        let mut found = [0; 2];
        for round in 0..4000 {
            let mut outline = || {
                let count = [1, 2, 3, 4, 7, 40][random.next() as usize % 6];
                let middle = DVec2::new(random.range(-1.0, 1.0), random.range(-1.0, 1.0));
                let (size, flat) = (random.range(0.1, 1.0), random.range(0.0, 1.0));
                let turn = DVec2::from_angle(random.range(0.0, TAU));
                let mut angles: Vec<f64> = (0..count).map(|_| random.range(0.0, TAU)).collect();
                angles.sort_by(f64::total_cmp);
                if random.next() >> 63 == 0 {
                    angles.reverse();
                }
                let corner = |&angle: &f64| {
                    let corner = DVec2::from_angle(angle) * DVec2::new(1.0, flat.powi(8));
                    (middle + turn.rotate(corner * size)) * f64::from(1 << 20)
                };
                angles.iter().map(corner).map(DVec2::round).collect::<Vec<_>>()
            };
            let [a, b] = [outline(), outline()];
            let is_outside = |a: &[DVec2], b: &[DVec2]| {
                let area: f64 = (2..a.len()).map(|i| (a[i - 1] - a[0]).perp_dot(a[i] - a[0])).sum();
                (0..a.len()).any(|i| {
                    let (from, to) = (a[i], a[(i + 1) % a.len()]);
                    let side = (to - from) * if area < 0.0 { -1.0 } else { 1.0 };
                    is_long(side) && b.iter().all(|&p| side.perp_dot(p - from) <= 0.0)
                })
            };
            let reaches_out = |a: &[DVec2], b: &[DVec2]| {
                sides(a).any(|[from, side]| {
                    is_long(side) && b.iter().any(|&p| side.perp_dot(p - from) < 0.0)
                })
            };
            for [a, b] in [[&a, &b], [&b, &a]] {
                let expected = is_outside(a, b);
                assert_eq!(has_outside(a, b, 0.0), expected, "{round}: {a:?} {b:?}");
                let outside = extremes(a, b, -1.0).any(|outside| outside > 0.0);
                assert_eq!(outside, reaches_out(a, b), "{round}: {a:?} {b:?}");
                found[usize::from(expected)] += 1;
            }
        }
        assert!(found.iter().all(|&count| count > 1000), "{found:?}");
    }

    /// Each corner is there up to three times, with differences of a unit, and coordinates are so large that rounding
    /// exceeds these: no corner far inside is missed, and no side without corners inside.
    #[test]
    fn corners_that_rounding_separates_do_not_end_the_search() {
        let mut random = crate::random::SplitMix64::new(9);
        let mut found = [0; 2];
        for round in 0..4000 {
            let mut outline = || {
                let middle = DVec2::new(random.range(-2.0, 2.0), random.range(-2.0, 2.0));
                let mut angles: Vec<f64> = (0..12).map(|_| random.range(0.0, TAU)).collect();
                angles.sort_by(f64::total_cmp);
                let mut corners = Vec::new();
                for angle in angles {
                    let corner = (middle + DVec2::from_angle(angle)) * 50_f64.exp2();
                    for _ in 0..=random.next() % 3 {
                        let step = [(); 2].map(|()| (random.next() % 3) as f64 - 1.0);
                        corners.push(corner.round() + DVec2::from_array(step));
                    }
                }
                corners
            };
            let [a, b] = [outline(), outline()];
            // The side with the fewest units inside.
            let deepest = |[from, side]: [DVec2; 2]| {
                let inside = b.iter().map(|&p| side.perp_dot(p - from)).fold(f64::MIN, f64::max);
                inside / side.length()
            };
            let long = sides(&a).filter(|[_, side]| side.length() > 1000.0);
            let least = long.map(deepest).fold(f64::MAX, f64::min);
            let is_outside = has_outside(&a, &b, 0.0);
            if least.abs() > 1000.0 {
                assert_eq!(is_outside, least < 0.0, "{round}: {least}");
                found[usize::from(is_outside)] += 1;
            }
        }
        assert!(found.iter().all(|&count| count > 500), "{found:?}");
    }

    /// A corner of a triangle is there twice, with a difference that is smaller than a rounding. Octagons inside.
    #[test]
    fn corners_that_rounding_separates_hide_no_overlap() {
        let wall = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from_array);
        let (faces, _) = Faces::new([wall], Some(0.0)).unwrap();
        let size = 42_f64.exp2();
        let triangle = [[8.0, 10.0], [-100.0, -50.0], [20.0, -50.0]].map(|p| p.map(|c| c * size));
        let outline = |corners: &[[f64; 2]]| -> Outline {
            corners.iter().map(|&[x, y]| [x, y, 0.0]).collect()
        };
        let once = outline(&triangle);
        let mut count = 0;
        for place in 0..25 * 27 {
            let (corner, step) = (place % 3, place / 3 % 9);
            let (x, y) = (f64::from(place / 27 % 5), f64::from(place / 135));
            let step = [step % 3, step / 3].map(|c| f64::from(c - 1) * (-7_f64).exp2());
            let mut twice = triangle.to_vec();
            let double = [0, 1].map(|axis| twice[corner as usize][axis] + step[axis]);
            twice.insert(corner as usize + 1, double);
            let twice = outline(&twice);
            let middle = DVec2::new(10.0 * x - 140.0, 15.0 * y - 60.0);
            let corner = |k: f64| middle + DVec2::from_angle((k + 0.5) * TAU / 8.0) * 60.0;
            let octagon: Outline =
                (0..8).map(|k| (corner(f64::from(k)) * size).extend(0.0).to_array()).collect();
            let expected = faces.overlap(0, [&octagon, &once]);
            assert_eq!(faces.overlap(0, [&octagon, &twice]), expected, "{place}");
            count += usize::from(expected);
        }
        assert!(count > 20 * 27, "{count}");
    }

    /// Small cards far from the origin of the grid.
    #[test]
    fn small_outlines_overlap_wherever_they_are() {
        let wall = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from_array);
        let (faces, _) = Faces::new([wall], Some(0.0)).unwrap();
        let mut random = crate::random::SplitMix64::new(2);
        for size in (10..40).map(|power| f64::from(power).exp2()) {
            for _ in 0..20 {
                let at = [(); 2].map(|()| (random.range(-1.0, 1.0) * 2f64.powi(50)).round());
                let card = |shift: f64| -> Outline {
                    let corners = [[0.0, 0.0], [1.0, 0.25], [0.75, 1.0], [-0.25, 0.75]];
                    let corner =
                        |c: [f64; 2]| [at[0] + size * (c[0] + shift), at[1] + size * c[1], 0.0];
                    corners.into_iter().map(corner).collect()
                };
                for (shift, expected) in [(0.0, true), (0.75, true), (1.5, false), (-1.5, false)] {
                    let both = [&card(0.0), &card(shift)];
                    assert_eq!(faces.overlap(0, both), expected, "{size} {at:?} {shift}");
                    assert_eq!(faces.is_inside(0, both), shift == 0.0, "{size} {at:?} {shift}");
                }
            }
        }
    }
}
