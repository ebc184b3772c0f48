//! What hides a point, in rationals: faces, with their edges, between it and the eye.

use super::support::model::Face;
use super::support::rational::{self, Point, Rational};
use binspace::glam::DVec3;
use binspace::internals::Faces;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Where rays come from, on the lattice of a scene.
pub(crate) enum Origin {
    Eye(Point),
    /// They have this direction, and no beginning.
    Along(Point),
}

/// The faces of a scene.
pub(crate) struct Sightlines {
    faces: Vec<(usize, Face)>,
    /// The corners of each, rounded.
    rounded: Vec<Vec<DVec3>>,
    pub(crate) origin: Origin,
}

impl Sightlines {
    pub(crate) fn new(faces: &Faces, origin: Origin) -> Self {
        let all = (0..faces.len() as u32).map(|face| (faces.polygon(face), Face::new(faces, face)));
        let all: Vec<(usize, Face)> = all.collect();
        let rounded = all.iter().map(|(_, face)| face.corners.iter().map(to_f64).collect());
        Self { rounded: rounded.collect(), faces: all, origin }
    }

    /// The polygons that hide a point of the scene, each once.
    pub(crate) fn polygons_before(&self, point: &Point) -> Vec<usize> {
        let all = self.faces.iter().zip(&self.rounded);
        let mut polygons: Vec<usize> = all
            .filter(|(_, corners)| self.may_be_before(corners, to_f64(point)))
            .filter(|((_, face), _)| self.is_before(face, point))
            .map(|((polygon, _), _)| *polygon)
            .collect();
        // Faces of one polygon follow one another.
        polygons.dedup();
        polygons
    }

    /// Whether the line of sight of a point may go through a face, if floats tell: only to save time.
    fn may_be_before(&self, corners: &[DVec3], point: DVec3) -> bool {
        let (from, way) = match &self.origin {
            Origin::Eye(eye) => (to_f64(eye), point - to_f64(eye)),
            Origin::Along(direction) => (point, to_f64(direction)),
        };
        let arms = || corners.iter().map(|corner| *corner - from);
        let turns: Vec<f64> = arms()
            .zip(arms().cycle().skip(1))
            .map(|(a, b)| a.cross(b).dot(way) / (1.0 + a.length() * b.length() * way.length()))
            .collect();
        turns.iter().all(|&turn| turn > -1e-9) || turns.iter().all(|&turn| turn < 1e-9)
    }

    fn is_before(&self, face: &Face, point: &Point) -> bool {
        let at = face.plane.at(point);
        let (from, share) = match &self.origin {
            Origin::Eye(eye) => {
                let at_eye = face.plane.at(eye);
                if at_eye == at {
                    return false;
                }
                // From 0 at the point to 1 at the eye.
                (rational::difference(eye, point), &at / (&at - &at_eye))
            }
            Origin::Along(direction) => {
                let slope = rational::scalar(&face.plane.normal, direction);
                if slope.is_zero() {
                    return false;
                }
                let zero = [(); 3].map(|()| Rational::zero());
                (rational::difference(&zero, direction), &at / slope)
            }
        };
        let ends_at_eye = matches!(self.origin, Origin::Eye(_));
        if !share.is_positive() || ends_at_eye && share >= Rational::one() {
            return false;
        }
        let hit: Point = std::array::from_fn(|i| &point[i] + &from[i] * &share);
        let n = face.corners.len();
        (0..n).all(|k| {
            let (a, b) = (&face.corners[k], &face.corners[(k + 1) % n]);
            let (edge, arm) = (rational::difference(b, a), rational::difference(&hit, a));
            let turn = rational::product(&edge, &arm);
            !rational::scalar(&turn, &face.plane.normal).is_negative()
        })
    }
}

fn to_f64(point: &Point) -> DVec3 {
    DVec3::from_array(point.each_ref().map(|c| c.to_f64().expect("in range")))
}
