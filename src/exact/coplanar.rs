//! Whether two faces lie in one plane: the one place that decides it.
//!
//! Two faces are *coplanar* if every corner of the smaller face is within the tolerance of the larger face's
//! plane. The corners of all faces are rounded by the same amount, so the plane of a small face is less
//! certain. Extended across a large face, it can deviate from that face by many times the tolerance. So the
//! plane of the larger face decides. With τ = 0, faces are coplanar if their planes are equal.
//!
//! The relation is symmetric, but not transitive: two faces can be coplanar with a third and up to 2 τ apart.

use glam::DVec3;

use super::plane::RoundedNormal;
use super::{Faces, PreparedPlane, Side};

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

    /// Whether two faces lie in one plane.
    #[cfg(any(feature = "drawing", test))]
    pub(crate) fn are_coplanar(&self, one: u32, other: u32) -> bool {
        let [large, small] = if self.is_larger(one, other) { [one, other] } else { [other, one] };
        PreparedPlane::new(self, super::PlaneId::face(large)).contains(self, small)
    }
}

impl PreparedPlane {
    /// Whether every corner of a face is within the tolerance of the plane.
    #[inline]
    pub(crate) fn contains(&self, faces: &Faces, face: u32) -> bool {
        // Most planes are far from the first corner.
        self.distance(faces.corners(face)[0]).abs() <= self.slack()
            && self.classify(faces, face, None) == Side::Coplanar
    }
}

#[cfg(test)]
mod tests {
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
}
