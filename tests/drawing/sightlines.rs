//! What hides a point, in rationals: faces, with their edges, between it and the eye.

use super::support::model::Face;
use super::support::rational::{self, Point, Rational};
use binspace::internals::Faces;
use num_traits::{One, Signed, Zero};

/// Where rays come from, on the lattice of a scene.
pub(crate) enum Origin {
    Eye(Point),
    /// They have this direction, and no beginning.
    Along(Point),
}

/// The faces of a scene.
pub(crate) struct Sightlines {
    faces: Vec<(usize, Face)>,
    pub(crate) origin: Origin,
}

impl Sightlines {
    pub(crate) fn new(faces: &Faces, origin: Origin) -> Self {
        let all = (0..faces.len() as u32).map(|face| (faces.polygon(face), Face::new(faces, face)));
        Self { faces: all.collect(), origin }
    }

    /// The polygons that hide a point of the scene.
    pub(crate) fn before<'a>(&'a self, point: &'a Point) -> impl Iterator<Item = usize> + 'a {
        self.faces
            .iter()
            .filter(|(_, face)| self.is_before(face, point))
            .map(|(polygon, _)| *polygon)
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
