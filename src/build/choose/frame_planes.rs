//! The choice of planes for small sets in frames: own planes first, because each tree is ordered only once or
//! twice. Also contains the test whether two pieces cross.

use glam::DVec3;

use super::cost::{Cost, Counts};
use super::own::Shares;
use super::set::Set;
use super::tuning::FrameTuning;
use crate::build::piece::{Division, Piece};
use crate::exact::{Faces, LATTICE_LIMIT, PlaneId, RoundedNormal, Side, Vertex};

impl FrameTuning {
    /// The share of the set's box that a piece has to fill so that its plane can be used without further
    /// search.
    ///
    /// Corners in `f32` are rounded, so small polygons that were meant to lie in one plane have different
    /// planes. Far from such a polygon, the error of its plane exceeds the tolerance, and the plane would
    /// separate other polygons that were meant to lie in one plane.
    fn least_share(&self, faces: &Faces) -> f64 {
        if self.is_coarse(faces) { self.trusted_share } else { 0.0 }
    }

    /// Whether planes of small pieces cannot be trusted.
    fn is_coarse(&self, faces: &Faces) -> bool {
        faces.tolerance() > self.coarse * LATTICE_LIMIT
    }
}

/// Tries the planes of a few pieces, and returns the first good one. A plane is good if its piece is large
/// enough, and the plane either cuts nothing and divides the set evenly, or cuts few pieces that all cross
/// the plane's own piece. Writes the plane and the pieces' sides to `division`.
pub(super) fn find_own(
    set: &Set<'_>,
    frames: &FrameTuning,
    division: &mut Division,
) -> Option<PlaneId> {
    let (shares, least_share) = (Shares::of(set.size()), frames.least_share(set.faces));
    let own = set.sample(frames.probes).find(|&own| {
        shares.get(&set.pieces[own]) >= least_share
            && set.divide(set.own_plane(own), frames.crossings, division)
            && (Cost::of(&Counts::of(division)).divides_evenly(set.len(), frames.uneven)
                || cuts_what_crosses(set, own, division))
    });
    own.map(|own| set.own_plane(own))
}

/// Whether the plane of a piece cuts some pieces, and all of these cross the piece. Any tree has to cut one
/// of two crossing pieces.
fn cuts_what_crosses(set: &Set<'_>, own: usize, division: &Division) -> bool {
    let mut cut = (0..set.len()).filter(|&other| division.sides[other] == Side::Spanning);
    division.count(Side::Spanning) > 0
        && cut.all(|other| {
            let [own, other] = [own, other].map(|piece| &set.pieces[piece]);
            crosses(set.faces, set.arena, own, other)
        })
}

/// The largest error of a vertex's computed distance from a plane, in units of the `size` of the plane's
/// rounded normal. The vertex is rounded by less than 1 lattice unit. The difference between vertex and
/// plane's point is below 2⁵³ and rounded by ½. The errors of the normal's components add up to 2⁻⁵² of the
/// size, and the errors of the products and sums add as much again: 4 units.
const PLANE_OFF: f64 = 6.0;
/// The largest error of a coordinate of the difference of two vertices, in lattice units: each vertex is
/// rounded by less than 1, and the difference by ½.
const ARM_OFF: f64 = 2.5;
/// The largest rounding error of the determinant of three vectors, divided by the product of the vectors'
/// largest coordinates. The determinant is a sum of six products of three factors.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Whether two pieces certainly cross. Without a tolerance, any tree cuts one of two crossing pieces.
///
/// The plane of each piece cuts the other piece along a segment of the line in which the planes meet, and the
/// two segments overlap (Guigue and Devillers, “Fast and robust triangle-triangle overlap test using
/// orientation predicates”, 2003). Returns false if rounding may decide, for example if pieces only touch or
/// lie nearly in one plane.
fn crosses(faces: &Faces, arena: &[Vertex], a: &Piece, b: &Piece) -> bool {
    if (0..3).any(|axis| a.max[axis] < b.min[axis] || b.max[axis] < a.min[axis]) {
        return false;
    }
    let Some(one) = Ends::of(faces, arena, a, b.face) else { return false };
    let Some(other) = Ends::of(faces, arena, b, a.face) else { return false };
    // Follow the line so that in the plane of `a` the front of `b` is on the left. The last point of `a` is
    // where `a` enters the front of `b`; the first point of `b` is where `b` enters the front of `a`.
    let [p, q] = one.to_back;
    is_positive(one.to_front, other.to_front) && is_positive([q, p], other.to_back)
}

/// The edges in which a convex outline crosses a plane.
struct Ends {
    to_front: [DVec3; 2],
    to_back: [DVec3; 2],
}

impl Ends {
    /// The edges in which the outline of a piece crosses the plane of a face; `None` if the outline does not
    /// certainly cross the plane.
    fn of(faces: &Faces, arena: &[Vertex], piece: &Piece, plane: u32) -> Option<Self> {
        let triangle = faces.triangle(plane);
        let RoundedNormal { normal, size } = RoundedNormal::through(triangle);
        let (normal, through) = (DVec3::from(normal), DVec3::from(triangle[0]));
        let off = PLANE_OFF * size;
        let (mut to_front, mut to_back) = (None, None);
        let mut see = |(from, before): (DVec3, f64), (to, after): (DVec3, f64)| {
            if before < -off && after > off {
                to_front = Some([from, to]);
            } else if before > off && after < -off {
                to_back = Some([from, to]);
            }
        };
        let (mut first, mut last) = (None, None);
        piece.for_each_vertex(faces, arena, |vertex| {
            let vertex = DVec3::from(vertex);
            let here = (vertex, normal.dot(vertex - through));
            match last {
                None => first = Some(here),
                Some(last) => see(last, here),
            }
            last = Some(here);
        });
        see(last?, first?);
        Some(Self { to_front: to_front?, to_back: to_back? })
    }
}

/// Whether the volume that two edges span is certainly positive.
fn is_positive([p, q]: [DVec3; 2], [r, s]: [DVec3; 2]) -> bool {
    let arms = [q - p, r - p, s - p];
    let volume = arms[0].dot(arms[1].cross(arms[2]));
    // Six products, in each of which every factor may be off.
    let [a, b, c] = arms.map(|arm| arm.abs().max_element());
    let (product, most) = (a * b * c, (a + ARM_OFF) * (b + ARM_OFF) * (c + ARM_OFF));
    volume > 6.0 * (most - product) + ROUNDING * most
}

#[cfg(test)]
mod crossing_tests {
    use dashu_int::IBig;
    use glam::{DQuat, DVec3, EulerRot};
    use num_traits::FromPrimitive;

    use super::crosses;
    use crate::build::choose::tests::{Fixture, triangles};
    use crate::random::SplitMix64;

    fn cross(fixture: &Fixture) -> bool {
        crosses(&fixture.faces, &[], &fixture.pieces[0], &fixture.pieces[1])
    }

    /// A square of side 2 in the plane z = 0, and a square in the plane x = 0, which is moved along y and z.
    #[test]
    fn pieces_cross_where_an_edge_of_one_goes_through_the_other() {
        let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7);
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let level = square.map(|[x, y]| turn * DVec3::new(x, y, 0.0));
        for (y, z, expected) in [
            (0.1, 0.0, true),
            (0.1, 0.9, true),
            (1.9, 0.0, true),
            (-1.9, -0.9, true),
            (0.0, 1.1, false),
            (2.1, 0.0, false),
            (-2.1, 0.9, false),
            (2.1, -1.1, false),
        ] {
            let upright = square.map(|[u, v]| turn * DVec3::new(0.0, u + y, v + z));
            for polygons in [[level, upright], [upright, level]] {
                assert_eq!(cross(&Fixture::new(&polygons, 1e-9)), expected, "{y} {z}");
            }
        }
    }

    /// The volume that a point spans with three others, in integers.
    fn volume(point: &[IBig; 3], triangle: [&[IBig; 3]; 3]) -> IBig {
        let [a, b, c] = triangle.map(|p| [0, 1, 2].map(|axis: usize| &p[axis] - &point[axis]));
        let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
        &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
    }

    fn goes_through(one: &[[IBig; 3]], other: &[[IBig; 3]]) -> bool {
        let sign = |value: IBig| value.signum();
        (0..3).any(|k| {
            let (p, q) = (&one[k], &one[(k + 1) % 3]);
            let plane = [&other[0], &other[1], &other[2]];
            let sides = [p, q].map(|end| sign(volume(end, plane)));
            let turns = [0, 1, 2].map(|e| sign(volume(p, [q, &other[e], &other[(e + 1) % 3]])));
            &sides[0] * &sides[1] == IBig::from(-1)
                && !turns[0].is_zero()
                && turns.iter().all(|turn| *turn == turns[0])
        })
    }

    /// Half of the pairs nearly touch, at distances of many powers of two.
    #[test]
    fn pieces_that_certainly_cross_do_so_in_integers() {
        let mut random = SplitMix64::new(5);
        let (mut certain, mut near) = (0, 0);
        for round in 0..20_000 {
            let size = 2f64.powf(random.range(-40.0, 0.0));
            let [a, mut b] = [(); 2].map(|()| triangles(&mut random, 1, 1.0)[0]);
            if round % 2 == 0 {
                // Three points on the edges of the first triangle, each moved a little.
                b = [a[0].lerp(a[1], 0.3), a[2].lerp(a[1], 0.2), a[2].lerp(a[0], 0.4)];
                b = b.map(|corner| corner + random.point(-size, size));
            } else {
                // An edge that begins near an edge of the other.
                b[0] = a[0].lerp(a[1], random.range(0.1, 0.9)) + random.point(-size, size);
                b[1] = b[0] + random.point(-1.0, 1.0);
            }
            let fixture = Fixture::new(&[a, b], 0.0);
            if fixture.pieces.len() < 2 {
                continue;
            }
            let corners = [0, 1].map(|face| {
                let integer = |c: &f64| IBig::from_f64(*c).unwrap();
                let corners = fixture.faces.corners(face).iter();
                corners.map(|p| p.each_ref().map(integer)).collect::<Vec<_>>()
            });
            let exactly =
                goes_through(&corners[0], &corners[1]) || goes_through(&corners[1], &corners[0]);
            assert!(exactly || !cross(&fixture), "{a:?} {b:?}");
            certain += usize::from(cross(&fixture));
            near += usize::from(exactly && !cross(&fixture));
        }
        assert!(certain > 2000 && near > 20 && near < certain / 4, "{certain} {near}");
    }
}
