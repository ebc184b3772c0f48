//! The side of a plane on which a piece of a face lies. Rounded distances decide if their sign is certain (a
//! floating-point filter: Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
//! predicates", 1997); otherwise integers decide.
//!
//! These rules classify a piece against a plane. τ is the coplanar tolerance, and *corners* are the corners
//! of the whole face:
//!
//! - if no corner is further than τ from the plane, the piece is coplanar;
//! - if some corner is further than τ in front of the plane, but no corner is further than τ behind the
//!   plane, the piece is in front. With the sides exchanged, the piece is behind. So a piece is not cut if
//!   its face reaches across the plane by τ or less;
//! - otherwise the exact signs of the piece's own vertices decide, and the piece is cut if they differ.
//!
//! With τ = 0 every decision equals the decision of real arithmetic.

use std::cmp::Ordering;

use glam::DVec3;

use super::lattice::LIMIT;
use super::names::{PlaneId, PlaneKind, VertexId};
use super::plane::RoundedNormal;
use super::split::Vertex;
use super::{Faces, Int};

/// The side of a plane on which a piece of a [`PieceSet`](crate::choose::PieceSet) lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// No part of the piece is behind the plane.
    Front,
    /// No part of the piece is in front of the plane.
    Back,
    /// The piece lies entirely on the plane.
    Coplanar,
    /// Parts of the piece are on both sides of the plane, so the plane must cut the piece.
    Spanning,
}

impl Side {
    /// The side, given whether a part is in front of a plane, and whether a part is behind it.
    fn of(in_front: bool, behind: bool) -> Self {
        match (in_front, behind) {
            (true, true) => Self::Spanning,
            (true, false) => Self::Front,
            (false, true) => Self::Back,
            (false, false) => Self::Coplanar,
        }
    }
}

/// A plane prepared for many decisions: its rounded equation, and the error bound of the filter.
#[derive(Clone, Copy, Debug)]
pub struct PreparedPlane {
    pub(super) plane: PlaneId,
    normal: [f64; 3],
    offset: f64,
    /// The filter's bound: a rounded distance of larger magnitude has the right sign.
    pub(super) bound: f64,
    /// The tolerance times the length of the exact normal, within a share of 10⁻⁹, rounded down to an
    /// integer.
    pub(super) band: f64,
}

impl PreparedPlane {
    /// Prepares a plane.
    pub fn new(faces: &Faces, plane: PlaneId) -> Self {
        match plane.kind() {
            PlaneKind::Axis(axis, corner) => {
                let mut normal = [0.0; 3];
                normal[axis] = 1.0;
                let offset = faces.corner(corner)[axis];
                let band = faces.tolerance().floor();
                PreparedPlane { plane, normal, offset, bound: AXIS_ERROR, band }
            }
            PlaneKind::Face(face) => {
                let corners = faces.triangle(face);
                let rounded = RoundedNormal::through(corners);
                let RoundedNormal { normal, size } = rounded;
                let ([x, y, z], p) = (normal, corners[0]);
                let offset = x * p[0] + y * p[1] + z * p[2];
                let band = floor(faces.tolerance() * faces.normal_length(face, &rounded));
                PreparedPlane { plane, normal, offset, bound: FACE_ERROR * size, band }
            }
        }
    }

    /// The rounded normal.
    pub(crate) fn normal(&self) -> DVec3 {
        DVec3::from_array(self.normal)
    }

    /// The name of the plane.
    pub(crate) fn id(&self) -> PlaneId {
        self.plane
    }

    /// Returns the signed distance of a position, times the length of the normal, rounded; positive in front.
    #[inline]
    pub fn distance(&self, p: [f64; 3]) -> f64 {
        let n = self.normal;
        n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - self.offset
    }

    /// The side of the plane on which every piece with rounded vertices in a box lies, further than twice the
    /// tolerance from the plane; `None` if the box does not decide.
    pub(crate) fn side_of_box(&self, [low, high]: [[f64; 3]; 2]) -> Option<Side> {
        let lowest = std::array::from_fn(|i| if self.normal[i] > 0.0 { low[i] } else { high[i] });
        let highest = std::array::from_fn(|i| if self.normal[i] > 0.0 { high[i] } else { low[i] });
        // The bound is for a vertex at the corner of the box. Other vertices of the piece may have larger
        // coordinates, and so larger errors: three roundings of the largest coordinate, a third of the bound.
        let far = 2.0 * (self.band + self.bound);
        if self.distance(lowest) > far {
            Some(Side::Front)
        } else if self.distance(highest) < -far {
            Some(Side::Back)
        } else {
            None
        }
    }

    /// The side of the plane on which a lattice point lies; `Equal` if the point is within the tolerance of
    /// the plane.
    #[cfg(feature = "drawing")]
    pub(crate) fn side_beyond(&self, faces: &Faces, point: &[f64; 3]) -> Ordering {
        let (distance, far) = (self.distance(*point), self.band + 2.0 * self.bound);
        if distance.abs() > far {
            return distance.total_cmp(&0.0);
        }
        let (at, band) = (faces.plane(self.plane).at(point), Int::<3>::from_f64(self.band));
        match ((at - band).sign(), (at + band).sign()) {
            (Ordering::Greater, _) => Ordering::Greater,
            (_, Ordering::Less) => Ordering::Less,
            _ => Ordering::Equal,
        }
    }

    /// The distance by which a lattice point is further than the tolerance on one side of the plane, times the length
    /// of the normal; negative for other points.
    #[cfg(feature = "drawing")]
    pub(crate) fn excess(&self, faces: &Faces, point: &[f64; 3], side: Ordering) -> Int<3> {
        let (at, band) = (faces.plane(self.plane).at(point), Int::from_f64(self.band));
        if side.is_gt() { at - band } else { -at - band }
    }

    /// Whether `band` is the tolerance times the length of the exact normal, within a share of 10⁻⁹.
    #[cfg(feature = "validate")]
    pub(crate) fn has_length_of(&self, faces: &Faces) -> bool {
        /// A share of the length: more than the error of the normal, and far more than the rounding error of
        /// the length.
        const SHARE: f64 = 1e-9;
        let exact = faces.tolerance() * faces.plane(self.plane).normal_f64().length();
        self.band <= exact * (1.0 + SHARE) && self.band + 1.0 >= exact * (1.0 - SHARE)
    }

    /// Returns the largest error of [`distance`](Self::distance) plus the tolerance, in the same unit. If the
    /// rounded position of a vertex is further than this sum from the plane, the sign of the distance
    /// certainly is the vertex's side.
    pub fn slack(&self) -> f64 {
        self.bound + self.band
    }

    /// Returns the side of the plane on which a piece of a face lies, by the rules at the head of this file.
    /// `cut` contains the vertices of a piece that was cut, in order; it is `None` for the whole face.
    #[inline]
    pub fn classify(&self, faces: &Faces, face: u32, cut: Option<&[Vertex]>) -> Side {
        self.classify_and_reach(faces, face, cut).0
    }

    /// The same side, and whether the piece may come within twice the tolerance of the plane.
    #[inline]
    pub(crate) fn classify_and_reach(
        &self,
        faces: &Faces,
        face: u32,
        cut: Option<&[Vertex]>,
    ) -> (Side, bool) {
        if self.plane == PlaneId::face(face) {
            return (Side::Coplanar, true);
        }
        let (low, high) = self.extent_of(faces, face, cut);
        let reaches = low <= self.twice() && high >= -self.twice();
        (self.side_of_extent(faces, face, cut, [low, high]), reaches)
    }

    /// Whether a piece may count as on a side of the plane, or as on the plane: no point of it is further from there than
    /// twice the tolerance.
    pub(crate) fn allows(
        &self,
        faces: &Faces,
        face: u32,
        cut: Option<&[Vertex]>,
        side: Side,
    ) -> bool {
        let (low, high) = self.extent_of(faces, face, cut);
        (side == Side::Back || low >= -self.twice())
            && (side == Side::Front || high <= self.twice())
    }

    /// Whether a piece reaches beyond one side of the plane by more than the tolerance, given the other side.
    pub(crate) fn leaves(
        &self,
        faces: &Faces,
        face: u32,
        cut: Option<&[Vertex]>,
        inside: Side,
    ) -> bool {
        self.is_left_by(self.extent_of(faces, face, cut), inside)
    }

    /// Whether some part of a piece with these rounded vertices may be within twice the tolerance of the plane.
    pub(crate) fn comes_near(&self, vertices: &[[f64; 3]]) -> bool {
        let (low, high) = self.extent(vertices.iter().copied());
        low <= self.twice() && high >= -self.twice()
    }

    /// Whether these rounded vertices are nowhere further inside than the tolerance.
    pub(crate) fn has_beyond(&self, inside: Side, vertices: &[[f64; 3]]) -> bool {
        let (low, high) = self.extent(vertices.iter().copied());
        // Seen from the other side, the inside is beyond the plane.
        !self.is_left_by((-high, -low), inside)
    }

    /// Whether vertices that extend from `low` to `high` reach beyond the side `inside` by more than the tolerance.
    fn is_left_by(&self, (low, high): (f64, f64), inside: Side) -> bool {
        (if inside == Side::Front { -low } else { high }) > self.slack()
    }

    /// A bound on the rounded distance of points within twice the tolerance.
    fn twice(&self) -> f64 {
        2.0 * self.band + self.bound
    }

    /// The side of a piece whose rounded vertices extend from `low` to `high`.
    #[inline]
    fn side_of_extent(
        &self,
        faces: &Faces,
        face: u32,
        cut: Option<&[Vertex]>,
        [low, high]: [f64; 2],
    ) -> Side {
        // A distance above `near` is certainly not 0; a distance above `far` certainly exceeds the tolerance.
        let (near, far) = (self.bound, self.band + self.bound);
        // The tolerance applies to the corners of the whole face. So a whole face may reach behind by the
        // tolerance and still be in front. For a piece, the corners of its face would have to be tested, as
        // `classify_exactly` does.
        let allowed = if cut.is_none() { near - self.band } else { near };
        if high > far && low >= allowed {
            Side::Front
        } else if low < -far && high <= -allowed {
            Side::Back
        } else if high > far && low < -far {
            Side::Spanning
        } else if cut.is_none() && high.max(-low) <= self.band - near {
            Side::Coplanar
        } else {
            self.classify_exactly(faces, face, cut)
        }
    }

    /// The least and the greatest distance of the vertices of a piece, rounded.
    #[inline]
    fn extent_of(&self, faces: &Faces, face: u32, cut: Option<&[Vertex]>) -> (f64, f64) {
        match (cut, faces.corners(face)) {
            (Some(vertices), _) => self.extent(vertices.iter().map(|vertex| vertex.position)),
            // Without a loop, because most faces have three or four corners.
            (None, &[a, b, c]) => self.extent([a, b, c].into_iter()),
            (None, &[a, b, c, d]) => self.extent([a, b, c, d].into_iter()),
            (None, corners) => self.extent(corners.iter().copied()),
        }
    }

    /// The least and the greatest distance of some positions, rounded.
    #[inline]
    fn extent(&self, positions: impl Iterator<Item = [f64; 3]>) -> (f64, f64) {
        positions.map(|position| self.distance(position)).fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            // Not `min` and `max`, which take more instructions because of NaN.
            |(low, high), s| (if s < low { s } else { low }, if s > high { s } else { high }),
        )
    }

    /// Like [`classify`](Self::classify), with every comparison certified.
    #[cold]
    fn classify_exactly(&self, faces: &Faces, face: u32, cut: Option<&[Vertex]>) -> Side {
        let corners = faces.corners(face);
        let corner = |k: usize, threshold| {
            compare(faces, self, face, VertexId::corner(k as u32), corners[k], threshold)
        };
        // The third corner of a segment does not belong to it.
        let count = faces.reach(face);
        let band = self.band;
        // First the whole face decides, so that all pieces of the face are treated alike. Tested one by one,
        // some pieces would be coplanar and others spanning.
        let in_front = (0..count).any(|k| corner(k, band).is_gt());
        let behind = (0..count).any(|k| corner(k, -band).is_lt());
        let of_face = Side::of(in_front, behind);
        match (cut, of_face) {
            // The face spans the plane by more than the tolerance, so its pieces are decided exactly. The pieces
            // are not coplanar: a convex piece with an area lies in the plane only if its face does.
            (Some(vertices), Side::Spanning) => self.exact_side(faces, face, vertices),
            _ => of_face,
        }
    }

    /// The side of the plane on which a piece of a face lies, as if the tolerance were 0.
    pub(crate) fn exact_side(&self, faces: &Faces, face: u32, vertices: &[Vertex]) -> Side {
        let (mut in_front, mut behind) = (false, false);
        for vertex in vertices {
            let side = self.side(faces, face, vertex);
            in_front |= side.is_gt();
            behind |= side.is_lt();
        }
        Side::of(in_front, behind)
    }

    /// Returns the side of the plane on which a vertex of a face's piece lies, exactly.
    #[inline]
    pub fn side(&self, faces: &Faces, face: u32, vertex: &Vertex) -> Ordering {
        compare(faces, self, face, vertex.vertex_id, vertex.position, 0.0)
    }
}

/// A number of at least 0, rounded down. Not `f64::floor`, which calls a function on processors without an
/// instruction for it.
#[inline]
fn floor(value: f64) -> f64 {
    /// Every `f64` of at least this is an integer.
    const WHOLE: f64 = (1u64 << 52) as f64;
    if value < WHOLE { value as i64 as f64 } else { value }
}

/// The largest distance of a rounded vertex from a face's plane that can have the wrong sign, per unit of π =
/// Σ over components of |u_j w_k| + |u_k w_j|.
///
/// Let ε = 2⁻⁵³, m the largest coordinate, u and w the exact edges of the triangle, n their product with
/// components at most πᵢ, v the vertex, p the point on the plane, d = v − p, and P = n₀p₀ + n₁p₁, V = n₀v₀ +
/// n₁v₁, N = n·p. The sign can only be wrong if n·v and N differ by no more than a few επm, so n·v counts as
/// N here. The parts of the error, each a multiple of ε:
///
/// - the rounded normal: Σ (πᵢ + |nᵢ|)|dᵢ|;
/// - the two scalar products: Σ |nᵢ|(|pᵢ| + |vᵢ|) + |P| + |V| + 2|N|; their difference is exact;
/// - the vertex, three roundings of each coordinate (see [`Faces::position`]); the rounding of the common
///   denominator moves the vertex along v: 2 Σ |nᵢ||vᵢ| + |N|. (Truncating its weights adds
///   [`OFF`](super::vertex::OFF), less than a thirtieth of a rounding of m.)
///
/// Everything except Σ (πᵢ + |nᵢ|)|dᵢ| + 3|N| + |P| + |V| is at most 4πm. That sum is at most 5πm:
/// the excess of π over |n₀| + |n₁| + |n₂| counts twice, and in units in which |n₀| + |n₁| + |n₂|
/// and m are 1, the rest is 2 Σ |nᵢ||dᵢ| + 3|N| + |P| + |V|. As |dᵢ| + |pᵢ + vᵢ| ≤ 2,
/// Σ |nᵢ||dᵢ| ≤ 2 − 2|N|.
///
/// - If P and V have the same sign, Σ |nᵢ||dᵢ| + |P| + |V| ≤ 2 as well: 4 + |N|.
/// - Otherwise let x be |n₂|. Of P and V, one number has the sign of N. Let b be the magnitude of this
///   number, and a the magnitude of the other number. Then |n₂d₂| = a + b ≤ 2x, the rest of Σ |nᵢ||dᵢ| is at
///   most 2(1 − x) − |b − a|, and
///   |N| ≤ x − a. So the sum is at most
///   4 − x − 2|b − a| + 3b, with a and b at most 1 − x. That is at most 4 + 2x and 7 − 4x.
///
/// The total is 9 επm. For a corner moved onto its face's plane, the error of the vertex is replaced by half
/// a step along one axis, which is 2ε of m. A tolerance of m/128 adds at most 1/32, and moves vertices out to
/// 1.014 m. Too small: wrong decisions pass. Too large: integers decide cases that floats could have decided.
const FACE_ERROR: f64 = 9.2 * (f64::EPSILON / 2.0) * LIMIT;

/// The largest distance of a rounded vertex from an axis-aligned plane that can have the wrong sign. This is
/// the error of the vertex's coordinate: three roundings of a coordinate of at most 1.014 m, and less than a
/// thirtieth of a rounding for truncating the vertex's weights. The difference of two numbers this close is
/// exact.
const AXIS_ERROR: f64 = 3.1 * (f64::EPSILON / 2.0) * LIMIT;

/// Compares a vertex's distance from a plane with a threshold: by the filter if the filter is certain,
/// otherwise by integers.
#[inline]
pub(super) fn compare(
    faces: &Faces,
    prepared: &PreparedPlane,
    face: u32,
    vertex: VertexId,
    position: [f64; 3],
    threshold: f64,
) -> Ordering {
    let excess = prepared.distance(position) - threshold;
    // The threshold is an integer, hence exact. The subtraction loses at most one ulp of the larger number,
    // which the bound includes.
    if excess > prepared.bound {
        Ordering::Greater
    } else if excess < -prepared.bound {
        Ordering::Less
    } else {
        compare_exactly(faces, prepared, face, vertex, threshold)
    }
}

/// Like [`compare`], by integers alone.
#[cold]
fn compare_exactly(
    faces: &Faces,
    prepared: &PreparedPlane,
    face: u32,
    vertex: VertexId,
    threshold: f64,
) -> Ordering {
    if threshold == 0.0 && vertex.is_on(prepared.plane) {
        return Ordering::Equal;
    }
    let plane = faces.plane(prepared.plane);
    let threshold = Int::<3>::from_f64(threshold);
    let value = |x: &[f64; 3]| plane.at(x) - threshold;
    // A vertex on an edge was made between the edge's ends. If both ends are on one side of the plane, so is
    // the vertex, and no weights are needed.
    if let Some([a, b]) = faces.edge_ends(face, vertex) {
        // Not `map`, which calls a function for each end.
        match (value(&a).sign(), value(&b).sign()) {
            (a, b) if a == b || b.is_eq() => return a,
            (Ordering::Equal, b) => return b,
            _ => {}
        }
    }
    faces.weights::<5>(face, vertex).sign(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    /// Boxes of one lattice point, so near a plane that floats decide its side wrongly.
    #[test]
    fn a_box_is_on_a_side_only_if_it_is_so_exactly() {
        let (mut random, mut wrong, mut told) = (SplitMix64::new(6), 0, 0);
        for _ in 0..200 {
            let triangle = [(); 3].map(|()| random.point(-1.0, 1.0));
            let all = [DVec3::NEG_ONE, DVec3::ONE, DVec3::X];
            let (faces, _) = Faces::new([triangle, all], Some(0.0)).unwrap();
            let prepared = PreparedPlane::new(&faces, PlaneId::face(0));
            let plane = faces.plane(PlaneId::face(0));
            let (normal, main) = (plane.normal_f64(), plane.dominant_axis());
            for step in 0..50 {
                let mut at = (random.point(-0.9, 0.9) * LIMIT / 2.0).round();
                let off = normal.dot(at - DVec3::from(faces.corner(0))) / normal[main];
                at[main] = (at[main] - off).round() + f64::from(step % 5 - 2);
                let point = at.to_array();
                if at.abs().max_element() > LIMIT {
                    continue;
                }
                let exact = plane.at(&point).sign();
                let rounded = prepared.distance(point).total_cmp(&0.0);
                wrong += usize::from(exact.is_ne() && rounded != exact);
                let side = prepared.side_of_box([point; 2]);
                told += usize::from(side.is_some());
                assert!(side != Some(Side::Front) || exact.is_gt(), "{point:?}");
                assert!(side != Some(Side::Back) || exact.is_lt(), "{point:?}");
            }
        }
        assert!(wrong > 20, "{wrong} {told}");
    }

    /// The sliver is in the plane z = 0. Twice its area is 1 in square lattice units, but 2⁴⁸ if computed in
    /// floats.
    fn with_sliver(tolerance: Option<f64>) -> Faces {
        let sliver = [
            [-1.0, -1.0, 0.0],
            [0.719_638_576_572_251_9, 0.75, 0.0],
            [0.931_029_674_363_226_3, 0.965_123_355_671_395_6, 0.0],
        ];
        let rest = [[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]];
        Faces::new([sliver, rest], tolerance).unwrap().0
    }

    #[cfg(feature = "drawing")]
    #[test]
    fn points_are_beyond_the_tolerance_by_their_distance() {
        for tolerance in [None, Some(0.0), Some(1e-3)] {
            let faces = with_sliver(tolerance);
            let length = faces.tolerance();
            let prepared = PreparedPlane::new(&faces, PlaneId::face(0));
            let near = (length * (1.0 - 1e-9)).floor();
            let far = (length * (1.0 + 1e-9)).floor() + 1.0;
            let up = faces.plane(PlaneId::face(0)).normal()[2].signum() as f64;
            for (z, expected) in [
                (far, Ordering::Greater),
                (-far, Ordering::Less),
                (near, Ordering::Equal),
                (-near, Ordering::Equal),
                (2f64.powi(48), Ordering::Greater),
            ] {
                let side = prepared.side_beyond(&faces, &[12345.0, -678.0, z * up]);
                assert_eq!(side, expected, "{z} of {length}");
            }
        }
    }

    #[test]
    fn a_tolerance_that_is_another_length_is_noticed() {
        for tolerance in [None, Some(1e-3)] {
            let faces = with_sliver(tolerance);
            for plane in [PlaneId::face(0), PlaneId::face(1), PlaneId::axis(1, 2)] {
                let prepared = PreparedPlane::new(&faces, plane);
                assert!(prepared.has_length_of(&faces));
                for share in [0.0, 1.0 - 1e-6, 1.0 + 1e-6, 2.0] {
                    let band = (prepared.band * share).floor();
                    let other = PreparedPlane { band, ..prepared };
                    assert!(!other.has_length_of(&faces), "{share} at {plane:?}");
                }
            }
        }
    }
}
