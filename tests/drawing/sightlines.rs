//! What hides a point, in rationals: faces, with their edges, between it and the eye.

use binspace::glam::DVec3;
use binspace::internals::Faces;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::cmp::Ordering;
use testkit::model::Face;
use testkit::rational::{self, Point, Rational};

/// Where rays come from, on the lattice of a scene.
pub(crate) enum Origin {
    Eye(Point),
    /// They have this direction, and no beginning.
    Along(Point),
}

/// What is in front of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cover {
    None,
    Hidden,
    /// The border of a face, or the point is on a face of another polygon.
    Unsure,
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

    /// What lies between a point and the eye, without the faces that it is on.
    pub(crate) fn cover(&self, point: &Point, own: [usize; 2]) -> Cover {
        let mut cover = Cover::None;
        for ((polygon, face), corners) in self.faces.iter().zip(&self.rounded) {
            let is_on = face.plane.at(point).is_zero();
            if is_on && own.contains(polygon) || !self.may_be_before(corners, to_f64(point)) {
                continue;
            }
            match if is_on { self.place(face, point) } else { self.before(face, point) } {
                Some(Ordering::Greater) if !is_on => return Cover::Hidden,
                Some(Ordering::Less) | None => {}
                Some(_) => cover = Cover::Unsure,
            }
        }
        cover
    }

    fn is_before(&self, face: &Face, point: &Point) -> bool {
        self.before(face, point).is_some_and(Ordering::is_ge)
    }

    /// Whether the line of sight of a point goes through a face before the point, as in [`place`](Self::place).
    fn before(&self, face: &Face, point: &Point) -> Option<Ordering> {
        let at = face.plane.at(point);
        let (from, share) = match &self.origin {
            Origin::Eye(eye) => {
                let at_eye = face.plane.at(eye);
                if at_eye == at {
                    return None;
                }
                // From 0 at the point to 1 at the eye.
                (rational::difference(eye, point), &at / (&at - &at_eye))
            }
            Origin::Along(direction) => {
                let slope = rational::scalar(&face.plane.normal, direction);
                if slope.is_zero() {
                    return None;
                }
                let zero = [(); 3].map(|()| Rational::zero());
                (rational::difference(&zero, direction), &at / slope)
            }
        };
        let ends_at_eye = matches!(self.origin, Origin::Eye(_));
        if !share.is_positive() || ends_at_eye && share >= Rational::one() {
            return None;
        }
        let hit: Point = std::array::from_fn(|i| &point[i] + &from[i] * &share);
        self.place(face, &hit)
    }

    /// Whether a point of a face's plane is inside the face, on its border, or outside.
    fn place(&self, face: &Face, point: &Point) -> Option<Ordering> {
        let n = face.corners.len();
        let turns = (0..n).map(|k| {
            let (a, b) = (&face.corners[k], &face.corners[(k + 1) % n]);
            let (edge, arm) = (rational::difference(b, a), rational::difference(point, a));
            let turn = rational::product(&edge, &arm);
            rational::sign(&rational::scalar(&turn, &face.plane.normal))
        });
        turns.min()
    }
}

fn to_f64(point: &Point) -> DVec3 {
    DVec3::from_array(point.each_ref().map(|c| c.to_f64().expect("in range")))
}
